"""A bound for the lower Poisson tail by Temme's expansion, over all counts beyond 60 next to the mean.

With a = k + 1, lambda = x/a, mu = lambda - 1, eta**2/2 = mu - ln(1 + mu) and eta of the sign of mu:

    Q(a, x) = erfc(eta sqrt(a/2))/2 + exp(-a eta**2/2)/sqrt(2 pi a) S(a, eta).

As dQ/deta = -sqrt(a/2 pi) exp(-a eta**2/2) g(eta)/G(a), where g = eta/mu and G is Gamma(a) over
Stirling's formula, S' - a eta S = a (1 - g/G). The terms c_k of the expansion fulfil this power by
power: c_0 = (g - 1)/eta, c_k = (c_(k-1)' + gamma_k g)/eta, where gamma_k are the coefficients of
1/G. So T = S - (c_0 + ... + c_(K-1)/a**(K-1)) fulfils T' - a eta T = -r with

    |r| <= a**(1-K) (|c_(K-1)'| + |g| |gamma_K + gamma_(K+1)/a + ...|),

and, integrated from a border farther out, where it is T_2, |T| is at most
|T_2| exp(-a (eta_2**2 - eta**2)/2) + max|r| sqrt(pi/(2 a)).
"""

from __future__ import annotations

from contextlib import contextmanager
from functools import cache, reduce

import numpy as np
from counted import SECOND, excess_error
from enclosures import UNIT, Box, boxes
from flint import acb, arb, ctx, fmpq, fmpq_series
from mills import mills_error

from quizgen.arrays import tables
from quizgen.arrays.polynomial import horner

LEAST = 61
"""Of a = k + 1."""
BELOW, ABOVE = arb("0.5") - arb(2) ** -40, arb("1.5") + arb(2) ** -40
"""Ends of lambda, with what rounding adds."""
BORDERS = (fmpq(2, 5), fmpq(19, 10))
"""Of lambda, from which T is integrated."""
EXACTLY = 400
"""Up to this a, T is computed at the borders; beyond, the distance to them is enough."""
TERMS = 60
"""Of each series, of which all else is enclosed."""
ROWS = len(tables.TEMME)
CIRCLE = 2
"""Radius in eta on which g is enclosed: its series converges to 2 sqrt(pi) (Temme 1979)."""
LIMIT = arb(27) / 32
"""More than |eta| at the borders."""


@contextmanager
def terms(count):
    """Series of so many terms."""
    before, ctx.cap = ctx.cap, count
    try:
        yield
    finally:
        ctx.cap = before


def largest(*values):
    """Of enclosures, whichever it is."""
    return reduce(arb.max, values)


def eta(ratio):
    """Of lambda."""
    size = (2 * (ratio - 1 - ratio.log())).sqrt()
    return size if ratio > 1 else -size


@cache
def series_of_g():
    """First coefficients of g = eta/mu, by reversion of eta(mu) = mu sqrt(1 - 2 mu/3 + ...)."""
    count = TERMS + 2 * ROWS + 2
    with terms(count + 2):
        logarithm = fmpq_series([1, 1]).log().coeffs()
        shape = fmpq_series([-2 * c for c in logarithm[2:]]).sqrt()
        mu = fmpq_series([0, *shape.coeffs()]).reversion()
        return (1 / fmpq_series(mu.coeffs()[1:])).coeffs()[:count]


@cache
def stirling(count=TERMS, known=15):
    """Coefficients of exp(-L) in 1/a, for the first terms of Stirling's series L, and these."""
    log = [fmpq(0)] * (2 * known)
    for n in range(1, known + 1):
        log[2 * n - 1] = fmpq.bernoulli(2 * n) / (2 * n * (2 * n - 1))
    with terms(count):
        return (-fmpq_series(log)).exp().coeffs(), log


