"""The exact path on the hard rows: the right value, or a refusal whose reason the policy names."""

from __future__ import annotations

import ast
import inspect
import math
import re
from fractions import Fraction
from pathlib import Path

import mpmath as mp
import pytest
from sweep import together
from test_rows import ROWS, rows_of
from ulp import ulps

from quizgen.core.errors import FormulaError, MathError
from quizgen.maths import exact
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import evaluate
from quizgen.maths.numbers import to_float, to_rational
from quizgen.maths.precision import working_precision
from quizgen.numerics.luminosity import DAY

FIRST_NM, STEP_NM, V = DAY.first, DAY.step, DAY.values.tolist()
LAST_NM = FIRST_NM + STEP_NM * (len(V) - 1)
HEXAGON = "V - V*S*max(0, min(mod({turn} + H/60, 6), 4 - mod({turn} + H/60, 6), 1))"
TENTS = " + ".join(
    f"{value}*max(0, 1 - abs(w - {FIRST_NM + STEP_NM * i})/{STEP_NM})" for i, value in enumerate(V)
)
BETWEEN = f"({TENTS})*(1 - sign(max(0, {FIRST_NM} - w) + max(0, w - {LAST_NM})))"
"""Straight lines between the rows of a table, as a sum of tents; nothing beyond its ends."""
FORMULAS = {
    "gaussian.upper_tail": "erfc(k/sqrt(2))/2",
    "gaussian.two_sided_tail": "erfc(abs(k)/sqrt(2))",
    "distortion.distort_x": "x*(1 + k_1*(x^2 + y^2) + k_2*(x^2 + y^2)^2)",
    "distortion.fold_radius": "sqrt(2/(sqrt(9*k_1^2 - 20*k_2) - 3*k_1))",
    "depth_of_field.far_limit": "s*f^2/(f^2 - N*c*(s - f))",
    "projection.pixel_coordinate": "o + f*x/(p*z)",
    "gamma.gap": "((a + b)/2)^(5/11) - (a^(5/11) + b^(5/11))/2",
    "gamma.srgb_decode": "((x + 0.055)/1.055)^2.4",
    "hsv.red": HEXAGON.format(turn=5),
    "hsv.green": HEXAGON.format(turn=3),
    "hsv.blue": HEXAGON.format(turn=1),
    "luminosity.luminous_efficiency": BETWEEN,
}
ORDER = {
    "gaussian.upper_tail": "k", "gaussian.two_sided_tail": "k", "distortion.distort_x": "x y k_1 k_2",
    "depth_of_field.far_limit": "f N c s", "projection.pixel_coordinate": "f p x z o", "gamma.gap": "a b",
    "gamma.srgb_decode": "x", "distortion.fold_radius": "k_1 k_2", "luminosity.luminous_efficiency": "w",
    "hsv.red": "H S V", "hsv.green": "H S V", "hsv.blue": "H S V",
    "gaussian.inverse_upper_tail": "p", "distortion.inverse_radius": "d k_1 k_2",
    "poisson.pmf": "k m", "poisson.lower": "k m",
}  # fmt: skip
ROOTS = {
    "gaussian.inverse_upper_tail": "p - erfc(r/sqrt(2))/2",
    "distortion.inverse_radius": "r*(1 + k_1*r^2 + k_2*r^4) - d",
}
"""What has no formula: where this one, which rises, goes through zero."""
CHAINS = {"poisson.pmf", "poisson.lower"}
"""A chain of steps, a term from the one before, as far as anybody would follow it."""
LONGEST_CHAIN = 20_000
STIRLING = "exp(k*ln(m/k) - (m - k) - 1/(12*k) + 1/(360*k^3){next})/sqrt(2*pi*k)"
BOUNDS = (STIRLING.format(next=" - 1/(1260*k^5)"), STIRLING.format(next=""))
"""For any count: one term more or less of Stirling's series is below or above a factorial."""
STIRLING_FROM = 1000
LAST = Fraction(1, 10**38)
"""What the rows leave of a value, relative to it."""
DECIMALS = {"projection.pixel_coordinate", "gamma.srgb_decode"}
"""Numbers mean the decimals they print as."""
KNEE = 0.04045
POLICY = Path(__file__).parents[2] / "docs" / "accuracy.md"


def test_the_exact_path_is_tried_on_every_function():
    assert {row[0] for row in ROWS} == FORMULAS.keys() | ROOTS.keys() | CHAINS


def given_of(name, args):
    given = [to_rational(repr(arg) if name in DECIMALS else Fraction(arg)) for arg in args]
    return dict(zip(ORDER[name].split(), given, strict=False))


def exactly(name, args):
    """What a key would hold."""
    formula = FORMULAS[name]
    if name == "gamma.srgb_decode" and args[0] <= KNEE:
        formula = "x/12.92"
    return evaluate(parse_formula(formula), given_of(name, args))


