"""A square grid under radial distortion, over the undistorted grid in grey.

Lines through the principal point stay straight. The shown part of the plane is made so small that
the map never folds over: its derivative 1 + 3 k1 r² + 5 k2 r⁴ stays above 0.099 to the corners.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, floor, hypot
from typing import TYPE_CHECKING

from quizgen.figures.kit import (
    ABSENT,
    GREY,
    LINE,
    RED,
    Canvas,
    Parameter,
    Pen,
    Style,
    Values,
    given,
    require,
    words_of,
)

if TYPE_CHECKING:
    import numpy as np


DARK = "invert"

PARAMETERS = {
    "k1": Parameter("1", "first coefficient, from undistorted to distorted coordinates"),
    "k2": Parameter("1", "second coefficient", 0.0),
    "step": Parameter("1", "distance of grid lines; a quarter of the extent", ABSENT, 0.02, 1.0),
    "extent": Parameter(
        "1", "the grid covers [-extent, extent]²; shrunk in tenths until nothing folds", 1.0, 0.1
    ),
    "c_x": Parameter("1", "principal point, to the right of the centre", 0.0, -0.8, 0.8),
    "c_y": Parameter("1", "principal point, above the centre", 0.0, -0.8, 0.8),
}

_LEAST_SLOPE = 0.099
_SIDE = 178.0
_FOOT = 24.0
_SAMPLES = 33


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave the coefficients out.

    Raises
    ------
    BankError
        If the map folds over even on a tenth of the plane, or the principal point lies outside.
    """
    foot = 0.0 if quiz else _FOOT
    pen = Pen(_SIDE + 20, _SIDE + 20 + foot)
    lines = _lines(values, shown_extent(values))
    moved = _distorted(lines, values)
    scale, middle = _frame([*lines, *moved])
    place = (10 + _SIDE / 2 - scale * middle[0], 10 + foot + _SIDE / 2 - scale * middle[1], scale)
    _paint(pen, "undistorted", lines, place, GREY)
    _paint(pen, "distorted", moved, place, LINE)
    _cross(pen, values, place, RED)
    if not quiz:
        _caption(pen, values)
    pen.onto(canvas)


def shown_extent(values: Values) -> float:
    """Half width of the grid that is drawn: ``extent``, or less where the map would fold over.

    Parameters
    ----------
    values : mapping of str to float
        As ``PARAMETERS`` says.

    Returns
    -------
    float
        At most ``extent``.

    Raises
    ------
    BankError
        If not even 0.1 can be shown, or the principal point lies outside.
    """
    extent = values["extent"]
    while extent > 0.05 and _folds(values, extent):
        extent = round((ceil(extent * 10 - 1e-9) - 1) / 10, 1)
    require("distorted_grid", extent > 0.05, "the map folds over everywhere")
    offset = max(abs(values["c_x"]), abs(values["c_y"]))
    require("distorted_grid", offset < extent, "the principal point lies outside the grid")
    return extent


def _folds(values: Values, extent: float) -> bool:
    """Whether the slope falls below the least one, where stronger coefficients fold over."""
    corner = hypot(extent + abs(values["c_x"]), extent + abs(values["c_y"]))
    return _fold_radius(*(values[name] / (1 - _LEAST_SLOPE) for name in ("k1", "k2"))) < corner


@lru_cache(maxsize=64)
def _fold_radius(k1: float, k2: float) -> float:
    """Where the map folds over; a figure asks for it many times."""
    from quizgen.arrays.distortion import fold_radius

    return float(fold_radius(k1, k2))


def _lines(values: Values, extent: float) -> list[np.ndarray]:
    """Grid lines as (samples, 2) arrays: multiples of the step from the principal point."""
    import numpy as np

    along = np.linspace(-extent, extent, _SAMPLES)
    lines = [
        np.column_stack([np.full_like(along, x), along])
        for x in _levels(values["c_x"], _step(values), extent)
    ]
    return lines + [
        np.column_stack([along, np.full_like(along, y)])
        for y in _levels(values["c_y"], _step(values), extent)
    ]


def _step(values: Values) -> float:
    return values.get("step", shown_extent(values) / 4)


def _levels(centre: float, step: float, extent: float) -> list[float]:
    first, last = ceil((-extent - centre) / step), floor((extent - centre) / step)
    inner = {round(centre + i * step, 9) for i in range(first, last + 1)}
    return sorted(inner | {-extent, extent})


def _distorted(lines: list[np.ndarray], values: Values) -> list[np.ndarray]:
    import numpy as np

    from quizgen.arrays.distortion import distort

    centre = np.array([values["c_x"], values["c_y"]])
    x, y = np.moveaxis(np.stack(lines) - centre, -1, 0)
    moved = np.stack(distort(x, y, values["k1"], values["k2"]), axis=-1)
    return list(centre + moved)


def _frame(lines: list[np.ndarray]) -> tuple[float, tuple[float, float]]:
    import numpy as np

    everything = np.concatenate(lines)
    low, high = everything.min(axis=0), everything.max(axis=0)
    return _SIDE / float((high - low).max()), tuple((low + high) / 2)


Place = tuple[float, float, float]


def _paint(pen: Pen, part: str, lines: list[np.ndarray], place: Place, style: Style) -> None:
    for line in lines:
        pen.line(part, line * place[2] + place[:2], style)


def _cross(pen: Pen, values: Values, place: Place, style: Style) -> None:
    x, y = place[0] + values["c_x"] * place[2], place[1] + values["c_y"] * place[2]
    pen.line("principal-point", [(x - 6, y - 6), (x + 6, y + 6)], style)
    pen.line("principal-point", [(x - 6, y + 6), (x + 6, y - 6)], style)


def _caption(pen: Pen, values: Values) -> None:
    text = f"k_1 = {given(values['k1'])}"
    if values["k2"]:
        text += f",  k_2 = {given(values['k2'])}"
    pen.label((pen.width / 2, 13), text)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words.

    In a quiz, leave the coefficients and the kind of distortion out.
    """
    words = words_of(__file__, lang)
    text = words["figure"].format(step=given(_step(values)), extent=given(shown_extent(values)))
    if quiz:
        return text
    numbers = words["answer"].format(k1=given(values["k1"]), k2=given(values["k2"]))
    return text + numbers + words[_kind(values)]


def _kind(values: Values) -> str:
    sign = values["k1"] or values["k2"]
    if sign == 0:
        return "none"
    return "barrel" if sign < 0 else "pincushion"
