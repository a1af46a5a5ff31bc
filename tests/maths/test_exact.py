"""The exact number system: rational as long as it can be, certain or undecided beyond."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import arb, fmpq
from sweep import together

from quizgen.core.errors import MathError, UndecidedError
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import evaluate

TWO = "sqrt(2)*sqrt(2)"
"""Equal to 2, which no ball can certify."""


def value(text: str):
    return evaluate(parse_formula(text), {})


@together("sign", ["<", "<=", ">", ">=", "=", "!="])
@together("sides", [(TWO, "2"), ("2", TWO), (TWO, TWO)])
def test_what_cannot_be_certified_is_neither_true_nor_false(sign, sides):
    with pytest.raises(UndecidedError):
        value(f"{sides[0]} {sign} {sides[1]}")


@together("text", [
    f"min({TWO}, 2)", f"max({TWO}, 2)", f"floor({TWO})", f"ceil({TWO})", f"round({TWO} + 1/2)",
    f"sign({TWO} - 2)", f"piecewise(1, {TWO} < 2, 0)", f"mod({TWO}, 2)", f"not {TWO} = 2",
    f"({TWO} - 2)^(1/3)", f"ln({TWO} - 2)",
])  # fmt: skip
def test_nor_is_anything_that_rests_on_it(text):
    with pytest.raises(UndecidedError):
        value(text)


@together(("text", "expected"), [
    ("sqrt(2) < 3/2", True), ("sqrt(2) > 3/2", False), ("sqrt(2) <= 3/2", True),
    ("3/2 >= sqrt(2)", True), ("sqrt(2) >= 3/2", False), ("sqrt(2) = 3/2", False),
    ("sqrt(2) != 3/2", True), ("2/3 < 2/3", False), ("2/3 <= 2/3", True), ("2/3 = 4/6", True),
])  # fmt: skip
def test_what_is_certain_is_decided(text, expected):
    assert value(text) is expected


@together(("text", "expected"), [
    ("sqrt(4/9)", "2/3"), ("sqrt(0)", "0"), ("(9/4)^(1/2)", "3/2"), ("(2/3)^-3", "27/8"),
    ("log2(8)", "3"), ("log2(1/8)", "-3"), ("log10(1000)", "3"), ("log10(1)", "0"), ("exp(0)", "1"),
    ("erf(0)", "0"), ("erfc(0)", "1"), ("mod(-7/2, 2)", "1/2"), ("floor(-sqrt(2))", "-2"),
    ("ceil(-sqrt(2))", "-1"), ("round(-5/2)", "-3"), ("round(sqrt(2))", "1"), ("0^sqrt(2)", "0"),
])  # fmt: skip
def test_rational_values_stay_rational(text, expected):
    found = value(text)
    assert isinstance(found, fmpq)
    assert Fraction(int(found.p), int(found.q)) == Fraction(expected)


@together("text", ["sqrt(2)", "sqrt(4/3)", "sqrt(3/4)", "sqrt(8/9)", "2^(1/2)",
                                  "log2(6)", "log10(2)", "log2(8/3)", "exp(1)", "pi"])  # fmt: skip
def test_irrational_values_are_balls_of_the_working_precision(text):
    found = value(text)
    assert isinstance(found, arb)
    assert 140 < found.rel_accuracy_bits() < 200


@pytest.mark.parametrize(("text", "square"), [("sqrt(2)", 2), ("sqrt(4/3)", "4/3"),
                                              ("sqrt(3/4)", "3/4")])  # fmt: skip
def test_a_root_is_the_number_whose_square_it_is(text, square):
    root = value(text).mid().fmpq()
    found = Fraction(int(root.p), int(root.q)) ** 2
    assert 0 < abs(found - Fraction(square)) < Fraction(1, 10**40)


@together("text", ["1/0", "sqrt(-1)", "0^-1", "ln(0)", "log2(-1)", "(-2)^(1/3)",
                                  "asin(2)", "(-sqrt(2))^(1/2)", "sqrt(-sqrt(2))"])  # fmt: skip
def test_what_has_no_real_value_is_an_error(text):
    with pytest.raises(MathError):
        value(text)


@pytest.mark.parametrize(("text", "wanted"), [
    ("(1 - sqrt(2))^2", 0.1715728752538099), ("(1 - sqrt(2))^3", -0.07106781186547524),
    ("(1 - sqrt(2))^-2", 5.82842712474619), ("cos(2)^2", 0.17317818956819406),
    ("(sqrt(2)*sqrt(2) - 2)^2", 0.0),
])  # fmt: skip
def test_whole_powers_of_negative_balls_have_a_value(text, wanted):
    assert abs(float(value(text)) - wanted) < 1e-14


@pytest.mark.parametrize("text", ["(1 - sqrt(2))^(1/3)", "(1 - sqrt(2))^sqrt(2)", "cos(2)^0.5"])
def test_other_powers_of_negative_balls_have_none(text):
    with pytest.raises(MathError):
        value(text)


@pytest.mark.parametrize("count", [64, 65, 400, 1990])
def test_runs_of_one_sign_may_be_as_long_as_a_line(count):
    assert value("+".join(["1"] * count)) == count
    assert value("*".join(["2"] * (count - 1)) + "/2") == fmpq(2) ** (count - 2)
    assert value("1-" + "+".join(["1/3"] * (count // 2))) == 1 + fmpq(count // 2 - 2, 3)
