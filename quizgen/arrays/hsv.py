"""RGB to HSV and back for any hue and for colours outside the gamut.

Sources: Smith, SIGGRAPH 1978; V = max, S = (max - min)/max, H in 60-degree sectors.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from quizgen.arrays.aliases import Array, Flags, Numbers, Result
from quizgen.arrays.domain import REAL, Rule
from quizgen.arrays.kernel import Exactly, Kernel

_HUGE = 2.0**1000


def _shrunk(*channels: Array) -> tuple[Array, ...]:
    """Ratios of differences do not change with scale; huge channels would overflow."""
    if max(np.abs(c).max() for c in channels) < _HUGE:
        return channels
    scale = np.where(np.max(np.abs(np.broadcast_arrays(*channels)), axis=0) > _HUGE, 0.25, 1.0)
    return tuple(c * scale for c in channels)


def _hue(R: Array, G: Array, B: Array) -> Array:
    R, G, B = _shrunk(R, G, B)
    top = np.maximum(np.maximum(R, G), B)
    spread = top - np.minimum(np.minimum(R, G), B)
    red = top == R
    green = ~red & (top == G)
    difference = np.where(red, G - B, np.where(green, B - R, R - G))
    turn = np.where(red, 0.0, np.where(green, 2.0, 4.0))
    degrees = 60 * (turn + difference / spread)  # divide first: 60 (G - B) may overflow
    degrees += np.where(degrees < 0, 360.0, 0.0)
    return np.where(degrees >= 360, 0.0, degrees)


def _saturation(R: Array, G: Array, B: Array) -> Array:
    R, G, B = _shrunk(R, G, B)
    top = np.maximum(np.maximum(R, G), B)
    spread = top - np.minimum(np.minimum(R, G), B)
    size = np.where(spread == 0, 1.0, np.where(top == 0, 0.0, top))
    return spread / size


def _grey(R: Array, G: Array, B: Array) -> Flags:
    return (R == G) & (G == B)


_HUE = Kernel(_hue, (REAL,) * 3, (Rule("grey-hue", _grey),))
_SATURATION = Kernel(_saturation, (REAL,) * 3)
_VALUE = Kernel(lambda R, G, B: np.maximum(np.maximum(R, G), B), (REAL,) * 3)


def hue(R: Numbers, G: Numbers, B: Numbers) -> Result:
    """Hue in degrees.

    Parameters
    ----------
    R, G, B : array_like
        Linear or encoded channels, any scale, any sign.

    Returns
    -------
    float or array
        0 <= H < 360. Judge its error on the circle: 359.999 and 0 are neighbours.

    Raises
    ------
    DomainError
        ``grey-hue`` (R = G = B).
    """
    return _HUE(R, G, B)


def saturation(R: Numbers, G: Numbers, B: Numbers) -> Result:
    """Saturation (max - min)/max.

    Parameters
    ----------
    R, G, B : array_like
        Channels.

    Returns
    -------
    float or array
        0 for greys and black; above 1 or negative outside the gamut; infinity when the largest
        channel is 0 and another is negative (a pole).
    """
    return _SATURATION(R, G, B)


def value(R: Numbers, G: Numbers, B: Numbers) -> Result:
    """Value, the largest channel.

    Parameters
    ----------
    R, G, B : array_like
        Channels.

    Returns
    -------
    float or array
        Same scale as the channels.
    """
    return _VALUE(R, G, B)


def to_hsv(R: Numbers, G: Numbers, B: Numbers) -> tuple[Result, Result, Result]:
    """Hue (degrees), saturation and value.

    Parameters
    ----------
    R, G, B : array_like
        Channels.

    Returns
    -------
    tuple
        As ``hue``, ``saturation`` and ``value``; in arrays only the hue of greys is masked.

    Raises
    ------
    DomainError
        As ``hue``.
    """
    return hue(R, G, B), saturation(R, G, B), value(R, G, B)


def _to_rgb(H: Array, S: Array, V: Array) -> tuple[tuple[Array, ...], Flags | None]:
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
    outside = (S < 0) | (S > 1)
    G, B = np.where(mirrored, B, G), np.where(mirrored, G, B)
    return (R, G, B), np.broadcast_to(outside, R.shape) if outside.any() else None


def _to_rgb_exact(H: Fraction, S: Fraction, V: Fraction) -> tuple[Fraction, ...]:
    H %= 360
    sector = math.floor(H / 60)
    C = V * S
    X = C * (1 - abs((H / 60) % 2 - 1))
    mixed = ((C, X, 0), (X, C, 0), (0, C, X), (0, X, C), (X, 0, C), (C, 0, X))[sector]
    return tuple(channel + V - C for channel in mixed)


_TO_RGB = Kernel(_to_rgb, (REAL,) * 3, exact=Exactly(_to_rgb_exact, 2.0**400), outputs=3)


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
