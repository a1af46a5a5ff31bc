"""Natural vignetting: illumination falls with the fourth power of the cosine.

Source: cos**4(atan(r/f)) = (f**2/(f**2 + r**2))**2, rational in r and f.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import NONNEGATIVE, POSITIVE
from quizgen.arrays.double_double import Number, Pair, pairs
from quizgen.arrays.kernel import Exactly, Kernel, Short


def _cos4(r: Number, f: Number) -> Number:
    A = f * f
    q = A / (r * r + A)
    return q * q


def _falloff(r: Number, f: Number) -> Number:
    A, B = f * f, r * r
    S = A + B
    return B * (A + S) / (S * S)


def _on_pairs(formula: Callable[..., Pair]) -> Callable[..., tuple[Array, None]]:
    return lambda r, f: (formula(*pairs(r, f)).rounded(), None)


def _cos4_short(r: Array, f: Array, out: Array) -> None:
    """In the middle 1 - p (2 - p), where the errors of p count little."""
    widest, shortest = r.max(), f.min()
    if 2 * widest <= shortest:
        _falloff_short(r, f, out)
        np.subtract(1, out, out=out)
    elif widest <= shortest:
        out[...] = _cos4_outside(r, f)
    else:
        out[...] = _cos4(*pairs(r, f)).rounded()


def _cos4_outside(r: Array, f: Array) -> Array:
    """What rounding the sum loses is put back; it would count twice."""
    A = f * f
    B = r * r
    S = A + B
    lost = S - A  # exact because r <= f
    lost -= B
    q = A / S
    lost /= S
    q *= q
    lost *= q
    q += 2 * lost
    return q


def _falloff_short(r: Array, f: Array, out: Array) -> None:
    """Product p (2 - p) with p = r**2/(r**2 + f**2): no difference of nearly equal values."""
    B = r * r
    p = B + f * f
    np.divide(B, p, out=p)
    np.subtract(2, p, out=out)
    out *= p


_COS4 = Kernel(
    _on_pairs(_cos4), (NONNEGATIVE, POSITIVE), exact=Exactly(_cos4), short=Short(_cos4_short)
)
_FALLOFF = Kernel(
    _on_pairs(_falloff),
    (NONNEGATIVE, POSITIVE),
    exact=Exactly(_falloff),
    short=Short(_falloff_short),
)


def cos4(r: Numbers, f: Numbers) -> Result:
    """Relative illumination cos**4 at distance r from the image centre.

    Parameters
    ----------
    r : array_like
        Distance from the principal point on the sensor, >= 0.
    f : array_like
        Focal length, > 0, same unit.

    Returns
    -------
    float or array
        Between 0 and 1; the angle is atan(r/f).
    """
    return _COS4(r, f)


def falloff(r: Numbers, f: Numbers) -> Result:
    """Loss of illumination 1 - cos**4, accurate for small angles too; arguments as ``cos4``."""
    return _FALLOFF(r, f)
