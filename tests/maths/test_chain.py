"""A chain of steps: solving, traps, and only the steps that a change touches."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import fmpq
from sweep import together

from quizgen.core.errors import MathError
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula
from quizgen.maths.number_systems import exact_system, float64_system
from quizgen.maths.numbers import decimal_exponent

CHAIN = Chain(
    given={"f": "mm", "X": "m", "Z": "m"},
    steps=(
        ChainStep("x", parse_formula("f*X/Z")),
        ChainStep("n", parse_formula("Z/f")),
        ChainStep("m", parse_formula("x^2")),
        ChainStep("s", parse_formula("m + n")),
    ),
    traps={"upside-down": (ChainStep("x", parse_formula("f*Z/X")),)},
)
GIVEN = {"f": fmpq(2), "X": fmpq(3), "Z": fmpq(4)}


def steps(plan) -> list[str]:
    return [name for name, _ in plan]


def test_steps_follow_one_another():
    assert CHAIN.solve(GIVEN) == GIVEN | {
        "x": fmpq(3, 2),
        "n": 2,
        "m": fmpq(9, 4),
        "s": fmpq(17, 4),
    }


def test_a_trap_changes_what_follows_it_and_nothing_else():
    found = CHAIN.solve_with_misconception("upside-down", CHAIN.solve(GIVEN))
    assert found == GIVEN | {"x": fmpq(8, 3), "n": 2, "m": fmpq(64, 9), "s": fmpq(82, 9)}


def test_a_plan_holds_the_wrong_step_and_those_that_rest_on_it():
    assert steps(
        CHAIN.compile_affected_steps([ChainStep("x", parse_formula("f"))], exact_system())
    ) == ["x", "m", "s"]
    assert steps(
        CHAIN.compile_affected_steps([ChainStep("n", parse_formula("f"))], exact_system())
    ) == ["n", "s"]
    assert steps(CHAIN.compile_affected_steps([], exact_system())) == []


def test_a_given_quantity_that_changes_touches_every_step_over_it():
    assert steps(CHAIN.compile_affected_steps([], exact_system(), changed=["X"])) == ["x", "m", "s"]
    assert steps(CHAIN.compile_affected_steps([], exact_system(), changed=["f"])) == [
        "x",
        "n",
        "m",
        "s",
    ]


def test_a_plan_can_leave_steps_out():
    wrong = [ChainStep("x", parse_formula("f"))]
    assert steps(CHAIN.compile_affected_steps(wrong, exact_system(), within={"x", "m"})) == [
        "x",
        "m",
    ]
    assert steps(CHAIN.compile_affected_steps([], exact_system(), changed=["f"], within={"n"})) == [
        "n"
    ]


def test_a_plan_computes_in_the_system_asked_for():
    env = {"f": 2.0, "X": 3.0, "Z": 4.0, "n": 2.0}
    for name, compiled in CHAIN.compile_affected_steps(
        [ChainStep("x", parse_formula("f/3"))], float64_system()
    ):
        env[name] = compiled(env)
    assert env["s"] == 2 + (2 / 3) ** 2


def test_what_a_quantity_rests_on():
    assert CHAIN.required_steps("s") == {"s", "m", "n", "x"}
    assert CHAIN.required_steps("s", known={"m"}) == {"s", "n"}


def test_a_step_without_a_value_is_named():
    with pytest.raises(MathError):
        CHAIN.solve(GIVEN | {"Z": fmpq(0)})


@together(("value", "power"), [
    (Fraction(999999999, 10**6), 2), (Fraction(10**6 - 1, 10**6), -1), (1, 0), (Fraction(1, 10), -1),
    (10**23, 23), (10**23 - 1, 22), (-Fraction(1, 10**7) + Fraction(1, 10**20), -8), (0, 0),
])  # fmt: skip
def test_the_power_of_ten_of_the_leading_digit(value, power):
    value = Fraction(value)
    assert decimal_exponent(fmpq(value.numerator, value.denominator)) == power
