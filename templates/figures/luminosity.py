"""V(lambda) by day and V'(lambda) by night over the visible spectrum, with marked wavelengths."""

from __future__ import annotations

from functools import cache, lru_cache
from math import log10
from typing import Any

import numpy as np

from quizgen.figures.kit import (
    ABSENT,
    Parameter,
    Values,
    format_derived,
    format_given,
    load_alt_words,
    require,
    strip_mathtext,
)
from quizgen.numerics.hsv import hsv_to_rgb
from quizgen.numerics.luminosity import DAY, NIGHT, luminous_efficiency

from ._plots import format_learned, mark_point

PARAMETERS = {
    "m_1": Parameter("nm", "first marked wavelength", ABSENT, 380.0, 780.0),
    "m_2": Parameter("nm", "second marked wavelength", ABSENT, 380.0, 780.0),
    "night": Parameter("", "1 marks V' instead of V", 0.0, 0.0, 1.0, whole=True),
    "log": Parameter("", "1 for a logarithmic axis from 0.0001", 0.0, 0.0, 1.0, whole=True),
}
SIZE = (268.0, 128.0)

FIRST, LAST = 380.0, 780.0
_FLOOR = 1e-4  # of the logarithmic axis
_LEVELS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
_DECADES = range(-4, 1)
_FINE = [decade + log10(digit) for decade in _DECADES[:-1] for digit in range(2, 10)]
_NAMED = {0: ((606.0, 622.0, 588.0, 572.0), (457.0, 490.0, 435.0)), 1: ((692.0,), (622.0,))}
"""Where V and V' may be named in nm, by the axis: the first place that no mark runs through."""
_NAME_WIDTH = 28.0


def list_marks(values: Values) -> tuple[float, ...]:
    """Marked wavelengths in nm."""
    return tuple(values[name] for name in ("m_1", "m_2") if name in values)


@lru_cache(256)
def read_efficiency(wavelength: float, *, night: bool) -> float:
    """V or V' at a wavelength in nm."""
    return float(luminous_efficiency(wavelength, NIGHT if night else DAY))


@cache
def _curve(night: bool, logarithmic: bool) -> Any:
    """Points of a curve; on a logarithmic axis it leaves through the floor."""
    grid = np.linspace(FIRST, LAST, 161)
    heights = np.asarray(luminous_efficiency(grid, NIGHT if night else DAY), float)
    if logarithmic:
        seen = heights >= _FLOOR
        grid, heights = grid[seen], np.log10(heights[seen])
    return np.column_stack([grid, heights])


@cache
def _spectrum() -> Any:
    """Colours of the spectrum, one column every 4 nm: each pure hue with the brightness at its end.

    Hues run from violet (270 degrees, 400 nm) over blue 460, green 530 and yellow 580 to red 640.
    """
    places = np.arange(FIRST, LAST, 4.0)
    hues = np.interp(places, [400, 460, 490, 530, 580, 640], [270, 240, 180, 120, 60, 0])
    fades = np.interp(places, [FIRST, 430, 680, LAST], [0.35, 1, 1, 0.35])
    row = np.stack(hsv_to_rgb(hues, 1.0, fades), axis=-1)
    return np.round(row[None] * 255).astype(np.uint8)


