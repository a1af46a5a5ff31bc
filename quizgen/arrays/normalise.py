"""Linear change of the intensity range.

Source: N = (newMax - newMin)/(max - min) (I - min) + newMin, clamped on both sides if asked.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache

import numpy as np

from quizgen.arrays.aliases import Array, Flags, Numbers, Result
from quizgen.arrays.domain import REAL, Rule
from quizgen.arrays.double_double import Pair, pairs
from quizgen.arrays.kernel import Exactly, Kernel, in_short_blocks
from quizgen.arrays.rational import nearest

_CANCELLED = 2.0**-48
_SHORT = 2.0**25
_LARGEST = 2.0**52


def _exact(
    I: Fraction, low: Fraction, high: Fraction, new_low: Fraction, new_high: Fraction
) -> Fraction:
    return new_low + (I - low) * (new_high - new_low) / (high - low)


def _compute(
    I: Array, low: Array, high: Array, new_low: Array, new_high: Array
) -> tuple[Array, Flags | None]:
    if low.size == high.size == new_low.size == new_high.size == 1:
        return _along_line(I, low.item(), high.item(), new_low.item(), new_high.item())
    above, below = pairs(I)[0] - low, pairs(high)[0] - I
    up, down = new_high * above, new_low * below
    value = ((up + down) / (pairs(high)[0] - low)).rounded()
    terms = (np.abs(up.high) + np.abs(down.high)) / np.abs(high - low)
    cancelled = np.abs(value) < _CANCELLED * terms
    certain_zero = (value == 0) & (above.low == 0) & (below.low == 0)
    return value, cancelled & ~certain_zero


def _along_line(I: Array, *ends: float) -> tuple[Array, Flags | None]:
    slope, start = _line(*ends)
    line = slope * I + start
    value = line.rounded()
    if slope.low == 0 and start.low == 0:
        return value, None
    return value, np.abs(value) < _CANCELLED * abs(start.high)


@lru_cache(maxsize=64)
def _whole_line(*ends: float) -> tuple[float, float, float] | None:
    """Whole numbers with N = (slope I + start)/width exactly, when the ends are whole."""
    if not all(abs(end) < _SHORT and end == round(end) for end in ends):
        return None
    a, b, c, d = (int(end) for end in ends)
    if b <= a:
        return None
    common = math.gcd(d - c, c * b - d * a, b - a)
    return float((d - c) // common), float((c * b - d * a) // common), float((b - a) // common)


def _of_whole_numbers(*blocks: Array) -> bool:
    """Whole intensities between whole ends: one quotient of exactly known numbers."""
    I, *ends, out = blocks
    if any(end.size > 1 for end in ends):
        return _between(*blocks)
    line = _whole_line(*[end.item() for end in ends])
    if line is None:
        return False
    slope, start, width = line
    top = I * slope
    top += start
    np.divide(top, width, out=out)
    return _whole(I) and float(top.max()) < _LARGEST and float(top.min()) > -_LARGEST


def _between(
    I: Array, low: Array, high: Array, new_low: Array, new_high: Array, out: Array
) -> bool:
    """Below 2**25 every product is below 2**51, so that their sum is exact."""
    for block in (I, low, high, new_low, new_high):
        if not (_whole(block) and float(block.max()) < _SHORT and float(block.min()) > -_SHORT):
            return False
    width = high - low
    if float(width.min()) <= 0:
        return False
    np.multiply(new_high - new_low, I - low, out=out)
    out += new_low * width
    out /= width
    return True


def _whole(values: Array) -> bool:
    return bool((np.rint(values) == values).all())


@lru_cache(maxsize=64)
def _line(low: float, high: float, new_low: float, new_high: float) -> tuple[Pair, Pair]:
    a, b, c, d = (Fraction(end) for end in (low, high, new_low, new_high))
    return _as_pair((d - c) / (b - a)), _as_pair((c * b - d * a) / (b - a))


def _as_pair(value: Fraction) -> Pair:
    high = nearest(value)
    if abs(high) == float("inf"):
        return Pair(high, 0.0)
    return Pair(high, nearest(value - Fraction(high)))


_NORMALISE = Kernel(
    _compute,
    (REAL,) * 5,
    (Rule("empty-range", lambda _I, low, high, _c, _d: high <= low),),
    exact=Exactly(_exact),
)


def normalise(
    I: Numbers,
    low: Numbers,
    high: Numbers,
    new_low: Numbers = 0.0,
    new_high: Numbers = 1.0,
    *,
    clamp: bool = False,
) -> Result:
    """Map intensities linearly so that low goes to new_low and high to new_high.

    Parameters
    ----------
    I : array_like
        Intensities.
    low, high : array_like
        The old range, low < high.
    new_low, new_high : array_like
        The new range; new_low > new_high turns the picture into its negative.
    clamp : bool
        Limit the result to the new range on both sides.

    Returns
    -------
    float or array
        Both ends are met exactly and nothing between them leaves the new range.

    Raises
    ------
    DomainError
        ``empty-range`` (high <= low).
    """
    args = (I, low, high, new_low, new_high)
    if all(np.ndim(arg) == 0 for arg in args):
        value = _NORMALISE(*args)
    else:
        value = in_short_blocks(_of_whole_numbers, _NORMALISE, *args)
    return _clamped(value, new_low, new_high) if clamp else value


def _clamped(value: Result, new_low: Numbers, new_high: Numbers) -> Result:
    bottom, top = np.minimum(new_low, new_high), np.maximum(new_low, new_high)
    if isinstance(value, float):
        return float(min(max(value, bottom), top))
    np.maximum(np.ma.getdata(value), bottom, out=np.ma.getdata(value))
    np.minimum(np.ma.getdata(value), top, out=np.ma.getdata(value))
    return value
