"""A bound for the gap enc(mean) - mean(enc), over all values and exponents e between 0 and 1.

With g(q) = 1 - ((1 + d)**e + (1 - d)**e)/2, q = d**2, the even part of Cauchy's formula around the
cut of (1 - d)**e gives

    g(q)/q = sin(pi e)/(2 pi) integral over t from 1 of (sqrt(t) - 1)**e/(t (t - q)) dt,

a positive measure times h_t = 1/(t - q). In w = q/(1 - b q), and with s = t/(1 - b t), h_t is
(1 + b s) (1 + b w)/(s - w): a single pole s, which is at least 2.9 or at most -1/b. So whatever is
linear in g/q and at most c h_t(w) for every t is at most c g/q: rounding is bounded that way, for
all e at once. Interpolation is off by h_t(w) omega(w)/omega(s) (1 + b s)/(1 + b w), with omega
the product of the distances to the nodes, and that is summed over t, in boxes of e and of w.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from enclosures import UNIT
from flint import arb

from quizgen.arrays import gamma_gap

SLACK = 1 + 1e-9
"""More than the rounding of these sums of positive doubles."""
BEND, CENTRE, MIDST, WIDE = (
    gamma_gap._BEND, gamma_gap._CENTRE, gamma_gap._MIDST, gamma_gap._WIDE,
)  # fmt: skip
COUNT = 19
ENDS = 1 / (1 - BEND), -1 / BEND
"""The poles next to the interval of w: t = 1 and t without end."""
CELLS = np.concatenate([[1.0], 1 + np.geomspace(1e-5, 1e8, 1500)])
"""Of t, and all beyond."""


def nodes():
    """Of the interpolation in w, as the kernel takes them."""
    asked = []
    gamma_gap._interpolate(lambda x: (asked.append(float(x)), x)[1], 0.0, 2 * CENTRE, CENTRE, COUNT)
    return np.array(asked)


def pole(t):
    """The pole s of a t."""
    return t / (1 - BEND * t)


def missed(w):
    """Largest relative error of the interpolation for w in a box, by cells of t and the rest."""
    points = nodes()
    omega = np.prod([np.maximum(abs(w[0] - x), abs(w[1] - x)) for x in points])

    def share(t):  # |1 + b s|/|omega(s)|, with |1 + b s| = |s|/t
        return abs(pole(t)) / t / np.prod([abs(pole(t) - x) for x in points], axis=0)

    # on either side of the interval it sinks with the distance of s
    ends = share(CELLS)
    beyond = 1 / CELLS[-1] * abs(pole(CELLS[-1])) / np.prod([abs(ENDS[1] - x) for x in points])
    return omega / (1 + BEND * w[0]) * np.append(np.maximum(ends[1:], ends[:-1]), beyond)


def interpolation(w):
    """The same against the sum over all t, for the worst box of e."""
    q = [x / (1 + BEND * x) for x in w]
    low, high = CELLS[:-1], CELLS[1:]
    most = (high - low) / (low * (low - q[1])) if q[1] < 1 else np.inf
    least = (high - low) / (high * (high - q[0]))
    errors, worst = missed(w), 0.0
    roots = np.sqrt(low) - 1, np.sqrt(high) - 1
    bounds = np.linspace(0.0, 1.0, 41)
    for first, last in pairwise(bounds):
        above = np.maximum(roots[1] ** first, roots[1] ** last)
        below = np.minimum(roots[0] ** first, roots[0] ** last) if first else np.minimum(
            np.where(roots[0] > 0, 1.0, 0.0), roots[0] ** last
        )  # fmt: skip
        tail = CELLS[-1] ** (last / 2 - 1) / (1 - last / 2) / (1 - q[1] / CELLS[-1])
        total = float(above @ (most * errors[:-1]) + tail * errors[-1])
        worst = max(worst, total / float(below @ least))
    return worst * SLACK


def rounding(w):
    """What rounding adds to the polynomial in w, relative to g/q, for w in a box.

    Coefficients next to the centre c are (1 + b s)**2/(s - c)**(k + 1) of h_t. Both (1 + b s)/(s - c)
    and (s - w)/(s - c) are monotonic in s on either side. Of the polynomial they differ by what
    omega(x)/(omega(s) (s - x)) has at most. The k-th takes 2 k roundings and its own; w is off by
    what q, the denominator and the quotient are, x by one more.
    """
    c, (low, high) = CENTRE, w
    away = max(abs(low - c), abs(high - c))
    right, left = ENDS
    grown = max(
        max((1 + BEND * right) / (right - c), BEND) * max((right - low) / (right - c), 1.0),
        BEND * max((high - left) / (c - left), 1.0),
    )
    nearest = min(right - c, c - left)
    sums = sum(
        (2 * k + 1) * grown / (1 + BEND * low) * away**k / nearest ** (k - 1)
        for k in range(1, COUNT)
    )
    points = nodes()
    besides = max(
        (1 + BEND * right) * (right - low) / np.prod(abs(right - points)),
        BEND * (c - left) * max(high - left, c - left) / np.prod(abs(left - points)),
    )
    majorant = np.prod(away + abs(points - c)) / (nearest - away)
    sums += 2 * COUNT * majorant * besides / (1 + BEND * low)
    q = high / (1 + BEND * high)
    shift = high * ((1 + BEND * high) + (1 + BEND * q) / (1 - BEND * q) + 1) + away
    slope = max(right / ((1 + BEND * low) * (right - high)), BEND / (1 + BEND * low))
    return (sums + slope * shift) * SLACK


def narrow_bound(w):
    """Bound for d up to 0.85: the polynomial, and one product; q is a pair."""
    ends = max(float(w.lower()), 0.0), float(w.upper())
    return arb(interpolation(ends)) + UNIT * (rounding(ends) + 1 + 2**-18) + powered()


def powered():
    """The power of the mean (4), two products and a sum; far away its scale (4)."""
    return (4 + 3 + 4) * UNIT


ZEROS = np.concatenate([[0.0], np.geomspace(1e-300, 0.1501, 4000)])
"""Of x = 1 - d."""


def wide_bound(e):
    """Bound for d from 0.85, where x**e is a power.

    Twice the shape is, less its lines, A + B: of e < 0.27 A = -((2 - x)**e - 1) and B = 1 - x**e, of
    e > 0.75 A = (2 - x) (1 - (2 - x)**-f) and B = -(x**e - x), f = 1 - e, and A = 2 - (2 - x)**e and
    B = -x**e between. B is right to 4 units (power, or exponential of a pair less 1, and product).
    Of the polynomial around the middle, 0.075 away at most, only what is multiplied with that is
    rounded: four units of the slope, and a few of terms that are forty times smaller each; what 13
    nodes leave out is below 2**-70. Where x is small, it is the lower half of d, which is right to
    8 units; else that is 2**-26 beside it.
    """
    first, last = max(float(e.lower()), 0.0), min(float(e.upper()), 1.0)
    low, high = ZEROS[:-1], ZEROS[1:]
    ways = []
    if first <= gamma_gap._FLAT:
        ways.append(flat(first, min(last, gamma_gap._FLAT), low, high))
    if last >= gamma_gap._STEEP:
        ways.append(steep(1 - last, 1 - max(first, gamma_gap._STEEP), low, high))
    if last >= gamma_gap._FLAT and first <= gamma_gap._STEEP:
        ways.append(between(first, last, low, high))
    return arb(max(ways) * SLACK) * UNIT + powered()


def grown(z):
    """(exp(z) - 1)/z, which rises."""
    z = np.asarray(z, float)
    return np.divide(np.expm1(z), z, out=np.ones_like(z), where=z != 0)


def total(own, slope, turned, shape):
    """Units: 4 of B, 4 of the slope and less of the next terms, 8 of x by what it turns B."""
    assert (shape > 0).all()
    return float(((4 * own + 4.2 * 0.0751 * slope + turned) / shape).max())


def turned(low):
    """How far x is off, relative, in units, between this and the next."""
    return 8 * np.minimum(1.0, 2.0**-26 / np.maximum(low, 1e-300))


def flat(first, last, low, high):
    """All by e: (1 - x**e)/e falls with e and x, ((2 - x)**e - 1)/e rises with e and falls with x."""
    long, log = -np.log(high), np.log(2 - low)
    least = long * grown(-last * long)
    shape = least - log * grown(last * log)
    return total(least, np.ones_like(low), high**first * turned(low), shape)


def steep(first, last, low, high):
    """All by f: x (x**-f - 1)/f rises with f, and with x up to 0.3; A/f falls with f and x.

    Moving x moves B by x (ln x + ...) of it, which is nothing where x is off.
    """
    log, long = np.log(2 - high), -np.log(high)
    least, most = (2 - high) * log * grown(-last * log), high * long * grown(last * long)
    return total(most, 1 + np.log(2 - low), (most + high ** (1 - last)) * turned(low), least - most)


def between(first, last, low, high):
    """Both powers at their greatest."""
    most = high**first
    shape = 2 - (2 - low) ** last - most
    return total(most, np.full_like(low, last), last * most * turned(low), shape)


def far_bound(_):
    """Bound where x is below 2**-900, for e below 0.1.

    Its logarithm is at least 623, of three terms of together 1500 that are off by two units each and
    two sums; the exponentials less 1 take one to three units, and A is at most 0.2 B.
    """
    logarithm = (2 * 1500 + 1500) * UNIT / 623
    return ((logarithm + 4 * UNIT) * 5 / 4) + 2 * UNIT + powered()
