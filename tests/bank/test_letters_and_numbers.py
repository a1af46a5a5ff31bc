"""What a step says of letters holds of the drawn numbers, for every function that there is.

Each goes the whole way: a solver with letters, a template, a draw. What is right says SymPy of the
numbers themselves, SciPy or NumPy.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
import scipy.stats
import sympy
from flint import fmpq
from symbolic_bank import HEAD, write_questions
from sympy import Rational

import quizgen
from quizgen.bank.solvers import load_chain
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.maths.from_sympy import REWRITES
from quizgen.maths.numbers import to_float
from quizgen.maths.operators import LIST_OPERATORS, OPERATORS

HALF, THIRD = Rational(1, 2), Rational(1, 3)
ARGUMENTS = {
    "asin": (HALF,), "acos": (HALF,), "atanh": (HALF,), "acosh": (3,), "erfinv": (HALF,),
    "erfcinv": (HALF,), "atan2": (2, 3), "mod": (17, 5), "min": (3, HALF, 2), "max": (3, HALF, 2),
    "pow": (2, THIRD), "add": (2, HALF), "mul": (3, HALF), "div": (6, 4), "sub": (2, 5),
    "factorial": (5,), "zeta": (3,), "binomial": (7, 3), "beta": (2, 3), "besselj": (1, HALF),
    "bessely": (1, HALF), "besseli": (1, HALF), "besselk": (1, HALF), "lowergamma": (2, HALF),
    "uppergamma": (2, HALF), "normal_cdf": (HALF,), "normal_quantile": (THIRD,), "t_cdf": (2, 5),
    "t_quantile": (THIRD, 5), "chi2_cdf": (2, 5), "chi2_quantile": (THIRD, 5),
    "f_cdf": (2, 5, 7), "f_quantile": (THIRD, 5, 7), "Chi": (2,), "Ei": (2,), "elliptic_k": (THIRD,),
    "elliptic_e": (THIRD,), "elliptic_f": (HALF, THIRD), "expint": (2, HALF), "polylog": (2, HALF),
    "polygamma": (1, HALF), "legendre": (3, HALF), "chebyshevt": (3, HALF), "chebyshevu": (3, HALF),
    "hermite": (3, HALF), "laguerre": (3, HALF), "jacobi_symbol": (6, 35), "legendre_symbol": (6, 7),
    "mod_inverse": (6, 35), "n_order": (6, 35), "multiplicity": (2, 24), "gcd": (12, 18, 8),
    "lcm": (12, 18, 8), "stirling": (7, 3), "divisor_sigma": (12, 2), "numer": (Rational(6, 4),),
    "denom": (Rational(6, 4),), "asech": (HALF,), "acoth": (3,), "RisingFactorial": (3, 4),
    "FallingFactorial": (7, 3), "erf2": (HALF, 2), "jn": (1, HALF), "yn": (1, HALF), "asec": (3,),
    "acsc": (3,), "KroneckerDelta": (3, 3), "piecewise": (1, 2, 3), "sum": (1, 4, 2),
    "product": (1, 4, 2), "integral": (1, 4, 2), "catalan": (5,), "isprime": (17,), "prime": (7,),
    "prevprime": (24,), "reduced_totient": (24,), "primorial": (4,), "frac": (Rational(17, 5),),
    "floor": (Rational(-17, 5),), "ceil": (Rational(-17, 5),), "sign": (-3,), "abs": (-3,),
}  # fmt: skip
"""Arguments where 12, or one half for what is irrational, would not do."""
WRITTEN = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0}*{1}", "div": "{0}/{1}", "neg": "-{0}",
    "pow": "{0}**{1}", "log2": "log({0}, 2)", "log10": "log({0}, 10)", "pi": "pi + 0*{0}",
    "piecewise": "Piecewise(({0}, {1} > {2}), ({1}, {0} < {2}), ({2}, True))",
    "sum": "Sum(k**{2}, (k, {0}, {1}))", "product": "Product(k + {2}, (k, {0}, {1}))",
    "integral": "Integral(exp(-k**{2}), (k, {0}, {1}))",
    "multiplicity": "ntheory.multiplicity({0}, {1})", "n_order": "ntheory.n_order({0}, {1})",
    "stirling": "functions.combinatorial.numbers.stirling({0}, {1})",
    "nextprime": "ntheory.nextprime({0})", "primorial": "ntheory.primorial({0})",
    "gcd": "gcd(gcd({0}, {1}), {2})", "lcm": "lcm(lcm({0}, {1}), {2})",
}  # fmt: skip
"""What is not written as a call under SymPy's name."""
RELATIONS = {"eq": "Eq({0}, {1})", "ne": "Ne({0}, {1})", "lt": "{0} < {1}", "le": "{0} <= {1}",
             "gt": "{0} > {1}", "ge": "{0} >= {1}", "and": "And({0} < 9, {1} < 9)",
             "or": "Or({0} < 3, {1} < 9)", "not": "Not({0} < {1})"}  # fmt: skip
