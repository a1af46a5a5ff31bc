"""HSV to RGB for any hue and for colours outside the gamut.

Source: Smith, SIGGRAPH 1978; H in 60-degree sectors.
"""

from __future__ import annotations

import numpy as np
from flint import fmpq

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import REAL
from quizgen.arrays.kernel import Kernel


def _to_rgb(H: Array, S: Array, V: Array) -> tuple[Array, ...]:
    turned = np.fmod(H, 360.0)
    mirrored = turned < 0
    size = np.abs(turned)
    sector = np.floor(size / 60)
    sector = np.where(size < 60 * sector, sector - 1, sector)
    along = size - 60 * sector
    low = V * (1 - S)
    # (1 - S) + S a/60 has no cancellation for 0 <= S <= 1, unlike 1 - S b/60.
    rising = V * ((1 - S) + S * (along / 60))
    falling = V * ((1 - S) + S * ((60 - along) / 60))
    V = np.broadcast_to(V, rising.shape)
    low = np.broadcast_to(low, rising.shape)
    pick = sector.astype(np.intp)
    R = np.choose(pick, (V, falling, low, low, rising, V))
    G = np.choose(pick, (rising, V, V, falling, low, low))
    B = np.choose(pick, (low, low, rising, V, V, falling))
    channels = R, np.where(mirrored, B, G), np.where(mirrored, G, B)
    if S.min() >= 0 and S.max() <= 1:
        return channels
    return tuple(np.where((S < 0) | (S > 1), np.nan, channel) for channel in channels)


def _to_rgb_exact(H: fmpq, S: fmpq, V: fmpq) -> tuple[fmpq, ...]:
    def channel(turn: int) -> fmpq:
        place = H / 60 + turn
        place -= 6 * (place / 6).floor()
        return V - V * S * max(0, min(place, 4 - place, 1))

    return channel(5), channel(3), channel(1)


_TO_RGB = Kernel(_to_rgb, (REAL,) * 3, exact=_to_rgb_exact, reach=2.0**400, outputs=3)


def to_rgb(H: Numbers, S: Numbers, V: Numbers) -> tuple[Result, Result, Result]:
    """Red, green and blue of a hue, saturation and value.

    Parameters
    ----------
    H : array_like
        Hue in degrees, any number of turns, either sign.
    S, V : array_like
        Saturation and value; outside 0 .. 1 the same formulas continue.

    Returns
    -------
    tuple of float or array
        R, G, B on the scale of V.
    """
    result: tuple[Result, Result, Result] = _TO_RGB(H, S, V)
    return result
