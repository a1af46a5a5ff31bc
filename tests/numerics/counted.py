"""Bounds of short formulas by counting their roundings, with their constants checked by Arb.

Each bound is relative, for the doubtful parameter in a box. Exact are differences of neighbours
within a factor of 2 (Sterbenz), and ``two_sum`` and ``two_product`` together with what they lost.
"""

from __future__ import annotations

from enclosures import UNIT, Box
from flint import arb, fmpq

from quizgen.numerics import distortion, gamma

SECOND = 64 * UNIT * UNIT
"""More than products of the few roundings of a formula."""


def one():
    """A number that is right; products, quotients and roots of such have relative errors."""
    return Box(arb(1))


def relative(box):
    """Error of a product by its value."""
    return box.error / abs(box.value)


def decode_bound(exponent):
    """Bound for sRGB above the knee, base about 2**exponent.

    The base and what it lost are exact. The power is right to one unit in the last place, which is
    two of 2**-53, and makes up for the exponent's rounding; three products and sums follow. Of
    (1 + l)**2.4 the terms from l**2 on are left out.
    """
    high, low = gamma._DECODE
    log = abs(exponent) * arb(2).log()
    kept = abs(arb(fmpq(12, 5)) - arb(high) - arb(low)) * log
    shrink = gamma._SHRINK
    base = arb("1.055") ** -(arb(12) / 5)
    constant = abs((arb(shrink.high) + arb(shrink.low)) / base - 1)
    offset = abs(arb("0.055") - arb(gamma._OFFSET.high) - arb(gamma._OFFSET.low)) / arb("0.095")
    power = 2 * UNIT + kept + abs(arb(low)) * log * 4 * UNIT + 2 * UNIT
    return power + constant + 3 * offset + 2 * UNIT + SECOND


def raised_bound(_):
    """Bound for powers of normal numbers, exponents to 12/5, while the result is normal.

    The power of the rounded exponent is right to one unit in the last place, two of 2**-53. What
    the exponent lost by the logarithm is at most 2**-43: as a factor 1 + t it leaves out t**2 and
    takes a sum and a product, or is itself left out below a unit.
    """
    return 4 * UNIT + arb(2) ** -85 + SECOND


def hsv_bound(_):
    """Bound for RGB of hues in sectors, where no sum of different signs cancels.

    The remainder by 360 is exact, the sector is the true one, and what is left of it is exact
    (Sterbenz). For saturations from 0 to 1 all terms of the sum are positive: the longest has
    60 - degrees, its quotient, its product, the sum and the product with V. Other saturations take
    pairs, which lose 2**-106 of 60, twice, while what remains of 60 is at least 60/2**50, and three
    roundings.
    """
    degrees = Box(1, UNIT)
    share = relative(one() * (degrees / one()))
    within = relative(one() * Box(1, max(share, UNIT) + UNIT))
    outside = 3 * UNIT + arb(2) ** -55
    return max(within, outside) + SECOND


def dim_bound(_):
    """Bound for sRGB up to the knee: a quotient by a decimal (half a subnormal unit more below)."""
    return abs(arb(gamma._SLOPE) / arb("12.92") - 1) + relative(one() / one()) + SECOND


def distort_bound(_):
    """Bound for distorted positions: what is off is allowed three units of the result.

    Of r**2, two roundings; of k2 r**2, three; their sum with k1, one; its product with r**2, three
    more, and with x, one: 5 |change| + 3 |k2| r**4, which the code asks for. The last sum adds one.
    """
    square = Box(1) * Box(1) + Box(0)
    bend = Box(1) * square
    assert relative(bend) < 3 * UNIT + SECOND
    assert relative(bend * square) < 6 * UNIT + SECOND
    return distortion._ALLOWED * UNIT + UNIT + SECOND


def barrel_bound(_):
    """Bound for the fold of one coefficient: a product, half of it in the root, and two more."""
    return relative(one() * one()) / 2 + 2 * UNIT + SECOND


def curve_bound(_):
    """Bound between points of a table: two positive products, their sum and its quotient.

    Wavelengths from 256 nm are multiples of 2**-44, so that both distances are exact.
    """
    product = one() * one()
    return relative((product + product) / one()) + SECOND


def pincushion_bound(_):
    """Bound for the inverse of one coefficient k1 >= 0: a step of Newton from the closed form.

    That is off by at most 256 units: four of each hyperbolic function (taken for granted) and the
    products, enlarged by a third of an angle below 65. The step squares it, as x f''/f' <= 2; the slope is off by five units of it, and the
    residual, of ten operations on pairs, by less than 2**-96 of the radius. The sum is rounded.
    """
    start = 256 * UNIT
    return start * start + 8 * UNIT * start + arb(2) ** -96 + UNIT + SECOND


