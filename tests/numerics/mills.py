"""How far the code for Mills' ratio is off."""

from __future__ import annotations

from enclosures import farthest, on_one
from flint import arb, arb_series

from quizgen.numerics import gaussian, tables


def far_difference(k):
    """Exact polynomial less (k + 3/4) Q(k) exp(k**2/2)."""
    t, total = (k - 4) / (k + 4), arb_series([0])
    for c in reversed(tables.MILLS):
        total = total * t + c
    tail = (k / arb(2).sqrt()).erfc() / 2
    return total - (k + arb("0.75")) * tail * (k * k / 2).exp()


def mills_error(box):
    """The computed ratio, and its relative error."""
    ratio = on_one(lambda k: gaussian.mills_ratio(k)[0], box)
    numerator = abs(ratio.value) * (box + arb("0.75"))
    return ratio.value, ratio.error / abs(ratio.value) + abs(
        farthest(far_difference, box)
    ) / numerator
