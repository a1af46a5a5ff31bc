"""Histogram of a picture before and after its values are normalised to 0 to 1 and clamped."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from quizgen.figures.kit import (
    DASHED,
    THIN,
    Canvas,
    Parameter,
    Pen,
    Values,
    given,
    require,
    statement,
    words_of,
)

if TYPE_CHECKING:
    from quizgen.camera.scene import Image

DARK = "invert"

PARAMETERS = {
    "a": Parameter("", "smallest grey level of the picture", 60.0, 0.0, 255.0),
    "b": Parameter("", "largest grey level of the picture", 180.0, 0.0, 255.0),
    "low": Parameter("", "I_min: the level that becomes 0", low=-255.0, high=510.0),
    "high": Parameter("", "I_max: the level that becomes 1", low=-255.0, high=510.0),
    "share": Parameter("1", "share of outliers anywhere from 0 to 255", 0.0, 0.0, 0.2),
    "seed": Parameter("", "seed of the values", 1.0, 0.0, 9999.0, whole=True),
}

BINS = 64
_COUNT = 6000
_SIDE, _WIDE, _LOW, _HIGH = 14.0, 122.0, 30.0, 106.0


@lru_cache(maxsize=64)
def sample(low: float, high: float, share: float, seed: int) -> Image:
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
    import numpy as np

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


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out I_min and I_max."""
    from quizgen.camera import pictures

    require("normalisation", values["a"] < values["b"], "b must be larger than a")
    require("normalisation", values["low"] < values["high"], "high must be larger than low")
    image = sample(values["a"], values["b"], values["share"], int(values["seed"]))
    _, before, after = pictures.normalised(image, values["low"] / 255, values["high"] / 255, BINS)
    pen = Pen(height=150.0)
    right = pen.width - _SIDE - _WIDE
    _histogram(pen, [float(n) for n in before], _SIDE, ("0", "255"))
    _histogram(pen, [float(n) for n in after], right, ("0", "1"))
    pen.arrow("arrow", (_SIDE + _WIDE + 8, 70), (right - 8, 70))
    if not quiz:
        _limits(pen, values)
    pen.onto(canvas)


def _histogram(pen: Pen, counts: list[float], left: float, ends: tuple[str, str]) -> None:
    from quizgen.figures.photographs import bars

    bars(pen, counts, (left, _LOW, _WIDE, _HIGH - _LOW + 6))
    for at, text in zip((left, left + _WIDE), ends, strict=True):
        pen.line("ticks", [(at, _LOW), (at, _LOW - 4)], THIN)
        pen.label((at, _LOW - 11), text, size=9.5)


def _limits(pen: Pen, values: Values) -> None:

    for name, level, row in (("I_{min}", values["low"], 0), ("I_{max}", values["high"], 1)):
        shown = min(max(level, -8.0), 263.0)  # limits outside the axis stand just beside it
        x = _SIDE + _WIDE * shown / 255
        pen.line("limits", [(x, _LOW), (x, _HIGH + 12)], DASHED)
        side = _SIDE + _WIDE / 2
        pen.label((side + 70 * row - 35, _HIGH + 32), statement(name, level), size=9.5)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out I_min and I_max."""
    words = words_of(__file__, lang)
    told = [words["before"].format(given(values["a"]), given(values["b"])), words[_after(values)]]
    if values["share"]:
        told.insert(1, words["outliers"])
    if not quiz:
        told.append(words["limits"].format(given(values["low"]), given(values["high"])))
    return " ".join(told)


def _after(values: Values) -> str:
    """What is seen at the ends of the second histogram."""
    low, high = values["low"] - values["a"], values["b"] - values["high"]
    if values["share"]:
        low, high = values["low"], 255.0 - values["high"]
    if low > 0 or high > 0:
        return "both" if low > 0 and high > 0 else "bottom" if low > 0 else "top"
    return "fits" if low == high == 0 else "gaps"
