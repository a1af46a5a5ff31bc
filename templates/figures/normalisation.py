"""Histogram of a picture before and after its values are normalised to 0 to 1 and clamped."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from quizgen.camera import picture_sets
from quizgen.camera.setup.scene import Image
from quizgen.figures.kit import (
    Parameter,
    Values,
    format_given,
    format_statement,
    load_alt_words,
    require,
)

from ._plots import format_learned, mark_place

PARAMETERS = {
    "a": Parameter("", "smallest grey level of the picture", 60.0, 0.0, 255.0),
    "b": Parameter("", "largest grey level of the picture", 180.0, 0.0, 255.0),
    "low": Parameter("", "I_min: the level that becomes 0", low=-255.0, high=510.0),
    "high": Parameter("", "I_max: the level that becomes 1", low=-255.0, high=510.0),
    "share": Parameter("1", "share of outliers anywhere from 0 to 255", 0.0, 0.0, 0.2),
    "seed": Parameter("", "seed of the values", 1.0, 0.0, 9999.0, whole=True),
}
SIZE = (322.0, 110.0)

BINS = 64
_COUNT = 6000
_WIDE, _HIGH, _RIGHT = 126.0, 84.0, 190.0  # of the histograms, and where the second begins
_BEYOND = 8.0  # grey levels that limits outside the axis stand beside it


@lru_cache(maxsize=64)
def draw_sample(low: float, high: float, share: float, seed: int) -> Image:
    """Grey values in [0, 1], shape (6000, 1): two humps over [low, high], and outliers.

    Parameters
    ----------
    low, high : float
        Grey levels; both occur.
    share : float
        Outliers, spread evenly over all levels.
    seed : int
        Seed of an SFC64 stream.
    """
    source = np.random.Generator(np.random.SFC64(seed))
    hump = np.where(source.random(_COUNT) < 0.6, 0.34, 0.7)
    values = np.clip(hump + 0.13 * source.standard_normal(_COUNT), 0.0, 1.0)
    inside = (values > 0.0) & (values < 1.0)  # no spikes of its own: tails are spread evenly
    values = np.where(inside, values, source.random(_COUNT))
    values[:2] = (0.0, 1.0)
    levels = low + (high - low) * values
    outlier = source.random(_COUNT) < share
    levels = np.where(outlier, 255.0 * source.random(_COUNT), levels)
    return (levels / 255.0).astype(np.float32)[:, None]


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out I_min and I_max."""
    require("normalisation", values["a"] < values["b"], "b must be larger than a")
    require("normalisation", values["low"] < values["high"], "high must be larger than low")
    image = draw_sample(values["a"], values["b"], values["share"], int(values["seed"]))
    _, before, after = picture_sets.make_normalised(
        image, values["low"] / 255, values["high"] / 255, BINS
    )
    art = fig.sketch()
    if not quiz:
        _shade_clamped(art, values)
    _draw_histogram(art, before, 0.0, "$I$", ("0", "64", "128", "192", "255"))
    _draw_histogram(art, after, _RIGHT, "$I'$", ("0", "0.25", "0.5", "0.75", "1"))
    art.arrow((_WIDE + 10, 0.45 * _HIGH), (_WIDE + 36, 0.45 * _HIGH), "grey", 1.2, part="arrow")
    if not quiz:
        _draw_limits(art, values)


def _draw_histogram(art: Any, counts: Any, left: float, name: str, ticks: tuple[str, ...]) -> None:
    """Draw filled steps, the tallest as high as the box; where ticks stand their labels say."""
    edges = np.repeat(np.linspace(left, left + _WIDE, len(counts) + 1), 2)
    tops = np.concatenate([[0], np.repeat(counts, 2), [0]]) * (_HIGH / counts.max())
    art.area(np.column_stack([edges, tops]), "blue", part="histogram")
    art.line([(left, _HIGH + 8), (left, 0), (left + _WIDE + 4, 0)], "ink", 0.7, part="axes")
    for text in ticks:
        x = left + _WIDE * float(text) / float(ticks[-1])
        art.line([(x, 0), (x, -3)], "ink", 0.6, part="ticks")
        art.label((x, -5.5), text, "ct", 9)
    art.label((left + _WIDE + 8, 0), name, "l")
    art.label((left - 8, _HIGH + 2), f"$h$({name})", "r")


def _place(level: float) -> float:
    """Where a grey level stands on the first axis, in points."""
    return _WIDE * min(max(level, -_BEYOND), 255 + _BEYOND) / 255


def _shade_clamped(art: Any, values: Values) -> None:
    """Shade the grey levels that the limits cut off."""
    for start, stop in ((0, values["low"]), (values["high"], 255)):
        if start < stop:
            x0, x1 = _place(max(start, 0)), _place(min(stop, 255))
            art.area([(x0, 0), (x1, 0), (x1, _HIGH), (x0, _HIGH)], "pale-red", part="clamped")


def _draw_limits(art: Any, values: Values) -> None:
    low, high = _place(values["low"]), _place(values["high"])
    near = high - low < 66
    for name, x, level, side in (("min", low, values["low"], "r"),
                                 ("max", high, values["high"], "l")):  # fmt: skip
        art.line([(x, 0), (x, _HIGH + 12)], "red", 1.0, dashes=(4, 2.5), part="limits")
        text = format_statement(rf"$I_\mathrm{{{name}}}$", level)
        art.label((x, _HIGH + 20), text, side if near else "c", 10, "red", part="limit-names")


MARKS = {"I_min": "", "I_max": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: Values) -> None:  # noqa: ARG001 - the axis is fixed
    """Draw a learner's ``I_min`` and ``I_max`` in the first histogram."""
    for name, side in (("min", "r"), ("max", "l")):
        if (value := marks.get(f"I_{name}")) is not None:
            text = rf"$I_\mathrm{{{name}}}$ = {format_learned(value)}"
            x = _WIDE * value / 255
            mark_place(fig, (0, 0, _WIDE, _HIGH + 26), x, text, align=side)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out I_min and I_max."""
    words = load_alt_words(__file__, lang)
    ends = format_given(values["a"]), format_given(values["b"])
    told = [words["before"].format(*ends), words[_name_ends(values)]]
    if values["share"]:
        told.insert(1, words["outliers"])
    if not quiz:
        limits = format_given(values["low"]), format_given(values["high"])
        told.append(words["limits"].format(*limits))
    return " ".join(told)


def _name_ends(values: Values) -> str:
    """What is seen at the ends of the second histogram."""
    low, high = values["low"] - values["a"], values["b"] - values["high"]
    if values["share"]:
        low, high = values["low"], 255.0 - values["high"]
    if low > 0 or high > 0:
        return "both" if low > 0 and high > 0 else "bottom" if low > 0 else "top"
    return "fits" if low == high == 0 else "gaps"
