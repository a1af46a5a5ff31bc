"""A paper at a level, from its making to its marks, through files; its code makes it again."""

from __future__ import annotations

from fractions import Fraction

import msgspec
import pytest
from road import Desk, all_templates, fields, typed
from sweep import draws, sample, together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.levels import CHOICES, EXAM
from quizgen.core.errors import PaperCodeError
from quizgen.lint.leaks import find_paper_leaks
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.code import parse_code
from quizgen.paper.paper import build_paper, rebuild_paper

LEVELS = [level for level in CHOICES if level != EXAM]
BLUEPRINTS = ("mock", "trial")
PAPERS = [
    *((name, 0) for name in BLUEPRINTS),
    *(
        pytest.param(BLUEPRINTS[seed % 2], seed, marks=pytest.mark.slow)
        for seed in range(1, draws(4, full=50))
    ),
]
"""One of each blueprint by default, then the two in turn."""


def at(level, name="trial"):
    return msgspec.structs.replace(load_blueprint(name), level=level)


@pytest.mark.slow
@pytest.mark.parametrize("level", sample(LEVELS, 1))
@pytest.mark.parametrize("seed", range(1, draws(2, full=5)))
def test_what_is_printed_is_marked_right_from_files(bank, tmp_path, level, seed):
    desk = Desk(tmp_path, all_templates(bank, seed, level=level))
    for lang in ("en", "bn"):
        printed = list(fields(desk.paper, lang))
        desk.toml({field.id: typed(field, field.answer) for field in printed})
        desk.json({field.id: typed(field, field.answer, side=1) for field in printed}, lang)
    for found in desk.marks():
        lost = {part: one["note"] for part, one in found.items() if one["status"] == "wrong"}
        right = [one for one in found.values() if one["status"] in {"correct", "open"}]
        assert not lost
        assert len(right) >= len(printed)


@pytest.mark.parametrize("level", LEVELS)
def test_a_code_holds_its_level_and_makes_the_paper_again(level):
    paper = build_paper(builtin_bank(), at(level), 5, "both", figures=False)
    assert f"-both-{level}-" in paper.code
    assert parse_code(paper.code).level == level
    again = rebuild_paper(builtin_bank(), paper.code, figures=False)
    assert write_answer_key(again) == write_answer_key(paper)
    exam = build_paper(builtin_bank(), at(EXAM), 5, "both", figures=False)
    assert exam.points == paper.points
    if any(item.keys[0].level != EXAM for item in paper.items):
        with pytest.raises(PaperCodeError):
            rebuild_paper(builtin_bank(), paper.code.replace(f"-{level}", ""), figures=False)


@together("level", LEVELS)
@together(("name", "seed"), PAPERS)
def test_no_question_of_a_paper_tells_what_another_one_asks(level, name, seed):
    paper = build_paper(builtin_bank(), at(level, name), seed, "both", figures=False)
    assert find_paper_leaks(paper) == []


@pytest.mark.parametrize("level", ["guided", "transfer"])
def test_formulas_that_two_questions_ask_are_printed_by_neither(level):
    pair = ("image-height-and-fill-distance", "point-to-image-plane", "image-scaling-laws")
    slots = tuple(SlotRule(templates=(name,), level=level) for name in pair)
    for seed in range(8):
        assert (
            find_paper_leaks(
                build_paper(builtin_bank(), Blueprint({"en": "x"}, slots, name="x"), seed)
            )
            == []
        )


def test_a_slot_may_have_a_level_of_its_own():
    slots = (
        SlotRule(templates=("rgb-to-hsv",), level="guided"),
        SlotRule(templates=("hsv-to-rgb",)),
    )
    paper = build_paper(builtin_bank(), Blueprint({"en": "x"}, slots, name="x"), 1, figures=False)
    assert [item.keys[0].level for item in paper.items] == ["guided", EXAM]
    assert all(item.points == Fraction(6) for item in paper.items)


def test_a_question_without_a_calculation_stays_as_it_is():
    slots = (SlotRule(templates=("why-pinhole-model",)),)
    plan = Blueprint({"en": "x"}, slots, name="x", level="guided")
    (item,) = build_paper(builtin_bank(), plan, 1, figures=False).items
    assert item.keys[0].level == EXAM