WHOLE = {
    "fibonacci", "lucas", "tribonacci", "bernoulli", "euler", "bell", "genocchi", "partition",
    "factorial2", "subfactorial", "totient", "mobius", "primenu", "primeomega", "primepi",
    "nextprime", "harmonic",
}  # fmt: skip
DISTRIBUTIONS = {"normal": scipy.stats.norm, "t": scipy.stats.t, "chi2": scipy.stats.chi2,
                 "f": scipy.stats.f}  # fmt: skip
BY_MPMATH = {
    "erf2": lambda a, b: mpmath.erf(b) - mpmath.erf(a), "erfcinv": lambda a: mpmath.erfinv(1 - a),
    "polylog": mpmath.polylog, "expint": mpmath.expint,
}  # fmt: skip
FUNCTIONS = (
    OPERATORS.keys() - LIST_OPERATORS - RELATIONS.keys() - {"round"}
    | {kind.__name__ for kind in REWRITES}
)  # fmt: skip
SAMPLE, OTHER = (3, 8, 1, 9, 4), (2, 7, 3, 6, 6)
LISTS = {
    "mean": np.mean, "var": lambda x: np.var(x, ddof=1), "sd": lambda x: np.std(x, ddof=1),
    "pvar": np.var, "psd": np.std, "median": np.median, "len": len, "list_sum": sum,
    "list_min": min, "list_max": max, "quantile": lambda x: np.quantile(x, 0.3),
    "cov": lambda x: np.cov(x, OTHER)[0, 1], "corr": lambda x: np.corrcoef(x, OTHER)[0, 1],
    "slope": lambda x: scipy.stats.linregress(x, OTHER).slope, "at": lambda x: x[1],
    "sort": lambda x: sorted(x)[1],
}  # fmt: skip


def arguments(name):
    return ARGUMENTS.get(name) or ((12,) if name in WHOLE else (HALF,))


def written(name, values):
    if name.endswith(("_cdf", "_quantile")):
        return f"Function('{name}')({', '.join(values)})"
    called = OPERATORS[name].function_in("sympy") if name in OPERATORS else name
    return WRITTEN.get(name, f"{called}({', '.join(['{}'] * len(values))})").format(*values)


def right(name):
    values = arguments(name)
    if name.endswith(("_cdf", "_quantile")):
        family, _, what = name.partition("_")
        function = getattr(DISTRIBUTIONS[family], {"cdf": "cdf", "quantile": "ppf"}[what])
        return function(*map(float, values))
    if name in BY_MPMATH:
        return float(BY_MPMATH[name](*map(mpmath.mpf, map(float, values))))
    space = {**vars(sympy), "k": sympy.Symbol("k"), "isprime": lambda n: int(sympy.isprime(n))}
    found = eval(written(name, [f"Rational('{one}')" for one in values]), space)
    return float(sympy.N(found.doit() if hasattr(found, "doit") else found, 20))


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    """Each function of letters by its name, with the numbers of a draw put in."""
    values = sorted({one for name in FUNCTIONS for one in arguments(name)})
    letters = {one: f"v_{n}" for n, one in enumerate(values)}
    steps = [
        f'Step("r_{n}", {written(name, [letters[one] for one in arguments(name)])})'
        for n, name in enumerate(sorted(FUNCTIONS))
    ]
    lists = [
        f'Step("l_{n}", {written_list(name)})' for n, name in enumerate(sorted(LIST_OPERATORS))
    ]
    conditions = [
        f'Step("c_{n}", Piecewise((1, {text.format("p", "q")}), (0, True)))'
        for n, text in enumerate(RELATIONS.values())
    ]
    names = [*letters.values(), "p", "q"]
    model = (
        "from quizgen.maths import lists\n"
        f"{', '.join(names)}, x, y, k = symbols('{' '.join(names)} x y k')\n"
        f"MODEL = Model(given={{**dict.fromkeys([{', '.join(names)}, x, y], '')}}, steps=(\n"
        + ",\n".join([*steps, *lists, *conditions]) + ",\n))\n"
    )  # fmt: skip
    draws = "".join(f'{letters[one]} = {{ pick = ["{one}"] }}\n' for one in values)
    draws += "p = { pick = [4] }\nq = { pick = [7] }\n"
    draws += f"x = {{ values = {list(SAMPLE)} }}\ny = {{ values = {list(OTHER)} }}\n"
    asked = ['kind = "number", of = "r_0", sigfigs = 4']
    folder = write_questions(tmp_path_factory.mktemp("all"), {"all": (model, draws, asked)})
    return draw_variant(quizgen.Bank(folder, trusted=True).template("all"), 1).values


