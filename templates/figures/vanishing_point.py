"""Vanishing point: the image of a line and of lines parallel to it, which meet in one pixel."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import Parameter, Values, format_derived, format_given, load_alt_words

from .pixel_grid import PictureFrame

SIZE = (270.0, 170.0)

_FAR = 1e6
PARAMETERS = {
    "f": Parameter("px", "focal length", None, 1e-3, _FAR),
    "W": Parameter("px", "width of the picture", None, 1.0, _FAR),
    "H": Parameter("px", "height of the picture", None, 1.0, _FAR),
    "o_x": Parameter("px", "column of the principal point", None, -_FAR, _FAR),
    "o_y": Parameter("px", "row of the principal point, counted downwards", None, -_FAR, _FAR),
    "a": Parameter("m", "start of the line: x to the right, y down, depth", None, kind="list"),
    "d": Parameter("", "its direction, likewise; the last is above 0", None, kind="list"),
}


def image_of(values: Values, name: str) -> tuple[float, float]:
    """Pixel that ``a`` is imaged at; of ``d`` it is the vanishing point."""
    x, y, depth = values[name]
    f = values["f"]
    return values["o_x"] + f * x / depth, values["o_y"] + f * y / depth


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, the picture and its principal point alone."""
    art, goal, start = fig.sketch(), image_of(values, "d"), image_of(values, "a")
    (o_x, o_y), seen = (values["o_x"], values["o_y"]), [] if quiz else [goal]
    frame = PictureFrame(art, values["W"], values["H"], [(o_x, o_y), *seen])
    side = (1 if goal[0] >= o_x else -1, 1 if goal[1] <= o_y else -1)
    frame.draw((1, -1) if quiz else side)
    if quiz:
        frame.mark_principal_point(o_x, o_y, (1, 1))
        return
    for u in (0.0, values["W"]):
        for v in (0.0, values["H"]):  # any line through the point is the image of a parallel one
            art.line(
                [frame.at(u, v), frame.at(*goal)], "grey", 0.7, dashes=(4, 2.5), part="parallels"
            )
    first = _shorten(start, goal, frame.box)
    art.ray([frame.at(*first), frame.at(*goal)], "red", 1.3, heads=((0, 0.5),), part="line")
    if first == start:
        art.dot(frame.at(*start), 2.4, "paper", "red", 1.1, part="start")
    frame.mark_principal_point(o_x, o_y, None)
    art.dot(frame.at(*goal), 2.8, "red", part="vanishing")
    frame.label(frame.at(*goal), "$(u; v)$ =", goal, side, "red")


def _shorten(start: tuple[float, float], goal: tuple[float, float], box: Any) -> Any:
    """Where a line towards a place inside a box comes into it."""
    share = 0.0
    for s, g, low, high in zip(start, goal, *box, strict=True):
        if s < low or s > high:
            share = max(share, ((low if s < low else high) - s) / (g - s))
    if not share:
        return start
    return tuple(s + share * (g - s) for s, g in zip(start, goal, strict=True))


MARKS = {"u": "", "v": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: dict[str, float]) -> None:
    """Ring the pixel (``u``; ``v``) that a learner gives."""
    seen = [(values["o_x"], values["o_y"]), image_of(values, "d")]
    PictureFrame(fig.sketch(), values["W"], values["H"], seen).mark(fig, marks, seen[1])


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without the vanishing point."""
    words = load_alt_words(__file__, lang)
    given = {name: format_given(values[name]) for name in ("W", "H", "o_x", "o_y", "f")}
    text = words["figure"].format(**given)
    if quiz:
        return text + words["quiz"]
    u, v = map(format_derived, image_of(values, "d"))
    return text + words["answer"].format(u=u, v=v)
