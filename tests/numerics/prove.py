"""Prove bounds on the error of kernels over their whole domain, with Arb.

Run: ``python tests/numerics/prove.py``. Writes ``proofs.tsv``: kernel, bound in units in the last
place, boxes looked at, and rounds of a loop that an element takes at most. After a change to the code of
a kernel, prove again: ``test_proofs.py`` looks at some of the boxes, and at values by mpmath.

The code itself runs, on boxes instead of numbers: each holds what exact arithmetic would give for
every input of the box, and how far rounding may have moved that. How far the polynomials are from
the functions is enclosed by Taylor series on the same boxes. Premises: additions, multiplications
and divisions round correctly, NumPy's logarithm and power are right to one unit in the last place.

``two_product`` and ``two_sum`` are exact (Dekker; Knuth). With k**2 = s + l, |l| <= u s, and d the
relative rounding of k + 3/4, the true exp(-l/2) and 1/(1 + d) differ from the factors taken for them
by l**2/8 + d**2 + |l d| < 2**-80.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import counted
from enclosures import ORDER, UNIT, boxes, farthest, on_one
from flint import arb, arb_series, ctx
from mills import mills_error

from quizgen.numerics import gaussian, quintic, tables

PROOFS = Path(__file__).with_name("proofs.tsv")
DOCS = Path(__file__).parents[2] / "docs/accuracy.md"
HEAD = "| kernel | relative error, in 2^-53 | boxes | rounds |\n|---|---|---|---|\n"
COMPENSATED = arb(2) ** -80


def exact_fraction(parts, x):
    """Fraction in exact arithmetic, of a series."""
    values = []
    for coefficients in parts:
        total = arb_series([0])
        for c in reversed(coefficients):
            total = total * x + c
        values.append(total)
    return values[0] / values[1]


def middle_difference(share):
    """Exact probability between 0 and the fraction's quantile, less the share asked for."""
    k = share * exact_fraction(gaussian._QUANTILE_MIDDLE, gaussian._WAY - share * share)
    return (k / arb(2).sqrt()).erf() / 2 - share


def middle_bound(share):
    """Relative error of the quantile next to 1/2.

    Shares up to 1/4 are exact (Sterbenz), others rounded by 2**-55 at most. The probability grows
    by at least the density a little beyond the quantile found; next to 0 the difference per share
    is at most its slope.
    """
    formula = gaussian._QUANTILE_MIDDLE
    k = on_one(lambda s: gaussian._evaluate_rational(formula, gaussian._WAY - s * s), share)
    slope, rounded = abs(k.value), k.error / abs(k.value) + UNIT
    density = (-((share * slope + arb(2) ** -40) ** 2) / 2).exp() * arb(gaussian._PEAK)
    if share.contains(0):
        missed = abs(farthest(lambda s: middle_difference(s).derivative(), share))
        return rounded + missed / (density * slope)
    missed = abs(farthest(middle_difference, share)) + (0 if share < 0.25 else UNIT / 4)
    return rounded + missed / (density * share * slope)


def near_difference_of_logarithms(root):
    """Logarithm of the exact tail at the fraction's quantile, less that of p = exp(-root**2)."""
    k = exact_fraction(gaussian._QUANTILE_NEAR, root - gaussian._NEAR_WAY)
    return ((k / arb(2).sqrt()).erfc() / 2).log() + root * root


def far_difference_of_logarithms(root):
    """The same below exp(-25), with the polynomial in place of Mills' ratio."""
    k = exact_fraction(gaussian._QUANTILE_FAR, root - gaussian._FAR_WAY)
    t, total = (k - 4) / (k + 4), arb_series([0])
    for c in reversed(tables.MILLS):
        total = total * t + c
    return (total / (k + arb("0.75"))).log() - k * k / 2 + root * root


def start_error(parts, way, root):
    """The fraction, how far rounding moves it, and the hazard there, which is above it.

    The logarithm of p is off by two units of 2**-53, its root by half of that and one rounding;
    the quantile changes with the root by 2 root by the hazard.
    """
    found = on_one(lambda r: gaussian._evaluate_rational(parts, r - way), root)
    k = farthest(lambda r: exact_fraction(parts, r - way), root)
    return k, found.error + 4 * UNIT * root * root / k, k


