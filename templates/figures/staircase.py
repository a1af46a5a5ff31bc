"""A quantiser as a staircase: the code over the intensity, by one of four ways of rounding."""

from __future__ import annotations

from math import ceil, floor

from quizgen.figures.kit import (
    BOLD,
    DOTTED,
    GREY,
    LINE,
    THIN,
    Canvas,
    Parameter,
    Pen,
    Point,
    Values,
    derived,
    equation,
    given,
    words_of,
)

DARK = "invert"

PARAMETERS = {
    "n": Parameter("", "number of levels", low=2.0, high=16.0, whole=True),
    "rule": Parameter(
        "", "0 nearest, 1 down, 2 down by n equal parts, 3 up", 0.0, 0.0, 3.0, whole=True
    ),
}

_LEFT, _RIGHT, _LOW, _HIGH = 30.0, 296.0, 30.0, 168.0
_RULES = (
    lambda value, n: floor(value * (n - 1) + 0.5),
    lambda value, n: floor(value * (n - 1)),
    lambda value, n: min(floor(value * n), n - 1),
    lambda value, n: ceil(value * (n - 1)),
)


def code(value: float, values: Values) -> int:
    """Code of an intensity in [0, 1]."""
    return _RULES[int(values["rule"])](value, int(values["n"]))


def jumps(values: Values) -> list[float]:
    """Intensities at which the code rises by 1."""
    n = int(values["n"])
    first, parts = ((0.5, n - 1), (1.0, n - 1), (1.0, n), (0.0, n - 1))[int(values["rule"])]
    return [(first + k) / parts for k in range(n - 1)]


def _at(value: float, level: float, n: int) -> Point:
    share = level / (n - 1)
    return _LEFT + (_RIGHT - _LEFT) * value, _LOW + (_HIGH - 14.0 - _LOW) * share


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the line without steps, n and the step."""
    n = int(values["n"])
    pen = Pen(height=182.0)
    _axes(pen, n)
    if not quiz:
        pen.line("line", [_at(0, 0, n), _at(1, n - 1, n)], DOTTED)
        pen.label((_LEFT + 20, _HIGH), f"n = {n}", "l")
        pen.label((_LEFT + 90, _HIGH), equation("Δ", 1 / (n - 1)), "l")
    start = 0.0
    for level, jump in enumerate([*jumps(values), 1.0]):
        if jump > start:
            pen.line("staircase", [_at(start, level, n), _at(jump, level, n)], BOLD)
        if level < n - 1:
            pen.line("rises", [_at(jump, level, n), _at(jump, level + 1, n)], DOTTED)
        start = jump
    if not jumps(values)[0]:
        pen.dot("staircase", _at(0, 0, n))
    if jumps(values)[-1] == 1:
        pen.dot("staircase", _at(1, n - 1, n))
    pen.onto(canvas)


def _axes(pen: Pen, n: int) -> None:

    for tenth in range(11):
        x = _at(tenth / 10, 0, n)[0]
        pen.line("grid", [(x, _LOW), (x, _HIGH - 14)], GREY)
        pen.label((x, _LOW - 11), given(tenth / 10), size=9)
    for level in range(n):
        y = _at(0, level, n)[1]
        pen.line("ticks", [(_LEFT - 4, y), (_LEFT, y)], THIN)
    pen.label((_LEFT - 7, _LOW), "0", "r", 9)
    pen.line("axes", [(_LEFT, _HIGH), (_LEFT, _LOW), (_RIGHT + 6, _LOW)], LINE)
    pen.label((_LEFT - 7, _HIGH - 3), "k", "r")
    pen.label((_RIGHT, 7), "I", "r")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out n and the step."""
    words = words_of(__file__, lang)
    at = ", ".join(derived(round(jump, 3)) for jump in jumps(values))
    told = words["figure"].format(jumps=at) + words[f"ends {int(values['rule'])}"]
    if quiz:
        return told
    n = int(values["n"])
    return told + words["answer"].format(n=n, step=equation("Δ", 1 / (n - 1)))
