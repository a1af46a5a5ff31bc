"""The minutes of a question, added up by hand from the table of the manual."""

from __future__ import annotations

from fractions import Fraction

import pytest

from quizgen.bank.rules import PartRule, Rules
from quizgen.bank.working_time import working_minutes
from quizgen.kinds import KINDS
from quizgen.kinds.work import MINUTES, VERBS
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula

NOTHING = Chain({}, ())


def minutes(answer, page, chain=NOTHING, **more):
    return working_minutes(Rules("light", "A", (PartRule(answer, **more),)), chain, page)


def test_words_are_read_and_the_words_of_the_model_are_written():
    """0.3 to find it, 30 words to read, 18 to write: 0.3 + 0.2 + 1.0."""
    page = f"# T\n{'word ' * 29}\n\n## model\n- a: {'word ' * 18}(One is enough.)\n"
    answer = {"kind": "rubric", "criteria": {"x": 1, "y": 1}}
    assert minutes(answer, page, points=2) == Fraction("1.5")
    assert minutes(answer, page, points=1) == Fraction("1.0"), "one of two criteria: half of it"


@pytest.mark.parametrize(
    ("answer", "works"),
    [
        ({"kind": "tf", "true": True}, 0.35),
        ({"kind": "choice", "options": dict.fromkeys("abcd", False)}, 4 * 0.35 / 2),
        ({"kind": "multi", "options": dict.fromkeys("abcd", False)}, 4 * 0.35),
        ({"kind": "match", "pairs": {"a": "b", "c": "d", "e": "f"}, "take": 2}, 2 * 0.35),
        ({"kind": "order", "steps": ["a", "b", "c"]}, 3 * 2 * 0.35),
        ({"kind": "gap", "gaps": ["a", "b"]}, 2 * 0.25),
        ({"kind": "derivation", "lines": {"a": {}, "b": {}}}, 2 * 0.85),
        ({"kind": "program", "solution": "a\nb\nc\n"}, 3 * 0.8),
        ({"kind": "sketch", "lines": {"a": 0, "b": 0}, "features": {"c": 0}}, (1 + 2 / 2) * 0.45),
        (
            {"kind": "witness", "symbols": {"x": "real"}, "demands": {"a": 0, "b": 0}},
            2 * 1.3 + 0.25,
        ),
        ({"kind": "code", "output": "1"}, 2 * 0.65),
        ({"kind": "expression", "value": "x"}, 2 * 0.85),
    ],
)
def test_each_kind_says_what_is_done(answer, works):
    """The title is three words; tenths of a minute are told."""
    assert minutes(answer, "# one two three\n") == Fraction(round((0.3 + 3 / 150 + works) * 10), 10)


def test_a_step_is_computed_once_and_a_name_for_a_number_is_none():
    steps = (ChainStep("a", parse_formula("x*y")), ChainStep("b", parse_formula("a/2")),
             ChainStep("c", parse_formula("b")))  # fmt: skip
    parts = tuple(PartRule({"kind": "number", "of": name}) for name in "bc")
    both = working_minutes(Rules("light", "A", parts), Chain({}, steps), "# T\n")
    assert both == Fraction(round((0.3 + 1 / 150 + 2 * (0.65) + 2 * 0.25) * 10), 10)


def test_what_an_author_says_holds():
    assert working_minutes(Rules("l", "A", (), minutes=7), NOTHING, "") == 7


def test_every_kind_has_a_verb_and_every_unit_a_time():
    assert {kind.verb for kind in KINDS.values()} == set(VERBS)
    assert all(value > 0 for value in MINUTES.values())


def test_the_bank_leaves_it_to_the_model_and_points_go_with_it(bank):
    rules = [bank.rules(name) for name in bank.template_paths]
    assert not any(one.minutes for one in rules)
    points = sum(one.points for one in bank.candidates())
    whole = sum(map(bank.minutes, bank.template_paths))
    assert 0.9 <= whole / points <= 1.1