def _height(values: Values, efficiency_there: float) -> float:
    """Where a height stands on the upright axis."""
    return log10(max(efficiency_there, 1e-9)) if values["log"] else efficiency_there


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the values at the marks."""
    marks = list_marks(values)
    apart = len(marks) < 2 or abs(marks[0] - marks[1]) >= 5
    require("luminosity", apart, "m_1 and m_2 must be at least 5 nm apart")
    _draw_axes(ax, logarithmic=bool(values["log"]))
    art = ax.figure.sketch(ax)
    for night, ink in ((True, "blue"), (False, "ink")):
        line = _curve(night, bool(values["log"]))
        art.line(line, ink, 1.2 if night else 1.6, dashes=(5, 2.2) if night else None,
                 part="night" if night else "day")  # fmt: skip
        side = -1 if night and not values["log"] else 1
        at = _place_name(_NAMED[int(values["log"])][night], side, marks)
        y = _height(values, read_efficiency(at, night=night))
        art.label((at, y), "$V'$" if night else "$V$", "l" if side > 0 else "r", 11, ink,
                  shift=(5 * side, 2))  # fmt: skip
    _draw_marks(ax, art, values, told=not quiz)


def _place_name(places: tuple[float, ...], side: int, marks: tuple[float, ...]) -> float:
    """Return the first place beside which a name stands clear of all marks; else the first."""
    clear = (at for at in places if not any(0 < side * (m - at) < _NAME_WIDTH for m in marks))
    return next(clear, places[0])


def _draw_axes(ax: Any, *, logarithmic: bool) -> None:
    ax.set(xlim=(FIRST, LAST), ylim=(-4, 0.6) if logarithmic else (0, 1.15))
    ax.set_xlabel(r"$\lambda$ / nm")
    ax.set_ylabel(r"$V(\lambda)$,  $V'(\lambda)$")
    ax.set_xticks(range(400, 800, 50))
    if logarithmic:
        ax.set_yticks(_DECADES, [f"$10^{{{d}}}$" if d else "1" for d in _DECADES])
        ax.set_yticks(_FINE, minor=True)
        ax.tick_params(axis="y", labelsize=10)  # its exponents are smaller
    else:
        ax.set_yticks(_LEVELS, map(format_given, _LEVELS))
    ax.grid(axis="y")
    ax.tick_params(axis="x", pad=9.5)
    box = ax.bbox
    ax.figure.picture(_spectrum(), (box.x0, box.y0 - 9, box.width, 5.5), gid="spectrum")


def _draw_marks(ax: Any, art: Any, values: Values, *, told: bool) -> None:
    """Marks from the axis up; a dot on the curve would say which one is to be read."""
    night, (low, high), marks = bool(values["night"]), ax.get_ylim(), list_marks(values)
    top = high - 0.1 * (high - low)
    near = len(marks) == 2 and abs(marks[0] - marks[1]) < 30
    for number, at in enumerate(marks):
        y = _height(values, read_efficiency(at, night=night))
        art.line([(at, low), (at, top)], "red", 0.8, dashes=(1.4, 1.6), part="marks")
        align = "c" if at > FIRST + 8 else "l"  # beside the axis
        if near:
            align = "r" if at == min(marks) else "l"
        shift = {"c": 0, "r": -0.5, "l": 2.5}[align]
        name = rf"$\lambda_{number + 1}$"
        art.label((at, top), name, align, 10, "red", shift=(shift, 6), part="mark-names")
        if told and y >= low:
            art.line([(FIRST, y), (at, y)], "red", 0.6, dashes=(1.4, 1.6), part="marks")
            art.dot((at, y), 2.3, "red", part="marks")
    if told and marks:
        text = ",   ".join(_reading(values, *mark) for mark in enumerate(marks))
        art.label((LAST, high), text, "r", 10, "red", shift=(0, 11.5), part="readings")


def _reading(values: Values, number: int, wavelength: float) -> str:
    night = bool(values["night"])
    value = format_derived(read_efficiency(wavelength, night=night))
    return rf"${'V' + chr(39) * night}(\lambda_{number + 1})$ ≈ {value}"


MARKS = {"V_1": "", "V_2": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(ax: Any, values: Values, marks: Values) -> None:
    """Draw a learner's heights ``V_1`` and ``V_2`` of the marked curve at the marks."""
    x0, y0, x1, y1 = ax.bbox.extents
    for number, at in enumerate(list_marks(values), 1):
        if (value := marks.get(f"V_{number}")) is not None:
            point = ax.transData.transform((at, _height(values, value)))
            mark_point(ax.figure, (x0, y0, x1, y1), tuple(point), format_learned(value))


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out the values at the marks."""
    words = load_alt_words(__file__, lang)
    text = words["log" if values["log"] else "figure"] + words["seen" if quiz else "curves"]
    for number, wavelength in enumerate(list_marks(values)):
        text += f" λ_{number + 1} = {format_given(wavelength)} nm"
        if not quiz:
            text += f", {strip_mathtext(_reading(values, number, wavelength))}"
        text += words["stop"]
    return text
