"""What a figure is drawn on: painted paths, labels and pictures, written as the inside of an SVG.

Figures are drawn in points from the lower left; SVG counts from the upper left.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Final, NamedTuple

import msgspec

from quizgen.figures._letters import glyph, runs
from quizgen.locale import numbers_in
from quizgen.png import encode

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

MOVE, LINE, CURVE, CLOSE = 1, 2, 4, 79
"""Codes of the points of a path; a curve, which only letters have, is two controls and its end."""
_RELATIVE: Final = {MOVE: "m", LINE: "l", CURVE: "c"}
_FORMS: Final = {MOVE: "M %s %s", LINE: "L %s %s"}
BLACK: Final = "#000000"

Point = Sequence[float]
Box = tuple[float, float, float, float]


class Style(msgspec.Struct, frozen=True):
    """How a part is painted: line width in points (0 fills instead), colour, dashes."""

    width: float = 0.0
    colour: str = BLACK
    dashes: tuple[float, ...] = ()

    def attribute(self) -> str:
        """The same for SVG, without what holds anyway."""
        if self.width == 0:
            rules = [] if self.colour == BLACK else [f"fill: {self.colour}"]
        else:
            rules = ["fill: none", *self._dashed(), f"stroke: {self.colour}"]
            rules += [] if self.width == 1 else [f"stroke-width: {self.width:g}"]
        return f' style="{"; ".join(rules)}"' if rules else ""

    def _dashed(self) -> tuple[str, ...]:
        lengths = ",".join(f"{length:g}" for length in self.dashes)
        return (f"stroke-dasharray: {lengths}", "stroke-dashoffset: 0") if lengths else ()


class Stroke(NamedTuple):
    """A painted part: its points in points of print, and their codes."""

    part: str
    style: Style
    points: Sequence[Point]
    codes: bytes


class Label(NamedTuple):
    """A label in the markup of ``_letters``: where its baseline starts, and its size."""

    text: str
    at: tuple[float, float]
    size: float


class Canvas:
    """A figure in the making: pictures lie under everything else, labels above it."""

    def __init__(self) -> None:
        self.width = self.height = 0.0
        self.background: str | None = None
        self.pictures: list[tuple[bytes | NDArray[np.uint8], Box]] = []
        self.strokes: list[Stroke] = []
        self.labels: list[Label] = []

    def size(self, width: float, height: float, background: str | None) -> None:
        """Size it in points and paint the paper; it is transparent without a colour."""
        self.width, self.height, self.background = width, height, background

    def picture(self, pixels: bytes | NDArray[np.uint8], box: Box) -> None:
        """Put a PNG file, or 8-bit codes, into a box: left, bottom, width and height in points."""
        self.pictures.append((pixels, box))

    def path(self, part: str, style: Style, points: Sequence[Point], codes: bytes) -> None:
        """Paint a part of the figure."""
        self.strokes.append(Stroke(part, style, points, codes))

    def flipped(self, points: Iterable[Point]) -> list[Point]:
        """Points as SVG counts them, rounded to hundredths."""
        return [(x / 100, y / 100) for x, y in _flipped(points, self.height)]

    def written_in(self, lang: str) -> Canvas:
        """The same with the decimal sign of a language in its labels; itself if they are alike."""
        labels = [label._replace(text=numbers_in(lang, label.text)) for label in self.labels]
        if labels == self.labels:
            return self
        found = Canvas()
        found.size(self.width, self.height, self.background)
        found.pictures, found.strokes, found.labels = self.pictures, self.strokes, labels
        return found

    @cached_property
    def inside(self) -> str:
        """Elements without ids, the same on every machine; each part is a group ``data-part``."""
        pictures = [self._image(pixels, box) for pixels, box in self.pictures]
        parts = [self._paper(), *pictures, *map(self._path, self.strokes), self._lettering()]
        return f"<g>{''.join(parts)}</g>"

    def _lettering(self) -> str:
        """All labels as one part."""
        if not self.labels:
            return ""
        return _part("labels", " ".join([_label(label, self.height) for label in self.labels]))

    def _path(self, stroke: Stroke) -> str:
        closed = stroke.style.width > 0
        data = _commands(_flipped(stroke.points, self.height), stroke.codes, closed)
        return _part(stroke.part, data, stroke.style.attribute())

    def _paper(self) -> str:
        if self.background is None:
            return ""
        wide, high, paint = self.width, self.height, Style(colour=self.background)
        corners = f"M 0 {high:g} L {wide:g} {high:g} L {wide:g} 0 L 0 0 z"
        return f'<g><path d="{corners}"{paint.attribute()}/></g>'

    def _image(self, pixels: bytes | NDArray[np.uint8], box: Box) -> str:
        left, low, wide, high = box
        if not isinstance(pixels, bytes):
            pixels = _png(pixels.tobytes(), pixels.shape)
        return (
            f'<image xlink:href="data:image/png;base64,{b64encode(pixels).decode()}"'
            f' x="{left:.2f}" y="{self.height - low - high:.2f}" width="{wide:.2f}"'
            f' height="{high:.2f}" preserveAspectRatio="none"/>'
        )


def _part(name: str, data: str, style: str = "") -> str:
    return f'<g data-part="{name}"><path d="{data}"{style}/></g>'


def _flipped(points: Iterable[Point], height: float) -> list[tuple[int, int]]:
    """Points in hundredths, from the upper left."""
    top = round(100 * height)
    return [(round(100 * x), top - round(100 * y)) for x, y in points]


@lru_cache(maxsize=64)
def _png(codes: bytes, shape: tuple[int, ...]) -> bytes:
    """A photograph: a solution shows again what its question showed."""
    import numpy as np

    return encode(np.frombuffer(codes, np.uint8).reshape(shape))


@lru_cache(maxsize=2048)
def _label(label: Label, height: float) -> str:
    """Commands that draw a label: most stand in the same place in the next figure of the kind."""
    (left, low), size, top = label.at, label.size, round(100 * height)
    letters = [
        (run.at, _letter(run.text, run.size * size, italic=run.italic))
        for run in runs(label.text)[0]
    ]
    return " ".join(
        [
            f"M {_HUNDREDTHS[round(100 * (left + x * size))]}"
            f" {_HUNDREDTHS[top - round(100 * (low + y * size))]}{commands}"
            for (x, y), commands in letters
            if commands
        ]
    )


@lru_cache(maxsize=2048)
def _letter(character: str, size: float, *, italic: bool) -> str:
    """Commands that draw a letter from where it starts: the same wherever it stands.

    Each contour closes at its start, from which the next one goes on.
    """
    found = glyph(character, italic=italic)
    told, start, at, ahead = [], (0, 0), (0, 0), 0
    for (x, y), code in zip(found.points, found.codes, strict=True):
        if code == CLOSE:
            told.append("z")
            at = start
            continue
        to = round(100 * x * size), -round(100 * y * size)
        way = f"{_HUNDREDTHS[to[0] - at[0]]} {_HUNDREDTHS[to[1] - at[1]]}"
        told.append(f"{' ' if ahead else _RELATIVE[code]}{way}")
        ahead = (ahead or 3) - 1 if code == CURVE else 0
        at = at if ahead else to
        start = to if code == MOVE else start
    return "".join(told)


class _Hundredths(dict[int, str]):
    """Numbers of hundredths as they are written; most stand in many figures."""

    def __missing__(self, number: int) -> str:
        text = f"{number / 100:g}"
        if len(self) < 1 << 16:
            self[number] = text
        return text


_HUNDREDTHS = _Hundredths()


def _commands(points: Sequence[tuple[int, int]], codes: bytes, closed: bool) -> str:
    """Drawing commands of SVG for points in hundredths."""
    form, order = _form(codes, closed)
    if len(order) < len(points) or closed:
        points = [points[place] for place in order]
    return form % tuple([_HUNDREDTHS[way] for point in points for way in point])


@lru_cache(maxsize=1024)
def _form(codes: bytes, closed: bool) -> tuple[str, list[int]]:
    """How points with these codes are written, and which of them.

    An outline that closes goes back to its start first; of a fill the start says nothing.
    """
    letters, order, start = [], [], 0
    for place, code in enumerate(codes):
        if code == MOVE:
            start = place
        if code == CLOSE:
            letters.append("L %s %s z" if closed else "z")
            order += [start] if closed else []
        else:
            letters.append(_FORMS[code])
            order.append(place)
    return " ".join(letters), order
