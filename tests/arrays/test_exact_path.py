"""The exact path on the hard rows: the right value, or a refusal whose reason the policy names."""

from __future__ import annotations

import ast
import inspect
import math
import re
from fractions import Fraction
from pathlib import Path

import pytest
from test_rows import NAMES, rows_of
from ulp import ulps

from quizgen.errors import FormulaError, MathError
from quizgen.maths import exact
from quizgen.maths.notation import parse
from quizgen.maths.numbers import rational, to_float
from quizgen.maths.systems import evaluate

FORMULAS = {
    "gaussian.upper_tail": "erfc(k/sqrt(2))/2",
    "gaussian.two_sided_tail": "erfc(abs(k)/sqrt(2))",
    "distortion.distort_x": "x*(1 + k_1*(x^2 + y^2) + k_2*(x^2 + y^2)^2)",
    "depth_of_field.far_limit": "s*f^2/(f^2 - N*c*(s - f))",
    "projection.pixel": "o + f*x/(p*z)",
    "gamma.gap": "((a + b)/2)^(5/11) - (a^(5/11) + b^(5/11))/2",
    "gamma.srgb_decode": "((x + 0.055)/1.055)^2.4",
}
ORDER = {
    "gaussian.upper_tail": "k", "gaussian.two_sided_tail": "k", "distortion.distort_x": "x y k_1 k_2",
    "depth_of_field.far_limit": "f N c s", "projection.pixel": "f p x z o", "gamma.gap": "a b",
    "gamma.srgb_decode": "x",
}  # fmt: skip
NO_FORMULA = {
    "gaussian.inverse_tail", "distortion.inverse_radius", "distortion.fold_radius",  # roots
    "poisson.pmf", "poisson.lower",  # factorials and sums
    "hsv.red", "hsv.green", "hsv.blue", "luminosity.efficiency",  # by cases and from a table
}  # fmt: skip
"""What no one formula of the grammar says."""
DECIMALS = {"projection.pixel", "gamma.srgb_decode"}
"""Numbers mean the decimals they print as."""
KNEE = 0.04045
POLICY = Path(__file__).parents[2] / "docs" / "accuracy.md"


def test_every_row_has_a_formula_or_none_is_possible():
    assert set(NAMES) == FORMULAS.keys() | NO_FORMULA


def exactly(name, args):
    """What a key would hold."""
    given = [rational(repr(arg) if name in DECIMALS else Fraction(arg)) for arg in args]
    formula = FORMULAS[name]
    if name == "gamma.srgb_decode" and args[0] <= KNEE:
        formula = "x/12.92"
    return evaluate(parse(formula), dict(zip(ORDER[name].split(), given, strict=False)))


@pytest.mark.parametrize("name", FORMULAS)
def test_hard_rows_are_answered_or_refused(name):
    for args, truth, tolerance in rows_of(name):
        if abs(truth) == math.inf and name == "depth_of_field.far_limit":
            assert is_beyond(args), args
            continue
        value = to_float(exactly(name, args))
        assert ulps(value, truth) <= tolerance, args


def is_beyond(args):
    """A pole is refused; beyond it the formula goes on below zero, so draws keep before it."""
    s, pole = Fraction(args[3]), Fraction(args[0]) ** 2 / (Fraction(args[1]) * Fraction(args[2]))
    if s - Fraction(args[0]) > pole:
        return exactly("depth_of_field.far_limit", args) < 0
    with pytest.raises(MathError, match="division by zero"):
        exactly("depth_of_field.far_limit", args)
    return s - Fraction(args[0]) == pole


def policy():
    """Examples and what is said of them, from the table of the page."""
    section = POLICY.read_text("utf-8").partition("### What a graded value is")[2]
    for line in section.partition("\n##")[0].splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 3 and "`" in cells[1]:
            yield from ((typed, cells[2]) for typed in re.findall(r"`([^`]+)`", cells[1]))


def test_the_policy_has_every_kind_of_case():
    kinds = {said.split(":")[0] for _, said in policy()}
    assert kinds == {"refused", "undecided", "unreadable", "answered"}


@pytest.mark.parametrize(("typed", "said"), list(policy()))
def test_the_policy_is_what_happens(typed, said):
    kind, _, reason = said.partition(": ")
    if kind == "answered":
        assert str(evaluate(parse(typed), {})) == reason.strip("`")
        return
    with pytest.raises(FormulaError if kind == "unreadable" else MathError) as caught:
        evaluate(parse(typed), {})
    if kind != "unreadable":
        assert str(caught.value) == reason
        assert (type(caught.value).__name__ == "Undecided") == (kind == "undecided")


def test_the_policy_names_every_reason():
    calls = [node for node in ast.walk(ast.parse(inspect.getsource(exact))) if _refuses(node)]
    reasons = {node.args[0].value for node in calls}
    assert reasons == {
        said.partition(": ")[2] for _, said in policy() if said[:2] in {"re", "un"}
    } - {"no number or name of the grammar"}


def _refuses(node):
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") in {"MathError", "Undecided"}