def written_list(name):
    more = {"quantile": ", Rational(3, 10)", "at": ", 2"}.get(name, "")
    more = ", y" if name in {"cov", "corr", "slope"} else more
    text = f"lists.{OPERATORS[name].signs[0]}(x{more})"
    return f"lists.at({text}, 2)" if name == "sort" else text


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_a_function_of_letters_is_that_of_the_numbers(solved, name):
    found = to_float(solved[f"r_{sorted(FUNCTIONS).index(name)}"])
    assert found == pytest.approx(right(name), rel=1e-12, abs=1e-15)


def test_functions_of_lists_are_those_of_numpy(solved):
    found = {name: to_float(solved[f"l_{n}"]) for n, name in enumerate(sorted(LIST_OPERATORS))}
    assert found == pytest.approx({name: LISTS[name](SAMPLE) for name in LIST_OPERATORS}, rel=1e-12)


def test_conditions_are_those_of_numbers(solved):
    found = [solved[f"c_{n}"] for n in range(len(RELATIONS))]
    assert found == [0, 1, 1, 1, 0, 0, 1, 1, 0]


MODEL = """
a, b, c, d, s, x = symbols("a b c d s x")
MODEL = Model(given={{a: "", b: "", c: "", d: ""}}, free=("x",), steps=(Step(s, {}),))
"""
SQUARE = "Matrix([[a, b], [c, d]])"


def compile_step(folder, formula):
    (folder / "one.py").write_text(HEAD + MODEL.format(formula))
    return load_chain(folder, "one")[0]


@pytest.mark.parametrize(("formula", "value"), [
    ("numer(a/b)", 3), ("denom(a/b)", 2), ("numer(a/b)*denom(c/d)", 6),
    (f"{SQUARE}.rank()", 1), ("Matrix([[a, b, 1], [c, d, 2]]).rank()", 1),
    ("Matrix([[a, b, 0], [c, d, 1], [0, 0, a]]).rank()", 2),
    ("Piecewise((1, a == 6), (2, True))", 1), ("Piecewise((1, a == b), (2, True))", 2),
    ("Piecewise((1, a*d != b*c), (2, True))", 2), ("Add(*map(numer, [a/b, c/d]))", 6),
    ("Matrix([[a/b, c/d]]).applyfunc(denom)[0]", 2), (f"{SQUARE}.det()", 0),
    (f"{SQUARE}.trace()", 14), ("Matrix([[numer(a/b), 1], [1, 2]]).det()", 5),
])  # fmt: skip
def test_what_looks_at_numbers_waits_for_them(tmp_path, formula, value):
    numbers = {"a": fmpq(6), "b": fmpq(4), "c": fmpq(12), "d": fmpq(8)}
    assert compile_step(tmp_path, formula).solve(numbers)["s"] == value


@pytest.mark.parametrize("formula", [
    f"{SQUARE}.rref()[0][0, 1]", f"len({SQUARE}.nullspace())", f"len({SQUARE}.columnspace())",
    f"1 if {SQUARE}.is_symmetric() else 2", f"1 if {SQUARE}.is_diagonalizable() else 2",
    "1 if a.is_prime else 2", "numer(together(x/a + x/b)).coeff(x)", "fraction(a/b)[0]", "(a/b).as_numer_denom()[1]",
    "gcd_terms(a*x + b*x).coeff(x)*0 + len(factor_list(a*b)[1])",
    "1 if a == b else 2",
    "a.as_coeff_Mul()[0]", "content(a*x + b, x)", "count_ops(a + b)",
    "integer_nthroot(a, 2)[0]", "len(divisors(a))", "integer_log(a, 2)[0]",
])  # fmt: skip
def test_what_cannot_wait_is_refused_with_its_line(tmp_path, formula):
    with pytest.raises(BankError) as found:
        compile_step(tmp_path, formula)
    assert found.value.diagnostic(tmp_path).span.line == 7
