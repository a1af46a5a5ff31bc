"""Functions of number theory, combinatorics and physics on exact values, under SymPy's names.

Whole numbers give whole numbers or rationals; what is irrational is a certified ball. They run and
raise as those of ``special``.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import gcd, lcm, prod
from types import SimpleNamespace

from flint import acb, arb, fmpq, fmpz

from quizgen.core.errors import MathError
from quizgen.maths.values import Value

LARGEST_INDEX = 2000
"""Largest place in a sequence, largest degree of a polynomial."""
LARGEST_FACTORED = 10**18
"""Largest number that is factored."""
LARGEST_SIEVED = 10**5
"""Largest number up to which primes are counted."""


def _to_ball(a: Value) -> arb:
    """Return a value as a ball that encloses it, at the working precision if it was exact."""
    return a if isinstance(a, arb) else arb(a)


def _require_real(x: arb | acb) -> arb:
    """Return a ball; ``MathError`` if it is not finite, or not certainly real."""
    if isinstance(x, acb):
        if not x.imag.is_zero():
            raise MathError("no finite real value")
        x = x.real
    if not x.is_finite():
        raise MathError("no finite real value")
    return x


def _require_integer(a: Value, least: int, most: int) -> int:
    """Return a value as an integer; ``MathError`` if it is none, or beyond the bounds."""
    if not (isinstance(a, fmpq) and a.q == 1):
        raise MathError("a whole number is needed")
    if not least <= a.p <= most:
        raise MathError(f"a whole number from {least} to {most} is needed")
    return int(a.p)


def _require_rational(a: Value) -> fmpq:
    """Return a value that is a fraction; ``MathError`` if it is irrational."""
    if not isinstance(a, fmpq):
        raise MathError("a fraction is needed")
    return a


def _make_ball_function(compute: Callable[..., arb | acb]) -> Callable[..., Value]:
    """Return a function of balls as one of any values."""
    return lambda *args: _require_real(compute(*map(_to_ball, args)))


def _make_whole_function(
    compute: Callable[..., int | Fraction], least: int = 0, most: int = LARGEST_INDEX
) -> Callable[..., Value]:
    """Return a function of integers between bounds as one of any values."""

    def apply(*args: Value) -> Value:
        """Return its value, which is exact."""
        found = Fraction(compute(*(_require_integer(a, least, most) for a in args)))
        return fmpq(found.numerator, found.denominator)

    return apply


def _make_polynomial(
    first: Callable[[Value], Value], following: Callable[[int, Value, Value, Value], Value]
) -> Callable[[Value, Value], Value]:
    """Return orthogonal polynomials (degree, x): 1, ``first``, and what follows from two."""

    def apply(degree: Value, x: Value) -> Value:
        """Return the value of the polynomial; a rational for a rational."""
        before, current = fmpq(1), first(x)
        n = _require_integer(degree, 0, LARGEST_INDEX)
        for k in range(1, n):
            before, current = current, following(k, x, current, before)
        return current if n else before

    return apply


def _harmonic(n: Value, power: Value = fmpq(1)) -> Value:  # noqa: B008 - never changed
    """Return the sum of 1/k^power for k from 1 to n, of any n where the power is 1."""
    if power == 1 and not (isinstance(n, fmpq) and n.q == 1):
        return _require_real((_to_ball(n) + 1).digamma() + arb.const_euler())
    last, exponent = _require_integer(n, 0, LARGEST_INDEX), _require_integer(power, -50, 50)
    return sum((fmpq(1, k) ** exponent for k in range(1, last + 1)), fmpq(0))


def _bernoulli(n: int) -> Fraction:
    """Return a Bernoulli number; the first is 1/2, as SymPy has it since 1.12."""
    found = fmpq.bernoulli(n)
    return Fraction(1, 2) if n == 1 else Fraction(int(found.p), int(found.q))


def _fibonacci(n: int) -> int:
    """Return a Fibonacci number: 0, 1, 1, 2, 3."""
    return int(fmpz.fib_ui(n))


def _lucas(n: int) -> int:
    """Return a Lucas number: 2, 1, 3, 4."""
    return 2 * _fibonacci(n + 1) - _fibonacci(n)


def _tribonacci(n: int) -> int:
    """Return a tribonacci number: 0, 1, 1, 2, 4."""
    a, b, c = 0, 1, 1
    for _ in range(n):
        a, b, c = b, c, a + b + c
    return a


def _genocchi(n: int) -> Fraction:
    """Return a Genocchi number as SymPy has it: 0, -1, -1, 0, 1."""
    return 2 * (1 - 2**n) * _bernoulli(n)


def _double_factorial(n: int) -> int:
    """Return n (n - 2) (n - 4) ... down to 1 or 2."""
    return prod(range(n, 0, -2))


def _subfactorial(n: int) -> int:
    """Return the number of permutations that leave nothing in its place."""
    found = 1
    for k in range(1, n + 1):
        found = found * k + (-1) ** k
    return found


def _factor(n: int) -> list[tuple[int, int]]:
    """Return the prime factors of a positive number with their powers."""
    return [(int(p), int(k)) for p, k in fmpz(n).factor()]


def _reduced_totient(n: int) -> int:
    """Return the least power that is 1 for every number without common factors (Carmichael)."""
    return lcm(*(
        2 ** (k - 2) if p == 2 and k > 2 else p ** (k - 1) * (p - 1) for p, k in _factor(n)
    ))  # fmt: skip


def _count_primes(n: int) -> int:
    """Return the number of primes up to n."""
    return sum(_sieve(n))


def _sieve(n: int) -> bytearray:
    """Return 1 at the place of each prime up to n, else 0."""
    marks = bytearray(b"\0\0" + b"\1" * (n - 1))[: n + 1]
    for k in range(2, int(n**0.5) + 1):
        if marks[k]:
            marks[k * k :: k] = bytes(len(marks[k * k :: k]))
    return marks


def _next_prime(n: int) -> int:
    """Return the smallest prime above n."""
    found = n + 1
    while not fmpz(found).is_prime():
        found += 1
    return found


def _previous_prime(n: int) -> int:
    """Return the largest prime below n."""
    return next(k for k in range(n - 1, 1, -1) if fmpz(k).is_prime())


def _find_prime(n: int) -> int:
    """Return the prime at a place; the first is 2."""
    found = 1
    for _ in range(n):
        found = _next_prime(found)
    return found


def _divide_out(p: int, n: int) -> int:
    """Return how often p divides n."""
    if p < 2:
        raise MathError("a divisor of at least 2 is needed")
    count = 0
    while n % p == 0:
        n, count = n // p, count + 1
    return count


def _invert_modulo(a: int, m: int) -> int:
    """Return the inverse of a modulo m; ``MathError`` if there is none."""
    if gcd(a, m) != 1:
        raise MathError("no inverse: a common factor")
    return pow(a, -1, m)


def _find_order(a: int, n: int) -> int:
    """Return the least power of a that is 1 modulo n; ``MathError`` if none is."""
    if gcd(a, n) != 1:
        raise MathError("no power is 1: a common factor")
    order = _reduced_totient(n)
    for p, _ in _factor(order):
        while order % p == 0 and pow(a, order // p, n) == 1 % n:
            order //= p
    return order


def _jacobi(a: int, n: int) -> int:
    """Return the Jacobi symbol; ``MathError`` unless n is odd."""
    if n % 2 == 0:
        raise MathError("an odd number is needed below")
    return int(fmpz(a).jacobi(fmpz(n)))


def _legendre_symbol(a: int, p: int) -> int:
    """Return whether a is a square modulo an odd prime; ``MathError`` for another number."""
    if not fmpz(p).is_prime():
        raise MathError("an odd prime is needed below")
    return _jacobi(a, p)


def _take_pairwise(combine: Callable[[int, int], int]) -> Callable[[Value, Value], Value]:
    """Return gcd or lcm of two values, of which formulas fold longer lists."""
    return _make_whole_function(combine, -LARGEST_FACTORED, LARGEST_FACTORED)


_SEQUENCES: dict[str, Callable[..., int | Fraction]] = {
    "fibonacci": _fibonacci,
    "lucas": _lucas,
    "tribonacci": _tribonacci,
    "bernoulli": _bernoulli,
    "genocchi": _genocchi,
    "euler": lambda n: int(fmpz.euler_number(n)),
    "bell": lambda n: int(fmpz.bell_number(n)),
    "partition": lambda n: int(fmpz(n).partitions_p()),
    "factorial2": _double_factorial,
    "subfactorial": _subfactorial,
    "stirling": lambda n, k: int(fmpz.stirling_s2(n, k)),
}
_OF_POSITIVE: dict[str, Callable[..., int | Fraction]] = {
    "totient": lambda n: int(fmpz(n).euler_phi()),
    "reduced_totient": _reduced_totient,
    "mobius": lambda n: int(fmpz(n).moebius_mu()),
    "primenu": lambda n: len(_factor(n)),
    "primeomega": lambda n: sum(k for _, k in _factor(n)),
    "nextprime": _next_prime,
    "mod_inverse": _invert_modulo,
    "n_order": _find_order,
    "jacobi_symbol": _jacobi,
    "legendre_symbol": _legendre_symbol,
    "multiplicity": _divide_out,
    "isprime": lambda n: int(fmpz(n).is_prime()),
}
_OF_BALLS: dict[str, Callable[..., arb | acb]] = {
    "Ei": arb.ei,
    "Si": arb.si,
    "Ci": arb.ci,
    "Shi": arb.shi,
    "Chi": arb.chi,
    "li": arb.li,
    "Li": lambda x: x.li() - arb(2).li(),
    "erfi": arb.erfi,
    "fresnels": arb.fresnel_s,
    "fresnelc": arb.fresnel_c,
    "airyai": arb.airy_ai,
    "airybi": arb.airy_bi,
    "airyaiprime": lambda x: x.airy_ai(derivative=1),
    "airybiprime": lambda x: x.airy_bi(derivative=1),
    "loggamma": arb.lgamma,
    "digamma": arb.digamma,
    "elliptic_k": lambda m: acb(m).elliptic_k(),
    "elliptic_e": lambda m: acb(m).elliptic_e(),
    "elliptic_f": lambda phi, m: acb.elliptic_f(acb(phi), acb(m)),
    "dirichlet_eta": lambda s: acb(s).dirichlet_eta(),
    "expint": lambda s, x: x.expint(s),
    "polylog": lambda s, x: x.polylog(s),
    "polygamma": lambda n, x: acb(x).polygamma(acb(n)),
}


def _sum_divisors(n: Value, power: Value = fmpq(1)) -> Value:  # noqa: B008 - never changed
    """Return the sum of the powers of all divisors; their number for the power 0."""
    of, exponent = _require_integer(n, 1, LARGEST_FACTORED), _require_integer(power, 0, 50)
    return fmpq(fmpz.divisor_sigma(fmpz(of), exponent))


FUNCTIONS = SimpleNamespace(
    **{name: _make_ball_function(compute) for name, compute in _OF_BALLS.items()},
    **{name: _make_whole_function(compute) for name, compute in _SEQUENCES.items()},
    **{
        name: _make_whole_function(compute, 1, LARGEST_FACTORED)
        for name, compute in _OF_POSITIVE.items()
    },
    prevprime=_make_whole_function(_previous_prime, 3, LARGEST_FACTORED),
    primepi=_make_whole_function(_count_primes, 0, LARGEST_SIEVED),
    prime=_make_whole_function(_find_prime, 1),
    primorial=_make_whole_function(lambda n: prod(_find_prime(k) for k in range(1, n + 1)), 1, 100),
    numer=lambda a: fmpq(_require_rational(a).p),
    denom=lambda a: fmpq(_require_rational(a).q),
    gcd=_take_pairwise(gcd),
    lcm=_take_pairwise(lcm),
    harmonic=_harmonic,
    divisor_sigma=_sum_divisors,
    legendre=_make_polynomial(
        lambda x: x, lambda k, x, now, before: ((2 * k + 1) * x * now - k * before) / (k + 1)
    ),
    chebyshevt=_make_polynomial(lambda x: x, lambda _k, x, now, before: 2 * x * now - before),
    chebyshevu=_make_polynomial(lambda x: 2 * x, lambda _k, x, now, before: 2 * x * now - before),
    hermite=_make_polynomial(
        lambda x: 2 * x, lambda k, x, now, before: 2 * x * now - 2 * k * before
    ),
    laguerre=_make_polynomial(
        lambda x: 1 - x, lambda k, x, now, before: ((2 * k + 1 - x) * now - k * before) / (k + 1)
    ),
)
"""Each operator of ``operators.FURTHER`` by its name."""
