"""Figures that only cards use, written as SVG directly: noise, focus, eye curves, histograms.

Symbols and digits only, as in ``quizgen.figures``; line art is drawn on nothing, so that a dark
page can invert it. The alt texts stand in ``content/drawings.toml``.
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Callable, Iterator, Mapping
from statistics import NormalDist

from quizgen.cards.content import read
from quizgen.figures import Figure

HEIGHT, WIDTH = 180.0, 330.0
_CELLS, _CELL = 16, 6
_GRID = 400, 700
_TALLEST = 128


def draw(name: str, *, quiz: bool, lang: str) -> Figure:
    """Draw one of ``DRAWINGS``.

    Parameters
    ----------
    name : str
    quiz : bool
        Leave out what is asked.
    lang : {"en", "bn"}
        Language of the alt text.
    """
    strokes, dark = DRAWINGS[name]
    inside = "".join(strokes(quiz))
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:g}pt" height="{HEIGHT:g}pt"'
        f' viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img"'
        f' font-family="Georgia, serif" font-size="11">{inside}</svg>'
    )
    alt = " ".join(_told(name, lang)[: 1 if quiz else 2])
    return Figure(svg.encode(), alt, WIDTH, HEIGHT, dark)


def _told(name: str, lang: str) -> tuple[str, str]:
    """What the figure shows, and what only the back of the card tells."""
    table: dict[str, dict[str, dict[str, str]]] = tomllib.loads(read("drawings"))
    return table[name]["alt"][lang], table[name]["tell"][lang]


def _text(x: float, y: float, text: str, anchor: str = "middle") -> str:
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}">{text}</text>'


def _sub(letter: str, index: str) -> str:
    """A letter with an index."""
    return f'{letter}<tspan dy="3" font-size="8">{index}</tspan><tspan dy="-3">&#8203;</tspan>'


def _bar(left: float, foot: float, width: float, height: float, opacity: str = "1") -> str:
    return (
        f'<rect x="{left:.1f}" y="{foot - height:.1f}" width="{width:.1f}"'
        f' height="{height:.1f}" fill-opacity="{opacity}"/>'
    )


def _line(points: list[tuple[float, float]], more: str = "") -> str:
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="#000" stroke-width="1.4"{more}/>'


def _uniform(name: str, count: int) -> Iterator[float]:
    """Fixed numbers in (0, 1) from a hash."""
    for index in range(count):
        digest = hashlib.sha256(f"{name}/{index}".encode()).digest()
        yield (int.from_bytes(digest[:6], "big") + 0.5) / 2**48


# FIG5: clean, Gaussian noise, salt and pepper, each with its histogram


def _clean() -> list[int]:
    return [
        200 if (x - 10) ** 2 + (y - 6) ** 2 < 14 else 70 if y > 11 else 130
        for y in range(_CELLS)
        for x in range(_CELLS)
    ]


def noisy(kind: str) -> list[int]:
    """Grey levels of the little picture: ``clean``, ``gauss`` (σ = 20) or ``impulse`` (8 %)."""
    clean, chance = _clean(), list(_uniform(f"noise/{kind}", _CELLS**2))
    pairs = zip(clean, chance, strict=True)
    if kind == "gauss":
        bell = NormalDist(0, 20)
        return [min(255, max(0, round(v + bell.inv_cdf(u)))) for v, u in pairs]
    if kind == "impulse":
        return [0 if u < 0.04 else 255 if u > 0.96 else v for v, u in pairs]
    return clean


def _noise(quiz: bool) -> Iterator[str]:
    yield f'<rect width="{WIDTH:g}" height="{HEIGHT:g}" fill="#fff"/>'
    names = ("A", "B", "C") if quiz else ("I", "I + n, σ = 20", "p = 8 %")
    for place, (kind, name) in enumerate(zip(("clean", "gauss", "impulse"), names, strict=True)):
        left = 8 + place * 108
        values = noisy(kind)
        for index, value in enumerate(values):
            x, y = left + index % _CELLS * _CELL, 6 + index // _CELLS * _CELL
            grey = f"{value:02x}" * 3
            yield f'<rect x="{x}" y="{y}" width="6.2" height="6.2" fill="#{grey}"/>'
        yield from _bars(values, left, 154, 40)
        yield _text(left + 48, 172, name)


def _bars(values: list[int], left: float, low: float, height: float) -> Iterator[str]:
    counts = [sum(v * 24 // 256 == b for v in values) for b in range(24)]
    for place, count in enumerate(counts):
        if count:
            tall = height * min(1.0, count / 90)
            yield _bar(left + 4 * place, low, 3.4, tall)
    yield _line([(left, low), (left + 96, low)])


# FIG7: depth of field, two f-numbers


_BUSH = (
    '<circle cx="26" cy="120" r="20" fill="#3c8f4d"/><circle cx="30" cy="116" r="5" fill="gold"/>'
)
_HOUSE = (
    '<rect x="56" y="74" width="46" height="46" fill="#b5533c"/>'
    '<path d="M50 76 l29 -26 l29 26 z" fill="#5b2d1f"/>'
    '<rect x="72" y="94" width="14" height="26" fill="#f3e2b0"/>'
)
_MOUNTAINS = '<path d="M0 92 l40 -52 l30 34 l36 -44 l50 62 z" fill="#7d93a8"/>'
_THINGS = (_BUSH, _HOUSE, _MOUNTAINS)
"""What stands in the scene, nearest first."""


def _focus(quiz: bool) -> Iterator[str]:
    yield f'<rect width="{WIDTH:g}" height="{HEIGHT:g}" fill="#fff"/>'
    for place, (blurs, name) in enumerate((((0.3, 0, 0.3), "f/16"), ((2.6, 0, 3.4), "f/1.8"))):
        left = 6 + 162 * place
        for index, blur in enumerate(blurs):
            yield (f'<filter id="b{place}{index}"><feGaussianBlur stdDeviation="{blur}"/></filter>')
        yield f'<rect x="{left}" y="6" width="156" height="146" fill="#dfe9f3"/>'
        for index in (2, 1, 0):
            yield f'<g filter="url(#b{place}{index})" transform="translate({left})">'
            yield _THINGS[index] + "</g>"
        yield _text(left + 78, 170, "AB"[place] if quiz else name)


# FIG8: luminosity curves by day and by night


def _eye(quiz: bool) -> Iterator[str]:
    from quizgen.camera.luminosity import photopic, scotopic

    day, night = ("1", "2") if quiz else ("V", "V′")
    curves = ((day, photopic, ""), (night, scotopic, ' stroke-dasharray="5 3"'))
    yield _line([(30, 12), (30, 150), (322, 150)])
    for wavelength in range(400, 701, 50):
        yield _text(_across(wavelength), 165, str(wavelength))
    yield _text(322, 178, "λ / nm", "end")
    for name, curve, dashes in curves:
        points = [(_across(w), 150 - _TALLEST * float(curve(w))) for w in range(400, 701, 5)]
        yield _line(points, dashes)
        peak = max(range(400, 701), key=lambda w: float(curve(w)))
        beside = _across(622) if curve is photopic else _across(442)
        yield _text(beside, 92, f'<tspan font-style="italic">{name}</tspan>')
        if not quiz:
            yield _line([(_across(peak), 150), (_across(peak), 22)], ' stroke-opacity="0.4"')
            yield _text(_across(peak), 14, str(peak))


def _across(wavelength: float) -> float:
    first, last = _GRID
    return 30 + 285 * (wavelength - first) / (last - first)


# FIG9: histogram before and after normalising with too small a range


def _histograms(quiz: bool) -> Iterator[str]:
    bell = NormalDist(110, 38)
    heights = [bell.pdf(8 * i + 4) / bell.pdf(110) for i in range(32)]
    limit = 22
    clamped = [*heights[:limit], *([0.0] * (32 - limit))]
    pile = min(1.0, sum(heights[limit:]))
    for left, bars, ends in ((14, heights, ("0", "255")), (180, clamped, ("0", "1"))):
        yield _line([(left, 150), (left + 138, 150)])
        for place, tall in enumerate(bars):
            width = 4.2 if left == 14 else 4.2 * 32 / limit
            if tall > 0.004:
                yield _bar(left + place * width, 150, width - 0.6, 118 * tall, "0.55")
        yield _text(left, 165, ends[0])
        yield _text(left + 135, 165, ends[1])
        yield _text(left + 68, 176, "I" if left == 14 else "?" if quiz else _sub("I", "n"))
    yield _bar(311, 150, 5, 118 * pile)
    if not quiz:
        yield _line([(14 + 4.2 * limit, 150), (14 + 4.2 * limit, 28)], ' stroke-dasharray="4 3"')
        yield _text(14 + 4.2 * limit, 20, _sub("I", "max") + " = 176")


DRAWINGS: Mapping[str, tuple[Callable[[bool], Iterator[str]], str]] = {
    "noise_histograms": (_noise, "keep"),
    "focus_pair": (_focus, "keep"),
    "luminosity": (_eye, "invert"),
    "clamped_histogram": (_histograms, "invert"),
}
"""Figure to the function that draws it, and what a dark page does with it."""
