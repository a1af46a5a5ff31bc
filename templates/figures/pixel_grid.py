"""Picture plane in pixels: origin at the top left, principal point, and the pixel of a point."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_equation,
    format_given,
    load_alt_words,
)
from quizgen.figures.sketch import measure_label

from ._plots import format_learned, mark_point

SIZE = (270.0, 170.0)

_FAR = 1e6
PARAMETERS = {
    "W": Parameter("px", "width of the picture", None, 1.0, _FAR),
    "H": Parameter("px", "height of the picture", None, 1.0, _FAR),
    "o_x": Parameter("px", "column of the principal point", None, -_FAR, _FAR),
    "o_y": Parameter("px", "row of the principal point, counted downwards", None, -_FAR, _FAR),
    "u": Parameter("px", "column of the point", None, -_FAR, _FAR),
    "v": Parameter("px", "row of the point, counted downwards", None, -_FAR, _FAR),
    "given": Parameter("", "1: the question gives u and v, 0: it asks", 0.0, 0.0, 1.0, whole=True),
}

_LEFT, _LOW, _WIDE, _HIGH = 34.0, 30.0, 176.0, 112.0  # the box that everything is fitted into


class PictureFrame:
    """Where a pixel lies on the sheet: the frame of the picture and all points fit into a box.

    Parameters
    ----------
    art : Sketch
        In points of the figure.
    width, height : float
        Of the picture in pixels.
    points : iterable of (float, float)
        Pixels outside the frame that are to be seen, too.
    """

    def __init__(
        self, art: Any, width: float, height: float, points: Iterable[tuple[float, float]] = ()
    ) -> None:
        us, vs = zip((0.0, 0.0), (width, height), *points, strict=True)
        self.art, self.width, self.height = art, width, height
        self.scale = min(_WIDE / (max(us) - min(us)), _HIGH / (max(vs) - min(vs)))
        self._left, self._top = min(us), min(vs)
        self.box = ((min(us), min(vs)), (max(us), max(vs)))
        self._taken: list[tuple[float, float, float, float]] = []

    def at(self, u: float, v: float) -> tuple[float, float]:
        """Place of a pixel in points."""
        top = _LOW + _HIGH
        return (_LEFT + (u - self._left) * self.scale, top - (v - self._top) * self.scale)

    def draw(self, side: tuple[int, int] = (1, -1)) -> None:
        """Draw frame, lattice and axes; width and height stand away from a side (up is 1)."""
        art, (x, y), (right, low) = self.art, self.at(0, 0), self.at(self.width, self.height)
        art.area([(x, y), (right, y), (right, low), (x, low)], "paper", "ink", 0.9, part="frame")
        for place in range(1, 8):  # a lattice, not the pixels: they are far too many
            u, v = self.width * place / 8, self.height * place / 6
            art.line([self.at(u, 0), self.at(u, self.height)], "shade", 0.5, part="lattice")
            if place < 6:
                art.line([self.at(0, v), self.at(self.width, v)], "shade", 0.5, part="lattice")
        art.arrow((x, y), (right + 15, y), "ink", 0.9, part="axes")
        art.arrow((x, y), (x, low - 15), "ink", 0.9, part="axes")
        self.name((right + 19, y), "$u$ / px", "l", 10)
        self.name((x - 4, low - 14), "$v$ / px", "r", 10)
        self.name((x - 4, y + 6), "0", "r", 9)
        wide, high = f"$W$ = {format_given(self.width)}", f"$H$ = {format_given(self.height)}"
        top, left = side[1] < 0, side[0] > 0
        self.name((right, y + 9 if top else low - 9), wide, "c", 9)
        self.name((x - 5 if left else right + 5, low), high, "r" if left else "l", 9)

    def name(self, at: tuple[float, float], text: str, align: str, size: float) -> None:
        """Write a label in one line, and remember where."""
        wide, high = measure_label(text, size)
        left = at[0] - wide * {"l": 0.0, "c": 0.5, "r": 1.0}[align]
        self._taken.append((left, at[1] - high / 2, left + wide, at[1] + high / 2))
        self.art.label(at, text, align, size)

    def mark_principal_point(self, o_x: float, o_y: float, side: tuple[int, int] | None) -> None:
        """Mark the principal point; its label stands to a side (right is 1, up is 1), or below."""
        x, y = self.at(o_x, o_y)
        for dx, dy in ((6, 0), (0, 6)):
            self.art.line([(x - dx, y - dy), (x + dx, y + dy)], "blue", 1.2, part="principal")
        name = "$(o_x; o_y)$ ="
        if side:
            self.label((x, y), name, (o_x, o_y), side, "blue")
            return
        text = f"{name} ({format_given(o_x)}; {format_given(o_y)})"
        self.art.label((_LEFT + 60, self.at(*self.box[1])[1] - 36), text, "l", fill="blue")

    def label(
        self, at: Any, name: str, pixel: tuple[float, float], side: tuple[int, int], fill: str
    ) -> None:
        """Write a name and a pixel in two lines diagonally beside a place: right is 1, up is 1.

        Where another label is in the way, they stand at another side.
        """
        lines = [name, "({}; {})".format(*map(format_derived, pixel))]
        wide = max(measure_label(text)[0] for text in lines)
        for right, up in (side, (-side[0], side[1]), (side[0], -side[1]), (-side[0], -side[1])):
            x, y = at[0] + 6 * right, at[1] + 4 * up
            box = (min(x, x + wide * right), min(y, y + 24 * up),
                   max(x, x + wide * right), max(y, y + 24 * up))  # fmt: skip
            if not any(_overlap(box, other) for other in self._taken):
                break
        self._taken.append(box)
        for row, text in enumerate(lines[::-1] if up > 0 else lines):
            align = ("l" if right > 0 else "r") + ("b" if up > 0 else "t")
            self.art.label((x, y + 13 * row * up), text, align, fill=fill, halo=True)

    def mark(self, fig: Any, marks: Values, right: tuple[float, float]) -> None:
        """Ring the pixel that a learner gives; what is not asked of it is as it should be."""
        u, v = marks.get("u", right[0]), marks.get("v", right[1])
        (left, top), (end, low) = (self.at(*corner) for corner in self.box)
        text = f"({format_learned(u)}; {format_learned(v)})"
        mark_point(fig, (left, low, end, top), self.at(u, v), text)


def _overlap(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Whether two boxes (left, low, right, high) come closer than two points."""
    return (one[0] < other[2] + 2 and other[0] < one[2] + 2
            and one[1] < other[3] + 2 and other[1] < one[3] + 2)  # fmt: skip


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, without the point unless it is given, and without offsets."""
    art, (u, v, o_x, o_y) = fig.sketch(), (values[name] for name in ("u", "v", "o_x", "o_y"))
    shown = bool(values["given"]) or not quiz
    frame = PictureFrame(art, values["W"], values["H"], [(o_x, o_y), *([(u, v)] if shown else [])])
    # The point's label stands away from the principal point, so that both have room.
    side = (1 if u >= o_x else -1, 1 if v <= o_y else -1) if shown else (-1, -1)
    frame.draw(side if shown else (1, -1))
    frame.mark_principal_point(o_x, o_y, (-side[0], -side[1]))
    if shown:
        _draw_point(frame, values, side, quiz)


def _draw_point(frame: PictureFrame, values: Values, side: tuple[int, int], quiz: bool) -> None:
    art, (u, v, o_x, o_y) = frame.art, (values[name] for name in ("u", "v", "o_x", "o_y"))
    start, corner, end = frame.at(o_x, o_y), frame.at(u, o_y), frame.at(u, v)
    art.line([start, corner, end], "red", 0.9, dashes=(3, 2), part="offsets")
    art.dot(end, 2.6, "red", part="point")
    frame.label(end, "$(u; v)$ =", (u, v), side, "red")
    if quiz:
        return
    low = frame.at(*frame.box[1])[1]
    for name, value, row in (("u - o_x", u - o_x, 36), ("v - o_y", v - o_y, 50)):
        text = format_equation(f"${name}$", value, "px")
        art.label((_LEFT + 60, low - row), text, "l", part="offsets")


MARKS = {"u": "", "v": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: dict[str, float]) -> None:
    """Ring the pixel (``u``; ``v``) that a learner gives."""
    seen = [(values["o_x"], values["o_y"]), (values["u"], values["v"])]
    PictureFrame(fig.sketch(), values["W"], values["H"], seen).mark(fig, marks, seen[1])


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without the point unless it is given."""
    words = load_alt_words(__file__, lang)
    text = words["figure"].format(**{name: format_given(value) for name, value in values.items()})
    if quiz and not values["given"]:
        return text + words["quiz"]
    point = {name: format_derived(values[name]) for name in ("u", "v")}
    return text + words["point"].format(**point)
