"""Operators on lists against NumPy and the statistics module, exactly where these are exact."""

from __future__ import annotations

import statistics
from fractions import Fraction

import numpy as np
import pytest
import sympy
from flint import fmpq
from sweep import together

from quizgen.core.errors import FormulaError, MathError
from quizgen.maths import lists
from quizgen.maths.from_sympy import from_sympy
from quizgen.maths.notation import format_tree, parse_formula
from quizgen.maths.number_systems import compile_expr, evaluate, exact_system, float64_system
from quizgen.maths.numbers import to_float, to_fraction
from quizgen.maths.values import NumberList
from quizgen.typeset import lay_out, to_latex, to_mathml, to_speech, to_typst

X = ["3.1", "2.4", "5.0", "4.4", "2.2", "-1.3"]
Y = ["1", "3", "2", "5", "4", "0.5"]
TEXTS = {"x": X, "y": Y}
EXACT = {
    name: NumberList(fmpq(*Fraction(t).as_integer_ratio()) for t in TEXTS[name]) for name in TEXTS
}
FLOATS = {name: NumberList(map(float, texts)) for name, texts in TEXTS.items()}
FX, FY = map(np.array, FLOATS.values())
EXPECTED = {
    "mean(x)": FX.mean(), "sum(x)": FX.sum(), "var(x)": FX.var(ddof=1), "pvar(x)": FX.var(),
    "sd(x)": FX.std(ddof=1), "psd(x)": FX.std(), "median(x)": np.median(FX), "len(x)": 6,
    "min(x)": FX.min(), "max(x)": FX.max(), "quantile(x, 1/4)": np.quantile(FX, 0.25),
    "quantile(x, 0.9)": np.quantile(FX, 0.9), "quantile(x, 1)": 5.0, "quantile(x, 0)": -1.3,
    "cov(x, y)": np.cov(FX, FY)[0, 1], "corr(x, y)": np.corrcoef(FX, FY)[0, 1],
    "slope(x, y)": np.polyfit(FX, FY, 1)[0], "x[1]": 3.1, "x[len(x)]": -1.3,
    "at(sort(x), 2)": 2.2, "max(x[1], 4)": 4.0, "max(x) - min(x)": 6.3,
}  # fmt: skip


@together("text", EXPECTED)
def test_values_are_those_of_numpy(text):
    tree = parse_formula(text, symbols=["x", "y"])
    assert to_float(evaluate(tree, EXACT)) == pytest.approx(EXPECTED[text], rel=1e-12)
    found = compile_expr(tree, float64_system())(FLOATS)
    assert found == pytest.approx(EXPECTED[text], rel=1e-12)


@pytest.mark.parametrize(
    ("text", "exactly"),
    [
        ("mean(x)", statistics.mean),
        ("var(x)", statistics.variance),
        ("pvar(x)", statistics.pvariance),
        ("median(x)", statistics.median),
    ],
)
def test_what_is_rational_is_exact(text, exactly):
    found = evaluate(parse_formula(text), EXACT)
    assert to_fraction(found) == exactly([Fraction(one) for one in X])


@together("text", EXPECTED)
def test_a_formula_is_written_as_it_is_read_and_printed_everywhere(text):
    tree = parse_formula(text)
    assert parse_formula(format_tree(tree)) == tree
    node = lay_out(tree)
    for write in (to_latex, to_mathml, to_typst):
        assert write(node)
    assert all(to_speech(node, lang) for lang in ("en", "bn", "de"))


@together(
    ("text", "what"),
    [
        ("x[0]", "the first is 1"),
        ("x[7]", "no place 7"),
        ("x[1.5]", "whole number"),
        ("quantile(x, 2)", "share from 0 to 1"),
        ("mean(y[1])", "a number stands where a list is needed"),
        ("cov(x, z)", "cannot be paired"),
        ("var(o)", "where 2 are needed"),
    ],
)
def test_what_has_no_value_says_why(text, what):
    env = {**EXACT, "z": NumberList(EXACT["x"][:3]), "o": NumberList(EXACT["x"][:1])}
    with pytest.raises(MathError, match=what):
        compile_expr(parse_formula(text), exact_system())(env)


def test_too_many_arguments_are_a_slip():
    with pytest.raises(FormulaError, match="argument count"):
        parse_formula("mean(x, y)")


@pytest.mark.parametrize(
    ("written", "text"),
    [
        (lambda x, y: lists.mean(x) - lists.min(y), "mean(x) - min(y)"),
        (lambda x, _y: lists.sum(x) / (lists.len(x) - 1), "sum(x)/(len(x) - 1)"),
        (lambda x, _y: lists.quantile(x, sympy.Rational(1, 4)), "quantile(x, {1/4})"),
        (lambda x, y: lists.at(lists.sort(x), 2) * lists.corr(x, y), "at(sort(x), 2)*corr(x, y)"),
    ],
)
def test_a_solver_writes_them_by_name(written, text):
    x, y = sympy.symbols("x y")
    with sympy.evaluate(False):
        expression = written(x, y)
    assert format_tree(from_sympy(expression)) == text


def test_a_letter_has_a_bar_for_its_mean():
    assert to_latex(lay_out(parse_formula("mean(x)"))) == r"\bar{x}"


@together("text", ["mean(x + y)", "2*x", "x*2", "x < y", "max(x, y)", "x + 1", "-x"])
def test_no_sum_joins_lists_and_no_sign_orders_them(text):
    for system, env in ((exact_system(), EXACT), (float64_system(), FLOATS)):
        with pytest.raises(TypeError):
            compile_expr(parse_formula(text), system)(env)
