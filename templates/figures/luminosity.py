"""V(lambda) by day and V'(lambda) by night over the visible spectrum, with marked wavelengths."""

from __future__ import annotations

from functools import cache
from math import log10

from quizgen.figures.kit import (
    ABSENT,
    BOLD,
    DASHED,
    DOTTED,
    LINE,
    THIN,
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Point,
    Values,
    derived,
    given,
    require,
    spoken,
    words_of,
)

DARK = "keep"

PARAMETERS = {
    "m_1": Parameter("nm", "first marked wavelength", ABSENT, 380.0, 780.0),
    "m_2": Parameter("nm", "second marked wavelength", ABSENT, 380.0, 780.0),
    "night": Parameter("", "1 marks V' instead of V", 0.0, 0.0, 1.0, whole=True),
    "log": Parameter("", "1 for a logarithmic axis from 0.0001", 0.0, 0.0, 1.0, whole=True),
}

FIRST, LAST = 380.0, 780.0
_LEFT, _RIGHT, _LOW, _HIGH = 34.0, 300.0, 36.0, 160.0
_DECADES = 4
_TICKS = range(400, 800, 50)


def _x(wavelength: float) -> float:
    return _LEFT + (_RIGHT - _LEFT) * (wavelength - FIRST) / (LAST - FIRST)


def _y(value: float, *, logarithmic: bool) -> float:
    share = max(0.0, 1.0 + log10(value) / _DECADES) if logarithmic else value
    return _LOW + (_HIGH - 14.0 - _LOW) * share


def marks(values: Values) -> tuple[float, ...]:
    """Marked wavelengths in nm."""
    return tuple(values[name] for name in ("m_1", "m_2") if name in values)


def read(wavelength: float, *, night: bool) -> float:
    """V or V' at a wavelength in nm."""
    from quizgen.arrays.luminosity import DAY, NIGHT, efficiency

    return float(efficiency(wavelength, NIGHT if night else DAY))


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the values at the marks."""
    apart = len(marks(values)) < 2 or abs(values["m_1"] - values["m_2"]) >= 5
    require("luminosity", apart, "m_1 and m_2 must be at least 5 nm apart")
    told = bool(marks(values)) and not quiz
    pen = Pen(height=186.0 if told else 168.0)
    log = bool(values["log"])
    _axes(canvas, pen, logarithmic=log)
    for night in (True, False):
        _curve(pen, night=night, logarithmic=log)
    for place, wavelength in enumerate(marks(values)):
        _mark(pen, values, place, wavelength, told=told)
        if told:
            pen.label((WIDTH * (0.3 + 0.4 * place), 177), _reading(values, place, wavelength))
    pen.onto(canvas, background="#ffffff")  # a dark page would turn the spectrum round


def _axes(canvas: Canvas, pen: Pen, *, logarithmic: bool) -> None:

    canvas.picture(_strip(), (_LEFT, _LOW - 9, _RIGHT - _LEFT, 8))
    pen.line("axes", [(_LEFT, _HIGH), (_LEFT, _LOW), (_RIGHT, _LOW)], LINE)
    for wavelength in _TICKS:
        x = _x(wavelength)
        pen.line("ticks", [(x, _LOW), (x, _LOW - 12)], THIN)
        pen.label((x, _LOW - 18), str(wavelength), size=9)
    pen.label((_RIGHT, 7), "λ / {nm}", "r", 9.5)
    for value in _levels(logarithmic=logarithmic):
        y = _y(value, logarithmic=logarithmic)
        pen.line("ticks", [(_LEFT - 4, y), (_LEFT, y)], THIN)
        pen.label((_LEFT - 6, y), given(value), "r", 8 if logarithmic else 9)


def _levels(*, logarithmic: bool) -> tuple[float, ...]:
    return (0.0001, 0.001, 0.01, 0.1, 1.0) if logarithmic else (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)


@cache
def _strip() -> bytes:
    """Colours of the spectrum, one column every 4 nm: each pure hue with the brightness at its end.

    Hues run from violet (270 degrees, 400 nm) over blue 460, green 530 and yellow 580 to red 640.
    """
    import numpy as np

    from quizgen.arrays.hsv import to_rgb
    from quizgen.png import encode

    places = np.arange(FIRST, LAST, 4.0)
    hues = np.interp(places, [400, 460, 490, 530, 580, 640], [270, 240, 180, 120, 60, 0])
    fades = np.interp(places, [FIRST, 430, 680, LAST], [0.35, 1, 1, 0.35])
    row = np.stack(to_rgb(hues, 1.0, fades), axis=-1)
    return encode(np.round(row[None] * 255).astype(np.uint8))


@cache
def _points(night: bool, logarithmic: bool) -> tuple[Point, ...]:
    from quizgen.arrays.luminosity import DAY, NIGHT, efficiency

    grid = [FIRST + 2.5 * step for step in range(161)]
    heights = efficiency(grid, NIGHT if night else DAY)
    # A logarithmic curve leaves through the floor of the axis: nothing is drawn along it.
    return tuple(
        (_x(x), _y(float(v), logarithmic=logarithmic))
        for x, v in zip(grid, heights, strict=True)
        if not logarithmic or v >= 10.0**-_DECADES
    )


def _curve(pen: Pen, *, night: bool, logarithmic: bool) -> None:

    pen.line("night" if night else "day", _points(night, logarithmic), DASHED if night else BOLD)
    beside = _NAMED[logarithmic][night]
    y = _y(read(beside, night=night), logarithmic=logarithmic)
    pen.label((_x(beside) + (-5 if night else 5), y), "V'" if night else "V", "r" if night else "l")


_NAMED = {False: {True: 458.0, False: 604.0}, True: {True: 404.0, False: 690.0}}
"""Where the curves are named: logarithmic, then night, to a wavelength on the outer slope."""


def _mark(pen: Pen, values: Values, place: int, wavelength: float, *, told: bool) -> None:
    """A mark from the axis to the name; a dot on the curve would say which one is to be read."""
    x = _x(wavelength)
    y = _y(read(wavelength, night=bool(values["night"])), logarithmic=bool(values["log"]))
    if told:
        pen.line("marks", [(x, _LOW), (x, y)], THIN)
        pen.dot("marks", (x, y), 2.6)
    pen.line("marks", [(x, y if told else _LOW), (x, _HIGH - 8)], DOTTED)
    pair = marks(values)
    near = len(pair) == 2 and abs(_x(pair[0]) - _x(pair[1])) < 18
    side = "c" if not near else "r" if wavelength == min(pair) else "l"
    shift = {"c": 0, "r": 2, "l": -2}[side]
    pen.label((x + shift, _HIGH - 1), f"λ_{place + 1}", side, 10)


def _reading(values: Values, place: int, wavelength: float) -> str:
    night = bool(values["night"])
    name = "V'" if night else "V"
    return f"{name}(λ_{place + 1}) ≈ {derived(read(wavelength, night=night))}"


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out the values at the marks."""
    words = words_of(__file__, lang)
    told = [words["log" if values["log"] else "figure"] + words["seen" if quiz else "curves"]]
    for place, wavelength in enumerate(marks(values)):
        text = f"λ_{place + 1} = {given(wavelength)} nm"
        told.append(text if quiz else f"{text}, {spoken(_reading(values, place, wavelength))}")
    return told[0] + ("".join(f" {text}{words['stop']}" for text in told[1:]))
