"""The plan until an exam: what it chooses, what fits into the minutes, and an honest range."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from quizgen.bank.bank import Bank, builtin_bank, builtin_root
from quizgen.practice.ability import (
    SLIP,
    AbilityModel,
    is_past_curriculum,
    mean_credit,
    read_practice_items,
)
from quizgen.practice.exam_plan import ExamPlan, read_exam_goal
from quizgen.practice.scheduler import DAY
from quizgen.practice.session_state import Attempt
from quizgen.store.learner import exam_time, group_attempts
from quizgen.store.records import OutcomeRecord

NOW = 1_795_800_000.0
TOMORROW = NOW + 0.6 * DAY
TRIAL = tomllib.loads((builtin_root() / "templates/blueprints/trial.toml").read_text("utf-8"))


@pytest.fixture(scope="module")
def items():
    return read_practice_items(builtin_bank())


@pytest.fixture(scope="module")
def goal():
    return read_exam_goal(builtin_bank())


def planned(items, goal, attempts=(), **more):
    return ExamPlan(goal, items, attempts, NOW, TOMORROW, **more)


def evening(names, credit):
    """Attempts of the last hour, one after the other."""
    return [
        Attempt(name, credit, NOW - 3600 + 3000 * place / len(names))
        for place, name in enumerate(names)
    ]


def test_the_goal_is_the_trial_exam_of_the_bank(goal):
    assert goal.name == "trial"
    assert [(slot.points, list(slot.templates)) for slot in goal.slots] == [
        (slot["points"], sorted(slot["templates"])) for slot in TRIAL["slot"]
    ]
    assert goal.points == 10


def test_an_hour_before_the_exam_begins_with_each_question_of_it_once(items, goal):
    block = planned(items, goal).plan_block(60).templates
    first = block[: len(goal.slots)]
    assert {next(s.points for s in goal.slots if name in s.templates) for name in first} == {
        slot.points for slot in goal.slots
    }
    assert sum(name in goal.templates for name in block[:9]) >= 6


@pytest.mark.parametrize("minutes", [15, 25, 60, 90])
def test_a_block_fits_into_its_minutes(items, goal, minutes):
    names, whole = planned(items, goal).plan_block(minutes)
    assert 0.7 * minutes < whole <= minutes
    stated = {item.name: item.minutes for item in items}
    assert sum(stated[name] for name in names) <= whole, "with the solution read"


def test_what_was_asked_lately_is_not_asked_again_in_the_round(items, goal):
    known = evening([slot.templates[0] for slot in goal.slots[:-1]], 1.0)
    assert planned(items, goal, known).choose_next() in goal.slots[-1].templates


def test_what_was_begun_last_does_not_come_at_once(items, goal):
    first = planned(items, goal).choose_next()
    assert planned(items, goal, latest=[first]).choose_next() != first


def test_only_what_is_allowed_is_asked(items, goal):
    noise = [item.name for item in items if item.topic == "noise"]
    plan = planned(items, goal, allowed=noise)
    assert set(plan.plan_block(90).templates) <= set(noise)
    beyond = {item.name for item in items if item.beyond}
    assert beyond
    assert not beyond & set(planned(items, goal).plan_block(600).templates)


def test_no_number_before_there_is_evidence_then_a_range_then_both(items, goal):
    names = [item.name for item in items[:10]]
    assert planned(items, goal, evening(names[:4], 0.5)).estimate() is None
    five = planned(items, goal, evening(names[:5], 0.5)).estimate()
    assert five.expected is None
    assert 0 <= five.low < five.high <= 10
    ten = planned(items, goal, evening(names, 0.5)).estimate()
    assert ten.low <= ten.expected <= ten.high
    assert (2 * ten.low).is_integer()
    assert (2 * ten.high).is_integer()


def test_an_answer_with_help_is_no_evidence_but_teaches(items, goal):
    name = goal.slots[0].templates[0]
    helped = [Attempt(name, 1.0, NOW - 60, helped=True)]
    plan, fresh = planned(items, goal, helped), planned(items, goal)
    assert plan.evidence == 0
    assert 0 < plan.expected_points() - fresh.expected_points() < 0.5
    alone = planned(items, goal, [Attempt(name, 1.0, NOW - 60)])
    assert alone.expected_points() > plan.expected_points()


def test_who_is_always_right_is_told_more_than_who_never_is(items, goal):
    names = [slot.templates[0] for slot in goal.slots] * 2
    low = planned(items, goal, evening(names, 0.0)).estimate()
    high = planned(items, goal, evening(names, 1.0)).estimate()
    assert low.expected < 4
    assert high.expected > 7.5
    assert low.low < high.low
    assert low.high < high.high


def test_what_was_taught_fades(items):
    model = AbilityModel(items)
    model.observe(Attempt(items[0].name, 0.0, NOW))
    soon, late = model.ability(NOW / DAY), model.ability(NOW / DAY + 30)
    assert late[0] < soon[0]


def test_the_covariance_stays_one(items):
    """However often and however oddly somebody answers."""
    model = AbilityModel(items[:40])
    rng = np.random.default_rng(5)
    for place in range(120):
        name = items[int(rng.integers(40))].name
        model.observe(Attempt(name, float(rng.random()), NOW + 40.0 * place))
    assert np.linalg.eigvalsh(model._covariance).min() > -1e-9
    assert np.isfinite(model.expected_credit()).all()


@pytest.mark.parametrize(("ability", "variance"), [(0.0, 1.0), (-1.5, 3.0), (2.0, 0.5)])
def test_the_mean_credit_is_that_of_a_gaussian_ability(ability, variance):
    spread = math.sqrt(variance)
    known = quad(lambda x: norm.pdf(x, ability, spread) / (1 + math.exp(-x)), -30, 30)[0]
    found = mean_credit(np.array(ability), np.array(variance), np.array(0.25))
    assert found == pytest.approx(0.25 + (1 - SLIP - 0.25) * known, abs=0.01)


def test_what_lies_past_the_curriculum():
    assert is_past_curriculum(["X-A1", "E12"], ["X-A", "E"])
    assert not is_past_curriculum(["X-A1", "F03"], ["X-A", "E"])
    assert not is_past_curriculum([], ["E"])


def outcome(part, credit, *, at=NOW, helped=False, attempt="one", name="hsv-to-rgb"):
    return OutcomeRecord(name, "colour", part, "", False, False, at, credit, helped, attempt)


def test_an_attempt_weighs_its_parts_by_their_points():
    bank, name = builtin_bank(), "why-bayer-green-and-demosaicing"
    a, b = (float(part.points) for part in bank.rules(name).part[:2])
    found = group_attempts(bank, [outcome("a", 1.0, name=name), outcome("b", 0.0, name=name)])
    assert [one.credit for one in found] == [pytest.approx(a / (a + b))]


def test_parts_with_help_say_nothing():
    bank = builtin_bank()
    rows = [outcome("", 1.0, helped=True, attempt="x"), outcome("", 0.5, attempt="y", at=NOW + 9)]
    assert [(one.helped, one.credit) for one in group_attempts(bank, rows)] == [
        (True, 0.0), (False, 0.5),
    ]  # fmt: skip


def test_rows_of_earlier_versions_are_grouped_by_time():
    rows = [
        OutcomeRecord("hsv-to-rgb", "colour", "a", "", True, True, NOW),
        OutcomeRecord("hsv-to-rgb", "colour", "b", "", False, False, NOW + 60),
        OutcomeRecord("hsv-to-rgb", "colour", "a", "", True, True, NOW + 2 * DAY),
        OutcomeRecord("gone", "colour", "a", "", True, True, NOW),
    ]
    found = group_attempts(builtin_bank(), rows)
    assert [one.at for one in found] == [NOW + 60, NOW + 2 * DAY]
    assert found[0].credit < found[1].credit == 1


def test_without_a_day_the_exam_is_tomorrow():
    assert 10 * 3600 <= exam_time(None, NOW) - NOW <= 34 * 3600


@pytest.mark.parametrize("name", ["filtering", "strangers"])
def test_a_bank_without_a_trial_exam_has_a_plan_too(name):
    bank = Bank(builtin_root() / "examples" / name, trusted=True)
    plan = ExamPlan(read_exam_goal(bank), read_practice_items(bank), [], NOW, TOMORROW)
    assert set(plan.plan_block(30).templates) <= set(bank.template_paths)
    assert plan.goal.points > 0
