"""Prove bounds on the error of the Gaussian tails over their whole domain, with Arb.

Run: ``python tests/arrays/prove.py``. Writes ``proofs.tsv``: kernel, bound in units in the last
place, boxes looked at, and the digest of the code that was proven.

The code itself runs, on boxes instead of numbers: each holds what exact arithmetic would give for
every input of the box, and how far rounding may have moved that. How far the polynomials are from
the functions is enclosed by Taylor series on the same boxes. Premises: additions, multiplications
and divisions round correctly, and NumPy's exponential is right to one unit in the last place.

``two_product`` and ``two_sum`` are exact (Dekker; Knuth). With k**2 = s + l, |l| <= u s, the far
tail is exp(-s/2) R (1 - l/2 - d), d the relative rounding of k + 3/4: the true exp(-l/2) and
1/(1 + d) differ from these factors by l**2/8 + d**2 + |l d| < 2**-80. Up to 37.5 sigma no result is subnormal.
"""

from __future__ import annotations

import hashlib
import inspect
from pathlib import Path

import numpy as np
from flint import arb, arb_series, ctx

from quizgen.arrays import gaussian, polynomial, tables

PROOFS = Path(__file__).with_name("proofs.tsv")
UNIT = arb(2) ** -53
COMPENSATED = arb(2) ** -80
ORDER = 14
"""Terms of the Taylor series on a box."""


class Box:
    """Exact values over a box, and the largest error of the computed ones."""

    def __init__(self, value, error=0):
        self.value, self.error = arb(value), arb(error)

    def _rounded(self, value, error):
        return Box(value, (error + UNIT * (abs(value) + error)).upper())

    def __add__(self, other):
        other = other if isinstance(other, Box) else Box(other)
        return self._rounded(self.value + other.value, self.error + other.error)

    def __neg__(self):
        return Box(-self.value, self.error)

    def __sub__(self, other):
        return self + -(other if isinstance(other, Box) else Box(other))

    def __rsub__(self, other):
        return Box(other) - self

    def __mul__(self, other):
        other = other if isinstance(other, Box) else Box(other)
        error = abs(self.value) * other.error + abs(other.value) * self.error
        return self._rounded(self.value * other.value, error + self.error * other.error)

    def __truediv__(self, other):
        value = self.value / other.value
        error = (self.error + abs(value) * other.error) / (abs(other.value) - other.error)
        return self._rounded(value, error)

    __radd__, __rmul__ = __add__, __mul__


def boxes(low, high, count):
    """Interval cut into pieces that overlap in their ends."""
    width = (arb(high) - arb(low)) / count
    for i in range(count):
        yield arb(low) + width * (i + arb("0.5")) + arb(0, (width / 2).upper())


def farthest(difference, box):
    """Enclose a function over a box by its Taylor series in the middle."""
    middle, radius = arb(box.mid()), arb(0, box.rad().upper())
    terms = difference(arb_series([middle, 1], prec=ORDER)).coeffs()
    rest = difference(arb_series([box, 1], prec=ORDER)).coeffs()[-1]
    total = rest
    for term in reversed(terms[: ORDER - 1]):
        total = total * radius + term
    return total


def on_one(formula, box):
    """Run code for arrays on one box."""
    return formula(np.array([Box(box)], dtype=object))[0]


def far_difference(k):
    """Exact polynomial less (k + 3/4) Q(k) exp(k**2/2)."""
    t, total = (k - 4) / (k + 4), arb_series([0])
    for c in reversed(tables.MILLS):
        total = total * t + c
    tail = (k / arb(2).sqrt()).erfc() / 2
    return total - (k + arb("0.75")) * tail * (k * k / 2).exp()


def near_difference(k):
    """Exact polynomial less the probability beyond k."""
    square, total = k * k, arb_series([0])
    for c in reversed(tables.CENTRAL):
        total = total * square + c
    return arb("0.5") - k * total - (k / arb(2).sqrt()).erfc() / 2


def far_bound(box):
    """Relative error of the far tail: Mills' ratio, exponential, product, correction."""
    ratio = on_one(lambda k: gaussian.mills(k)[0], box)
    numerator = abs(ratio.value) * (box + arb("0.75"))
    missed = abs(farthest(far_difference, box)) / numerator
    return ratio.error / abs(ratio.value) + missed + 4 * UNIT + COMPENSATED


def near_bound(box):
    """Relative error of the near tail."""
    tail = on_one(gaussian.near_tail, box)
    return (tail.error + abs(farthest(near_difference, box))) / abs(tail.value)


PIECES = {
    "gaussian.far_tail": (far_bound, 0.6999, 37.5, 4000),
    "gaussian.near_tail": (near_bound, 0.0, 0.7, 200),
}
"""What is proven: relative error on a box, the domain, and into how many boxes it is cut."""


def digest():
    """Of everything that the proven functions run."""
    parts = (gaussian.mills, gaussian.far_tail, gaussian.near_tail, polynomial.horner, tables)
    return hashlib.sha256("".join(map(inspect.getsource, parts)).encode()).hexdigest()[:16]


def worst(bound, low, high, count):
    """Units in the last place: a unit is at least UNIT relative to the value."""
    return max(float((bound(box) / UNIT).upper()) for box in boxes(low, high, count))


def main():
    ctx.prec, ctx.cap = 300, ORDER
    rows = [
        f"{name}\t{worst(*piece):.2f}\t{piece[-1]}\t{digest()}" for name, piece in PIECES.items()
    ]
    PROOFS.write_text("\n".join(rows) + "\n")
    print(PROOFS.read_text(), end="")


if __name__ == "__main__":
    main()
