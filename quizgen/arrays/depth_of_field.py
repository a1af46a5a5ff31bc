"""Far limit of the depth of field of a thin lens, next to the hyperfocal distance too.

Source: the distance at which the blur disc of the thin lens equals c, in closed form; no image
distance occurs, so nothing cancels but f**2 - N c (s - f).
"""

from __future__ import annotations

import math

import numpy as np
from flint import fmpq

from quizgen.arrays.aliases import Array, Numbers, Result
from quizgen.arrays.domain import POSITIVE, Rule
from quizgen.arrays.double_double import two_product, two_sum
from quizgen.arrays.kernel import Kernel

_NEAR = 0.3
"""Share of the hyperfocal distance from which its rest is computed with its rounding errors."""

_CLOSE = 2.0**-40
"""Rest below which it is left to exact fractions."""


def _far_limit(f: Array, N: Array, c: Array, s: Array) -> Array:
    """s/(1 - q), q = N c (s - f)/f**2."""
    q = N * c / (f * f) * (s - f)
    rest = 1 - q
    value: Array = s / rest
    if q.max() < _NEAR:
        return value
    where = np.flatnonzero(q >= _NEAR)
    if not where.size:  # not a number: out of range
        return value
    f, N, c, s = (arg.take(where) if arg.size > 1 else arg for arg in (f, N, c, s))
    rest = _rest(f, N, c, s)
    value[where] = np.where(rest > 0, s / rest, math.inf)
    value[where[np.abs(rest) < _CLOSE]] = np.nan
    return value


def _rest(f: Array, N: Array, c: Array, s: Array) -> Array:
    """(f**2 - N c (s - f))/f**2 with the rounding errors of its products, below 1."""
    way, way_lost = two_sum(s, -f)
    coarse, coarse_lost = two_product(N, c)
    blurred, blurred_lost = two_product(coarse, way)
    square, square_lost = two_product(f, f)
    lost = square_lost - blurred_lost - (coarse_lost * way + coarse * way_lost)
    rest: Array = ((square - blurred) + lost) / square
    return rest - rest * (square_lost / square)


def _far_limit_exact(f: fmpq, N: fmpq, c: fmpq, s: fmpq) -> fmpq | float:
    rest = f * f - N * c * (s - f)
    return f * f * s / rest if rest > 0 else math.inf


_NO_IMAGE = Rule(
    "no-real-image", lambda f, _N, _c, s: s < f, lambda f, _N, _c, s: bool(s[0] < f[1])
)
_FAR_LIMIT = Kernel(_far_limit, (POSITIVE,) * 4, (_NO_IMAGE,), exact=_far_limit_exact)


def far_limit(f: Numbers, N: Numbers, c: Numbers, s: Numbers) -> Result:
    """Farthest distance that is still sharp; infinity at or beyond the hyperfocal distance.

    Parameters
    ----------
    f, N, c : array_like
        Focal length, f-number, largest blur disc still called sharp; all > 0.
    s : array_like
        Distance in focus, >= f. Lengths share one unit.

    Returns
    -------
    float or array
        That unit, at least s. Whether s reaches the hyperfocal distance is decided exactly.

    Raises
    ------
    DomainError
        ``no-real-image`` (s < f).
    """
    return _FAR_LIMIT(f, N, c, s)
