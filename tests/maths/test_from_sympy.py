"""SymPy expressions keep the order in which they were written."""

from __future__ import annotations

import math
import subprocess
import sys
from fractions import Fraction

import pytest
import sympy as sp
from sweep import together

from quizgen.core.errors import BankError
from quizgen.maths.from_sympy import from_sympy
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import evaluate, float64_system
from quizgen.maths.tree import Call, Num, names_in

f, X, Z, x, p, c, t = sp.symbols("f X Z x p c t")
mu, sigma, N, q, z = sp.symbols("mu sigma N q z")
R, G, B, H, V, Delta = sp.symbols("R G B H V Delta")
pi, S = sp.pi, sp.S


with sp.evaluate(False):
    WRITTEN = [
        (f * X / Z, "f*X/Z"),
        (f * (X / Z), "f*(X/Z)"),
        (X / Z * f, "(X/Z)*f"),
        (1 / Z * f, "(1/Z)*f"),
        (-x / p + c, "-(x/p) + c"),
        (c - x / p, "c - x/p"),
        (x - p + c, "(x - p) + c"),
        (sp.Add(x, -p, c, evaluate=False), "(x - p) + c"),
        ((t - mu) / sigma, "(t - mu)/sigma"),
        (sp.erfc(z / sp.sqrt(2)) / 2, "erfc(z/sqrt(2))/2"),
        (N * (1 - q), "N*(1 - q)"),
        (1 / (1 / f - 1 / Z), "1/(1/f - 1/Z)"),
        (sp.Max(R, G, B), "max(R, G, B)"),
        (sp.Min(1, sp.Max(0, x)), "min(1, max(0, x))"),
        (1 - sp.Abs(sp.Mod(H / 60, 2) - 1), "1 - abs(mod(H/60, 2) - 1)"),
        (sp.log(x, 2), "log2(x)"),
        (20 * sp.log(x, 10), "20*log10(x)"),
        (sp.log(x), "ln(x)"),
        (sp.log(x, 3), "ln(x)/ln(3)"),
        (x**0.5, "x^0.5"),
        (x**S.Half, "sqrt(x)"),
        (x ** (-S.Half), "1/sqrt(x)"),
        (x**-2, "1/x^2"),
        (x ** (1 / Z), "x^(1/Z)"),
        (x**2.2, "x^2.2"),
        (x / p / c, "x/(p*c)"),
        (x - 3, "x - 3"),
        (3 - x, "3 - x"),
        (-2 * x, "-2*x"),
        (-(x + p), "-(x + p)"),
        (-x * p, "-(x*p)"),
        (1 - 2 * x, "1 - 2*x"),
        (0.1 * x, "0.1*x"),
        (2 * pi * x, "2*pi*x"),
        (sp.exp(-((t - mu) ** 2) / (2 * sigma**2)), "exp(-((t - mu)^2/(2*sigma^2)))"),
        (sp.E**x, "exp(x)"),
        (sp.floor(H / 60), "floor(H/60)"),
        (sp.ceiling(x), "ceil(x)"),
        (sp.sign(x), "sign(x)"),
        (sp.sin(x) + sp.cos(x) + sp.tan(x), "(sin(x) + cos(x)) + tan(x)"),
        (sp.asin(x) * sp.acos(x) * sp.atan(x), "asin(x)*acos(x)*atan(x)"),
        (sp.atan2(x, p), "atan2(x, p)"),
        (sp.erf(x), "erf(x)"),
        (sp.Eq(x, p), "x = p"),
        (sp.Ne(x, p), "x != p"),
        (sp.Or(x < 0, sp.Not(x <= 2)), None),
        (sp.Piecewise((0, x < 0), (1, sp.And(x >= 0, x < 2)), (2, True)), None),
        (
            sp.Piecewise((60 * (G - B) / Delta, sp.Eq(V, R)), (60 * (2 + (B - R) / Delta), True)),
            "piecewise(60*(G - B)/Delta, V = R, 60*(2 + (B - R)/Delta))",
        ),
        (sp.Rational(1, 3) * x, None),
    ]


