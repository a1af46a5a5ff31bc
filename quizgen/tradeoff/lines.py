"""Plain lines of NumPy that keep their digits, and others that a reader might write instead.

Letters are those of the chapter (f, N, z, s, c), lengths all in one unit, intensities 0 to 1.
None looks at its arguments: what a line gives where there is no answer (a pole, a grey) is not
defined.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt

from quizgen.numerics.domain import Array
from quizgen.numerics.double_double import as_pairs

Column = npt.NDArray[np.floating[Any]]
"""One quantity of many inputs, in the precision of a way of computing."""


def two_sided_tail(k: Column) -> Column:
    """Return the probability beyond k sigma on either side, without a subtraction from 1."""
    tail: Column = _erfc(k * 0.5**0.5)
    return tail


_erfc = np.vectorize(math.erfc, otypes=[np.float64])


def image_distance(f: Column, z: Column) -> Column:
    """Return the image distance of a thin lens; z - f is exact where digits are at stake."""
    return f * (z / (z - f))


def blur_disc(f: Column, N: Column, s: Column, z: Column) -> Column:
    """Return the diameter of the blur disc of a point at z, focused at s."""
    return (f / N) * (f / (s - f)) * (np.abs(z - s) / z)


def far_limit(f: Array, N: Array, c: Array, s: Array) -> Array:
    """Return the far limit of the depth of field.

    The difference that cancels has twice the digits.
    """
    f2, N2, c2, s2 = as_pairs(f, N, c, s)
    rest = (f2 * f2 - N2 * c2 * (s2 - f2)).round_to_double()
    return s * (f * f / rest)


def snr_loss(N: Column, s: Column) -> Column:
    """Return the share of the signal-to-noise ratio lost to read noise s, at N electrons."""
    return -np.expm1(-0.5 * np.log1p(s * s / N))


def gamma_gap(a: Column, b: Column) -> Column:
    """Return encoded mean minus mean of the encoded, exponent 5/11, of two intensities.

    With d = (b - a)/(a + b) and e the exponent, (1 + d)**e and (1 - d)**e are exp(e (p +- q)),
    where 2 p = ln(1 - d**2) and q = artanh d: 1 less their mean has no small difference.
    """
    e, d = 5 / 11, (b - a) / (a + b)
    p = 0.5 * np.log1p(-d * d)
    bend = 2 * np.sinh(0.5 * e * np.arctanh(d)) ** 2
    gap: Column = -((0.5 * (a + b)) ** e) * (np.expm1(e * p) + np.exp(e * p) * bend)
    return gap


def falloff(r: Column, f: Column) -> Column:
    """Return the share of light lost at r from the centre, 1 - cos^4."""
    q = r * r
    p = q / (q + f * f)
    return p * (2 - p)


def _compute_decimal_pixel(*row: float) -> float:
    """Return o + f x/(s z) rounded once, for the decimals that the numbers print as."""
    f, s, x, z, o = (Fraction(repr(value)) for value in row)
    return float(o + f * x / (s * z))


pixel = np.vectorize(_compute_decimal_pixel, otypes=[np.float64])
"""Pixel coordinates from f, s, x, z and o: 2 mm, 5 um, -1, 2 and 320 give 120."""


def hue(R: Column, G: Column, B: Column) -> Column:
    """Return the hue in degrees, as textbooks write it; a grey has none."""
    most = np.maximum(np.maximum(R, G), B)
    span = most - np.minimum(np.minimum(R, G), B)
    sector = np.where(most == R, (G - B) / span, (B - R) / span + 2)
    sector = np.where((most == B) & (most != R) & (most != G), (R - G) / span + 4, sector)
    return 60 * np.where(sector < 0, sector + 6, sector)


def fixed_point(r_d: Column, k1: Column, steps: int = 5) -> Column:
    """Return the undistorted radius by repeating r := r_d/(1 + k1 r**2), as OpenCV does."""
    r = r_d
    for _ in range(steps):
        r = r_d / (1 + k1 * r * r)
    return r


def newton(r_d: Column, k1: Column, steps: int = 4) -> Column:
    """Return the undistorted radius by Newton's method on r + k1 r**3 = r_d, from r_d."""
    r = r_d
    for _ in range(steps):
        square = k1 * r * r
        r = r - (r * (1 + square) - r_d) / (1 + 3 * square)
    return r
