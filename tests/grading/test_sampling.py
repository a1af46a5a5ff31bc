"""Two formulas at the points of a domain: which points, when enough, and what is found there."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import arb, fmpq
from sweep import together

from quizgen.grading.judging.algebraic_equality import prove_equal
from quizgen.grading.judging.sampled_equality import (
    SamplingResult,
    _find_common_ratio_or_offset,
    compare_by_sampling,
    sample_points,
    values_agree,
)
from quizgen.maths.notation import parse_formula


def compared(key: str, typed: str, domain: object = "real") -> SamplingResult:
    names = {"x": domain} if "x" in key + typed else {}
    return compare_by_sampling(parse_formula(key), parse_formula(typed), names)


@pytest.mark.parametrize(
    ("domain", "points"),
    [
        ("positive", "980955/1000448 763293/250112 827775/250112"),
        ("real", "-1233/250112 -439185/500224 -2408817/500224"),
        (["1", "3"], "33026323/20002816 17631483/10001408 21362477/10001408"),
    ],
    ids=str,
)
def test_the_points_are_the_same_in_every_version(domain, points):
    """A verdict can be repeated elsewhere only where the same points are looked at."""
    found = [point["x"] for point in sample_points({"x": domain})[:3]]
    assert [f"{value.p}/{value.q}" for value in found] == points.split()


@pytest.mark.parametrize(
    ("domain", "low", "high"),
    [("positive", Fraction(1, 1000), 17), ("real", -17, 17), (["1", "3"], 1, 3)],
    ids=str,
)
def test_points_lie_inside_their_domain(domain, low, high):
    points = sample_points({"x": domain})
    assert len(points) == 96
    assert all(low < Fraction(int(p["x"].p), int(p["x"].q)) < high for p in points)


def test_no_point_lies_within_a_4096th_of_the_end_of_an_interval():
    """The last step is 4094/4096, moved by 1/9767: 0.99961 of the way, and 4095/4096 is 0.99976."""
    for high in range(1, 13):
        points = [point["x"] / high for point in sample_points({"x": ["0", str(high)]})]
        assert max(points) < fmpq(4095, 4096)


def test_a_real_domain_has_both_signs():
    assert {p["x"] > 0 for p in sample_points({"x": "real"})[:8]} == {True, False}


WIDE = arb(1, "0.001")


@together(
    ("first", "second", "same"),
    [
        (fmpq(1, 3), fmpq(1, 3), True),
        (fmpq(1, 3), fmpq(2, 3), False),
        (arb(2), fmpq(1), False),
        (arb(2), fmpq(2), True),
        (arb(0), fmpq(0), True),
        (WIDE, WIDE, None),
        (arb(1, "2.1e-20"), fmpq(1), None),
        (arb(1, "1.9e-20"), fmpq(1), True),
        (arb(0, "1.1e-50"), fmpq(0), None),
        (arb(0, "0.9e-50"), fmpq(0), True),
    ],
)  # fmt: skip
def test_values_agree_as_sharp_balls_only(first, second, same):
    """Sharp is less than 10^-20 of both sizes together, 2 here; around nothing, 10^-50."""
    assert values_agree(first, second) is same


@together(
    ("key", "typed", "equal", "points", "ground"),
    [
        ("2", "4/2", True, 1, "proved"),
        ("2", "3", False, 1, "proved"),
        ("sqrt(2)", "2^(1/2)", True, 1, "sampled"),
        ("2", "sqrt(2)^2", True, 1, "sampled"),
        ("2", "1/0", False, 1, "domain"),
        ("2", "floor(sqrt(2)^2)", None, 0, "undecided"),
        ("floor(sqrt(2)^2)", "2", None, 0, "undecided"),
    ],
)
def test_two_constants(key, typed, equal, points, ground):
    assert compared(key, typed) == SamplingResult(equal, points, ground)


def test_a_smaller_domain_is_counted_with_the_points_that_it_lacks():
    """The eighth positive point is the sixteenth of all; the typed root has no value at eight."""
    signs = [point["x"] > 0 for point in sample_points({"x": "real"})[:16]]
    assert (sum(signs), signs[-1]) == (8, True)
    assert compared("x", "sqrt(x)^2") == SamplingResult(equal=False, points=16, ground="domain")


def test_a_formula_without_any_value_in_common_is_undecided():
    assert compared("ln(0*x)", "ln(0*x)") == SamplingResult(
        equal=None, points=0, ground="undecided"
    )


@pytest.mark.parametrize(
    ("typed", "ratio", "difference"),
    [("2*x", 2, None), ("x + 3", None, 3), ("x^2", None, None), ("-x", -1, None)],
)
def test_a_common_factor_or_offset_is_found(typed, ratio, difference):
    found = compared("x", typed)
    assert (found.equal, found.ratio, found.difference) == (False, ratio, difference)
    assert (found.points, found.ground) == (1, "differs")


@pytest.mark.parametrize(("points", "named"), [(2, False), (3, True), (4, True)])
def test_a_factor_is_named_from_three_points_on(points, named):
    """The root has a value at so many of the twelve points that are looked at."""
    values = sorted((p["x"] for p in sample_points({"x": "real"})[:12]), reverse=True)
    start = values[points - 1]
    root = f"sqrt(x - {start.p}/{start.q} + 1/1000000)"
    ratio = compared(root, f"2*{root}").ratio
    assert ratio.contains(2) if named else ratio is None


@pytest.mark.parametrize("odd", range(3))
def test_a_factor_or_offset_is_that_of_every_point(odd):
    pairs = [(fmpq(1), fmpq(3 if place == odd else 2)) for place in range(3)]
    assert _find_common_ratio_or_offset(pairs) == (None, None)
    assert _find_common_ratio_or_offset([(fmpq(1), fmpq(2))] * 3) == (2, 1)


def test_a_factor_is_named_where_a_value_is_one_and_not_where_it_is_zero():
    assert _find_common_ratio_or_offset([(fmpq(n, 2), fmpq(n)) for n in (1, 2, 3)]) == (2, None)
    assert _find_common_ratio_or_offset([(fmpq(n), fmpq(0)) for n in (1, 2, 3)]) == (None, None)


def test_no_factor_is_named_where_a_formula_vanishes():
    """The first point, -1233/250112, is a root of both."""
    found = compared("x + 1233/250112", "2*(x + 1233/250112)")
    assert (found.equal, found.points, found.ratio) == (False, 2, None)
    assert compared("x + 1233/250112", "x + 1").ratio is None


@together(
    ("first", "second", "proved"),
    [
        ("(x + 1)^2", "x^2 + 2*x + 1", True),
        ("(x + 1)^2", "x^2 + 2*x", False),
        ("x^12", "x^6*x^6", True),
        ("x^13", "x^6*x^7", False),
        ("x^(-1)", "1/x", True),
        ("x^(-12)", "1/x^12", True),
        ("(1/x)^(-2)", "x^2", True),
        ("(2*x)^(-1)", "1/(2*x)", True),
        ("(x/y)^(-2)", "y^2/x^2", True),
        ("x^(-1)", "1/(2*x)", False),
        ("x^0", "1", True),
        ("x^(x - x)", "1", True),
        ("x^(1/2)", "x^(1/2)", False),
        ("x^y", "x^y", False),
        ("1/(x - x)", "1/(x - x)", False),
        ("x + y - y", "x", True),
        ("x - y + y", "x", True),
        ("x", "y", False),
        ("sin(x)", "sin(x)", False),
    ],
)
def test_rational_functions_are_proved_equal(first, second, proved):
    """What is no quotient of polynomials, or has a power above 12, is left to sampling."""
    assert prove_equal(parse_formula(first), parse_formula(second)) is proved


@pytest.mark.parametrize(("terms", "proved"), [(59, True), (60, False)])
def test_a_formula_too_large_to_expand_is_not_proved(terms, proved):
    """A sum of n terms is a tree of n + 1 nodes; 60 are expanded."""
    total = " + ".join(["x"] * terms)
    assert prove_equal(parse_formula(total), parse_formula(total)) is proved