def _same(left, right):
    """Equal trees, except that -2 may be a number or a sign and sums may be nested."""
    return _plain(left) == _plain(right)


def _plain(tree):
    if not isinstance(tree, Call):
        return tree
    args = [_plain(arg) for arg in tree.args]
    if tree.op == "neg" and isinstance(args[0], Num):
        return Num(-args[0].value, args[0].decimal)
    if tree.op in {"add", "mul"}:
        flat = []
        for arg in args:
            flat += arg.args if isinstance(arg, Call) and arg.op == tree.op else [arg]
        args = flat
    return Call(tree.op, tuple(args))


@together(("written", "text"), [pair for pair in WRITTEN if pair[1]])
def test_order_is_kept(written, text):
    assert _same(from_sympy(written), parse_formula(text))


VALUES = {
    key: 0.3 + 0.05 * index
    for index, key in enumerate(
        map(str, (f, X, Z, x, p, c, t, mu, sigma, N, q, z, R, G, B, H, V, Delta))
    )
}


@together("written", [written for written, _ in WRITTEN if isinstance(written, sp.Expr)])
def test_value_is_what_sympy_computes(written):
    with sp.evaluate(True):
        point = {symbol: VALUES[symbol.name] for symbol in written.free_symbols}
        expected = float(written.subs(point).doit().evalf())
    tree = from_sympy(written)
    assert names_in(tree) == {symbol.name for symbol in written.free_symbols}
    assert evaluate(tree, VALUES, float64_system()) == pytest.approx(expected, rel=1e-12)


@together(
    ("written", "expected"),
    [
        (sp.coth(x), math.cosh(2.5) / math.sinh(2.5)),
        (sp.acot(x), math.atan(0.4)),
        (sp.sinc(x), math.sin(2.5) / 2.5),
        (sp.frac(x), 0.5),
        (sp.catalan(sp.Symbol("x") * 2), 42),
        (sp.Heaviside(x - 1), 1),
    ],
)
def test_other_functions_are_said_by_those_there_are(written, expected):
    with sp.evaluate(True):
        tree = from_sympy(written)
    assert evaluate(tree, {"x": 2.5}, float64_system()) == pytest.approx(expected)


def test_decimals_are_the_typed_ones():
    assert from_sympy(sp.Float(2.2)) == Num(Fraction(11, 5), decimal=True)
    assert from_sympy(sp.Float("0.1")) == Num(Fraction(1, 10), decimal=True)
    assert from_sympy(sp.Float("0.12345678901234567890")) == Num(
        Fraction("0.12345678901234567890"), decimal=True
    )
    assert from_sympy(1e-9) == Num(Fraction(1, 10**9), decimal=True)
    assert from_sympy(3) == Num(Fraction(3))
    assert from_sympy(sp.Rational(20, 3)) == Num(Fraction(20, 3))


def test_conditions():
    with sp.evaluate(False):
        tree = from_sympy(sp.Piecewise((0, x < 0), (1, sp.And(x >= 0, x < 2)), (2, True)))
    assert tree.op == "piecewise"
    assert [evaluate(tree, {"x": at}, float64_system()) for at in (-1.0, 0.0, 1.9, 2.0)] == [
        0,
        1,
        1,
        2,
    ]


@together(
    "bad",
    [
        sp.Function("g")(x),
        sp.stieltjes(x),
        sp.euler(p, x),
        sp.Integral(x, x),
        sp.Sum(x, (x, 0, sp.oo)),
        sp.Derivative(x**2, x, evaluate=False),
        sp.Matrix([x]),
        sp.I,
        sp.oo,
        sp.nan,
        sp.S.true,
        sp.TribonacciConstant,
        sp.Piecewise((1, x < 0)),
        sp.Symbol("A", commutative=False) * sp.Dummy() * sp.I,
        "x",
        None,
        True,
        sp.Float("inf"),
    ],
)
def test_everything_else_is_refused(bad):
    with pytest.raises(BankError):
        from_sympy(bad)


def test_printing_does_not_load_sympy():
    code = "import sys, quizgen.typeset; sys.exit('sympy' in sys.modules or 'numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
