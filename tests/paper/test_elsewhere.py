"""A paper and its bank can be handed to another process."""

from __future__ import annotations

import pickle

import pytest

from quizgen.bank.folder import Bank, builtin
from quizgen.marking.mark import mark
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.key import key_bytes
from quizgen.paper.paper import build
from quizgen.render import render_paper


@pytest.fixture(scope="module")
def paper():
    return build(builtin(), load_blueprint("trial", builtin()), 3, "both")


def pages(paper):
    return [render_paper(paper, kind, "html") for kind in ("exam", "solutions")], key_bytes(paper)


def test_a_paper_is_the_same_after_its_journey(paper):
    before = pages(paper)
    for item in paper.items:
        for part in item.keys[0].specs:
            mark(part, "1")
    again = pickle.loads(pickle.dumps(paper))
    assert pages(again) == before


def test_a_template_and_a_draw_go_with_their_numbers():
    from quizgen.bank.draw import draw

    template = builtin().template("point-to-image-plane")
    drawn = draw(template, 5)
    again = pickle.loads(pickle.dumps(drawn))
    assert again.template == template
    assert (again.shown, again.values) == (drawn.shown, drawn.values)
    assert draw(again.template, 5).values == drawn.values


def test_the_banks_own_is_the_one_there_is():
    assert pickle.loads(pickle.dumps(builtin())) is builtin()


def test_another_bank_is_opened_anew_and_trusted_as_before():
    for trusted in (True, False):
        again = pickle.loads(pickle.dumps(Bank(builtin().root, trusted=trusted)))
        assert (again.root, again.trusted) == (builtin().root, trusted)
        assert len(again) == len(builtin())
