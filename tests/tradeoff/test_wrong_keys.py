"""What another arithmetic would print and mark: cases typed by hand, and counts that are not stale."""

from __future__ import annotations

import statistics
import sys
import timeit
from pathlib import Path
from types import SimpleNamespace

import pytest
from sweep import draws

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.maths.number_systems import exact_system, float64_system
from quizgen.maths.numbers import to_float
from quizgen.maths.precision import working_precision
from quizgen.tradeoff.questions import Counted, load_recorded_counts, measure_questions
from quizgen.tradeoff.rivals import in_turns
from quizgen.tradeoff.solving import ARITHMETICS, draws_list

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

from count import ROUND, count_wrong, find_faults, is_wrong

THIRDS = "compare-two-gaussian-noises"
"""Its answers are 1/3, 2/3 and the like, to be given exactly."""


def found(name, seed, system):
    return find_faults(draw_variant(builtin_bank().template(name), seed), system)


def test_a_third_is_a_third_only_exactly():
    assert found(THIRDS, 0, "exact") == set()
    assert found(THIRDS, 0, "rounded") == {"accepted", "rejected"}  # 0.333333333333 is
    assert "rejected" in found(THIRDS, 0, "balls")


def test_doubles_round_the_wrong_way_where_the_value_ends_in_a_five():
    """The value lies halfway, but its double lies below it; twelve figures put that right."""
    assert "digit" in found("magnification-and-object-distance", 85, "float64")
    assert "digit" not in found("magnification-and-object-distance", 85, "rounded")


def test_balls_cannot_tell_that_two_colours_are_equal():
    assert found("rgb-to-hsv", 0, "balls") == {"unanswered"}


def test_nobody_marks_by_equality_with_doubles():
    one = draw_variant(builtin_bank().template(THIRDS), 0)
    assert "rejected" in find_faults(one, "float64")
    assert not is_wrong(one, "float64")


def test_a_careful_engine_gets_few_questions_wrong_and_an_exact_one_none():
    counted = load_recorded_counts()
    assert counted.drawn == ROUND == 10_000
    assert max(counted.wrong["rounded"], key=counted.wrong["rounded"].get) == THIRDS
    assert counted.questions("rounded") < counted.questions("float64") / 2
    assert counted.questions("exact") == 0


def test_no_template_of_a_sample_is_wrong_that_was_right_when_it_was_counted():
    """One question of each template; after a failure: ``uv run python tools/do.py counts``."""
    counted, bank = load_recorded_counts(), builtin_bank()
    assert counted.templates == len(bank.template_paths)
    for name in bank.template_paths:
        template = bank.template(name)
        if template.chain.steps:
            one = draw_variant(template, 3)
            if draws_list(one):
                continue
            wrong = {system for system in ARITHMETICS if is_wrong(one, system)}
            assert wrong <= {system for system, hit in counted.wrong.items() if name in hit}, name


@pytest.mark.slow
def test_the_counts_are_those_of_today():
    """Of all that were counted with ``QUIZGEN_SWEEP=full``, else of a part, as far as it goes."""
    drawn = draws(1000, full=10_000)
    now, then = count_wrong(builtin_bank(), drawn).wrong, load_recorded_counts().wrong
    for system, counts in now.items():
        assert all(number <= then[system].get(name, 0) for name, number in counts.items()), system
        assert drawn < ROUND or counts == then[system]
        # what goes wrong in a third of 60 questions and more does so among the first six
        often = {name for name, number in then[system].items() if number > 20}
        assert often <= counts.keys(), system


def test_counts_are_kept_by_template():
    bank = builtin_bank()
    few = SimpleNamespace(
        template_paths=[THIRDS, "thin-lens-image-distance"], template=bank.template
    )
    counted = count_wrong(few, 2)
    assert (counted.templates, counted.drawn) == (2, 2)
    assert counted.wrong["rounded"] == {THIRDS: 1}
    assert counted.wrong["exact"] == {}
    assert counted.questions("rounded") == 1
    assert Counted("2026-01-01", 1, 1, {}).questions("float64") == 0


def test_calls_are_timed_in_turns_after_a_round_that_warms_up():
    told = []
    first, second = in_turns([lambda: told.append(1), lambda: told.append(2)], 3)
    assert told == [1, 2] * 4
    assert 0 < first.least <= first.median
    assert second.per(2).median == second.median / 2


def test_every_arithmetic_is_timed_on_the_same_questions():
    bank = builtin_bank()
    few = SimpleNamespace(
        template_paths=[THIRDS, "thin-lens-image-distance", "rgb-to-hsv"], template=bank.template
    )
    found = measure_questions(few)
    assert found.count == 2  # balls do not solve the colours
    assert found.costs.keys() == ARITHMETICS.keys()
    assert found.costs["float64"].times == found.costs["rounded"].times == 1
    assert len(found.alone) == 3


def call_seconds(drawn, system, enter):
    """Seconds of one question's chain by ``timeit``, every step called as the chain has it."""
    given = {name: enter(drawn.values[name]) for name in drawn.template.chain.given}
    steps = list(drawn.template.chain.compile_steps(system()).items())

    def solve():
        with working_precision():
            values = dict(given)
            for name, compute in steps:
                values[name] = compute(values)

    return min(timeit.repeat(solve, number=20, repeat=7)) / 20


@pytest.mark.slow
def test_exact_takes_twice_as_long_as_float64_and_some_microseconds_more():
    """By another clock; the page's median ratio lies between the quartiles found here, widened."""
    bank = builtin_bank()
    ratios, more = [], []
    for name in list(bank.template_paths)[::2]:
        if bank.template(name).chain.steps:
            one = draw_variant(bank.template(name), 0)
            if draws_list(one):
                continue
            ours, doubles = (
                call_seconds(one, exact_system, lambda x: x),
                call_seconds(one, float64_system, to_float),
            )
            ratios.append(ours / doubles)
            more.append(ours - doubles)
    low, _, high = statistics.quantiles(ratios, n=4)
    cost = measure_questions(bank).costs["exact"]
    assert low / 1.3 < cost.times < high * 1.3
    assert statistics.median(more) / 3 < cost.more < 3 * statistics.median(more)
