"""Exposure stops between f-numbers, light ratios, and what nominal f-numbers stand for.

Source: light goes with the area of the aperture, E ~ 1/N**2; a stop is a factor 2 in light.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import POSITIVE, DomainError
from quizgen.arrays.kernel import Kernel, Short

_PER_LN2 = 2.8853900817779268
"""2/ln 2."""

_MODERATE = 2.0**1000


def _stops(N1: Array, N2: Array) -> Array:
    ratio = N2 / N1
    value = 2 * np.log2(ratio)
    # Near 1 log2 loses the digits of N2 - N1, which is exact there.
    where = np.flatnonzero((ratio > 0.5) & (ratio < 2))
    if where.size:
        a, b = (N.take(where) if N.size > 1 else N for N in (N1, N2))
        value[where] = np.log1p((b - a) / a) * _PER_LN2
    if ratio.min() > 1 / _MODERATE and ratio.max() < _MODERATE:
        return value
    far = ~((ratio > 1 / _MODERATE) & (ratio < _MODERATE))
    return np.where(far, 2 * (np.log2(N2) - np.log2(N1)), value)


def _light(N1: Array, N2: Array) -> Array:
    ratio = N2 / N1
    ratio *= ratio
    return ratio


def _light_short(N1: Array, N2: Array, out: Array) -> None:
    np.divide(N2, N1, out=out)
    out *= out


_STOPS = Kernel(_stops, (POSITIVE, POSITIVE))
_LIGHT = Kernel(_light, (POSITIVE, POSITIVE), short=Short(_light_short, math.inf, tiny=True))


def stops(N1: Numbers, N2: Numbers) -> Result:
    """Stops of light lost from f-number N1 to N2, 2 log2(N2/N1).

    Parameters
    ----------
    N1, N2 : array_like
        f-numbers as they are, > 0 (use ``nominal`` for 5.6 meaning 2**2.5).

    Returns
    -------
    float or array
        Stops; positive when N2 > N1.
    """
    return _STOPS(N1, N2)


def light_ratio(N1: Numbers, N2: Numbers) -> Result:
    """How many times more light N1 admits than N2, (N2/N1)**2.

    Parameters
    ----------
    N1, N2 : array_like
        f-numbers, > 0.

    Returns
    -------
    float or array
        Pure number.
    """
    return _LIGHT(N1, N2)


_ENGRAVED = {
    # sixths of a factor 2 in the f-number (thirds of a stop) as engraved on lenses
    -6: "0.5", -5: "0.56", -4: "0.63", -3: "0.7", -2: "0.8", -1: "0.9",
    0: "1", 1: "1.1", 2: "1.25", 3: "1.4", 4: "1.6", 5: "1.8",
    6: "2", 7: "2.2", 8: "2.5", 9: "2.8", 10: "3.2", 11: "3.5",
    12: "4", 13: "4.5", 14: "5", 15: "5.6", 16: "6.3", 17: "7.1",
    18: "8", 19: "9", 20: "10", 21: "11", 22: "13", 23: "14",
    24: "16", 25: "18", 26: "20", 27: "22", 28: "25", 29: "29",
    30: "32", 31: "36", 32: "40", 33: "45", 34: "51", 35: "57", 36: "64",
}  # fmt: skip
_SIXTH_ROOTS = (
    1.0,
    1.122462048309373,
    1.2599210498948732,
    1.4142135623730951,
    1.5874010519681996,
    1.7817974362806785,
)


def _table() -> Iterator[tuple[float, float]]:
    for sixths, text in _ENGRAVED.items():
        octave, rest = divmod(sixths, 6)
        yield float(text), math.ldexp(_SIXTH_ROOTS[rest], octave)
    yield 1.2, _SIXTH_ROOTS[2]


_MEANT = dict(_table())


def _nominal(N: Array) -> Array:
    return np.array([_MEANT[float(value)] for value in N])


_NOMINAL = Kernel(_nominal, (POSITIVE,))


def nominal(N: Numbers) -> Result:
    """Exact power of sqrt(2) that an engraved f-number stands for (5.6 is 2**2.5).

    Parameters
    ----------
    N : array_like
        Engraved f-numbers in full and third stops from 0.5 to 64.

    Returns
    -------
    float or array
        2**(k/2) for full stops, 2**(k/6) for thirds, correctly rounded.

    Raises
    ------
    DomainError
        ``not-nominal`` when no lens is engraved like that.
    """
    values = np.asarray(N, dtype=np.float64)
    known = np.array([float(value) in _MEANT for value in values.ravel()], dtype=bool)
    if values.shape == ():
        if not known.all():
            raise DomainError("not-nominal")
        return _NOMINAL(values)
    data = np.full(values.size, np.nan)
    data[known] = _nominal(values.ravel()[known])
    if known.all():
        return data.reshape(values.shape)
    return np.ma.MaskedArray(data, mask=~known).reshape(values.shape)
