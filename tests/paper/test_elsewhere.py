"""A paper and its bank can be handed to another process."""

from __future__ import annotations

import pickle

import pytest

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.kinds.grade import grade_answer
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.render import render_paper


@pytest.fixture(scope="module")
def paper():
    return build_paper(builtin_bank(), load_blueprint("trial", builtin_bank()), 3, "both")


def pages(paper):
    return [render_paper(paper, kind, "html") for kind in ("exam", "solutions")], write_answer_key(
        paper
    )


def test_a_paper_is_the_same_after_its_journey(paper):
    before = pages(paper)
    for item in paper.items:
        for part in item.keys[0].specs:
            grade_answer(part, "1")
    again = pickle.loads(pickle.dumps(paper))
    assert pages(again) == before


def test_a_template_and_a_draw_go_with_their_numbers():
    from quizgen.bank.variant import draw_variant

    template = builtin_bank().template("point-to-image-plane")
    drawn = draw_variant(template, 5)
    again = pickle.loads(pickle.dumps(drawn))
    assert again.template == template
    assert (again.shown, again.values) == (drawn.shown, drawn.values)
    assert draw_variant(again.template, 5).values == drawn.values


def test_the_banks_own_is_the_one_there_is():
    assert pickle.loads(pickle.dumps(builtin_bank())) is builtin_bank()


def test_another_bank_is_opened_anew_and_trusted_as_before():
    for trusted in (True, False):
        again = pickle.loads(pickle.dumps(Bank(builtin_bank().root, trusted=trusted)))
        assert (again.root, again.trusted) == (builtin_bank().root, trusted)
        assert len(again) == len(builtin_bank())
