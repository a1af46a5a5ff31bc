"""Roots of A x + B x**3 + C x**5 = m on the branch that starts at 0, up to its fold.

Sources: the cubic in closed form (Cardano, trigonometric), the quintic by Newton steps in a
bracket; one more step with a residual of twice the working precision makes both nearly correctly
rounded. Next to the fold that step solves the polynomial around the root found so far.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import msgspec
import numpy as np
from flint import fmpq

from quizgen.numerics.domain import Array, Flags, Indices
from quizgen.numerics.double_double import DoubleDouble, as_pairs
from quizgen.numerics.rational import exact_arguments, nearest_double

_FLAT = 2.0**-12
"""Below this slope, relative to m/x, a single Newton step is not trusted."""

_NEWTON, _STEPS = 24, 88
"""Steps that Newton has, and all: halving the bracket ends what he does not."""
_NOISE = 2.0**-50
"""Of values in doubles next to a root, relative to m."""
_CLOSE = 2.0**-3
_UNSURE = 2.0**-40
_TIE = 2.0**-90
_HIGHEST = 16.0
"""Above every root without a fold, relative to m, once units are taken out."""


Function = Callable[[Array], tuple[Array, Array]]
"""Value and slope at a place."""


def solve_cubic(m: Array, B: Array) -> Array:
    """Return the root of x + B x**3 = m below the fold: closed form, good to a few last places."""
    size = np.sqrt(3 * np.abs(B))
    size = np.where(size == 0, 1.0, size)
    if B.max() < 0:
        return _solve_barrel_cubic(m, B, size)
    pincushion = 2 / size * np.sinh(np.arcsinh(1.5 * size * m) / 3)
    if B.min() < 0:
        return np.where(B < 0, _solve_barrel_cubic(m, B, size), np.where(B == 0, m, pincushion))
    return np.where(B == 0, m, pincushion)


def _solve_barrel_cubic(m: Array, B: Array, size: Array) -> Array:
    """Return the root for B < 0: 2/sqrt(-3 B) sin(asin(m/fold)/3), ``size`` being sqrt(-3 B).

    The arc sine is taken from both its legs, since next to the fold it is ill-conditioned.
    """
    leg = np.sqrt(np.maximum(cubic_discriminant(m, B).round_to_double(), 0.0))
    result: Array = 2 / size * np.sin(np.arctan2(3 * size * m, leg) / 3)
    return result


def cubic_discriminant(m: Array, B: Array) -> DoubleDouble:
    """Return 4 + 27 B m**2: positive below the fold of a cubic, zero at it."""
    m_pair, B_pair = as_pairs(m, B)
    return 4 + m_pair * m_pair * (27 * B_pair)


class QuinticSolver(msgspec.Struct, frozen=True):
    """The equations A x + B x**3 + C x**5 = m of a block, with A > 0 and m > 0."""

    A: Array
    B: Array
    C: Array
    m: Array

    def discriminant(self) -> Array:
        """Return 9 B**2 - 20 A C, by fractions where it cancels.

        It is negative when the slope never vanishes.
        """
        square, product = 9 * self.B * self.B, 20 * self.A * self.C
        value, size = square - product, square + np.abs(product)
        close = np.flatnonzero(np.abs(value) < _CLOSE * size)
        if close.size:
            some = self.take(close)
            A, B, C = as_pairs(some.A, some.B, some.C)
            value[close] = (B * B * 9 - A * C * 20).round_to_double()
        for i in close[np.abs(value[close]) < _UNSURE * size[close]]:
            a, b, c = exact_arguments((self.A, self.B, self.C), i)
            value[i] = nearest_double(9 * b * b - 20 * a * c)
        return value

    def fold(self) -> Array:
        """Return the smallest x > 0 where the slope A + 3 B x**2 + 5 C x**4 is 0, or infinity."""
        inside = self.discriminant()
        root = np.sqrt(np.maximum(inside, 0.0))
        falling = 2 * self.A / np.where(self.B < 0, root - 3 * self.B, 1.0)
        rising = (3 * self.B + root) / (-10 * np.where(self.C < 0, self.C, -1.0))
        square = np.where(self.B < 0, falling, np.where(self.C < 0, rising, math.inf))
        return np.where(inside < 0, math.inf, np.sqrt(square))

    def beyond(self) -> Flags:
        """Return where m is larger than every value up to the fold, so that there is no root.

        The value at the fold hardly changes with x, so that a rounded fold will do.
        """
        fold = self.fold()
        folds = np.isfinite(fold)
        square = np.where(folds, fold * fold, 0.0)
        largest = np.where(folds, fold, math.inf) * (self.A + square * (self.B + square * self.C))
        beyond = self.m > largest
        close = np.flatnonzero(folds & (np.abs(self.m - largest) < _UNSURE * largest))
        if close.size:
            some = self.take(close)
            left = some.residual(np.broadcast_to(fold, self.m.size)[close])
            beyond[close] = left < 0
            for i in np.flatnonzero(np.abs(left) < _TIE * some.m):
                beyond[close[i]] = _exceeds_fold(
                    *exact_arguments((some.A, some.B, some.C, some.m), i)
                )
        return beyond

    def take(self, where: Indices) -> QuinticSolver:
        """Return the equations at the given indices."""
        parts = (self.A, self.B, self.C, self.m)
        return QuinticSolver(*(part.take(where) if part.size > 1 else part for part in parts))

    def residual(self, x: Array) -> Array:
        """Return A x + B x**3 + C x**5 - m, computed to twice the working precision."""
        A, B, C, x_pair = as_pairs(self.A, self.B, self.C, x)
        square = x_pair * x_pair
        bend = B if not self.C.any() else B + C * square
        return (x_pair * (square * bend) + (x_pair * A - self.m)).round_to_double()

    def root(self) -> Array:
        """Return the root to about twelve digits, fewer next to the fold."""
        fold = self.fold()
        ends = np.zeros(self.m.size), np.minimum(fold, _HIGHEST * self.m)
        return _find_bracketed_root(
            self.value_and_slope, ends, np.minimum(fold, self.m), fold, _NOISE * self.m
        )

    def value_and_slope(self, x: Array) -> tuple[Array, Array]:
        """Return A x + B x**3 + C x**5 - m in doubles, and its derivative."""
        square = x * x
        linear = square * self.B
        fifth = square * square * self.C
        return x * (self.A + linear + fifth) - self.m, self.A + 3 * linear + 5 * fifth

    def refine_root(self, x: Array) -> DoubleDouble:
        """Return the root next to x by a Newton step with a residual of twice the precision."""
        residual, square = self.residual(x), x * x
        slope = self.A + square * (3 * self.B + 5 * self.C * square)
        flat = slope * x <= _FLAT * self.m
        step = -residual / np.where(flat, 1.0, slope)
        if flat.any():
            where = np.flatnonzero(flat)
            step[where] = self.take(where).small_root(x[where], residual[where])
        return DoubleDouble(x, step)

    def small_root(self, x: Array, residual: Array) -> Array:
        """Return the step from x to the root, where the slope is too flat for Newton's.

        It is a root of the polynomial around x, whose coefficients may cancel where folds meet. Two
        such folds lie next to one another: the root is looked for up to the first.
        """
        A, B, C, x_pair = as_pairs(self.A, self.B, self.C, x)
        square = x_pair * x_pair
        bend = square * (C * 10)
        slope = (A + square * (B * 3 + square * (C * 5))).round_to_double()
        second, third = (x_pair * (B * 3 + bend)).round_to_double(), (B + bend).round_to_double()
        terms = (residual, slope, second, third, 5 * self.C * x, self.C)
        near, fold = _NEAR * x, self.fold()
        last = np.minimum(near, fold - x * (1 - _FOLD_OFF))
        return _find_bracketed_root(
            _make_polynomial(terms), (-near, last), np.zeros(x.size), fold, np.zeros(1)
        )


_NEAR = 2.0**-6
_FOLD_OFF = 2.0**-50
"""Above what a rounded fold is off by, relative to it."""


def _find_bracketed_root(
    function: Function, ends: tuple[Array, Array], x: Array, fold: Array, noise: Array
) -> Array:
    """Return the root by Newton steps from x, kept inside a bracket.

    The function grows up to its fold.

    A value below its noise has arrived. What has not after those steps is halved: 64 times take the
    bracket, at most 64 times as wide as the root lies from 0, to less than 2**-50 of it.
    """
    low, high = ends
    folds = np.isfinite(fold)
    for turn in range(_STEPS):
        value, slope = function(x)
        above = (value > 0) | ((slope <= 0) & folds)
        high, low = np.where(above, x, high), np.where(above, low, x)
        step = x - value / np.where(slope == 0, 1.0, slope)
        near = 2.0**-50 * np.abs(x)
        # a step that stays where it is has arrived, though that is now an end of the bracket
        usable = ((step > low) & (step < high) & (slope > 0)) | (np.abs(step - x) <= near)
        following = np.where(usable & (turn < _NEWTON), step, (low + high) / 2)
        following = np.where(np.abs(value) <= noise, x, following)
        arrived = np.all(np.abs(following - x) <= near)
        x = following
        if arrived:
            break
    return x


def _make_polynomial(terms: Sequence[Array]) -> Function:
    """Return a function that gives value and slope of a polynomial by Horner's rule.

    ``terms`` are the coefficients in ascending order.
    """

    def evaluate(x: Array) -> tuple[Array, Array]:
        """Return value and slope at x."""
        *rest, value = terms
        slope = np.zeros(x.size)
        for term in reversed(rest):
            slope = slope * x + value
            value = value * x + term
        return value, slope

    return evaluate


def _exceeds_fold(A: fmpq, B: fmpq, C: fmpq, m: fmpq) -> bool:
    """Return whether m exceeds the value at the fold of one equation, by exact fractions.

    Tested is m**2 > u (A + B u + C u**2)**2, with u the square of the fold.

    With s = sqrt(9 B**2 - 20 A C) it is u = -(3 B + s)/(10 C) and, there, 5 C u**2 = -A - 3 B u.
    """
    if C == 0:
        return bool(27 * B * m * m < -4 * A**3)
    D = 9 * B * B - 20 * A * C
    p, q = -3 * B / (10 * C), -1 / (10 * C)
    v, w = 2 * A + B * p, B * q
    square, cross = v * v + w * w * D, 2 * v * w
    whole = 25 * m * m / 4 - (p * square + q * cross * D)
    part = p * cross + q * square
    if part >= 0:
        return bool(whole > 0 and whole * whole > part * part * D)
    return bool(whole > 0 or whole * whole < part * part * D)
