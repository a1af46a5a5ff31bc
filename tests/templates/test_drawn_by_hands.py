"""Every question that is drawn: hundreds of hands draw it right, and wrong in known ways.

The lines are worked out here, from the numbers of the draw and the textbook's formulas.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import pytest
from grading.hands import Line, drawings, waved
from sweep import draws, together

from quizgen.bank.bank import builtin_bank
from quizgen.kinds.grade import grade_answer, show_key
from quizgen.question.compose import draw_instance
from quizgen.question.part_context import ask_part

Values = dict[str, float]
Lines = dict[str, Line]
HANDS = [5, pytest.param(draws(20, full=250), marks=pytest.mark.slow)]
WRONG_HANDS = [2, pytest.param(draws(10, full=35), marks=pytest.mark.slow)]


@dataclass(frozen=True)
class Task:
    """What is drawn, and shapes that are wrong with what is said of them: a mistake, or features."""

    part: int
    right: Callable[[Values], Lines]
    wrong: dict[str, tuple[Callable[[Values], Lines], set[str]]]


def but(right: Callable[[Values], Lines], **changed: Callable[[Values], Line | None]):
    """Right lines, some of them replaced or left out."""

    def lines(v: Values) -> Lines:
        made = {**right(v), **{name: change(v) for name, change in changed.items()}}
        return {name: line for name, line in made.items() if line}

    return lines


def bent(right: Callable[[Values], Lines], name: str, size: float):
    return but(right, **{name: lambda v: waved(right(v)[name], size, 0.5)})


def rays(v: Values) -> Lines:
    """1/f = 1/g + 1/b, and sizes are as distances."""
    f, g, h = v["f"], v["g"], v["h"]
    b = 1 / (1 / f - 1 / g)
    tip = (b, -h * b / g)
    return {"parallel": [(-g, h), (0, h), tip], "central": [(-g, h), (0, 0), tip],
            "image": [(b, 0), tip]}  # fmt: skip


def parallel(slope: Callable[[Values], float]):
    """The parallel ray with another slope behind the lens, as long as the field is high."""

    def line(v: Values) -> Line:
        b, fall = rays(v)["image"][0][0], slope(v)
        far = min([b, *([(2.9 - v["h"]) / -fall] if fall < 0 else [])])
        return [(-v["g"], v["h"]), (0, v["h"]), (far, v["h"] - far * fall)]

    return line


LENS = Task(0, rays, {
    "no lens": (but(rays, parallel=parallel(lambda _: 0)), {"trap:straight-on"}),
    "through 2f": (but(rays, parallel=parallel(lambda v: v["h"] / v["f"] / 2)),
                   {"trap:twice-as-far"}),
    "bent away": (but(rays, parallel=parallel(lambda v: -v["h"] / v["f"])), {"parallel-ray"}),
    "too steep": (but(rays, parallel=lambda v: [(-v["g"], v["h"]), (0, v["h"]), (v["f"] / 2, 0),
                                                (v["f"] * 0.9, -v["h"] * 0.8)]), {"parallel-ray"}),
    "not parallel": (but(rays, parallel=lambda v: [(-v["g"], v["h"]), (0, v["h"] / 2),
                                                   rays(v)["image"][1]]), {"parallel-ray"}),
    "bent in the centre": (but(rays, central=lambda v: [(-v["g"], v["h"]), (0, 0),
                                                        (rays(v)["image"][0][0], 0)]),
                           {"trap:centre-bent"}),
    "beside the centre": (but(rays, central=lambda v: [(-v["g"], v["h"]), (0, v["h"] / 2),
                          (rays(v)["image"][0][0], v["h"] / 2)]), {"central-ray"}),
    "upright": (but(rays, image=lambda v: [(x, -y) for x, y in rays(v)["image"]]),
                {"trap:upright"}),
    "at the focus": (but(rays, image=lambda v: [(v["f"], y) for _, y in rays(v)["image"]]),
                     {"trap:at-focus"}),
    "too short": (but(rays, image=lambda v: [(x, 0.5 * y) for x, y in rays(v)["image"]]), {"arrow"}),
    "no image": (but(rays, image=lambda _: None), {"arrow"}),
    "no central ray": (but(rays, central=lambda _: None), {"central-ray"}),
    "a curved ray": (bent(rays, "central", 0.8), {"central-ray"}),
})  # fmt: skip


def pinhole(v: Values) -> Lines:
    """p/f = h/Z, upside down."""
    f, far, h = v["f"], v["Z"], v["h"]
    tip = (f, -f * h / far)
    return {"ray": [(-far, h), tip], "image": [(f, 0), tip]}


PINHOLE = Task(0, pinhole, {
    "upright": (but(pinhole, ray=lambda v: [(-v["Z"], v["h"]), (0, 0),
                                            (v["f"], v["f"] * v["h"] / v["Z"])],
                    image=lambda v: [(x, -y) for x, y in pinhole(v)["image"]]), {"trap:upright"}),
    "along the axis": (but(pinhole, ray=lambda v: [(-v["Z"], v["h"]), (0, 0), (v["f"], 0)]),
                       {"trap:level"}),
    "as large": (but(pinhole, image=lambda v: [(v["f"], 0), (v["f"], -v["h"])]),
                 {"trap:same-size"}),
    "in front": (but(pinhole, image=lambda v: [(-x, -y) for x, y in pinhole(v)["image"]]),
                 {"trap:in-front"}),
    "half as large": (but(pinhole, image=lambda v: [(x, y / 2) for x, y in pinhole(v)["image"]]),
                      {"size"}),
    "beside the hole": (but(pinhole, ray=lambda v: [(x, y - 0.9) for x, y in pinhole(v)["ray"]]),
                        {"ray"}),
    "no ray": (but(pinhole, ray=lambda _: None), {"ray"}),
    "off the plane": (but(pinhole, image=lambda v: [(x - 1.3, y) for x, y in pinhole(v)["image"]]),
                      {"plane"}),
})  # fmt: skip


def bars(level: Callable[[Values, float], float], height: Callable[[Values], float] = lambda _: 1):
    """Upright lines where a level goes."""

    def lines(v: Values) -> Lines:
        old = [v["a"], v["x_2"], v["x_3"], v["b"]]
        return {str(i): [(level(v, x), 0), (level(v, x), height(v) * v[f"c_{i}"])]
                for i, x in enumerate(old, 1)}  # fmt: skip

    return lines


def normalised(v: Values, level: float) -> float:
    return 255 * (level - v["a"]) / (v["b"] - v["a"])


histogram = bars(normalised)
HISTOGRAM = Task(0, histogram, {
    "only shifted": (bars(lambda v, x: x - v["a"]), {"trap:shifted"}),
    "only stretched": (bars(lambda v, x: 255 * x / v["b"]), {"trap:scaled"}),
    "backwards": (bars(lambda v, x: 255 - normalised(v, x)), {"trap:reversed"}),
    "lower": (bars(normalised, lambda v: (v["b"] - v["a"]) / 255), {"trap:lowered"}),
    "as it was": (bars(lambda _, x: x), {"begins", "ends"}),
    "one left out": (but(histogram, **{"1": lambda _: None}), {"begins"}),
    "hanging": (lambda v: {name: [(x, 10), (x, 10 - y)] for name, ((x, _), (_, y)) in
                           histogram(v).items()}, {"heights"}),
    "even": (lambda v: {str(i): [(85 * i, 0), (85 * i, v[f"c_{i + 1}"])] for i in range(4)},
             {"between"}),
})  # fmt: skip

BY_DAY = [(400, 0.0), (450, 0.038), (475, 0.11), (500, 0.323), (520, 0.71), (540, 0.954),
          (555, 1.0), (570, 0.952), (600, 0.631), (620, 0.381), (650, 0.107), (700, 0.004)]  # fmt: skip
BY_NIGHT = [(400, 0.009), (420, 0.097), (440, 0.328), (480, 0.793), (507, 1.0), (520, 0.935),
            (540, 0.65), (560, 0.329), (580, 0.121), (600, 0.033), (640, 0.002), (700, 0.0)]  # fmt: skip


def hills(*peaks: float, width: float = 40, base: float = 0.0) -> Callable[[Values], Lines]:
    """A curve with hills of one height."""
    xs = [400 + 5 * i for i in range(61)]
    heights = [max(math.exp(-(((x - p) / width) ** 2)) for p in peaks) for x in xs]
    return lambda _: {"curve": [(x, max(base, y)) for x, y in zip(xs, heights, strict=True)]}


def eye(v: Values, *, other: bool = False) -> Lines:
    """CIE 1924 and CIE 1951."""
    points = BY_DAY if (v["day"] == 1) != other else BY_NIGHT
    (first, last), curve = (400, 700), []
    for x in range(first, last + 1, 5):
        (x0, y0), (x1, y1) = next(pair for pair in pairwise(points) if pair[1][0] >= x)
        curve.append((float(x), y0 + (y1 - y0) * (x - x0) / (x1 - x0)))
    return {"curve": curve}


EYE = Task(0, eye, {
    "the other one": (lambda v: eye(v, other=True), {"trap:other-eye"}),
    "three peaks": (hills(440, 540, 640, width=25), {"single"}),
    "two peaks": (hills(480, 600, width=30), {"single"}),
    "in the middle of nowhere": (hills(620), {"top"}),
    "not down to zero": (lambda v: {"curve": [(x, max(y, 0.4)) for x, y in eye(v)["curve"]]},
                         {"falls"}),
    "too low": (lambda v: {"curve": [(x, y / 2) for x, y in eye(v)["curve"]]}, {"top"}),
    "a triangle": (lambda v: {"up": [(400, 0), (555 if v["day"] else 507, 1)],
                              "down": [(555 if v["day"] else 507, 1), (700, 0)]}, {"bell"}),
    "a slope": (lambda _: {"curve": [(400, 0), (700, 1)]}, {"top", "single", "falls"}),
    "a level": (lambda _: {"curve": [(400, 0.5), (700, 0.5)]}, {"top", "single", "falls"}),
})  # fmt: skip


def grid(v: Values, share: float = 1) -> Lines:
    """x (1 + k r²) and y (1 + k r²), point by point."""
    a, k = v["a"], v["k_1"] * share
    run = [i / 10 for i in range(-10, 11)]

    def out(x: float, y: float) -> tuple[float, float]:
        return x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))

    return {"top": [out(a * t, a) for t in run], "bottom": [out(a * t, -a) for t in run],
            "left": [out(-a, a * t) for t in run], "right": [out(a, a * t) for t in run],
            "across": [out(-a, 0), out(a, 0)], "down": [out(0, -a), out(0, a)]}  # fmt: skip


GRID = Task(1, grid, {
    "the other way": (lambda v: grid(v, -1), {"trap:reversed"}),
    "half as much": (lambda v: grid(v, 0.5), {"trap:one-square"}),
    "as it was": (lambda v: grid(v, 0), {"outer", "strength"}),
    "smaller": (lambda v: {name: [(0.75 * x, 0.75 * y) for x, y in line]
                           for name, line in grid(v, 0).items()}, {"outer"}),
    "no middle": (but(grid, across=lambda _: None), {"radial"}),
    "a bent middle": (bent(grid, "down", 0.35), {"radial"}),
})  # fmt: skip


def blur(v: Values) -> Lines:
    """c = f²/(N (s - f)) |s - z|/z, in mm, with z in m."""

    def disc(z: float) -> float:
        return 2500 / (v["N"] * (1000 * v["s"] - 50)) * abs(v["s"] - z) / z

    runs = {"front": range(18, 41), "behind": range(40, 141)}
    return {name: [(v["s"] * i / 40, disc(v["s"] * i / 40)) for i in run]
            for name, run in runs.items()}  # fmt: skip


def shaped(height: Callable[[Values, float, float], float]):
    """The curve with another height, of z/s and the right height, as high as the field at most."""

    def lines(v: Values) -> Lines:
        return {name: [(z, min(v["h"], max(0.0, height(v, z / v["s"], y)))) for z, y in line]
                for name, line in blur(v).items()}  # fmt: skip

    return lines


BLUR = Task(0, blur, {
    "a V": (shaped(lambda v, r, _: 2 * v["c_1"] * abs(r - 1)), {"trap:symmetric"}),
    "straight behind": (shaped(lambda v, r, y: v["c_1"] * (r - 1) if r > 1 else y),
                        {"trap:on-and-on"}),
    "mirrored": (shaped(lambda v, r, y: v["c_1"] * (r - 1) / (2 - r) if 1 < r < 1.9
                        else v["h"] if r >= 1.9 else y), {"trap:symmetric"}),
    "highest in focus": (shaped(lambda v, _, y: v["c_1"] - y), {"trap:peak"}),
    "twice as high": (shaped(lambda _, __, y: 2 * y), {"behind", "far"}),
    "never a point": (shaped(lambda v, _, y: y + 0.3 * v["c_1"]), {"zero"}),
    "level behind": (shaped(lambda v, r, y: v["c_1"] * min(1.0, 6 * (r - 1)) if r > 1 else y),
                     {"behind"}),
    "nothing in front": (but(blur, front=lambda _: None), {"front"}),
})  # fmt: skip


def brightened(v: Values, *, beyond: float | None = 255, both: bool = True) -> Lines:
    """Levels move; what is above 255 ends there, and piles up."""
    bars = [(v["k"] * v[level] + v["b"], v[f"c_{i}"])
            for i, level in enumerate(("a", "x_2", "x_3", "x_4", "x_5"), 1)]  # fmt: skip
    kept = bars[:3]
    if beyond is None:
        kept += bars[3:]
    elif beyond:
        kept += [(beyond, sum(n for _, n in bars[3:]) if both else bars[3][1])]
    return {str(i): [(x, 0), (x, y)] for i, (x, y) in enumerate(kept)}


BRIGHTENED = Task(0, brightened, {
    "beyond 255": (lambda v: brightened(v, beyond=None), {"clipped", "inside"}),
    "none at 255": (lambda v: brightened(v, beyond=0), {"clipped", "sum"}),
    "one of two": (lambda v: brightened(v, both=False), {"trap:lost"}),
    "in a circle": (lambda v: {**brightened(v, beyond=0),
                               "x": [(v["y_4"] - 256, 0), (v["y_4"] - 256, v["c_4"])]},
                    {"trap:wrapped"}),
    "squeezed": (lambda v: {str(i): [(v[f"x_{i}"] if i > 1 else v["a"], 0)] * 2
                            and [((v[f"x_{i}"] if i > 1 else v["a"]) * 255 / v["y_5"], 0),
                                 ((v[f"x_{i}"] if i > 1 else v["a"]) * 255 / v["y_5"], v[f"c_{i}"])]
                            for i in range(1, 6)}, {"moved"}),
    "as it was": (lambda v: {str(i): [(x, 0), (x, v[f"c_{i}"])] for i, x in enumerate(
                      (v["a"], v["x_2"], v["x_3"], v["x_4"], v["x_5"]), 1)}, {"moved"}),
})  # fmt: skip


def density(v: Values, *, wide: float = 0, high: float = 0, shift: float = 0) -> Lines:
    """The Gaussian of the wanted width, or with another width, peak or place."""
    sigma = wide or v["r"]
    peak = high or 1 / math.sqrt(2 * math.pi) / v["r"]
    mean = v["mu"] + shift
    places = {"left": range(-30, 1), "right": range(31)}
    return {side: [(mean + v["r"] * i / 10, peak * math.exp(-((v["r"] * i / 10 / sigma) ** 2) / 2))
                   for i in run] for side, run in places.items()}  # fmt: skip


def humps(v: Values, side: int) -> Line:
    """Half of a curve with a hill on either side of the mean, and nothing at the mean."""
    return [(v["mu"] + side * v["r"] * i / 10,
             v["p_t"] * math.exp(-(((i - 12) / 5) ** 2))) for i in range(31)]  # fmt: skip


GAUSSIAN = Task(0, density, {
    "as high as before": (lambda v: density(v, high=v["p_s"]), {"trap:same-peak"}),
    "beside the mean": (lambda v: density(v, shift=min(1.0, v["r"])), {"sides"}),
    "flat": (lambda v: density(v, wide=3 * v["r"]), {"sides"}),
    "half as high": (lambda v: density(v, high=v["p_t"] / 2), {"height"}),
    "two hills": (lambda v: {"a": humps(v, -1), "b": humps(v, 1)}, {"top"}),
    "a triangle": (lambda v: {"left": [(v["mu"] - 3 * v["r"], 0), (v["mu"], v["p_t"])],
                              "right": [(v["mu"], v["p_t"]), (v["mu"] + 3 * v["r"], 0)]}, {"sides"}),
})  # fmt: skip


def pole(v: Values, share: float = 1) -> Lines:
    """The foot has moved on by v t while the rows above it were read."""
    moved = v["v"] * v["T"] / 1000 * v["rows"] / 1080 * share
    return {name: [(x, v["rows"]), (x + moved, 0)] for name, x in (("left", -2), ("right", 2))}


POLE = Task(0, pole, {
    "against": (lambda v: pole(v, -1), {"trap:against"}),
    "upright": (lambda v: pole(v, 0), {"leans"}),
    "half": (lambda v: pole(v, 0.5), {"trap:half"}),
    "smeared": (lambda v: {**pole(v), "left" if v["v"] > 0 else "right":
                           pole(v, 0)["left" if v["v"] > 0 else "right"]}, {"trap:smeared"}),
    "one edge": (but(pole, left=lambda _: None), {"leans"}),
    "bent": (lambda v: {name: [(x + (x_0 - x) * (y / v["rows"]) ** 3, y)
                               for y in [v["rows"] * i / 20 for i in range(21)]]
                        for name, x_0, x in (("left", -2, pole(v)["left"][1][0]),
                                             ("right", 2, pole(v)["right"][1][0]))}, {"straight"}),
})  # fmt: skip


def oval(place: float, a: float, b: float, turned_by: float = 0) -> Line:
    """An ellipse, point by point."""
    ring = [(a * math.cos(math.pi * i / 30), b * math.sin(math.pi * i / 30)) for i in range(61)]
    c, s = math.cos(turned_by), math.sin(turned_by)
    return [(place + c * x - s * y, s * x + c * y) for x, y in ring]


def box(place: float, a: float, b: float) -> Line:
    return [(place + x * a, y * b) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]


def levels(v: Values) -> Lines:
    """Half axes are roots of variances."""
    roots = [math.sqrt(v[name]) for name in "ABC"]
    return {"first": oval(v["m"], *roots[:2]), "second": oval(-v["m"], roots[2], roots[2])}


LEVELS = Task(0, levels, {
    "variances": (lambda v: {"first": oval(v["m"], v["A"], v["B"]),
                             "second": oval(-v["m"], v["C"], v["C"])}, {"trap:variances"}),
    "exchanged": (but(levels, first=lambda v: oval(v["m"], v["b"], v["a"])), {"trap:exchanged"}),
    "turned": (but(levels, first=lambda v: oval(v["m"], 1.5 * v["a"], 0.5 * v["b"], 0.7)),
               {"oval"}),
    "a box": (but(levels, first=lambda v: box(v["m"], v["a"], v["b"])), {"oval"}),
    "a rhombus": (but(levels, second=lambda v: [(v["n"] + v["c"] * x, v["c"] * y) for x, y in
                                                ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 0))]),
                  {"circle"}),
    "beside the mean": (but(levels, second=lambda v: oval(v["n"] + 1.2, v["c"], v["c"])),
                        {"circle"}),
    "half a circle": (but(levels, second=lambda v: oval(v["n"], v["c"], v["c"])[:31]), {"circle"}),
    "one alone": (but(levels, second=lambda _: None), {"circle"}),
})  # fmt: skip

TASKS = {
    "draw-blur-against-distance": BLUR,
    "draw-histogram-after-brightening": BRIGHTENED,
    "draw-gaussian-of-another-width": GAUSSIAN,
    "draw-pole-under-rolling-shutter": POLE,
    "draw-level-lines": LEVELS,
    "draw-rays-through-a-lens": LENS,
    "draw-image-through-a-pinhole": PINHOLE,
    "draw-normalised-histogram": HISTOGRAM,
    "draw-curve-of-the-eye": EYE,
    "draw-distortion-to-scale": GRID,
}


@cache
def posed(name: str, seed: int):
    """The spec of the part that is drawn, its field and the numbers of the draw."""
    drawn = draw_instance(builtin_bank().template(name), seed)
    built = ask_part(drawn, TASKS[name].part)
    values = {key: float(value) for key, value in drawn.shown_values.items()}
    return built.spec, built.control.board, values


def by_hand(board, lines: Lines, seed: int) -> str:
    """Lines drawn by one hand, which sees the field and not its numbers."""
    left, right, low, high = board.view
    wide, tall = board.size
    across, up = wide / (right - left), tall / (high - low)
    seen = [[(x * across, y * up) for x, y in line] for line in lines.values()]
    drawn = drawings(seen, seed, wide)
    strokes = [[tuple(map(float, point.split(","))) for point in stroke.split()]
               for stroke in drawn.split("; ")]  # fmt: skip
    a, b = (max(0, 2 - math.floor(math.log10(extent))) for extent in (right - left, high - low))
    return "; ".join(
        " ".join(f"{x / across:.{a}f},{y / up:.{b}f}" for x, y in stroke) for stroke in strokes
    )


@together("hands", HANDS)
@together("name", TASKS)
def test_hands_that_draw_it_right_earn_all(name, hands):
    failed = {}
    for seed in range(hands):
        spec, board, values = posed(name, seed % 20)
        verdict = grade_answer(spec, by_hand(board, TASKS[name].right(values), seed))
        if verdict.verdict != "correct":
            failed[seed] = (values, verdict.note, verdict.fields.get("because"))
    assert not failed, f"{len(failed)} of {hands}: {failed}"


def said(verdict) -> set[str]:
    return {verdict.note, *verdict.fields.get("because", ())}


@together("hands", WRONG_HANDS)
@together(
    ("name", "shape"), [(name, shape) for name, task in TASKS.items() for shape in task.wrong]
)
def test_wrong_shapes_are_named_and_never_right(name, shape, hands):
    lines, wanted = TASKS[name].wrong[shape]
    missed = {}
    for seed in range(hands):
        spec, board, values = posed(name, seed % 20)
        verdict = grade_answer(spec, by_hand(board, lines(values), seed))
        assert verdict.verdict in {"partial", "wrong"}, (seed, values, verdict)
        if not wanted <= said(verdict):
            missed[seed] = (values, said(verdict))
    assert len(missed) <= hands // 20, f"{len(missed)} of {hands}: {missed}"


@pytest.mark.parametrize("name", TASKS)
def test_points_that_are_typed_earn_the_same(name):
    for seed in range(8):
        spec, _, values = posed(name, seed)
        right = TASKS[name].right(values).values()
        typed = "\n".join(" ".join(f"({x:.2f}, {y:.2f})" for x, y in line) for line in right)
        assert grade_answer(spec, typed).verdict == "correct"
        assert grade_answer(spec, show_key(spec)).verdict == "correct"
