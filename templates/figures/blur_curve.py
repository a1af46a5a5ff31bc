"""Diameter of the blur disc against the distance of a thing, for one lens at one or two f-numbers.

A dashed line marks the diameter that still counts as sharp; lines every half tick help to read.
"""

from __future__ import annotations

from math import floor, inf, isfinite, log10

from quizgen.figures.kit import (
    ABSENT,
    BOLD,
    DASHED,
    DOTTED,
    LINE,
    Canvas,
    Parameter,
    Pen,
    Point,
    Style,
    Values,
    equation,
    given,
    require,
    spoken,
    statement,
    words_of,
)

from .depth_of_field import disc

DARK = "invert"

PARAMETERS = {
    "f": Parameter("mm", "focal length", low=1.0, high=1000.0),
    "s": Parameter("m", "distance in focus", low=0.1, high=1000.0),
    "N_1": Parameter("", "f-number of curve 1", low=0.5, high=128.0),
    "N_2": Parameter("", "f-number of curve 2", ABSENT, 0.5, 128.0),
    "c": Parameter("um", "largest disc that counts as sharp", ABSENT, 0.1, 10_000.0),
    "far": Parameter("m", "end of the distance axis", 10.0, 0.1, 1000.0),
    "high": Parameter("um", "end of the diameter axis", 100.0, 0.1, 100_000.0),
}

_LEFT, _RIGHT, _LOW, _TOP = 34.0, 292.0, 34.0, 156.0
_POINTS = 120


def _reach(values: Values, number: str, diameter: float) -> tuple[float, float]:
    """Nearest and farthest distance with a disc of at most this diameter; infinity from H on."""
    focal, s = values["f"], values["s"]
    share = diameter * values[number] * (1000 * s - focal) / (1000 * focal**2)
    return s / (1 + share), s / (1 - share) if share < 1 else inf


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, mark neither the distance in focus nor the limits."""
    require("blur_curve", 1000 * values["s"] > 2 * values["f"], "s must exceed 2 f")
    require("blur_curve", values["s"] < values["far"], "s must lie on the axis")
    told = not quiz
    pen = Pen(height=194.0 if told else 180.0)
    _axes(pen, values)
    for place, number in enumerate(_numbers(values)):
        _curve(pen, values, number, str(place + 1))
    if "c" in values:
        _limit(pen, values, told=told)
    if told:
        pen.label(((_LEFT + _RIGHT) / 2 + 20, 186), _answers(values), size=9.5)
    pen.onto(canvas)


def _numbers(values: Values) -> tuple[str, ...]:
    return tuple(name for name in ("N_1", "N_2") if name in values)


def _at(values: Values, z: float, diameter: float) -> Point:
    across, up = z / values["far"], diameter / values["high"]
    return (_LEFT + (_RIGHT - _LEFT) * across, _LOW + (_TOP - _LOW) * up)


def _step(end: float) -> float:
    """Distance of ticks: 1, 2 or 5 times a power of ten, with 5 to 10 of them up to the end."""
    power = 10.0 ** floor(log10(end))
    return next(step for step in (power / 10, power / 5, power / 2, power) if end / step <= 10)


def _axes(pen: Pen, values: Values) -> None:

    _ticks(pen, values, "far", _RIGHT - _LEFT)
    _ticks(pen, values, "high", _TOP - _LOW)
    pen.line("axes", [(_LEFT, _TOP + 8), (_LEFT, _LOW), (_RIGHT + 6, _LOW)], LINE)
    pen.label((_LEFT - 5, _LOW - 10), "0", "r", 9)
    pen.label((_LEFT - 4, _TOP + 15), "{Ø} / {µm}", "l", 9.5)
    pen.label((_RIGHT, 8), "z / {m}", "r", 9.5)


def _ticks(pen: Pen, values: Values, axis: str, length: float) -> None:
    """Draw a line every half tick across the whole plot, and a number at every tick."""
    end, half = values[axis], _step(values[axis]) / 2
    for count in range(1, round(end / half) + 1):
        shift = length * count * half / end
        x, y = _LEFT + shift, _LOW + shift
        across = [(x, _LOW), (x, _TOP)] if axis == "far" else [(_LEFT, y), (_RIGHT, y)]
        pen.line("grid", across, Style(0.6, "#b8b8b8"))
        if count % 2 == 0:
            at = (x, _LOW - 10) if axis == "far" else (_LEFT - 5, y)
            pen.label(at, given(count * half), "c" if axis == "far" else "r", 9)


def _curve(pen: Pen, values: Values, number: str, name: str) -> None:

    first, last = _seen(values, number)
    inverse = [1 / first + (1 / last - 1 / first) * k / _POINTS for k in range(_POINTS + 1)]
    places = sorted({*(1 / u for u in inverse), values["s"]})
    points = [_at(values, z, disc(values, values[number], z)) for z in places]
    pen.line("curves", points, BOLD)
    x, y = points[-1]
    at, anchor = ((x + 5, y), "l") if last == values["far"] else ((x, y + 8), "c")
    pen.label(at, f"{{{name}}}", anchor, 10)


def _seen(values: Values, number: str) -> tuple[float, float]:
    """Between which distances a curve lies inside the plot."""
    near, far = _reach(values, number, values["high"])
    return near, min(values["far"], far)


def _limit(pen: Pen, values: Values, *, told: bool) -> None:

    level = _at(values, 0, values["c"])[1]
    pen.line("limit", [(_LEFT, level), (_RIGHT, level)], DASHED)
    pen.label((_LEFT + 6, level + 7), "c", "l")
    for z in _reach(values, "N_1", values["c"]) if told else ():
        if z <= values["far"]:
            x = _at(values, z, 0)[0]
            pen.line("limits", [(x, _LOW), (x, level)], DOTTED)
            pen.dot("limits", (x, level), 2.6)


def _answers(values: Values) -> str:
    told = [statement("s", values["s"], "m")]
    if "c" in values:
        names = zip(("z_n", "z_f"), _reach(values, "N_1", values["c"]), strict=True)
        told += [equation(name, z, "m") for name, z in names if isfinite(z)]
    told += [f"{{{n + 1}:}} f{{/{given(values[name])}}}" for n, name in enumerate(_numbers(values))]
    return ",   ".join(told)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words: both curves at every tick; in a quiz, no marks beside them."""
    words = words_of(__file__, lang)
    told = [words["figure"].format(far=given(values["far"]), high=given(values["high"]))]
    step = _step(values["far"])
    places = [step * count for count in range(1, round(values["far"] / step) + 1)]
    for place, number in enumerate(_numbers(values)):
        discs = [(z, disc(values, values[number], z)) for z in places]
        read = [f"{given(z)} m: {round(um)} µm" for z, um in discs if um <= values["high"]]
        told.append(words["curve"].format(place + 1, "; ".join(read)))
    if "c" in values:
        told.append(words["limit"].format(given(values["c"])))
    if not quiz:
        told.append(words["answer"].format(spoken(_answers(values))))
    return " ".join(told)