def tail_bound(root):
    """Relative error of the quantile of a tail between exp(-25) and 0.075."""
    k, error, hazard = start_error(gaussian._QUANTILE_NEAR, gaussian._NEAR_WAY, root)
    return (error + abs(farthest(near_difference_of_logarithms, root)) / hazard) / k


def newton_bound(root):
    """Relative error of the quantile after the step of Newton, for tails below exp(-25).

    The step is taken from the double k that was found. What it misses is off by the logarithm of
    p (two units of 2**-53), the logarithm of Mills' ratio with its own error, and three sums of
    which the second has the magnitude of k**2/2; what lies below k**2 is kept. The start squared
    remains, since the hazard grows by at most 1, and the slope taken is off by less than 2**-40.
    """
    k, error, hazard = start_error(gaussian._QUANTILE_FAR, gaussian._FAR_WAY, root)
    k += arb(0, error.upper())
    ratio, off = mills_error(k)
    start = error + (abs(farthest(far_difference_of_logarithms, root)) + 2 * off) / hazard
    log = abs(ratio.log()) + off
    sums = log + (log + k * k / 2) + arb(2) ** -30
    miss = 2 * UNIT * root * root + off + 2 * UNIT * log + UNIT * sums + COMPENSATED
    return (miss / hazard + start * start + start * arb(2) ** -40) / k + UNIT


class Piece(NamedTuple):
    """What is proven: relative error on a box, the domain, into how many boxes it is cut."""

    bound: Callable[[Any], Any]
    low: float
    high: float
    count: int
    rounds: int = 1
    """Of a loop, at most, for any element."""


PIECES = {
    "gaussian.quantile next to 1/2": Piece(middle_bound, 0.0, 0.42501, 400),
    "gaussian.quantile to exp(-25)": Piece(tail_bound, 1.609, 5.0001, 2000),
    "gaussian.quantile below exp(-25)": Piece(newton_bound, 4.9999, 27.285, 4000),
    "power.raised": Piece(counted.raised_bound, 0.0, 1.0, 1),
    "hsv.to_rgb": Piece(counted.hsv_bound, 0.0, 1.0, 1),
    "gamma.srgb_decode, dim": Piece(counted.dim_bound, 0.0, 0.0405, 1),
    "gamma.srgb_decode, bright (log2)": Piece(counted.decode_bound, -3.4, 427.0, 100),
    "distortion.distort": Piece(counted.distort_bound, 0.0, 1.0, 1),
    "fold_radius, k2 = 0": Piece(counted.barrel_bound, 0.0, 1.0, 1),
    "fold_radius, both coefficients": Piece(counted.fold_bound, 0.0, 1.0, 1),
    "inverse_radius, k1 >= 0, k2 = 0": Piece(counted.pincushion_bound, 0.0, 1.0, 1),
    "inverse_radius, k1 < 0, k2 = 0 (log2 of slope)": Piece(
        counted.barrel_inverse_bound, -60.0, 0.0, 60, quintic._STEPS
    ),
    "inverse_radius, k2 (log2 of slope)": Piece(
        counted.quintic_inverse_bound, -40.0, 0.0, 40, 2 * quintic._STEPS
    ),
    "inverse_radius, k2, slope to 2^-40: what r_d is missed by": Piece(
        counted.flat_inverse_bound, -41.0, -40.0, 1, 2 * quintic._STEPS
    ),
    "luminosity.efficiency": Piece(counted.curve_bound, 0.0, 1.0, 1),
}


def worst(piece):
    """Units in the last place: a unit is at least UNIT relative to the value."""
    cut = boxes(piece.low, piece.high, piece.count)
    return max(float((piece.bound(box) / UNIT).upper()) for box in cut)


def table():
    """Rows of the record, as the documents print them."""
    rows = (line.split("\t") for line in PROOFS.read_text().splitlines())
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def main():
    ctx.prec, ctx.cap = 300, ORDER
    rows = [
        f"{name}\t{worst(piece):.4g}\t{piece.count}\t{piece.rounds}"
        for name, piece in PIECES.items()
    ]
    PROOFS.write_text("\n".join(rows) + "\n")
    before, _, rest = DOCS.read_text().partition(HEAD)
    DOCS.write_text(before + HEAD + table() + "\n\n" + rest.partition("\n\n")[2])
    print(PROOFS.read_text(), end="")


if __name__ == "__main__":
    main()
