"""Diameter of the blur disc against the distance of a thing, for one lens at one or two f-numbers.

A dashed line marks the diameter that still counts as sharp; lines every half tick help to read.
"""

from __future__ import annotations

from functools import lru_cache
from math import floor, inf, isfinite, log10
from typing import Any

import numpy as np
from matplotlib.path import Path

from quizgen.figures.kit import (
    ABSENT,
    Parameter,
    Values,
    format_equation,
    format_given,
    format_statement,
    load_alt_words,
    require,
    strip_mathtext,
)

from ._plots import format_learned, mark_place, trace_lines

PARAMETERS = {
    "f": Parameter("mm", "focal length", low=1.0, high=1000.0),
    "s": Parameter("m", "distance in focus", low=0.1, high=1000.0),
    "N_1": Parameter("", "f-number of curve 1", low=0.5, high=128.0),
    "N_2": Parameter("", "f-number of curve 2", ABSENT, 0.5, 128.0),
    "c": Parameter("um", "largest disc that counts as sharp", ABSENT, 0.1, 10_000.0),
    "far": Parameter("m", "end of the distance axis", 10.0, 0.1, 1000.0),
    "high": Parameter("um", "end of the diameter axis", 100.0, 0.1, 100_000.0),
}
SIZE = (262.0, 126.0)

_POINTS = 120
_INKS = {"N_1": "blue", "N_2": "teal"}


def _find_disc(values: Values, number: float, z: Any) -> Any:
    """Blur disc in um of a thing at z metres: f² |z - s| / (N z (s - f))."""
    f, s = values["f"], values["s"]
    return 1000 * f**2 * abs(z - s) / (number * z * (1000 * s - f))