@cache
def largest_g(pieces=1200):
    """Bound |g| = |eta/(exp(w) - 1)| where exp(w) - 1 - w = eta**2/2, on the circle.

    On each arc Krawczyk's operator proves one w in a box. Arcs share their ends, and what is proven
    of one lies in the box of the next: it is one branch all around, real and positive on the right.
    """
    middle, most, before = acb(CIRCLE), arb(0), None
    for n in range(pieces + 1):
        angle = 2 * arb.pi() * n / pieces
        exact = CIRCLE * acb(angle.cos(), angle.sin())
        arc = angle + arb(0, (arb("3.3") / pieces).upper())
        point = CIRCLE * acb(arc.cos(), arc.sin())
        for _ in range(30):
            rise = middle.exp() - 1
            middle -= (rise - middle - exact * exact / 2) / rise
            middle = acb(middle.real.mid(), middle.imag.mid())
        box = middle + acb(arb(0, "0.04"), arb(0, "0.04"))
        slope = 1 / (middle.exp() - 1)
        residual = middle.exp() - 1 - middle - point * point / 2
        found = middle - slope * residual + (1 - slope * (box.exp() - 1)) * (box - middle)
        assert box.contains_interior(found)
        assert before is None or box.contains(before)
        assert n % pieces or (found.imag.contains(0) and found.real > 0)
        before, most = found, largest(most, abs(point / (found.exp() - 1)))
    return most


@cache
def rows():
    """First coefficients of c_0 to c_(K-1)."""
    g = series_of_g()
    found = [g[1:]]
    for k in range(1, ROWS):
        last, gamma = found[-1], stirling()[0][k]
        assert last[1] + gamma * g[0] == 0
        found.append([(n + 2) * last[n + 2] + gamma * g[n + 1] for n in range(len(last) - 2)])
    return found


def rest_of(k, radius):
    """Bound on all terms of c_k from `TERMS` on, within a radius, and on those of its derivative.

    |g_n| is at most G/2**n (Cauchy), and so |c_n| of row k B_k(n)/2**n by its recursion. Terms
    shrink by half at least.
    """
    gammas, g = stirling()[0], largest_g()

    def most(row, n):
        own = abs(arb(gammas[row])) * g / 2
        return own + (n + 2) * most(row - 1, n + 2) / 4 if row else own

    n = TERMS
    assert most(k, n + 1) * (n + 1) * radius < most(k, n) * n
    first = most(k, n) * (radius / CIRCLE) ** n
    return 2 * first, 2 * n * first / radius


def missing():
    """How far the table is from c_0 + c_1/a + ..., for any eta and a of the domain."""
    radius, total = -eta(BELOW), arb(0)
    for k, (row, exact) in enumerate(zip(tables.TEMME, rows(), strict=True)):
        kept = [*map(arb, row), *[arb(0)] * (TERMS - len(row))]
        apart = [
            abs(arb(c) - d) * radius**n for n, (c, d) in enumerate(zip(exact, kept, strict=False))
        ]
        total += (sum(apart, arb(0)) + rest_of(k, radius)[0]) / arb(LEAST) ** k
    return total


def residual():
    """Bound on |r| a**(K-1): of c_(K-1)' and of what 1/G has beyond its first K terms.

    Of Stirling's series the first term left out bounds the rest; exp(-L) has by Cauchy small
    coefficients from `TERMS` on.
    """
    coefficients, log = stirling()
    last = rows()[-1]
    slope = sum(
        (n * abs(arb(c)) * LIMIT ** (n - 1) for n, c in enumerate(last[:TERMS]) if n), arb(0)
    )
    far = fmpq(1, 4)
    growth = sum((abs(arb(c)) * arb(far) ** n for n, c in enumerate(log)), arb(0)).exp()
    beyond = growth * (1 / (far * LEAST)) ** TERMS * 2 * arb(LEAST) ** ROWS
    later = sum((abs(arb(c)) / arb(LEAST) ** n for n, c in enumerate(coefficients[ROWS:])), arb(0))
    n = len(log) // 2 + 1
    left_out = abs(arb(fmpq.bernoulli(2 * n))) / (2 * n * (2 * n - 1)) / arb(LEAST) ** (2 * n - 1)
    rest = 2 * left_out * 2 * arb(LEAST) ** ROWS
    return slope + rest_of(ROWS - 1, LIMIT)[1] + largest_g() * (later + beyond + rest)


