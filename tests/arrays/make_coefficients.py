"""Compute the coefficients in ``quizgen/arrays/tables.json`` with mpmath; prints the file.

Run: ``python tests/arrays/make_coefficients.py > quizgen/arrays/tables.json``
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


def central(terms):
    """Taylor coefficients of P(0 < n < k)/k in k**2."""
    return [
        (-1) ** j / (mp.mpf(2) ** j * mp.factorial(j) * (2 * j + 1) * mp.sqrt(2 * mp.pi))
        for j in range(terms)
    ]


def temme(orders, terms):
    """Taylor coefficients in eta of c_0, c_1, ... of the incomplete gamma function.

    Temme, SIAM J. Math. Anal. 10 (1979) 757; Gil, Segura & Temme (2007) section 8.3.
    """
    size = terms + 2 * orders + 4
    # mu = lambda - 1 as a series in eta, from eta**2/2 = mu - ln(1 + mu).
    alpha = [mp.mpf(0), mp.mpf(1)]
    for n in range(2, size + 2):
        inner = sum(i * alpha[i] * alpha[n + 1 - i] for i in range(2, n))
        alpha.append((alpha[n - 1] - inner) / (n + 1))
    # 1/mu = (1/eta) * 1/(1 + alpha_2 eta + ...)
    inverse = [mp.mpf(1)]
    for n in range(1, size):
        inverse.append(-sum(alpha[i + 1] * inverse[n - i] for i in range(1, n + 1)))
    over_mu = inverse  # coefficient n belongs to eta**(n - 1)
    c = [over_mu[n + 1] for n in range(size - 1)]
    gammas = stirling_gamma(orders + 1)
    result = [c]
    for k in range(1, orders):
        derivative = [(n + 1) * c[n + 1] for n in range(len(c) - 1)]
        # c_k = (1/eta) c_{k-1}' + gamma_k/mu, whose terms in 1/eta cancel.
        c = [derivative[n + 1] + gammas[k] * over_mu[n + 1] for n in range(len(derivative) - 1)]
        result.append(c)
    return [row[:terms] for row in result]


def stirling_gamma(count):
    """Signed coefficients of the Stirling series of 1/Gamma*(a) as in Temme: (-1)**k gamma_k."""
    # Gamma*(a) ~ sum g_k a**-k from exp of sum B_2j/(2j(2j-1)a**(2j-1)).
    log = [mp.mpf(0)] * (count + 1)
    for j in range(1, count + 1):
        if 2 * j - 1 <= count:
            log[2 * j - 1] = mp.bernoulli(2 * j) / (2 * j * (2 * j - 1))
    g = [mp.mpf(1)]
    for n in range(1, count + 1):
        g.append(sum(i * log[i] * g[n - i] for i in range(1, n + 1)) / n)
    # 1/Gamma* has coefficients with alternating signs: (-1)**k g_k.
    return [(-1) ** k * value for k, value in enumerate(g)]


def stirling_error(k):
    """ln k! minus Stirling's formula."""
    if k == 0:
        return mp.mpf(0)
    return mp.log(mp.factorial(k)) - (k + mp.mpf(1) / 2) * mp.log(k) + k - mp.log(2 * mp.pi) / 2


def found():
    """All of them, to be rounded to doubles."""
    return {
        "mills_shift": SHIFT,
        "mills_scale": SCALE,
        "mills": to_powers(chebyshev(shaped, TERMS)),
        "central": central(19),
        "stirling": [stirling_error(k) for k in range(16)],
        "temme": temme(9, 26),
    }


if __name__ == "__main__":
    print(json.dumps(found(), default=float, indent=1))