@together("name", FORMULAS)
def test_hard_rows_are_answered_or_refused(name):
    for args, truth, tolerance in rows_of(name):
        if abs(truth) == math.inf:
            assert INFINITE[name](args), args
            continue
        assert ulps(in_doubles(exactly(name, args)), truth) <= tolerance, args


def in_doubles(value):
    """Nearest double, also of what lies beyond all of them."""
    try:
        return to_float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


@pytest.mark.parametrize("name", ROOTS)
def test_hard_roots_are_certified(name):
    """The formula is certainly below zero on one side of the answer and above it on the other."""
    side = parse_formula(f"sign({ROOTS[name]})")
    for args, truth, tolerance in rows_of(name):
        given, root = given_of(name, args), Fraction(mp.nstr(truth, 40))
        away = Fraction(tolerance) * Fraction(math.ulp(float(truth)))
        if not root:  # a ball is too wide to tell so small a number from it
            assert evaluate(side, {**given, "r": to_rational(0)}) == 0, args
            continue
        signs = [evaluate(side, {**given, "r": to_rational(root + at)}) for at in (-away, away)]
        assert signs == [-1, 1], args


STEP, SUM = parse_formula("t*m/k"), parse_formula("s + t")


def along(count, mean):
    """Chances of k and of at most k, step by step."""
    chance = total = evaluate(parse_formula("exp(-m)"), {"m": mean})
    for k in range(1, count + 1):
        chance = evaluate(STEP, {"t": chance, "m": mean, "k": to_rational(Fraction(k))})
        total = evaluate(SUM, {"s": total, "t": chance})
    return {"poisson.pmf": chance, "poisson.lower": total}


@pytest.mark.parametrize("name", sorted(CHAINS))
def test_hard_counts_are_answered_as_far_as_a_chain_goes(name):
    tried = 0
    for args, truth, tolerance in rows_of(name):
        if args[0] <= LONGEST_CHAIN:
            tried += 1
            value = to_float(along(int(args[0]), to_rational(Fraction(args[1])))[name])
            assert ulps(value, truth) <= tolerance, args
    assert tried >= 9


def test_hard_probabilities_of_many_are_between_two_bounds():
    """Up to the largest count of all rows: no chain is too long to have a value."""
    rows = [row for row in rows_of("poisson.pmf") if row[0][0] >= STIRLING_FROM]
    for args, truth, tolerance in rows:
        given = given_of("poisson.pmf", args)
        below, above = (evaluate(parse_formula(bound), given) for bound in BOUNDS)
        read = Fraction(mp.nstr(truth, 40))
        with working_precision():
            assert not below > to_rational(read * (1 + LAST)), args
            assert not above < to_rational(read * (1 - LAST)), args
        assert max(ulps(in_doubles(bound), truth) for bound in (below, above)) <= tolerance, args
    assert max(args[0] for args, _, _ in rows) >= 1e15
    assert {args for args, _, _ in rows_of("poisson.lower") if args[0] > LONGEST_CHAIN} == set()


def is_beyond(args):
    """A pole is refused; beyond it the formula goes on below zero, so draws keep before it."""
    s, pole = Fraction(args[3]), Fraction(args[0]) ** 2 / (Fraction(args[1]) * Fraction(args[2]))
    if s - Fraction(args[0]) > pole:
        return exactly("depth_of_field.far_limit", args) < 0
    with pytest.raises(MathError, match="division by zero"):
        exactly("depth_of_field.far_limit", args)
    return s - Fraction(args[0]) == pole


def has_no_fold(args):
    """Refused: under the root stands zero in a divisor, or a negative number."""
    with pytest.raises(MathError, match=r"division by zero|square root of a negative|no finite"):
        exactly("distortion.fold_radius", args)
    return True


INFINITE = {"depth_of_field.far_limit": is_beyond, "distortion.fold_radius": has_no_fold}


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


@together(("typed", "said"), list(policy()))
def test_the_policy_is_what_happens(typed, said):
    kind, _, reason = said.partition(": ")
    if kind == "answered":
        assert str(evaluate(parse_formula(typed), {})) == reason.strip("`")
        return
    with pytest.raises(FormulaError if kind == "unreadable" else MathError) as caught:
        evaluate(parse_formula(typed), {})
    if kind != "unreadable":
        assert str(caught.value) == reason
        assert (type(caught.value).__name__ == "UndecidedError") == (kind == "undecided")


def test_the_policy_names_every_reason():
    calls = [node for node in ast.walk(ast.parse(inspect.getsource(exact))) if _refuses(node)]
    reasons = {node.args[0].value for node in calls}
    assert reasons == {
        said.partition(": ")[2] for _, said in policy() if said[:2] in {"re", "un"}
    } - {"no number or name of the grammar"}


def _refuses(node):
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") in {
        "MathError",
        "UndecidedError",
    }