def at_border(a, ratio):
    """T for a at a border, from the incomplete gamma function itself."""
    ratio = arb(ratio)
    way = eta(ratio)
    normal = (abs(way) * (arb(a) / 2).sqrt()).erfc() / 2
    x = ratio * a
    tail = x.gamma_upper if ratio > 1 else x.gamma_lower
    apart = (tail(arb(a), 1) - normal) * (1 if ratio > 1 else -1)
    exact = (2 * arb.pi() * a).sqrt() * (a * way * way / 2).exp() * apart
    for k, row in enumerate(rows()):
        value = sum((arb(c) * way**n for n, c in enumerate(row[:TERMS])), arb(0))
        exact -= (value + arb(0, rest_of(k, abs(way))[0].upper())) / arb(a) ** k
    return abs(exact)


@cache
def truncation():
    """Bound on |T| over the domain.

    It shrinks on the way from the borders. Beyond `EXACTLY` it is at most |S| + 1 there, and |S| at
    most sqrt(2 pi a) by Chernoff.
    """
    inside = residual() / arb(LEAST) ** (ROWS - 1) * (arb.pi() / (2 * LEAST)).sqrt()
    found = []
    for border, end in zip(BORDERS, (BELOW, ABOVE), strict=True):
        way = (eta(arb(border)) ** 2 - eta(end) ** 2) / 2
        found += [at_border(a, border) * (-a * way).exp() for a in range(LEAST, EXACTLY + 1)]
        found.append(((2 * arb.pi() * EXACTLY).sqrt() + 1) * (-EXACTLY * way).exp())
        assert way * EXACTLY > 1  # from where on the last one shrinks
    return inside + largest(*found)


def shape(low, high):
    """Of S between two etas: least and largest size, and what rounding adds to it.

    The way eta is off by two roots and a quotient, and by half of the excess' rounding.
    """
    inverse = arb(1) / (2 * LEAST)
    reciprocal = Box(inverse + arb(0, inverse.upper()), UNIT / LEAST)
    sizes, errors = [], []
    for way in boxes(low, high, 100):
        point = np.array([Box(way, 4 * UNIT * abs(way))], dtype=object)
        total = Box(0)
        for row in reversed(tables.TEMME):
            total = total * reciprocal + horner(row, point)[0]
        sizes.append(abs(total.value))
        errors.append(total.error)
    return reduce(arb.min, sizes).lower(), largest(*sizes).upper(), largest(*errors)


@cache
def known():
    """How far the expansion is off, and the shape of S with the farthest eta below and above 1."""
    below, above = eta(BELOW), eta(ABOVE)
    sides = (-below, *shape(below, arb(0))), (above, *shape(arb(0), above))
    return missing() + truncation(), sides


def lower_bound(root):
    """Relative error of the lower tail, for |eta| sqrt(a) in a box, while the value is normal.

    Mills' ratio, of a root that is off by 3/2 units, is off by no more than that besides its own
    error, as its slope is at most 1 relative to both. S/sqrt(2 pi a) stands beside it: W below is
    the ratio over that. The root of a, the constant, their product and the quotient are 4 units; the
    exponential, the sum, the product and the correction 5; the complement of what is at most 0.52
    another one. What the correction leaves out is of second order.
    """
    ratio, missed = mills_error(root)
    missed += 3 * UNIT / 2
    off, sides = known()
    sums = []
    for above, (way, least, most, rounded) in enumerate(sides):
        weight = (
            (2 * arb.pi()).sqrt() * largest(arb(LEAST).sqrt(), root.lower() / way) * ratio.lower()
        )
        beside = weight - most if above else weight + least
        sums.append((weight * missed + 4 * UNIT * most + rounded + off) / beside)
    error = largest(*sums, missed) + 5 * UNIT + excess_error() + arb(2) ** -75 + SECOND
    return error * arb("0.52") / arb("0.48") + UNIT
