"""Functions of other subjects: at whole numbers and rationals as SymPy has them, else as mpmath."""

from __future__ import annotations

import mpmath
import pytest
import sympy
from flint import arb, fmpq
from sweep import together
from sympy.functions.combinatorial.numbers import stirling
from sympy.ntheory import multiplicity, n_order, nextprime, prevprime, primorial

from quizgen.core.errors import MathError
from quizgen.maths.further import FUNCTIONS
from quizgen.maths.operators import FURTHER
from quizgen.maths.precision import working_precision

OTHERS = {
    "stirling": stirling, "n_order": n_order, "multiplicity": multiplicity,
    "nextprime": nextprime, "prevprime": prevprime, "primorial": primorial,
}  # fmt: skip
HALF = sympy.Rational(1, 2)
SEQUENCES = (
    "fibonacci", "lucas", "tribonacci", "bernoulli", "euler", "bell", "genocchi", "partition",
    "factorial2", "subfactorial", "primorial", "totient", "reduced_totient", "mobius", "primenu",
    "primeomega", "primepi", "prime", "nextprime", "prevprime", "isprime", "harmonic",
    "divisor_sigma",
)  # fmt: skip
POLYNOMIALS = ("legendre", "chebyshevt", "chebyshevu", "hermite", "laguerre")
WHOLE = [
    *((name, (n,)) for name in SEQUENCES for n in (3, 4, 12, 17, 30)),
    *((name, (n, HALF)) for name in POLYNOMIALS for n in (0, 1, 4)),
    ("stirling", (7, 3)), ("stirling", (5, 0)), ("mod_inverse", (3, 11)), ("n_order", (3, 7)),
    ("n_order", (2, 15)), ("multiplicity", (2, 24)), ("multiplicity", (5, 24)),
    ("jacobi_symbol", (5, 21)), ("legendre_symbol", (5, 11)), ("gcd", (12, 18)), ("gcd", (-4, 6)),
    ("lcm", (12, 18)), ("numer", (HALF * 3,)), ("denom", (HALF * 3,)), ("harmonic", (6, 2)), ("divisor_sigma", (12, 0)),
]  # fmt: skip
REAL = {
    "Ei": mpmath.ei, "Si": mpmath.si, "Ci": mpmath.ci, "Shi": mpmath.shi, "Chi": mpmath.chi,
    "li": mpmath.li, "Li": lambda x: mpmath.li(x, offset=True), "erfi": mpmath.erfi,
    "fresnels": mpmath.fresnels, "fresnelc": mpmath.fresnelc, "airyai": mpmath.airyai,
    "airybi": mpmath.airybi, "airyaiprime": lambda x: mpmath.airyai(x, derivative=1),
    "airybiprime": lambda x: mpmath.airybi(x, derivative=1), "loggamma": mpmath.loggamma,
    "digamma": mpmath.digamma, "elliptic_k": mpmath.ellipk, "elliptic_e": mpmath.ellipe,
    "dirichlet_eta": mpmath.altzeta, "expint": mpmath.expint, "polylog": mpmath.polylog,
    "polygamma": mpmath.polygamma, "elliptic_f": mpmath.ellipf, "harmonic": mpmath.harmonic,
}  # fmt: skip
REFUSED = [
    ("fibonacci", "1/2"), ("fibonacci", -1), ("prime", 10**9), ("totient", 0), ("Ei", 0),
    ("elliptic_k", 2), ("mod_inverse", 6, 9), ("n_order", 6, 9), ("jacobi_symbol", 3, 8),
    ("legendre_symbol", 3, 9), ("multiplicity", 1, 9), ("legendre", "1/2", 1), ("polylog", 2, 2),
]  # fmt: skip


def compute(name, *args):
    with working_precision():
        return getattr(FUNCTIONS, name)(
            *(fmpq(int(x.p), int(x.q)) for x in map(sympy.Rational, args))
        )


def test_each_function_of_the_table_is_tried():
    assert {name for name, _ in WHOLE} | REAL.keys() == FURTHER.keys()


@together(("name", "args"), WHOLE)
def test_whole_numbers_are_exact_and_those_of_sympy(name, args):
    function = OTHERS.get(name) or getattr(sympy, name)
    found = compute(name, *args)
    right = sympy.Rational(int(function(*args)) if name == "isprime" else function(*args))
    assert found == fmpq(int(right.p), int(right.q))


@together("name", REAL)
def test_other_values_are_balls_around_those_of_mpmath(name):
    args = [2, "0.5"][2 - FURTHER[name][0] :] if name != "harmonic" else ["0.5"]
    found = compute(name, *args)
    with mpmath.workdps(30), working_precision():
        right = arb(str(REAL[name](*map(mpmath.mpf, args))))
        assert abs(found - right) < arb(10) ** -25


@together(("name", "args"), [(name, args) for name, *args in REFUSED])
def test_what_has_no_value_is_refused(name, args):
    with pytest.raises(MathError):
        compute(name, *args)
