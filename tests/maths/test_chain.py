"""A chain of steps: solving, traps, and only the steps that a change touches."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import fmpq

from quizgen.errors import MathError
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse
from quizgen.maths.numbers import magnitude
from quizgen.maths.systems import exact, floats

CHAIN = Chain(
    given={"f": "mm", "X": "m", "Z": "m"},
    steps=(
        ChainStep("x", parse("f*X/Z")),
        ChainStep("n", parse("Z/f")),
        ChainStep("m", parse("x^2")),
        ChainStep("s", parse("m + n")),
    ),
    traps={"upside-down": (ChainStep("x", parse("f*Z/X")),)},
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
    found = CHAIN.trapped("upside-down", CHAIN.solve(GIVEN))
    assert found == GIVEN | {"x": fmpq(8, 3), "n": 2, "m": fmpq(64, 9), "s": fmpq(82, 9)}


def test_a_plan_holds_the_wrong_step_and_those_that_rest_on_it():
    assert steps(CHAIN.plan([ChainStep("x", parse("f"))], exact())) == ["x", "m", "s"]
    assert steps(CHAIN.plan([ChainStep("n", parse("f"))], exact())) == ["n", "s"]
    assert steps(CHAIN.plan([], exact())) == []


def test_a_given_quantity_that_changes_touches_every_step_over_it():
    assert steps(CHAIN.plan([], exact(), changed=["X"])) == ["x", "m", "s"]
    assert steps(CHAIN.plan([], exact(), changed=["f"])) == ["x", "n", "m", "s"]


def test_a_plan_can_leave_steps_out():
    wrong = [ChainStep("x", parse("f"))]
    assert steps(CHAIN.plan(wrong, exact(), within={"x", "m"})) == ["x", "m"]
    assert steps(CHAIN.plan([], exact(), changed=["f"], within={"n"})) == ["n"]


def test_a_plan_computes_in_the_system_asked_for():
    env = {"f": 2.0, "X": 3.0, "Z": 4.0, "n": 2.0}
    for name, compiled in CHAIN.plan([ChainStep("x", parse("f/3"))], floats()):
        env[name] = compiled(env)
    assert env["s"] == 2 + (2 / 3) ** 2


def test_what_a_quantity_rests_on():
    assert CHAIN.needs("s") == {"s", "m", "n", "x"}
    assert CHAIN.needs("s", known={"m"}) == {"s", "n"}


def test_a_step_without_a_value_is_named():
    with pytest.raises(MathError):
        CHAIN.solve(GIVEN | {"Z": fmpq(0)})


@pytest.mark.parametrize(("value", "power"), [
    (Fraction(999999999, 10**6), 2), (Fraction(10**6 - 1, 10**6), -1), (1, 0), (Fraction(1, 10), -1),
    (10**23, 23), (10**23 - 1, 22), (-Fraction(1, 10**7) + Fraction(1, 10**20), -8), (0, 0),
])  # fmt: skip
def test_the_power_of_ten_of_the_leading_digit(value, power):
    value = Fraction(value)
    assert magnitude(fmpq(value.numerator, value.denominator)) == power
