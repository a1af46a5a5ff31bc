"""Equality of formulas: identities that hold, near misses that do not, and on what ground."""

from __future__ import annotations

from functools import partial

import pytest
from sweep import together

from quizgen.grading.judging.algebraic_equality import prove_equal
from quizgen.grading.judging.sympy_equality import decide_by_sympy
from quizgen.kinds.grade import grade_answer
from quizgen.maths.notation import parse_formula

EQUAL = [
    ("(x+1)^2", "x^2+2*x+1", {"x": "real"}),
    ("(x^2-1)/(x-1)", "x+1", {"x": "positive"}),
    ("1/x + 1/y", "(x+y)/(x*y)", {"x": "real", "y": "real"}),
    ("sin(2*x)", "2*sin(x)*cos(x)", {"x": "real"}),
    ("ln(x*y)", "ln(x)+ln(y)", {"x": "positive", "y": "positive"}),
    ("sqrt(x^2)", "abs(x)", {"x": "real"}),
    ("exp(x+y)", "exp(x)*exp(y)", {"x": "real", "y": "real"}),
    ("atan(x)+atan(1/x)", "pi/2", {"x": "positive"}),
    ("2*atan(d/(2*f))", "2*asin(d/sqrt(d^2+4*f^2))", {"d": "positive", "f": "positive"}),
    ("erfc(x)", "1-erf(x)", {"x": "real"}),
    ("max(x, y)", "(x+y+abs(x-y))/2", {"x": "real", "y": "real"}),
    ("x^(1/3)*x^(2/3)", "x", {"x": "positive"}),
    ("floor(x)", "-ceil(-x)", {"x": "real"}),
    ("log2(x)", "ln(x)/ln(2)", {"x": "positive"}),
    ("-4*(-1)^n/n", "4*(-1)^(n+1)/n", {"n": "whole"}),
    ("-4*(-1)^n/n", "-4*cos(pi*n)/n", {"n": "whole"}),
    ("f*z/(z-f)", "1/(1/f-1/z)", {"f": [1, 2], "z": [3, 4]}),
]

DIFFERENT = [
    ("x^5+x+1", "x^5+x+1.0000000000000001", {"x": "real"}),
    ("sqrt(x^2)", "x", {"x": "real"}),
    ("ln(x^2)", "2*ln(x)", {"x": "real"}),
    ("sqrt(x*y)", "sqrt(x)*sqrt(y)", {"x": "real", "y": "real"}),
    ("acos(cos(x))", "x", {"x": [0, 10]}),
    ("x^2", "x^2.0000000001", {"x": "positive"}),
    ("sin(x)", "x", {"x": "real"}),
    ("x", "x + 10^-25", {"x": "real"}),
    ("99999999/10^8", "99999998/99999999", {}),
    ("x*y", "x+y", {"x": "real", "y": "real"}),
    ("abs(x*y)", "x*y", {"x": "real", "y": "positive"}),
    ("pi", "355/113", {}),
    ("-4*(-1)^n/n", "4/n", {"n": "whole"}),
    ("cos(pi*n)", "1", {"n": "whole"}),
    ("n^2", "n^3", {"n": "whole"}),
    ("max(x, y)", "x", {"x": "real", "y": "real"}),
    ("(x-1)^8-x^8+8*x^7-28*x^6+56*x^5-70*x^4+56*x^3-28*x^2+8*x", "2", {"x": "real"}),
]


@together(("key", "typed", "symbols"), EQUAL)
def test_equal(key, typed, symbols):
    for first, second in ((key, typed), (typed, key)):
        spec = {"kind": "expression", "value": first, "symbols": symbols}
        assert grade_answer(spec, second).verdict == "correct"


@together(("key", "typed", "symbols"), DIFFERENT)
def test_different(key, typed, symbols):
    spec = {"kind": "expression", "value": key, "symbols": symbols}
    assert grade_answer(spec, typed).verdict == "wrong"


def test_where_the_key_has_no_value_nothing_is_asked_of_the_answer():
    """The key decides where the formula matters: ln(x^2) is 2 ln(x) wherever that is defined."""
    for key, typed in (("2*ln(x)", "ln(x^2)"), ("sqrt(x)*sqrt(y)", "sqrt(x*y)")):
        spec = {"kind": "expression", "value": key, "symbols": {"x": "real", "y": "real"}}
        assert grade_answer(spec, typed).verdict == "correct"


@pytest.mark.parametrize(
    ("key", "typed", "ground"),
    [
        ("f*X", "fX", "proved"),
        ("(f+X)^2", "f²+2fX+X²", "proved"),
        ("sqrt(f)*sqrt(X)", "√(fX)", "sampled"),
    ],
)
def test_the_ground_is_stated(key, typed, ground):
    spec = {"kind": "expression", "value": key, "symbols": {"f": "positive", "X": "positive"}}
    assert grade_answer(spec, typed).fields["ground"] == ground


def test_proof_covers_quotients_and_negative_powers():
    assert prove_equal(parse_formula("1/(1/f-1/z)"), parse_formula("f*z/(z-f)"))
    assert prove_equal(parse_formula("x^-2"), parse_formula("1/x^2"))
    assert not prove_equal(parse_formula("x/y"), parse_formula("y/x"))
    assert not prove_equal(parse_formula("sqrt(x^2)"), parse_formula("x"))
    assert not prove_equal(parse_formula("x^(y)"), parse_formula("x^(y)"))


NOWHERE = {"kind": "expression", "value": "sqrt(-1-x)", "symbols": {"x": "positive"}}


def test_undecided_is_asked_back_unless_settling_is_allowed(monkeypatch):
    """A key without a value anywhere on its domain cannot be sampled."""
    patient = partial(decide_by_sympy, seconds=60)
    monkeypatch.setattr("quizgen.kinds.expression.decide_by_sympy", patient)
    assert grade_answer(NOWHERE, "sqrt(-x-1) + 0").note == "undecided"
    settled = grade_answer(NOWHERE, "sqrt(-x-1) + 0", settle=True)
    assert (settled.verdict, settled.fields["ground"]) == ("correct", "settled")


def test_settling_is_killed_at_its_time_limit():
    """With more time it decides; SymPy alone takes longer to load than that."""
    asked = parse_formula("sin(x)^2 + cos(x)^2"), parse_formula("1"), {"x": "real"}
    assert decide_by_sympy(*asked, seconds=0.05) is None
    assert decide_by_sympy(*asked, seconds=60) is True
