"""Compute the coefficients in ``quizgen/numerics/tables.json`` with mpmath; prints the file.

Run: ``python tests/numerics/make_coefficients.py > quizgen/numerics/tables.json``
"""

from __future__ import annotations

import json

import mpmath as mp

mp.mp.dps = 60

SHIFT = mp.mpf("0.75")
SCALE = mp.mpf(4)
TERMS = 27


def mills(k):
    """Tail over exp(-k**2/2): Q(k) exp(k**2/2)."""
    k = mp.mpf(k)
    if k > 1000:
        return sum((-1) ** n * mp.fac2(2 * n - 1) / k ** (2 * n + 1) for n in range(8)) / mp.sqrt(
            2 * mp.pi
        )
    return mp.erfc(k / mp.sqrt(2)) / 2 * mp.exp(k * k / 2)


def shaped(t):
    """(k + SHIFT) times Mills' ratio, as a function of t = (k - SCALE)/(k + SCALE)."""
    if t == 1:
        return 1 / mp.sqrt(2 * mp.pi)
    k = SCALE * (1 + t) / (1 - t)
    return (k + SHIFT) * mills(k)


def chebyshev(function, terms):
    """Interpolate at Chebyshev points; coefficients of T_0, T_1, ..."""
    points = 2 * terms
    nodes = [mp.cos(mp.pi * (i + mp.mpf(1) / 2) / points) for i in range(points)]
    values = [function(x) for x in nodes]
    return [
        (2 - (j == 0))
        * sum(v * mp.cos(j * mp.pi * (i + mp.mpf(1) / 2) / points) for i, v in enumerate(values))
        / points
        for j in range(terms)
    ]


def to_powers(coefficients):
    """Chebyshev coefficients to power coefficients."""
    total = [mp.mpf(0)] * len(coefficients)
    before, current = [mp.mpf(1)], [mp.mpf(0), mp.mpf(1)]
    for j, c in enumerate(coefficients):
        polynomial = before if j == 0 else current
        for i, p in enumerate(polynomial):
            total[i] += c * p
        if j:
            following = [mp.mpf(0)] + [2 * p for p in current]
            for i, p in enumerate(before):
                following[i] -= p
            before, current = current, following
    return total


def found():
    """All of them, to be rounded to doubles."""
    return {
        "mills_shift": SHIFT,
        "mills_scale": SCALE,
        "mills": to_powers(chebyshev(shaped, TERMS)),
    }


if __name__ == "__main__":
    print(json.dumps(found(), default=float, indent=1))
