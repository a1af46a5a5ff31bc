"""Formulas to choose from and tasks turned round: neither length nor habit tells the answer."""

from __future__ import annotations

from collections import Counter, defaultdict

import pytest
from sweep import draws, spread, together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.levels import guided
from quizgen.question.levels.comparison import choose_comparison
from quizgen.question.levels.consequence import choose_consequence, choose_way_back
from quizgen.question.levels.distractors import draw_formula_options
from quizgen.question.levels.error_spotting import choose_faulty_solution
from quizgen.question.levels.perturbations import Perturbations

CALCULATING = [
    name for name in builtin_bank().template_paths
    if builtin_bank().rules(name).solver and builtin_bank().rules(name).levels
]  # fmt: skip
MOST = 0.9
"""Share of the draws in which one answer may be right."""
FEWEST = 20
"""Times that something must have been asked before its answers are compared."""


def choices(name, seeds):
    """The formulas to choose from, of every draw that asks for one."""
    for seed in range(seeds):
        drawn = draw_variant(builtin_bank().template(name), seed)
        if guided.is_applicable(drawn):
            for stage in guided.guided_stages(drawn):
                if stage.formula is not None:
                    yield draw_formula_options(drawn, stage.formula, stage.known)


def longest(ways):
    """Whether the right formula is longer than all others."""
    lengths = [(way.is_right, len(inlines_to_text((way.shown,)))) for way in ways]
    right = next(length for is_right, length in lengths if is_right)
    return all(right > length for is_right, length in lengths if not is_right)


def test_the_longest_formula_is_no_better_guess_than_any():
    found = [ways for name in CALCULATING for ways in choices(name, 1)]
    chance = sum(1 / len(ways) for ways in found) / len(found)
    assert sum(map(longest, found)) / len(found) <= chance + 0.1


@together("name", spread(CALCULATING, 0, slow=15))
def test_in_no_template_is_the_longest_formula_mostly_right(name):
    found = list(choices(name, 50))
    assert sum(map(longest, found)) <= 0.6 * len(found)


@pytest.mark.parametrize(
    ("name", "step"),
    [("uint8-mean", "w"), ("luminous-flux-over-bands", "S"), ("noise-and-rounding", "sigma_q")],
)
def test_a_slip_is_a_formula_of_its_own_with_another_value(name, step):
    slips = set()
    for ways in choices(name, 12):
        assert len({way.shown.typed_text for way in ways}) == len(ways)
        assert [way.is_right for way in ways].count(True) == 1
        for way in ways:
            if way.slip and way.shown.typed_text.startswith(f"{step} = "):
                slips.add(way.slip)
                right = next(other for other in ways if other.is_right)
                assert abs(float(way.value) - float(right.value)) > 1e-6 * abs(float(right.value))
    assert slips


def test_bits_as_bytes_are_no_formula_to_choose():
    """M = Q holds in whatever units, and tells nothing of the 8."""
    for seed in range(12):
        drawn = draw_variant(builtin_bank().template("stored-values-and-bytes"), seed)
        assert "M" not in {
            stage.formula.name for stage in guided.guided_stages(drawn) if stage.formula
        }


def answers(name, seeds):
    """What is asked of a template turned round, to its answers."""
    found = defaultdict(Counter)
    for seed in range(seeds):
        drawn = draw_variant(builtin_bank().template(name), seed)
        changes = Perturbations(drawn)
        asked, mistake = choose_consequence(changes), choose_faulty_solution(drawn)
        pair = choose_comparison(changes, asked)
        if asked is not None and asked.way == "factor":
            found["factor"][asked.change.factor] += 1
        if (back := choose_way_back(changes, asked)) is not None:
            found["back"][back.change.scale] += 1
        if pair is not None:
            found["compare"][pair.answer] += 1
        if mistake is not None:
            found[f"mistake in {len(mistake.steps)} steps"][mistake.place] += 1
    return found


def one_sided(name, seeds, fewest):
    return {
        (name, asked)
        for asked, counts in answers(name, seeds).items()
        if counts.total() >= fewest and max(counts.values()) > MOST * counts.total()
    }


@pytest.mark.parametrize(
    "name",
    ["coefficients-from-measured-points", "normalise-from-offset-range", "fold-over-radius"],
)
def test_a_change_goes_either_way(name):
    assert one_sided(name, 40, 8) == set()


@together("name", spread(CALCULATING, 0, slow=15))
def test_no_answer_is_right_in_nearly_every_draw(name):
    assert one_sided(name, draws(50, full=200), FEWEST) == set()


def test_two_changes_are_of_different_quantities():
    for seed in range(20):
        drawn = draw_variant(builtin_bank().template("depth-of-field-limits"), seed)
        pair = choose_comparison(Perturbations(drawn), None)
        assert pair is None or pair.first.given != pair.second.given