def _find_reach(values: Values, number: float, diameter: float) -> tuple[float, float]:
    """Nearest and farthest distance with a disc of at most this diameter; infinity from H on."""
    f, s = values["f"], values["s"]
    share = diameter * number * (1000 * s - f) / (1000 * f**2)
    return s / (1 + share), s / (1 - share) if share < 1 else inf


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, mark neither the distance in focus nor the limits."""
    require("blur_curve", 1000 * values["s"] > 2 * values["f"], "s must exceed 2 f")
    require("blur_curve", values["s"] < values["far"], "s must lie on the axis")
    ax.set(xlim=(0, values["far"]), ylim=(0, values["high"]))
    for axis, end in ((ax.xaxis, values["far"]), (ax.yaxis, values["high"])):
        ticks = _list_ticks(end)
        axis.set_ticks(ticks, map(format_given, ticks))
    ax.set_xlabel("$z$ / m")
    ax.set_ylabel("Ø / µm")
    art = ax.figure.sketch(ax)
    art.shape(_trace_grid(values["far"], values["high"]), None, "rule", 0.4, part="grid")
    _draw_curves(art, values, told=not quiz)
    if "c" in values:
        _draw_limit(art, values, told=not quiz)
    if not quiz:
        text = ",   ".join(_list_answers(values))
        art.label((values["far"], values["high"]), text, "r", 10, "red", shift=(0, 25),
                  part="answer")  # fmt: skip


def _list_numbers(values: Values) -> tuple[str, ...]:
    return tuple(name for name in ("N_1", "N_2") if name in values)


def _list_ticks(end: float) -> list[float]:
    """Ticks 1, 2 or 5 times a power of ten apart, 5 to 10 of them after the one at 0."""
    power = 10.0 ** floor(log10(end))
    step = next(one for one in (power / 10, power / 5, power / 2, power) if end / one <= 10)
    return [round(step * count, 9) for count in range(floor(end / step + 1e-9) + 1)]


@lru_cache(64)
def _trace_grid(far: float, high: float) -> Path:
    """Lines at every tick and halfway between two, over the whole plot."""
    lines: list[Any] = []
    for end, across in ((far, True), (high, False)):
        half = _list_ticks(end)[1] / 2
        for count in range(1, floor(end / half + 1e-9) + 1):
            at = half * count
            lines.append([(at, 0), (at, high)] if across else [(0, at), (far, at)])
    return trace_lines(lines)


def _draw_curves(art: Any, values: Values, *, told: bool) -> None:
    ends = []
    for place, name in enumerate(_list_numbers(values), 1):
        text = f"{place}: f/{format_given(values[name])}" if told else str(place)
        ends.append((*_draw_curve(art, values, values[name], _INKS[name], "curves"), text, name))
    last = max(z for z, *_ in ends)
    for z, um, text, name in ends:
        right = z == values["far"]  # beside its end; one over the top is named above
        align = "l" if right or z == last else "r"
        shift = (5, 0) if right else (-3 if align == "l" else 3, 8)
        art.label((z, um), text, align, 10, _INKS[name], shift=shift, part="names")


def _draw_curve(art: Any, values: Values, number: float, ink: str, part: str) -> Any:
    """Draw the part of a curve that lies in the plot, and return its last point."""
    near, far = _find_reach(values, number, values["high"])
    inverse = np.linspace(1 / near, 1 / min(values["far"], far), _POINTS)
    z = np.sort(np.append(1 / inverse, values["s"]))
    z[-1] = min(values["far"], far)
    points = np.column_stack([z, _find_disc(values, number, z)])
    art.line(points, ink, 1.5, part=part)
    return points[-1]


def _draw_limit(art: Any, values: Values, *, told: bool) -> None:
    c = values["c"]
    art.line([(0, c), (values["far"], c)], "red", 1.0, dashes=(5, 2.5), part="limit")
    art.label((0, c), "$c$", "lb", 10.5, "red", shift=(5, 3))
    if not told:
        return
    limits = _find_reach(values, values["N_1"], c)
    for z in limits:
        if z <= values["far"]:
            art.line([(z, 0), (z, c)], "red", 0.8, dashes=(1.4, 1.6), part="limits")
            art.dot((z, c), 2.3, "red", part="limits")
    zone = [(limits[0], 0), (min(limits[1], values["far"]), 0)]
    art.line(zone, "red", 2.2, part="zone")


def _list_answers(values: Values) -> list[str]:
    told = [format_statement("$s$", values["s"], "m")]
    if "c" in values:
        limits = _find_reach(values, values["N_1"], values["c"])
        names = zip(("$z_n$", "$z_f$"), limits, strict=True)
        told += [format_equation(name, z, "m") for name, z in names if isfinite(z)]
    return told


MARKS = {"s": "m", "z_n": "m", "z_f": "m", "N_1": "", "N_2": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(ax: Any, values: Values, marks: Values) -> None:
    """Draw a learner's distances ``s``, ``z_n`` and ``z_f``, and the curves of ``N_1``, ``N_2``."""
    x0, y0, x1, y1 = ax.bbox.extents
    for name, value in marks.items():
        if name in ("N_1", "N_2"):
            art, number = ax.figure.sketch(ax, zorder=6), min(max(value, 0.1), 1000.0)
            end = _draw_curve(art, values, number, "gold", "learned")
            art.label(end, f"f/{format_learned(value)}", "rb", 10, "gold", shift=(-4, 4),
                      halo=True, part="learned")  # fmt: skip
        else:
            x, _ = ax.transData.transform((value, 0))
            text = f"${name}$ = {format_learned(value)} m"
            align = {"z_n": "r", "z_f": "l"}.get(name, "c")
            mark_place(ax.figure, (x0, y0, x1, y1 + 3), x, text, align=align)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words: both curves at every tick; in a quiz, no marks beside them."""
    words = load_alt_words(__file__, lang)
    told = [words["figure"].format(
        far=format_given(values["far"]), high=format_given(values["high"]))]  # fmt: skip
    places = _list_ticks(values["far"])[1:]
    for place, name in enumerate(_list_numbers(values), 1):
        discs = [(z, _find_disc(values, values[name], z)) for z in places]
        read = [f"{format_given(z)} m: {round(um)} µm" for z, um in discs if um <= values["high"]]
        told.append(words["curve"].format(place, "; ".join(read)))
    if "c" in values:
        told.append(words["limit"].format(format_given(values["c"])))
    if not quiz:
        answers = [strip_mathtext(answer) for answer in _list_answers(values)]
        numbers = enumerate(_list_numbers(values), 1)
        answers += [f"{place}: f/{format_given(values[name])}" for place, name in numbers]
        told.append(words["answer"].format(",   ".join(answers)))
    return " ".join(told)
