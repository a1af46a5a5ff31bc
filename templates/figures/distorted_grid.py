"""A square grid under radial distortion, over the undistorted grid in grey.

Lines through the principal point stay straight. The shown part of the plane is made so small that
the map never folds over: its derivative 1 + 3 k1 r² + 5 k2 r⁴ stays above 0.099 to the corners.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, floor, hypot
from typing import Any

import numpy as np

from quizgen.figures.kit import (
    ABSENT,
    SQUARE,
    Parameter,
    Values,
    format_given,
    load_alt_words,
    require,
)
from quizgen.numerics.distortion import distort, fold_radius

from ._plots import trace_lines

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
SIZE = SQUARE

_LEAST_SLOPE = 0.099
_SAMPLES = 33


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave the coefficients out.

    Raises
    ------
    BankError
        If the map folds over even on a tenth of the plane, or the principal point lies outside.
    """
    extent = find_extent(values)
    lines = _list_lines(values, extent)
    moved = _move(lines, values)
    both = np.concatenate([lines, moved]).reshape(-1, 2)
    low, high = both.min(axis=0), both.max(axis=0)
    half, middle = 0.52 * (high - low).max(), (low + high) / 2
    ax.set(
        xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half),
        xlabel="$x$", ylabel="$y$",
    )  # fmt: skip
    ticks = [extent * share for share in (-1, -0.5, 0, 0.5, 1)]
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_ticks(ticks, map(format_given, ticks))
    art = ax.figure.sketch(ax)
    art.shape(trace_lines(lines[:, [0, -1]]), None, "rule", 0.8, part="undistorted")
    art.shape(trace_lines(moved), None, "blue", 1.1, part="distorted")
    art.cross((values["c_x"], values["c_y"]), part="principal-point")
    if not quiz:
        _draw_answer(ax, art, values, extent)


def _draw_answer(ax: Any, art: Any, values: Values, extent: float) -> None:
    """Write the coefficients, and draw where the corners went."""
    corners = np.array([[(x, y) for x in (-extent, extent) for y in (-extent, extent)]])
    for start, end in zip(corners[0], _move(corners, values)[0], strict=True):
        if hypot(*np.diff(art.to_points([start, end]), axis=0)[0]) > 9:
            art.arrow(start, end, "red", 1.0, part="moved")
    text = f"$k_1$ = {format_given(values['k1'])}"
    if values["k2"]:
        text += f",   $k_2$ = {format_given(values['k2'])}"
    art.in_points().label(((ax.bbox.x0 + ax.bbox.x1) / 2, ax.bbox.y1 + 11.5), text, part="answer")


def find_extent(values: Values) -> float:
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
    return float(extent)


def _folds(values: Values, extent: float) -> bool:
    """Whether the slope falls below the least one, where stronger coefficients fold over."""
    corner = hypot(extent + abs(values["c_x"]), extent + abs(values["c_y"]))
    return _fold_radius(*(values[name] / (1 - _LEAST_SLOPE) for name in ("k1", "k2"))) < corner


@lru_cache(maxsize=64)
def _fold_radius(k1: float, k2: float) -> float:
    """Where the map folds over; a figure asks for it many times."""
    return float(fold_radius(k1, k2))


def _list_lines(values: Values, extent: float) -> Any:
    """Grid lines, shape (lines, samples, 2): multiples of the step from the principal point."""
    step, along = _step(values), np.linspace(-extent, extent, _SAMPLES)
    grids = [np.meshgrid(_list_levels(values[name], step, extent), along, indexing="ij")
             for name in ("c_x", "c_y")]  # fmt: skip
    (x, along_x), (y, along_y) = grids
    return np.concatenate([np.stack([x, along_x], axis=-1), np.stack([along_y, y], axis=-1)])


def _step(values: Values) -> float:
    return float(values.get("step", find_extent(values) / 4))


def _list_levels(centre: float, step: float, extent: float) -> list[float]:
    first, last = ceil((-extent - centre) / step), floor((extent - centre) / step)
    inner = {round(centre + i * step, 9) for i in range(first, last + 1)}
    return sorted(inner | {-extent, extent})


def _move(lines: Any, values: Values) -> Any:
    """Where the lens puts points, shape (lines, samples, 2)."""
    centre = np.array([values["c_x"], values["c_y"]])
    x, y = np.moveaxis(lines - centre, -1, 0)
    return centre + np.stack(distort(x, y, values["k1"], values["k2"]), axis=-1)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words.

    In a quiz, leave the coefficients and the kind of distortion out.
    """
    words = load_alt_words(__file__, lang)
    text = words["figure"].format(
        step=format_given(_step(values)), extent=format_given(find_extent(values))
    )
    if quiz:
        return text
    k1, k2 = format_given(values["k1"]), format_given(values["k2"])
    return text + words["answer"].format(k1=k1, k2=k2) + words[_name_kind(values)]


def _name_kind(values: Values) -> str:
    sign = values["k1"] or values["k2"]
    if sign == 0:
        return "none"
    return "barrel" if sign < 0 else "pincushion"
