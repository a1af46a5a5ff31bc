"""Radial lens distortion r_d = r (1 + k1 r**2 + k2 r**4), both ways, up to the fold.

Sources: Brown, Photogrammetric Engineering 37 (1971) 855. Units are taken out by powers of two,
which are exact: with r = 2**j x, x near 1, it is A x + B x**3 + C x**5 = m with m in [1/2, 1).
"""

from __future__ import annotations

import numpy as np
from flint import fmpq

from quizgen.numerics.domain import (
    NONNEGATIVE,
    REAL,
    Array,
    Constraint,
    Counts,
    Flags,
    FloatOrArray,
    Numbers,
)
from quizgen.numerics.quintic import QuinticSolver, cubic_discriminant, solve_cubic
from quizgen.numerics.rational import exact_arguments
from quizgen.numerics.ufunc import StableUfunc, smallest_nonzero

_UNSURE = 2.0**-40
_REACH = 2.0**60
_TAME = 4.0
"""With coefficients up to it, relative to r_d, units may stay."""
_LARGEST = 2.0**200


def _compute_relative_change(x: Array, y: Array, k1: Array, k2: Array) -> tuple[Array, Array]:
    """Return k1 r**2 + k2 r**4, the relative change of the radius, and r**2 = x**2 + y**2."""
    r2, square = x * x, y * y
    r2 = np.add(r2, square, out=r2 if r2.size >= square.size else square)
    change = k2 * r2
    change = change + k1 if k1.size > change.size else np.add(change, k1, out=change)
    change *= r2
    return change, r2


def _distort_in_doubles(x: Array, y: Array, k1: Array, k2: Array) -> tuple[Array, ...]:
    """Return x_d and y_d in plain doubles; NaN, which asks for fractions, where they are not safe.

    In units of 2**-53 times x, the change is off by at most 5 |change| + 3 |k2| r**4, also where
    its terms cancel; adding it to x and y costs one more.
    """
    change, r2 = _compute_relative_change(x, y, k1, k2)
    off = 5 * np.abs(change) + 3 * np.abs(k2) * r2 * r2
    sure = off <= _ALLOWED * (1 + change)
    return tuple(np.where(sure, place * change + place, np.nan) for place in (x, y))


_FAR = 2.0**100
_ALLOWED = 3.0


def _distort_exact(x: fmpq, y: fmpq, k1: fmpq, k2: fmpq) -> tuple[fmpq, fmpq]:
    """Return x_d and y_d of one point as fractions."""
    square = x * x + y * y
    scale = 1 + square * (k1 + k2 * square)
    return x * scale, y * scale


def _compute_binary_exponent(value: Array) -> Counts:
    r"""Return the exponent e for which abs(value) < 2**e; for zero -3000, below all others."""
    return np.where(value == 0, -3000, np.frexp(value)[1]).astype(np.int64)


