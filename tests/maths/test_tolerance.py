"""How wide a tolerance is: by hand at its bounds, and from outside for an approximate key."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import pytest
from flint import arb, fmpq
from sweep import together

from quizgen.maths.tolerance import AngleTolerance, Tolerance, parse_tolerance

WIDTHS = [
    ({}, "200", "1"),
    ({}, "-200", "1"),
    ({"rel": "0.01"}, "3", "0.03"),
    ({"abs": "0.5"}, "3", "0.5"),
    ({"decimals": 0}, "3", "1"),
    ({"decimals": 2}, "3", "0.01"),
    ({"decimals": 2, "within": "1/2"}, "3", "0.005"),
    ({"sigfigs": 3}, "123", "1"),
    ({"sigfigs": 3}, "99.9", "0.1"),
    ({"sigfigs": 2}, "0.0123", "0.001"),
    ({"sigfigs": 2, "within": 2}, "-0.0123", "0.002"),
]


@together(("rule", "key", "width"), WIDTHS)
def test_the_bounds_are_closed(rule, key, width):
    tolerance, value, half = Tolerance(**rule), Fraction(key), Fraction(width)
    least = Fraction(1, 10**12)
    for sign in (1, -1):
        assert tolerance.is_within(rational(value + sign * half), rational(value))
        assert not tolerance.is_within(rational(value + sign * (half + least)), rational(value))
    assert tolerance.half_width(rational(value)) == rational(half)


def rational(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


@together(("rule", "key", "width"), WIDTHS)
def test_around_a_float_the_width_is_a_little_more(rule, key, width):
    found, half = Tolerance(**rule).outer_width(float(Fraction(key))), Fraction(width)
    assert half < Fraction(found) < half * (1 + Fraction(1, 10**8))


def test_around_a_float_just_below_a_power_of_ten_the_wider_place_counts():
    assert Tolerance(sigfigs=2).outer_width(10 - 1e-12) > 1
    assert Tolerance(sigfigs=2).outer_width(9.9) < 0.2


@pytest.mark.parametrize(
    ("key", "width"), [(100.0, 0.005), (0.5, 0.005), (-0.25, 0.0025), (0.0, 0)]
)
def test_an_exact_answer_may_be_meant_by_two_decimals(key, width):
    """Half a hundredth, but no more than a hundredth of the key."""
    assert Tolerance(exact=True).outer_width(key) == width
    assert Tolerance(exact=True).half_width(fmpq(100)) == 0


def test_a_ball_on_the_bound_is_near():
    assert Tolerance(abs=1).is_within(arb(2, "1e-9"), fmpq(1))
    assert Tolerance(abs=1).is_within(arb(2), fmpq(1))
    assert not Tolerance(abs=1).is_within(arb("2.1", "1e-9"), fmpq(1))


@together(
    ("value", "accepted"),
    [("10", True), ("10.05", True), ("10.06", False), ("20", True), ("30", True), ("19.99", False),
     ("30.01", False)],
)  # fmt: skip
def test_an_interval_is_accepted_besides(value, accepted):
    tolerance = Tolerance(accept=["20", "30"])
    assert tolerance.accepts(rational(Fraction(value)), fmpq(10)) is accepted


@together(
    ("rule", "said"),
    [
        ({"decimals": 1, "rel": "0.1"}, "only one of decimals, sigfigs, rel, abs, exact"),
        ({"decimals": 0, "sigfigs": 1}, "only one of"),
        ({"exact": True, "abs": 1}, "only one of"),
        ({"accept": ["1"]}, "two bounds"),
        ({"accept": ["1", "2", "3"]}, "two bounds"),
        ({"accept": []}, "two bounds"),
        ({"decimals": -1}, "0 to 40"),
        ({"decimals": 41}, "0 to 40"),
        ({"sigfigs": 0}, "1 to 40"),
        ({"sigfigs": 41}, "1 to 40"),
        ({"rel": "a tenth"}, None),
        ({"abs": "1 cm"}, None),
        ({"within": "two"}, None),
        ({"accept": ["1", "two"]}, None),
    ],
)
def test_what_cannot_be_meant_is_refused(rule, said):
    with pytest.raises(ValueError, match=said):
        Tolerance(**rule).validate()


@together(
    "rule",
    [{}, {"decimals": 0}, {"decimals": 40}, {"sigfigs": 1}, {"sigfigs": 40}, {"exact": True},
     {"rel": "1/3"}, {"accept": ["1", "2"]}],
)  # fmt: skip
def test_what_can_be_meant_is_not(rule):
    Tolerance(**rule).validate()


@pytest.mark.parametrize(
    ("answer", "tolerance"),
    [
        ({"kind": "number", "of": "x"}, Tolerance()),
        ({"kind": "angle", "of": "x"}, AngleTolerance()),
        ({"kind": "number", "decimals": 2, "within": 2}, Tolerance(decimals=2, within=2)),
        ({"kind": "angle", "abs": "1", "strict": True}, AngleTolerance(abs="1", strict=True)),
        ({"kind": "number", "accept": ["x", "2*x"]}, Tolerance()),
    ],
)
def test_the_tolerance_of_an_authored_answer(answer, tolerance):
    assert parse_tolerance(answer) == tolerance


def test_an_angle_without_a_rule_has_half_a_degree():
    assert parse_tolerance({"kind": "angle"}).half_width(fmpq(140)) == fmpq(1, 2)
    assert parse_tolerance({"kind": "number"}).half_width(fmpq(140)) == fmpq(7, 10)


@pytest.mark.parametrize("answer", [{"decimals": "2"}, {"decimals": 1, "sigfigs": 1}])
def test_a_wrong_rule_of_an_authored_answer_is_refused(answer):
    with pytest.raises((msgspec.ValidationError, ValueError)):
        parse_tolerance(answer)
