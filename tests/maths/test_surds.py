"""Exact values at special angles, and formulas that drawn numbers choose, against SymPy."""

from __future__ import annotations

import pytest
import sympy

from quizgen.core.errors import BankError
from quizgen.maths.constants import parse_exact
from quizgen.maths.model import Model, Step
from quizgen.maths.notation import format_tree, parse_formula, pretty
from quizgen.maths.numbers import to_float, to_rational
from quizgen.maths.tidy import tidy_formula

SPECIAL = [k for k in range(-30, 31) if k % 2 == 0 or k % 3 == 0]


@pytest.mark.parametrize("name", ["sin", "cos", "tan"])
def test_a_function_of_a_special_angle_is_a_fraction_times_a_root(name):
    for k in SPECIAL:
        exact = getattr(sympy, name)(sympy.pi * sympy.Rational(k, 12))
        if exact is sympy.zoo or (name == "tan" and k % 12 == 6):
            continue
        found = format_tree(tidy_formula(parse_formula(f"{name}({k}*pi/12)", symbols=())))
        assert name not in found, (k, found)
        assert to_float(parse_exact(found)) == pytest.approx(float(exact), abs=1e-15)


@pytest.mark.parametrize(("typed", "angle"), [
    ("asin(1/2)", "π/6"), ("asin(-sqrt(3)/2)", "−π/3"), ("asin(-1)", "−π/2"), ("asin(0)", "0"),
    ("acos(-1/2)", "2π/3"), ("acos(sqrt(2)/2)", "π/4"), ("acos(0)", "π/2"), ("acos(-1)", "π"),
    ("atan(1)", "π/4"), ("atan(-sqrt(3))", "−π/3"), ("atan(sqrt(3)/3)", "π/6"),
])  # fmt: skip
def test_a_special_value_belongs_to_a_fraction_of_pi(typed, angle):
    found = tidy_formula(parse_formula(typed, symbols=()))
    assert pretty.format_constant(format_tree(found)) == angle


@pytest.mark.parametrize(("typed", "tidied"), [
    ("9*(sqrt(2)/2)", "9√2/2"), ("pi/6 + 2*pi/3", "5π/6"), ("sqrt(2)*sqrt(8)", "4"),
    ("3/sqrt(3)", "√3"), ("pi - 3*pi", "−2π"), ("sqrt(2) - sqrt(2)", "0"),
])  # fmt: skip
def test_constants_are_written_as_by_hand(typed, tidied):
    found = tidy_formula(parse_formula(typed, symbols=()))
    assert pretty.format_constant(format_tree(found)) == tidied


def bind(model: Model, name: str, **values: int) -> str:
    chain = model.chain()
    numbers = {key: to_rational(value) for key, value in values.items()}
    return format_tree(chain.bind_form(chain.form_by_name[name].expr, numbers))


def test_a_drawn_number_chooses_among_formulas_and_sizes_of_matrices():
    k, a, x = sympy.symbols("k a x")
    one, two = sympy.Matrix([[a, 1]]), sympy.Matrix([[1, a], [0, 1]])
    model = Model(
        given={k: "", a: ""},
        free=("x",),
        steps=(
            Step("f", sympy.Piecewise((a * x, sympy.Eq(k, 1)), (sympy.sin(x), True))),
            Step("A", sympy.Piecewise((one, sympy.Eq(k, 1)), (two, True))),
        ),
    )
    assert [bind(model, "f", k=n, a=5) for n in (1, 2)] == ["5*x", "sin(x)"]
    assert [bind(model, "A", k=n, a=5) for n in (1, 2)] == ["[5, 1]", "[1, 5; 0, 1]"]


def test_the_last_of_several_formulas_needs_no_condition():
    k, x = sympy.symbols("k x")
    cases = sympy.Piecewise((x, sympy.Eq(k, 1)), (2 * x, sympy.Eq(k, 2)))
    with pytest.raises(BankError, match="must hold otherwise"):
        Model(given={k: ""}, free=("x",), steps=(Step("f", cases),)).chain()


@pytest.mark.parametrize(("typed", "tidy"), [
    ("x^2 - 3*x - 2*x + 6", "x^2 - 5*x + 6"), ("x^2 + 3*x - 3*x + 1", "x^2 + 1"),
    ("x/2 + x/3", "{5/6}*x"), ("-x - x", "-2*x"), ("3*x^2*y + x^2*y - 5", "4*x^2*y - 5"),
    ("a*x + b*x", "a*x + b*x"), ("x + x^2", "x + x^2"), ("exp(x) - x", "exp(x) - x"),
])  # fmt: skip
def test_like_terms_are_put_together(typed, tidy):
    found = tidy_formula(parse_formula(typed, symbols=("a", "b", "x", "y")))
    assert format_tree(found) == tidy