def barrel_inverse_bound(exponent):
    """Bound for the inverse of one coefficient k1 < 0, of a slope of about 2**exponent at the root.

    With t the root by the fold, the slope is 1 - t**2 and the second derivative -2 t by the fold.
    The closed form is off by at most 256 units: the arc sine is taken from both its legs, of which
    one comes from a pair, and the sine by a third, below 30 degrees, loses nothing (four units of
    each are taken for granted). The residual is off by 8 * 2**-106 of the root: products with a
    number that is exact lose 3, 5 and 3 of what they are multiplied with, a third of the root, and
    the sum of the two pairs, whose upper halves cancel exactly, less than 3. Where the slope is no
    less than 2**-12 of m/x, one step of Newton squares the start, and the slope taken is off by
    4 units of 1. Elsewhere the polynomial around the start is solved, its slope being known as
    well as its residual: what the residual is off by moves the root by no more than the root of
    it, where the slope vanishes; what is relative moves the step, which is short.
    """
    start, slope = 256 * UNIT, arb(2) ** exponent
    residual = 8 * UNIT * UNIT
    steep = start * start / slope + start * 4 * UNIT / slope + residual / slope
    flat = residual.sqrt() + 2 * (6 * UNIT).sqrt() * start + SECOND
    return (steep if slope > arb(2) ** -12 else flat) + UNIT + SECOND


def fold_bound(_):
    """Bound for the fold of two coefficients, from what stands in the root.

    That is a difference of two numbers with two roundings each: next to one another they are
    taken in pairs or by fractions, else the difference is an eighth of their sum at least. Half
    of its error remains in its root, which stands beside numbers of its own sign, once rounded;
    two roundings more, and half of all that in the last root. Powers of two are exact, and what
    they bring below all doubles is nothing beside the other two terms: the one that decides nothing.
    """
    inside = 8 * 2 * UNIT + UNIT
    falling = (inside / 2 + UNIT) + UNIT + UNIT
    rising = (3 * UNIT / 2 + UNIT) + UNIT + 2 * UNIT
    return max(falling, rising) / 2 + UNIT + SECOND


_GROWING = 64 * (3 * 3 + 6 * 5 + 4 * 7)
"""Units squared of m by which a cubic that grows is off, see below."""


def quintic_inverse_bound(exponent):
    """Bound for the inverse of two coefficients, of a slope x f'/m of about 2**exponent at the root.

    Up to the first fold each term is at most 4 m: of unlike signs, the terms of the slope bound
    each other. The start has arrived: its last step, of Newton's or of halving, was at most 2**-50
    of it or its value at most 8 units of m, and a value in doubles is off by at most 32 units, by
    the slope. The step from there leaves out its square by 13 terms, and takes a slope that is off
    by 8 units of them; the residual is off by 64 * 2**-106 of m. Below 2**-12 the polynomial around
    the start is solved, whose bracket of 2**-5 is halved to 2**-69 at least, with coefficients that
    are known like the residual, then rounded. From the start to the root it grows, over a step so
    short that its last two terms are none: a cubic that grows has terms of at most 3, 6 and 4 times
    what it grows by, here 64 units. Each is off by a unit, and by two for each step of Horner's
    rule from there on.
    """
    slope = arb(2) ** exponent
    residual = 64 * UNIT * UNIT / slope
    start = arb(2) ** -50 + 40 * UNIT / slope
    terms = 52 / slope
    steep = start * start * terms + start * 8 * UNIT * terms + residual
    flat = residual + _GROWING * UNIT * UNIT / slope + arb(2) ** -69
    return (steep if slope > arb(2) ** -12 else flat) + UNIT + SECOND


def flat_inverse_bound(exponent):
    """By how much of r_d the inverse of two coefficients misses it, of slopes below 2**exponent.

    Where two folds meet, the root moves by the cube root of what r_d is off by, so that no digits
    of the root can be promised; what the formula says of the answer can. As above, the polynomial
    around the start is solved to 2**-69 of it; then the root is rounded. Both move the value by the
    slope and by half the second derivative, of which the terms are at most 52 m.
    """
    slope = arb(2) ** arb(exponent).upper()
    moved = UNIT + arb(2) ** -69
    return (64 + _GROWING) * UNIT * UNIT + moved * slope + 26 * moved * moved
