"""Radial lens distortion r_d = r (1 + k1 r**2 + k2 r**4), both ways, up to the fold.

Sources: Brown, Photogrammetric Engineering 37 (1971) 855; the cubic is inverted in closed form
(Cardano, trigonometric), the quintic by bracketed Newton steps; one more step with a residual of
twice the working precision makes both nearly correctly rounded.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from quizgen.arrays.aliases import Array, Flags, Indices, Limits, Numbers, Result
from quizgen.arrays.distortion_exact import beyond_exactly, fold_exactly, invert_exactly
from quizgen.arrays.domain import NONNEGATIVE, REAL, Rule
from quizgen.arrays.double_double import Number, Pair, pair, pairs
from quizgen.arrays.kernel import Exactly, Kernel, Short, extreme
from quizgen.arrays.rational import exactly, nearest

_REACH = 2.0**60
_FLAT = 2.0**-24
"""Below this slope (next to the fold) a Newton step is no longer trusted."""

_STEPS = 80
_REFINEMENTS = 8


def _factor(r2: Number, k1: Number, k2: Number) -> Number:
    return r2 * (k1 + k2 * r2)


def _forward(x: Number, y: Number, k1: Number, k2: Number) -> tuple[Number, Number]:
    scale = 1 + _factor(x * x + y * y, k1, k2)
    return x * scale, y * scale


def _distort(x: Array, y: Array, k1: Array, k2: Array) -> tuple[tuple[Array, Array], Flags]:
    x_pair, y_pair, k1_pair, k2_pair = pairs(x, y, k1, k2)
    r2 = x_pair * x_pair + y_pair * y_pair
    slope = k1_pair + k2_pair * r2 if k2.any() else k1_pair
    change = r2 * slope
    scale = 1 + change
    doubtful = np.abs(scale.high) < 2.0**-40
    if k2.any():
        doubtful |= np.abs(slope.high) < 2.0**-40 * np.abs(k1)
    return ((x_pair * scale).rounded(), (y_pair * scale).rounded()), doubtful


def _distort_short(x: Array, y: Array, k1: Array, k2: Array, x_d: Array, y_d: Array) -> None:
    """Plain doubles while the change is small, pairs for the rest.

    In units of 2**-53 times x, the change is off by at most 5 |change| + 3 |k2| r**4, also where
    its terms cancel; adding it to x and y costs one more.
    """
    r2 = x * x + y * y
    change = (k2 * r2 + k1) * r2
    for plain, distorted in ((x, x_d), (y, y_d)):
        np.multiply(plain, change, out=distorted)
        np.add(plain, distorted, out=distorted)
    least, most, top = change.min(), change.max(), r2.max()
    if 5 * max(most, -least) + 3 * np.abs(k2).max() * top * top <= _ALLOWED * (1 + least):
        return
    off = 5 * np.abs(change) + 3 * np.abs(k2) * r2 * r2
    where = np.flatnonzero(~(off <= _ALLOWED * (1 + change)))
    _by_pairs(where, (x, y, k1, k2), (x_d, y_d))


def _by_pairs(where: Indices, args: tuple[Array, ...], results: tuple[Array, Array]) -> None:
    some = [arg.take(where) if arg.size > 1 else arg for arg in args]
    values, doubtful = _distort(*some)
    for result, value in zip(results, values, strict=True):
        result[where] = value
    for i in where[doubtful]:
        results[0][i], results[1][i] = map(nearest, _forward(*exactly(args, i)))


_ALLOWED = 3.0


def _displacement(r: Array, k1: Array, k2: Array) -> tuple[Array, Flags]:
    k1_pair, k2_pair, r_pair = pairs(k1, k2, r)
    r2 = r_pair * r_pair
    slope = k1_pair + k2_pair * r2
    return -(r_pair * r2 * slope).rounded(), np.abs(slope.high) < 2.0**-40 * np.abs(k1)


def _displacement_exact(r: Fraction, k1: Fraction, k2: Fraction) -> Fraction:
    return -r * _factor(r * r, k1, k2)


def _no_cancellation(r: Limits, k1: Limits, k2: Limits) -> bool:
    """Whether k2 r**2 has the sign of k1 or is at most half of it."""
    if k2 == (0.0, 0.0) or (k1[0] >= 0 and k2[0] >= 0) or (k1[1] <= 0 and k2[1] <= 0):
        return True
    return max(k2[1], -k2[0]) * r[1] ** 2 <= 0.5 * max(k1[0], -k1[1])


def _displacement_short(r: Array, k1: Array, k2: Array, out: Array) -> None:
    r2 = r * r
    slope = k2 * r2
    slope = slope + k1
    np.multiply(r2, r, out=out)
    out *= slope
    np.negative(out, out=out)


def _is_plain_barrel(k1: Limits, k2: Limits) -> bool:
    return k1[1] < 0 and k2 == (0.0, 0.0)


def _fold_of_barrel(k1: Array, _k2: Array, out: Array) -> None:
    np.multiply(k1, -3, out=out)
    np.sqrt(out, out=out)
    np.divide(1, out, out=out)


def _fold(k1: Array, k2: Array) -> tuple[Array, Flags | None]:
    """Smallest positive root u = r**2 of 1 + 3 k1 u + 5 k2 u**2, without cancellation."""
    if not k2.any():
        return np.where(k1 < 0, 1 / np.sqrt(-3 * np.minimum(k1, 0.0)), math.inf), None
    inside = pairs(k1)[0] * k1 * 9 - pairs(k2)[0] * 20
    root = np.sqrt(np.maximum(inside.rounded(), 0.0))
    falling = 2 / np.where(k1 < 0, root - 3 * k1, 1.0)
    rising = np.where(k2 < 0, (3 * k1 + root) / (-10 * np.where(k2 < 0, k2, -1.0)), math.inf)
    u = np.where(k1 < 0, falling, rising)
    none = (inside.high < 0) | ((k1 >= 0) & (k2 >= 0))
    size = 9 * k1 * k1 + 20 * np.abs(k2)
    return np.where(none, math.inf, np.sqrt(u)), np.abs(inside.high) < 2.0**-40 * size


def _cubic(r_d: Array, k1: Array) -> Array:
    """Closed form of r + k1 r**3 = r_d below the fold, good to a few units in the last place."""
    size = np.sqrt(3 * np.abs(k1))
    size = np.where(size == 0, 1.0, size)
    if k1.max() < 0:
        return _barrel(r_d, k1, size)
    pincushion = 2 / size * np.sinh(np.arcsinh(1.5 * size * r_d) / 3)
    if k1.min() < 0:
        return np.where(k1 < 0, _barrel(r_d, k1, size), np.where(k1 == 0, r_d, pincushion))
    return np.where(k1 == 0, r_d, pincushion)


def _barrel(r_d: Array, k1: Array, size: Array) -> Array:
    """2/sqrt(-3 k1) sin(asin(r_d/fold)/3), the arc sine from both its legs."""
    leg = np.sqrt(np.maximum(_room(r_d, k1).rounded(), 0.0))
    angle = np.arctan2(3 * size * r_d, leg) / 3
    result: Array = 2 / size * np.sin(angle)
    return result


def _room(r_d: Array, k1: Array) -> Pair:
    """4 + 27 k1 r_d**2: positive below the fold of a barrel distortion."""
    r_pair, k_pair = pairs(r_d, k1)
    return 4 + r_pair * r_pair * (27 * k_pair)


def _refined(r: Array, r_d: Array, k1: Array, k2: Array) -> tuple[Pair, Flags]:
    """One Newton step with a residual of twice the working precision."""
    r_pair = Pair(r)
    r2 = r_pair * r_pair
    slope = pair(k1) if not k2.any() else pair(k1) + pair(k2) * r2
    residual = (r_pair * (r2 * slope) + (r_pair - r_d)).rounded()
    steep = 1 + r2.high * (3 * k1 + 5 * k2 * r2.high)
    return Pair(r, -residual / np.where(steep > _FLAT, steep, 1.0)), steep <= _FLAT


def _quintic(r_d: Array, k1: Array, k2: Array) -> Array:
    """Newton steps on rho = r/r_d, kept inside a bracket that ends at the fold."""
    r_d, k1, k2 = np.broadcast_arrays(r_d, k1, k2)
    square = r_d * r_d
    a, b = k1 * square, k2 * square * square
    low, high = np.zeros_like(a), _upper_end(a, b)
    rho = np.minimum(high, 1.0)
    for _ in range(_STEPS):
        rho2 = rho * rho
        residual = rho * (1 + rho2 * (a + b * rho2)) - 1
        above = residual > 0
        high, low = np.where(above, rho, high), np.where(above, low, rho)
        step = rho - residual / (1 + rho2 * (3 * a + 5 * b * rho2))
        near = 2.0**-50 * rho
        # a step that stays where it is has arrived, though that is now an end of the bracket
        usable = ((step > low) & (step < high)) | (np.abs(step - rho) <= near)
        following = np.where(usable, step, (low + high) / 2)
        if np.all(np.abs(following - rho) <= near):
            break
        rho = following
    return rho * r_d


def _upper_end(a: Array, b: Array) -> Array:
    fold = _fold(a, b)[0]
    least = np.where((a < 0) & (b > 0), 1 - 9 * a * a / (20 * np.where(b > 0, b, 1.0)), 1.0)
    free = np.where((a >= 0) & (b >= 0), 1.0, 1 / np.maximum(least, 2.0**-30))
    return np.where(np.isfinite(fold), fold, free)


def _inverse_pair(r_d: Array, k1: Array, k2: Array) -> tuple[Pair, Flags]:
    if not k2.any():
        return _refined(_cubic(r_d, k1), r_d, k1, k2)
    result, flat = _refined(_quintic(r_d, k1, k2), r_d, k1, k2)
    for _ in range(_REFINEMENTS):
        moved = np.abs(result.low) > 2.0**-50 * result.high
        if not moved.any():
            break
        result, flat = _refined(result.rounded(), r_d, k1, k2)
    return result, flat | moved


def _inverse(r_d: Array, k1: Array, k2: Array) -> tuple[Array, Flags]:
    result, flat = _inverse_pair(r_d, k1, k2)
    return result.rounded(), flat


def _correction(r_d: Array, k1: Array, k2: Array) -> tuple[Array, Flags]:
    """R - r_d = -r**3 (k1 + k2 r**2) at the refined r."""
    r, flat = _inverse_pair(r_d, k1, k2)
    r2 = r * r
    slope = pair(k1) + pair(k2) * r2
    return -(r * r2 * slope).rounded(), flat | (np.abs(slope.high) < 2.0**-40 * np.abs(k1))


def _correction_exact(r_d: Fraction, k1: Fraction, k2: Fraction) -> Fraction:
    r = invert_exactly(r_d, k1, k2)
    return r - r_d


def _beyond(r_d: Array, k1: Array, k2: Array) -> Flags:
    """Whether r_d exceeds every distorted radius, decided exactly next to the fold."""
    if not k2.any():
        if k1.min() >= 0:
            return np.zeros(1, dtype=bool)
        room = _room(r_d, k1)
        beyond, unsure = room.high < 0, np.abs(room.high) < 2.0**-40
    else:
        fold = _fold(k1, k2)[0]
        r2 = fold * fold
        largest = fold * (1 + r2 * (k1 + k2 * r2))
        beyond, unsure = r_d > largest, ~(np.abs(r_d - largest) > 2.0**-30 * largest)
        unsure &= np.isfinite(fold) | (np.abs(9 * k1 * k1 - 20 * k2) < 2.0**-30 * 9 * k1 * k1)
    far = extreme((r_d, k1, k2), _REACH)
    unsure = unsure if far is None else unsure | far
    return beyond_exactly(beyond, unsure, (r_d, k1, k2)) if unsure.any() else beyond


_BEYOND = (Rule("beyond-fold", _beyond),)
_DISTORT = Kernel(
    _distort,
    (REAL,) * 4,
    exact=Exactly(_forward, 2.0**100),
    short=Short(_distort_short, 2.0**100, tiny=True),
    outputs=2,
)
_DISPLACEMENT = Kernel(
    _displacement,
    (NONNEGATIVE, REAL, REAL),
    exact=Exactly(_displacement_exact),
    short=Short(_displacement_short, fits=_no_cancellation),
)
_FOLD = Kernel(
    _fold,
    (REAL, REAL),
    exact=Exactly(fold_exactly),
    short=Short(_fold_of_barrel, fits=_is_plain_barrel),
)
_INVERSE = Kernel(
    _inverse, (NONNEGATIVE, REAL, REAL), _BEYOND, exact=Exactly(invert_exactly, _REACH)
)
_CORRECTION = Kernel(
    _correction, (NONNEGATIVE, REAL, REAL), _BEYOND, exact=Exactly(_correction_exact, _REACH)
)


def distort(x: Numbers, y: Numbers, k1: Numbers, k2: Numbers = 0.0) -> tuple[Result, Result]:
    """Distorted position of an undistorted point.

    Parameters
    ----------
    x, y : array_like
        Undistorted coordinates from the principal point, any unit of length u.
    k1, k2 : array_like
        Coefficients in u**-2 and u**-4; k1 < 0 is barrel distortion in this direction.

    Returns
    -------
    tuple of float or array
        x_d and y_d. Points beyond the fold radius are mapped as the formula says.
    """
    result: tuple[Result, Result] = _DISTORT(x, y, k1, k2)
    return result


def displacement(r: Numbers, k1: Numbers, k2: Numbers = 0.0) -> Result:
    """How far a point at undistorted radius r moves inwards, r - r_d = -k1 r**3 - k2 r**5.

    Parameters
    ----------
    r : array_like
        Undistorted radius, >= 0.
    k1, k2 : array_like
        Coefficients as for ``distort``.

    Returns
    -------
    float or array
        Unit of r; negative for pincushion distortion.
    """
    return _DISPLACEMENT(r, k1, k2)


def fold_radius(k1: Numbers, k2: Numbers = 0.0) -> Result:
    """Radius at which the distorted radius stops growing (beyond it the picture folds over).

    Parameters
    ----------
    k1, k2 : array_like
        Coefficients as for ``distort``.

    Returns
    -------
    float or array
        1/sqrt(-3 k1) for k2 = 0; infinity when there is no fold.
    """
    return _FOLD(k1, k2)


def inverse_radius(r_d: Numbers, k1: Numbers, k2: Numbers = 0.0) -> Result:
    """Undistorted radius of a distorted radius, on the branch that starts at the centre.

    Parameters
    ----------
    r_d : array_like
        Distorted radius, >= 0.
    k1, k2 : array_like
        Coefficients as for ``distort``.

    Returns
    -------
    float or array
        Radius up to the fold radius.

    Raises
    ------
    DomainError
        ``beyond-fold``: no undistorted point lands there (decided exactly).
    """
    return _INVERSE(r_d, k1, k2)


def correction(r_d: Numbers, k1: Numbers, k2: Numbers = 0.0) -> Result:
    """How far a distorted point must move outwards, r - r_d as a function of r_d.

    Parameters
    ----------
    r_d, k1, k2 : array_like
        As for ``inverse_radius``.

    Returns
    -------
    float or array
        Unit of r_d.

    Raises
    ------
    DomainError
        As ``inverse_radius``.
    """
    return _CORRECTION(r_d, k1, k2)
