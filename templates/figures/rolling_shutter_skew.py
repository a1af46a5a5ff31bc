"""Rolling-shutter skew: a moving pole as a sensor sees it that reads its rows one after another.

A few rows stand for all of them, so the lean is not to scale; the dots in the middle say so.
"""

from __future__ import annotations

from math import atan, degrees
from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_equation,
    format_given,
    load_alt_words,
    relation_sign,
)

SIZE = (312.0, 170.0)

PARAMETERS = {
    "v": Parameter("px/s", "speed of the pole in the picture, to the right", None, 0.0, 1e6),
    "t_r": Parameter("µs", "time from one row to the next", None, 0.0, 1e6),
    "n": Parameter("", "rows that the pole is tall", None, 1.0, 1e6),
}

_LEFT, _RIGHT, _TOP, _HIGH = 60.0, 196.0, 142.0, 13.0
_ROWS = (0, 1, 2, 3, 5, 6, 7, 8)  # the fifth place is left out: there are many more
_POLE, _STEP, _THICK = 92.0, 8.0, 11.0


def lean_of(values: Values) -> tuple[float, float]:
    """How far the foot is shifted in pixels, and the angle to the vertical in degrees."""
    shift = values["v"] * values["n"] * values["t_r"] * 1e-6
    return shift, degrees(atan(shift / values["n"]))


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, with question marks for the shift and the angle."""
    art, (shift, angle) = fig.sketch(), lean_of(values)
    low = _TOP - 9 * _HIGH
    foot = _POLE + 8 * _STEP
    art.area(
        [(_LEFT, low), (_RIGHT, low), (_RIGHT, _TOP), (_LEFT, _TOP)],
        None,
        "ink",
        0.8,
        part="picture",
    )
    for row in _ROWS:
        y, x = _TOP - row * _HIGH, _POLE + row * _STEP
        art.line([(_LEFT, y - _HIGH), (_RIGHT, y - _HIGH)], "rule", 0.5, part="rows")
        piece = [(x, y), (x + _THICK, y), (x + _THICK, y - _HIGH), (x, y - _HIGH)]
        art.area(piece, "pale-blue", "blue", 0.8, part="pole")
    for place in (0.25, 0.5, 0.75):
        y = _TOP - (4 + place) * _HIGH
        art.dot((_POLE + 4 * _STEP + _THICK / 2, y), 0.9, "ink", part="break")
    start = [(_POLE, _TOP), (_POLE, low), (_POLE + _THICK, low), (_POLE + _THICK, _TOP)]
    art.line(start, "grey", 0.8, dashes=(3, 2), part="upright")
    middle = _POLE + _THICK / 2
    art.line([(middle, _TOP), (middle + 9 * _STEP, low)], "red", 0.9, part="lean")
    art.arc((middle, _TOP), 78, -90, -90 + degrees(atan(_STEP / _HIGH)), "red", 0.9, part="angle")
    art.label((_POLE + 27, _TOP - 91), r"$\alpha$", "c", fill="red", halo=True)
    art.arrow((_POLE - 8, _TOP + 9), (_POLE + 34, _TOP + 9), "blue", 1.2, part="movement")
    art.label((_POLE + 40, _TOP + 9), f"$v$ = {format_given(values['v'])} px/s", "l", fill="blue")
    art.arrow((_LEFT - 9, _TOP), (_LEFT - 9, low), "grey", 0.6, size=5.5, both=True, part="height")
    art.label((_LEFT - 14, (_TOP + low) / 2), f"$n$ = {format_given(values['n'])}", "r")
    for x in (_POLE, foot):
        art.line([(x, low - 2), (x, low - 13)], "rule", 0.6, part="helpers")
    art.arrow((_POLE, low - 10), (foot, low - 10), "grey", 0.6, size=5.5, both=True, part="shift")
    art.label((foot + 6, low - 10), format_equation("$d$", shift, "px", hide=quiz), "l")
    _times(art, values, low)
    text = "= ?" if quiz else f"{relation_sign(angle)} {format_derived(angle)}°"
    art.label((_RIGHT + 30, low - 10), rf"$\alpha$ {text}", "l", fill="red")


def _times(art: Any, values: Values, low: float) -> None:
    """Say beside the rows when each is read."""
    x = _RIGHT + 8
    art.arrow((x, _TOP), (x, low), "grey", 0.8, part="read-out")
    names = {0: "0", 1: "$t_r$", 2: "$2\\,t_r$", 3: "$3\\,t_r$", 8: "$n\\,t_r$"}
    for row, name in names.items():
        art.label((x + 7, _TOP - (row + 0.5) * _HIGH), name, "l")
    for place in (0, 4, 8):
        art.dot((x + 13, _TOP - 5.2 * _HIGH - place), 0.8, "grey", part="break")
    art.label((x, _TOP + 9), "$t$", "c")
    given = f"$t_r$ = {format_given(values['t_r'])} µs"
    art.label((x + 34, _TOP - 4.5 * _HIGH), given, "l")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without shift and angle."""
    words = load_alt_words(__file__, lang)
    text = words["figure"].format(**{name: format_given(value) for name, value in values.items()})
    if quiz:
        return text + words["quiz"]
    shift, angle = (f"{relation_sign(v)} {format_derived(v)}" for v in lean_of(values))
    return text + words["answer"].format(shift=shift, angle=angle)
