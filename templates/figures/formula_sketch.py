"""Small sketches for the formula sheet: symbols only, and formulas of one idea share a sketch."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import cos, exp, pi, radians, sin, sqrt
from typing import Any

from matplotlib.path import Path

from quizgen.figures.kit import Parameter, Values, load_alt_words, require
from quizgen.figures.sketch import Sketch

SIZE = (90.0, 60.0)

PARAMETERS = {"formula": Parameter("", "number of the formula", None, 1.0, 46.0, whole=True)}

_STEPS = 48
_DASHES = (3, 2)
_BANDS = {"R": "pale-red", "G": "pale-teal", "B": "pale-blue"}


# What sketches are made of: plots over the unit square, boxes, circles.


def _at(u: float, v: float) -> tuple[float, float]:
    """Place in points of a place in the unit square of a plot."""
    return 12 + 64 * u, 12 + 38 * v


def _axes(art: Sketch, x: str, y: str, names: Iterable[tuple[float, str]] = (),
          levels: Iterable[tuple[float, str]] = ()) -> None:  # fmt: skip
    art.arrow(_at(0, 0), _at(1.14, 0), "ink", 0.7, size=5, part="axes")
    art.arrow(_at(0, 0), _at(0, 1.2), "ink", 0.7, size=5, part="axes")
    art.label(_at(1.18, 0), x, "l")
    art.label(_at(0.05, 1.2), y, "l")
    for u, name in names:
        art.line([_at(u, 0), _at(u, -0.06)], "ink", 0.6, part="axes")
        art.label(_at(u, -0.12), name, "ct")
    for v, name in levels:
        art.line([_at(0, v), _at(-0.04, v)], "ink", 0.6, part="axes")
        art.label(_at(-0.07, v), name, "r")


def _curve(art: Sketch, rule: Callable[[float], float], stroke: str = "blue",
           ends: tuple[float, float] = (0.0, 1.0), dashes: Any = None) -> None:  # fmt: skip
    start, stop = ends
    places = [start + (stop - start) * i / _STEPS for i in range(_STEPS + 1)]
    width = 1.0 if stroke == "rule" else 1.3
    art.line([_at(u, rule(u)) for u in places], stroke, width, dashes=dashes, part="curve")


def _under(art: Sketch, rule: Callable[[float], float], start: float, stop: float) -> None:
    places = [start + (stop - start) * i / _STEPS for i in range(_STEPS + 1)]
    curve = [_at(u, rule(u)) for u in places]
    art.area([_at(start, 0), *curve, _at(stop, 0)], "pale-blue", part="area")


def _box(art: Sketch, box: tuple[float, float, float, float], fill: str | None = None,
         stroke: str = "ink", width: float = 0.8) -> None:  # fmt: skip
    x, y, wide, high = box
    corners = [(x, y), (x + wide, y), (x + wide, y + high), (x, y + high)]
    art.area(corners, fill, stroke, width, part="boxes")


def _lens(art: Sketch, x: float, y: float, half: float, bulge: float = 4.5) -> None:
    path = Path([(x, y + half), (x + 2 * bulge, y), (x, y - half), (x - 2 * bulge, y),
                 (x, y + half), (x, y + half)], [1, 3, 3, 3, 3, 79])  # fmt: skip
    art.shape(path, "pale-blue", "blue", 0.9, part="lens")


def _axis(art: Sketch, y: float = 30.0) -> None:
    art.line([(0, y), (90, y)], "grey", 0.6, dashes=(6, 2, 1.5, 2), part="axis")


def _ellipse(art: Sketch, a: float, b: float, turn: float = 0.0) -> None:
    c, s, at = cos(radians(turn)), sin(radians(turn)), (42.0, 30.0)
    art.arrow((4, 30), (82, 30), "grey", 0.6, size=5, part="axes")
    art.arrow((42, -2), (42, 64), "grey", 0.6, size=5, part="axes")
    art.label((85, 30), "$x$", "l")
    art.label((47, 62), "$y$", "l")
    for k, width in ((1.0, 1.3), (2.0, 0.9)):
        places = [2 * pi * i / _STEPS for i in range(_STEPS + 1)]
        points = [(k * a * cos(t), k * b * sin(t)) for t in places]
        turned = [(at[0] + c * x - s * y, at[1] + s * x + c * y) for x, y in points]
        art.line(turned, "blue", width, part="curve")


def _bell(u: float) -> float:
    return exp(-((u - 0.5) ** 2) / 0.032)


# The sketches.


def _image(art: Sketch) -> None:
    for place in (2, 1, 0):
        _box(art, (18 + 6 * place, 8 + 6 * place, 42, 32), "paper")
    for i in range(1, 4):
        art.line([(18 + 10.5 * i, 8), (18 + 10.5 * i, 40)], "rule", 0.5, part="lattice")
        art.line([(18, 8 + 8 * i), (60, 8 + 8 * i)], "rule", 0.5, part="lattice")
    art.label((39, 4), "$W$", "ct")
    art.label((14, 24), "$H$", "r")
    art.label((72, 10), "$C$", "l")


def _light(art: Sketch) -> None:
    def seen(u: float) -> float:
        return 0.75 * _bell(u)

    _axes(art, r"$\lambda$", "")
    _under(art, seen, 0.05, 0.95)
    _curve(art, seen)
    _curve(art, lambda u: 0.55 + 0.35 * u, "gold", dashes=_DASHES)
    art.label(_at(0.92, 1.05), "$L$", fill="gold")
    art.label(_at(0.5, 0.28), "$B$")


def _laser(art: Sketch) -> None:
    _axes(art, r"$\lambda$", "$V$", ((0.66, r"$\lambda$"),), ((1, "1"),))
    _curve(art, _bell)
    art.line(
        [_at(0.66, 0), _at(0.66, _bell(0.66)), _at(0, _bell(0.66))],
        "red",
        1.0,
        dashes=_DASHES,
        part="read",
    )


def _metamers(art: Sketch) -> None:
    _axes(art, r"$\lambda$", "$R$")
    _curve(art, lambda u: 0.5 + 0.3 * sin(9 * u))
    _curve(art, lambda u: 0.5 + 0.3 * sin(9 * u + 2.5), "red", dashes=_DASHES)
    art.label(_at(0.17, 0.95), "$R_1$", fill="blue")
    art.label(_at(0.6, 0.98), "$R_2$", fill="red")


def _projection(art: Sketch) -> None:
    _axis(art, 16)
    art.area([(6, 16), (80, 16), (80, 53)], "shade", part="triangle")
    art.area([(6, 16), (34, 16), (34, 30)], "pale-blue", part="triangle")
    art.line([(6, 16), (80, 53)], "red", 1.1, part="ray")
    art.line([(34, 6), (34, 50)], "blue", 1.4, part="plane")
    art.arrow((80, 16), (80, 53), "ink", 1.4, part="object")
    art.dot((6, 16), 1.8, "ink", part="pinhole")
    art.label((31, 33), "$p'$", "rb")
    art.label((84, 34), "$p$", "l")
    art.label((19, 12), "$f$", "ct")
    art.label((58, 12), "$p_z$", "ct")


def _ray(art: Sketch) -> None:
    _axis(art, 12)
    art.line([(6, 12), (84, 51)], "red", 1.1, part="ray")
    art.line([(30, 2), (30, 50)], "blue", 1.4, part="plane")
    for x, name in ((30, "$p'$"), (52, "$p$"), (76, r"$s\,p$")):
        art.dot((x, 9 + x / 2), 2.0, "ink", part="points")
        art.label(
            (x, 9 + x / 2), name, "r" if x == 30 else "c", shift=(-5, 4) if x == 30 else (-3, 9)
        )
    art.dot((6, 12), 1.8, "ink", part="pinhole")


def _pitch(art: Sketch) -> None:
    for i in range(5):
        _box(art, (10 + 14 * i, 24, 14, 14), "pale-blue" if i % 2 else "paper")
    for x in (24, 38):
        art.line([(x, 40), (x, 50)], "rule", 0.6, part="helpers")
    art.arrow((12, 46), (24, 46), "grey", 0.6, size=5, part="measures")
    art.arrow((50, 46), (38, 46), "grey", 0.6, size=5, part="measures")
    art.label((31, 51), "$d_x$", "cb")
    art.arrow((10, 16), (80, 16), "ink", 0.7, size=5, part="axes")
    art.label((83, 16), "$u$", "l")


def _pixels(art: Sketch) -> None:
    _box(art, (12, 6, 62, 44), None, "ink", 0.9)
    art.arrow((12, 50), (84, 50), "ink", 0.7, size=5, part="axes")
    art.arrow((12, 50), (12, -2), "ink", 0.7, size=5, part="axes")
    art.label((87, 50), "$u$", "l")
    art.label((8, 0), "$v$", "r")
    art.line([(43, 50), (43, 28), (12, 28)], "blue", 0.8, dashes=_DASHES, part="principal")
    art.label((43, 54), "$o_x$", "cb", fill="blue")
    art.label((9, 28), "$o_y$", "r", fill="blue")
    art.dot((43, 28), 1.8, "blue", part="principal")
    art.dot((61, 16), 2.2, "red", part="point")
    art.line([(43, 28), (61, 28), (61, 16)], "red", 0.8, dashes=_DASHES, part="point")


def _range(art: Sketch) -> None:
    _axes(art, "$I$", "$I_n$", ((0.15, r"$I_{\mathrm{min}}$"), (0.9, r"$I_{\mathrm{max}}$")))
    _curve(art, lambda u: (u - 0.15) / 0.75, ends=(0.15, 0.9))
    art.line([_at(0, 1), _at(0.9, 1), _at(0.9, 0)], "rule", 0.8, dashes=_DASHES, part="helpers")


def _clamp(art: Sketch) -> None:
    _axes(art, "$I_n$", "$I_c$", (), ((0.15, ""), (0.85, "")))
    _curve(art, lambda u: u, "rule", dashes=_DASHES)
    _curve(art, lambda u: min(max(u, 0.15), 0.85))


def _noisy(art: Sketch) -> None:
    jumps = (3, -5, 1, 6, -2, 4, -6, 2, -1, 5, -3, 0, 4, -4, 2, -6, 3, 1, -2, 5)
    _axes(art, "$x$", "$I$")
    level = [0.35 if i < 10 else 0.75 for i in range(len(jumps))]
    points = [
        _at((i + 0.5) / 20, v + 0.03 * j) for i, (v, j) in enumerate(zip(level, jumps, strict=True))
    ]
    art.line(points, "blue", 1.0, part="curve")
    art.line([_at(0, 0.35), _at(0.5, 0.35), _at(0.5, 0.75), _at(1, 0.75)], "red", 1.2, part="clean")


def _density(art: Sketch) -> None:
    art.line([_at(0.5, 0), _at(0.5, 1)], "rule", 0.8, part="helpers")
    _axes(art, "$n$", "$g$", ((0.5, r"$\mu$"),))
    _curve(art, _bell)
    art.arrow(_at(0.5, 0.607), _at(0.626, 0.607), "grey", 0.7, size=4.5, part="measures")
    art.label(_at(0.68, 0.66), r"$\sigma$", "l")


def _peak(art: Sketch) -> None:
    _axes(art, "$n$", "$g$", ((0.5, r"$\mu$"),))
    _curve(art, _bell)
    art.line([_at(0, 1), _at(0.5, 1)], "red", 0.9, dashes=_DASHES, part="peak")
    art.dot(_at(0.5, 1), 2.2, "red", part="peak")


def _tails(art: Sketch) -> None:
    _under(art, _bell, 0.3, 0.7)
    _axes(art, "$n$", "$g$", ((0.24, r"$-k\sigma$"), (0.76, r"$+k\sigma$")))
    for u in (0.3, 0.7):
        art.line([_at(u, 0), _at(u, _bell(u))], "blue", 0.8, part="marks")
    _curve(art, _bell)
    art.label(_at(0.5, 0.35), "$P$")


def _distortion(art: Sketch) -> None:
    for i in range(-2, 3):
        row = []
        for j in range(-12, 13):
            x, y = j / 6, float(i)
            k = 1 - 0.045 * (x * x + y * y)
            row.append((x * k, y * k))
        art.line([(45 + 17 * x, 30 + 17 * y) for x, y in row], "blue", 0.9, part="grid")
        art.line([(45 + 17 * y, 30 + 17 * x) for x, y in row], "blue", 0.9, part="grid")
    _box(art, (11, -4, 68, 68), None, "rule", 0.8)


def _radius(art: Sketch) -> None:
    art.area([(14, 10), (68, 10), (68, 48)], "shade", part="triangle")
    art.arrow((14, 10), (84, 10), "ink", 0.7, size=5, part="axes")
    art.arrow((14, 10), (14, 62), "ink", 0.7, size=5, part="axes")
    art.line([(14, 10), (68, 48)], "red", 1.2, part="radius")
    art.dot((68, 48), 2.0, "red", part="point")
    art.label((38, 33), "$r$", "rb", fill="red")
    art.label((42, 6), "$x$", "ct")
    art.label((72, 29), "$y$", "l")


def _fold(art: Sketch) -> None:
    _axes(art, "$r$", "$r_d$", ((0.577, r"$r_{\mathrm{fold}}$"),))
    _curve(art, lambda u: 2.4 * (u - u**3))
    top = 2.4 * (0.57735 - 0.57735**3)
    art.line([_at(0.577, 0), _at(0.577, top)], "red", 0.9, dashes=_DASHES, part="fold")
    art.dot(_at(0.577, top), 2.0, "red", part="fold")


def _channels(art: Sketch) -> None:
    heights = {"R": 0.9, "G": 0.6, "B": 0.25}
    for place, (name, high) in enumerate(heights.items()):
        _box(art, (10 + 18 * place, 12, 13, 38 * high), _BANDS[name])
        art.label((16.5 + 18 * place, 9), f"${name}$", "ct")
    for high in (0.9, 0.25):
        art.line(
            [(8, 12 + 38 * high), (74, 12 + 38 * high)], "rule", 0.7, dashes=_DASHES, part="helpers"
        )
    art.arrow((68, 21.5), (68, 46.2), "grey", 0.7, size=5, both=True, part="measures")
    art.label((73, 33), r"$\Delta$", "l")
    art.label((78, 49), "$V$", "l")


def _hexcone(art: Sketch) -> None:
    at, names = (42.0, 30.0), ("R", "Y", "G", "C", "B", "M")
    corners = [(at[0] + 25 * cos(i * pi / 3), at[1] + 25 * sin(i * pi / 3)) for i in range(6)]
    art.area(corners, None, "ink", 0.9, part="hexagon")
    for (x, y), name in zip(corners, names, strict=True):
        art.line([at, (x, y)], "rule", 0.6, part="sectors")
        art.label((at[0] + 1.3 * (x - at[0]), at[1] + 1.24 * (y - at[1])), name)
    art.arrow(at, (at[0] + 20 * cos(0.7), at[1] + 20 * sin(0.7)), "red", 1.1, size=5, part="hue")
    art.arc(at, 11, 0, 40, "red", 0.9, part="hue")


def _hue(art: Sketch) -> None:
    _hexcone(art)
    art.label((88, 48), "$H$", "r", fill="red")


def _sectors(art: Sketch) -> None:
    at = (42.0, 30.0)
    corners = [(at[0] + 29 * cos(i * pi / 3), at[1] + 29 * sin(i * pi / 3)) for i in range(6)]
    art.area(corners, None, "ink", 0.9, part="hexagon")
    for i, corner in enumerate(corners):
        art.line([at, corner], "rule", 0.7, part="sectors")
        turn = (i + 0.5) * pi / 3
        art.label((at[0] + 17 * cos(turn), at[1] + 17 * sin(turn)), str(i))
    art.label((76, 30), "R", "l")


def _parts(art: Sketch) -> None:
    for place, (low, high) in enumerate(((12, 46), (12, 34), (12, 22))):
        _box(art, (10 + 18 * place, low, 13, high - low), "shade")
    art.line([(8, 22), (70, 22)], "rule", 0.7, dashes=_DASHES, part="helpers")
    for x, low, high, name in ((72, 22, 46, "$C$"), (84, 22, 34, "$X$")):
        art.arrow((x, low), (x, high), "grey", 0.7, size=4.5, both=True, part="measures")
        art.label((x, high + 3), name, "cb")
    art.arrow((72, 12), (72, 22), "grey", 0.7, size=4.5, both=True, part="measures")
    art.label((76, 15), "$m$", "l")


def _site(letter: str, used: str, offsets: Iterable[tuple[int, int]]) -> Callable[[Sketch], None]:
    def draw_site(art: Sketch) -> None:
        _box(art, (36, 21, 18, 18), _BANDS[letter], "ink", 1.6)
        for dx, dy in offsets:
            x, y = 45 + 18 * dx, 30 + 18 * dy
            _box(art, (x - 9, y - 9, 18, 18), _BANDS[used])
            art.label((x, y), used)
            art.arrow(
                (x - 7 * dx, y - 7 * dy),
                (45 + 5 * dx, 30 + 5 * dy),
                "red",
                1.0,
                size=5,
                part="used",
            )

    return draw_site


def _opening(art: Sketch) -> None:
    _axis(art)
    _lens(art, 26, 30, 22)
    for side in (1, -1):
        art.line([(0, 30 + 22 * side), (26, 30 + 22 * side), (80, 30)], "gold", 1.0, part="rays")
    art.arrow((5, 8), (5, 52), "grey", 0.6, size=5, both=True, part="measures")
    art.label((8, 38), "$D$", "l")
    art.arrow((26, 3), (80, 3), "grey", 0.6, size=5, both=True, part="measures")
    art.label((53, 6), "$f$", "cb")
    art.dot((80, 30), 1.8, "ink", part="focus")


def _openings(art: Sketch) -> None:
    for x, radius, name in ((24, 22, "$D_1$"), (70, 11, "$D_2$")):
        art.dot((x, 32), radius, "pale-gold", "gold", 1.1, part="apertures")
        art.arrow(
            (x - radius, 32), (x + radius, 32), "grey", 0.6, size=4.5, both=True, part="measures"
        )
        art.label((x, 35), name, "cb")


def _blur(art: Sketch) -> None:
    _axis(art)
    _lens(art, 14, 30, 24)
    for side in (1, -1):
        art.line([(14, 30 + 24 * side), (60, 30), (80, 30 - 10.4 * side)], "gold", 1.0, part="rays")
    art.line([(80, 8), (80, 52)], "ink", 1.0, part="sensor")
    art.line([(80, 19.6), (80, 40.4)], "red", 3.0, part="disc")
    art.label((85, 34), "$c$", "l", fill="red")
    art.arrow((3, 6), (3, 54), "grey", 0.6, size=5, both=True, part="measures")
    art.label((0, 30), "$D$", "r")
    art.label((58, 25), "$z'_p$", "ct")
    art.label((80, 55), "$z'_s$", "cb")


def _wrap(art: Sketch) -> None:
    at = (44.0, 30.0)
    art.dot(at, 22, "paper", "ink", 1.0, part="circle")
    for turn, name, align in (
        (90, "0", "cb"),
        (0, "64", "l"),
        (-90, "128", "ct"),
        (180, "192", "r"),
    ):
        c, s = cos(radians(turn)), sin(radians(turn))
        art.line(
            [(at[0] + 20 * c, at[1] + 20 * s), (at[0] + 24 * c, at[1] + 24 * s)],
            "ink",
            0.8,
            part="marks",
        )
        art.label((at[0] + 26 * c, at[1] + 26 * s), name, align, 9)
    art.arc(at, 15, 60, 140, "red", 1.1, part="sum")
    art.head(
        (at[0] + 15 * cos(radians(56)), at[1] + 15 * sin(radians(56))), (0.83, -0.56), "red", 6
    )


def _impulse(art: Sketch) -> None:
    for x, wide, fill, name in (
        (8, 16, "ink", "0"),
        (24, 42, "shade", "$I$"),
        (66, 16, "paper", "255"),
    ):
        _box(art, (x, 22, wide, 18), fill)
        art.label((x + wide / 2, 44), name, "cb")
    for x, name, align in ((8, "0", "c"), (24, "$p/2$", "c"), (82, "1", "c")):
        art.line([(x, 22), (x, 18)], "ink", 0.6, part="marks")
        art.label((x, 15), name, f"{align}t")
    art.label((88, 12), "$u$", "l")


def _flat(art: Sketch) -> None:
    def lit(u: float) -> float:
        return 0.9 - 1.3 * (u - 0.5) ** 2

    _axes(art, "$x$", "")
    _curve(art, lit, "red", dashes=_DASHES)
    _curve(art, lambda u: lit(u) * (0.5 + 0.25 * (u > 0.5)))
    art.label(_at(0.12, 0.98), "$F$", fill="red")
    art.label(_at(0.25, 0.2), "$I$", fill="blue")


def _thin_lens(art: Sketch) -> None:
    # z = 40 and f = 18 make z' = 32.7; the image is 14.7 high where the object is 18.
    _axis(art)
    _lens(art, 44, 30, 25)
    art.ray([(4, 48), (44, 48), (86, 6)], "red", 1.0, heads=((0, 0.55),), size=5, part="rays")
    art.line([(4, 48), (86, 11.1)], "teal", 1.0, part="rays")
    art.arrow((4, 30), (4, 48), "ink", 1.5, size=6, part="object")
    art.arrow((76.7, 30), (76.7, 15.3), "ink", 1.5, size=6, part="image")
    art.dot((62, 30), 1.8, "paper", "ink", 0.9, part="foci")
    for a, b, name in ((4, 44, "$z$"), (44, 76.7, "$z'$")):
        art.arrow((a, -2), (b, -2), "grey", 0.6, size=5, both=True, part="measures")
        art.label(((a + b) / 2, 1), name, "cb")
    art.label((63, 34), "F$'$", "cb")


def _parallel(art: Sketch) -> None:
    _axis(art, 14)
    art.dot((4, 14), 1.8, "ink", part="pinhole")
    art.line([(26, 4), (26, 56)], "blue", 1.4, part="plane")
    art.line([(66, 4), (66, 56)], "rule", 1.0, dashes=_DASHES, part="mean")
    for x in (58, 76):
        art.line([(x, 46), (66, 46)], "grey", 0.8, part="flattened")
        art.dot((x, 46), 2.0, "ink", part="points")
    art.line([(4, 14), (66, 46)], "red", 1.0, part="ray")
    art.arrow((58, 46), (26, 46), "teal", 0.9, size=5, dashes=_DASHES, part="parallel")
    art.label((66, 0), r"$\bar{z}$", "c")


def _depth(art: Sketch) -> None:
    _axis(art, 22)
    art.dot((4, 22), 1.8, "ink", part="pinhole")
    art.line([(64, 12), (64, 50)], "rule", 1.0, dashes=_DASHES, part="mean")
    for x in (48, 80):
        art.arrow((x, 22), (x, 44), "ink", 1.4, size=6, part="objects")
    art.arrow((64, 48), (80, 48), "grey", 0.6, size=4.5, both=True, part="measures")
    art.label((72, 51), "$d$", "cb")
    art.arrow((4, 8), (64, 8), "grey", 0.6, size=5, both=True, part="measures")
    art.label((34, 5), r"$\bar{z}$", "ct")


def _photons(art: Sketch) -> None:
    _axes(art, r"$N_{\mathrm{ph}}$", "SNR")
    _curve(art, lambda u: 0.95 * sqrt(u))


def _gamma(art: Sketch) -> None:
    _axes(art, r"$I_{\mathrm{lin}}$", r"$I_{\mathrm{enc}}$", ((1, "1"),), ((1, "1"),))
    _curve(art, lambda u: u, "rule", dashes=_DASHES)
    _curve(art, lambda u: u ** (1 / 2.2))
    _curve(art, lambda u: u**2.2, "red", dashes=_DASHES)


_EDGES, _CORNERS = ((0, 1), (0, -1), (1, 0), (-1, 0)), ((1, 1), (1, -1), (-1, 1), (-1, -1))

SKETCHES: dict[str, tuple[tuple[int, ...], Callable[[Sketch], None]]] = {
    "image": ((1,), _image),
    "light": ((2,), _light),
    "laser": ((3,), _laser),
    "metamers": ((4,), _metamers),
    "projection": ((5, 10), _projection),
    "ray": ((6,), _ray),
    "pitch": ((8,), _pitch),
    "pixels": ((9,), _pixels),
    "range": ((11, 12), _range),
    "clamp": ((13,), _clamp),
    "noisy": ((14,), _noisy),
    "density": ((15,), _density),
    "peak": ((16,), _peak),
    "isotropic": ((17,), lambda art: _ellipse(art, 13, 13)),
    "tails": ((18,), _tails),
    "distortion": ((20,), _distortion),
    "radius": ((21,), _radius),
    "fold": ((22,), _fold),
    "channels": ((23,), _channels),
    "hue": ((24,), _hue),
    "parts": ((25,), _parts),
    "sectors": ((26,), _sectors),
    "green": ((28,), _site("B", "G", _EDGES)),
    "corners": ((29,), _site("B", "R", _CORNERS)),
    "row": ((30,), _site("G", "R", _EDGES[2:])),
    "opening": ((31,), _opening),
    "openings": ((32, 34, 35), _openings),
    "blur": ((33,), _blur),
    "wrap": ((36,), _wrap),
    "impulse": ((38,), _impulse),
    "flat": ((39,), _flat),
    "turned": ((40,), lambda art: _ellipse(art, 17, 8, 30)),
    "upright": ((41,), lambda art: _ellipse(art, 18, 9)),
    "lens": ((42,), _thin_lens),
    "parallel": ((43,), _parallel),
    "depth": ((44,), _depth),
    "photons": ((45,), _photons),
    "gamma": ((46,), _gamma),
}
"""Name of a sketch to the formulas that it is of, and what draws it."""


def find_sketch(formula: float) -> str:
    """Name of a formula's sketch.

    Raises
    ------
    BankError
        If the formula has none.
    """
    names = [name for name, (numbers, _) in SKETCHES.items() if formula in numbers]
    require("formula_sketch", bool(names), f"formula {formula:g} has no sketch")
    return names[0]


def draw(fig: Any, values: Values, *, quiz: bool) -> None:  # noqa: ARG001 - it hides nothing
    """Draw the sketch of a formula.

    Raises
    ------
    BankError
        If the formula has none.
    """
    SKETCHES[find_sketch(values["formula"])][1](fig.sketch())


def alt(values: Values, lang: str, *, quiz: bool) -> str:  # noqa: ARG001 - it hides nothing
    """Describe the sketch in words."""
    return load_alt_words(__file__, lang)[find_sketch(values["formula"])]