def _scale_equation(r_d: Array, k1: Array, k2: Array) -> tuple[QuinticSolver, Counts]:
    """Return A x + B x**3 + C x**5 = m without units, and the j with r = 2**j x.

    Coefficients that put m far beyond the fold are cut off at ``_LARGEST``.
    """
    r_d = np.broadcast_to(r_d, max(r_d.size, k1.size, k2.size))
    square = r_d.max() ** 2
    if (
        _is_moderate(r_d)
        and square * max(_find_largest_magnitude(k1), _find_largest_magnitude(k2) * square) < _TAME
    ):
        return QuinticSolver(np.ones(1), k1, k2, r_d), np.zeros(1, dtype=np.int64)
    m, e = np.frexp(r_d)
    by_cubic = np.where(k1 > 0, (e - _compute_binary_exponent(k1)) // 3, e)
    by_quintic = np.where(k2 > 0, (e - _compute_binary_exponent(k2)) // 5, e)
    j = np.minimum(e, np.minimum(by_cubic, by_quintic))
    A, B, C = np.ldexp(1.0, j - e), np.ldexp(k1, 3 * j - e), np.ldexp(k2, 5 * j - e)
    B, C = np.clip(B, -_LARGEST, _LARGEST), np.clip(C, -_LARGEST, _LARGEST)
    return QuinticSolver(A, B, C, m), j


def _find_largest_magnitude(coefficient: Array) -> float:
    """Return the largest absolute value of a block."""
    return float(np.abs(coefficient).max())


def _is_cubic(r_d: Array, k1: Array, k2: Array) -> bool:
    """Return whether k2 = 0 and all magnitudes are moderate: Cardano's form needs no scaling."""
    return not k2.any() and _is_moderate(r_d) and _is_moderate(np.abs(k1))


def _is_moderate(sizes: Array) -> bool:
    """Return whether all nonzero magnitudes lie between 1/``_REACH`` and ``_REACH``."""
    return float(sizes.max()) < _REACH and smallest_nonzero(sizes) > 1 / _REACH


def _invert_radius(r_d: Array, k1: Array, k2: Array) -> Array:
    """Return the undistorted radius of each distorted one, below the fold."""
    if _is_cubic(r_d, k1, k2):
        whole = QuinticSolver(np.ones(1), k1, np.zeros(1), r_d)
        return whole.refine_root(solve_cubic(r_d, k1)).round_to_double()
    equation, j = _scale_equation(r_d, k1, k2)
    centre = equation.m == 0
    result = np.ldexp(equation.refine_root(equation.root()).round_to_double(), j)
    return np.where(centre, 0.0, result) if centre.any() else result


def _is_beyond_fold(r_d: Array, k1: Array, k2: Array) -> Flags:
    """Return where r_d exceeds every distorted radius; next to the fold decided by fractions."""
    if _is_cubic(r_d, k1, k2):
        if k1.min() >= 0:
            return np.zeros(1, dtype=bool)
        left = cubic_discriminant(r_d, k1).high
        beyond, unsure = np.atleast_1d(left < 0), np.abs(left) < _UNSURE
        for i in np.flatnonzero(unsure):
            radius, k = exact_arguments((r_d, k1), i)
            beyond[i] = 27 * k * radius * radius < -4
        return beyond
    return (r_d > 0) & _scale_equation(r_d, k1, k2)[0].beyond()


def _compute_fold_radius(k1: Array, k2: Array) -> Array:
    """Return the fold radius, computed in a unit 2**j in which the deciding terms are near 1.

    With r = 2**j x the slope is 1 + 3 k1 4**j x**2 + 5 k2 16**j x**4, here times 2**s. Mostly 1 and
    the larger coefficient decide. Where k1 > 0 lets the slope grow first and a far smaller k2 < 0
    ends that, it is the two coefficients, and 1 is negligible.
    """
    if not k2.any() and (k1 > -_LARGEST).all():
        alone: Array = 1 / np.sqrt(-3 * np.minimum(k1, -0.0))
        return alone  # of 0, infinity
    k1, k2 = (np.array(arg) for arg in np.broadcast_arrays(k1, k2))
    e1, e2 = _compute_binary_exponent(k1), _compute_binary_exponent(k2)
    grows = (k1 > 0) & (k2 < 0) & (e2 < 2 * e1)
    j = np.where(grows, (e1 - e2) // 2, -np.maximum(e1 // 2, e2 // 4))
    s = np.where(grows, -(e1 + 2 * j), 0)
    A, B, C = np.ldexp(1.0, s), np.ldexp(k1, 2 * j + s), np.ldexp(k2, 4 * j + s)
    return np.ldexp(QuinticSolver(A, B, C, np.ones(k1.size)).fold(), j)


_DISTORT = StableUfunc(
    _distort_in_doubles, (REAL,) * 4, exact=_distort_exact, reach=_FAR, outputs=2
)
_FOLD = StableUfunc(_compute_fold_radius, (REAL, REAL))
_INVERSE = StableUfunc(
    _invert_radius, (NONNEGATIVE, REAL, REAL), (Constraint("beyond-fold", _is_beyond_fold),)
)


def distort(
    x: Numbers, y: Numbers, k1: Numbers, k2: Numbers = 0.0
) -> tuple[FloatOrArray, FloatOrArray]:
    """Return the distorted position (x_d, y_d) of an undistorted point.

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
    result: tuple[FloatOrArray, FloatOrArray] = _DISTORT(x, y, k1, k2)
    return result


def fold_radius(k1: Numbers, k2: Numbers = 0.0) -> FloatOrArray:
    """Return the radius at which the distorted radius stops growing.

    Beyond it the picture folds over.

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


def inverse_radius(r_d: Numbers, k1: Numbers, k2: Numbers = 0.0) -> FloatOrArray:
    """Return the undistorted radius of a distorted one, on the branch that starts at the centre.

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
