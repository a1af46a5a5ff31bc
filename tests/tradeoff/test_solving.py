"""What another arithmetic would print and mark: cases typed by hand, and that exact has no fault."""

from __future__ import annotations

import pytest

from quizgen.bank.draw import draw
from quizgen.bank.folder import builtin
from quizgen.tradeoff.basis import Basis, basis, meaning
from quizgen.tradeoff.product import Counted, count_faults, measure_product, questions, recorded
from quizgen.tradeoff.solving import ARITHMETICS, Faults, faults


def found(name, seed, system):
    return faults(draw(builtin().template(name), seed), system)


def test_a_third_is_a_third_only_exactly():
    name = "compare-two-gaussian-noises"  # 1/3, to be given exactly
    assert found(name, 0, "exact") == Faults()
    assert found(name, 0, "float64").rejected  # 1/3 is not 6004799503160661/2^54
    assert found(name, 0, "rounded") == Faults(accepted=True, rejected=True)  # 0.333333333333 is
    assert found(name, 0, "certified").rejected


def test_doubles_round_the_wrong_way_where_the_value_ends_in_a_five():
    # 84.375 mm to two places: 84.38, but its double lies below
    assert found("magnification-and-object-distance", 1, "float64").digit
    assert not found("magnification-and-object-distance", 1, "rounded").digit


def test_balls_cannot_tell_that_two_colours_are_equal():
    assert found("rgb-to-hsv", 0, "certified").unanswered


def test_float32_prints_wrong_digits():
    assert found("flat-field-two-pixels", 0, "float32") == Faults(digit=True, rejected=True)


def test_questions_are_spread_over_the_templates():
    assert list(questions("abcdef", 3)) == [("a", 0), ("c", 0), ("e", 0)]
    assert list(questions("ab", 5)) == [("a", 0), ("b", 0), ("a", 1), ("b", 1), ("a", 2)]


def test_counts_are_of_ten_thousand():
    found = Counted("2026-01-01", 10, 150, Basis({}, {}), {"float64": {"digit": 3}})
    assert found.of_round("float64", "digit") == 200
    assert found.of_round("float64", "accepted") == 0


def test_a_paper_is_timed_and_exact_solving_has_no_fault():
    told = []
    product = measure_product(12, 1, told.append)
    assert [row.system for row in product.rows] == list(ARITHMETICS)
    assert product.counted.drawn == 12
    assert product.counted.faults["exact"] == {}
    assert told
    for row in product.rows:
        assert row.whole.median == pytest.approx(sum(t.median for t in row.phases.values()))
        assert all(spent.median > 0 for spent in row.phases.values())


@pytest.mark.slow
def test_among_many_questions_only_exact_solving_has_no_fault():
    wrong = count_faults(builtin(), 2 * len(builtin().paths), lambda _: None).faults
    assert not wrong["exact"]
    assert wrong["float64"]["rejected"] > 0
    assert wrong["rounded"]["accepted"] > 0
    assert wrong["float32"]["digit"] > wrong["float64"].get("digit", 0)
    assert wrong["certified"]["unanswered"] > 0


def test_what_is_recorded_was_counted_in_full():
    found = recorded()
    assert found.drawn == 10_000
    assert found.faults["exact"] == {}
    assert found.faults["float64"]["rejected"] > 100
    assert set(found.faults) == set(ARITHMETICS)


ANEW = "count again: uv run python tools/do.py counts"
CHANGED = 0.05
"""Share of templates whose change would move the counts by no more than itself."""


def test_what_is_recorded_was_counted_with_this_code():
    """A change of comments and docstrings makes nothing stale, one of code does."""
    assert recorded().basis.code == basis(builtin()).code, ANEW


def test_what_is_recorded_was_counted_from_these_templates():
    then, now = recorded().basis.templates, basis(builtin()).templates
    names = then.keys() | now.keys()
    changed = [name for name in names if then.get(name) != now.get(name)]
    assert len(changed) <= CHANGED * len(names), ANEW


def test_a_digest_follows_code_and_not_comments():
    module = 'def f(x):\n    """Said."""\n    # why\n\n    return x + 1\n'
    assert meaning(module) == meaning("def f(x):\n    return x + 1\n")
    assert meaning(module) != meaning(module.replace("+ 1", "+ 2"))
