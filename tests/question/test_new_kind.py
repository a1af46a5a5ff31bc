"""An answer kind is two modules and a row in two tables: nothing else makes, prints, marks it."""

from __future__ import annotations

import importlib.util
import json
import re
import sys
from pathlib import Path
from textwrap import dedent

import pytest
from msgspec import to_builtins

import quizgen.grading.kinds
import quizgen.question.kinds
from quizgen.bank.language_file import parse_language_file
from quizgen.bank.rules import DrawRule, PartRule, Rules
from quizgen.bank.template import Template
from quizgen.bank.variant import draw_variant
from quizgen.maths.chain import Chain
from quizgen.paper.answer_key import parse_answer_key, write_answer_key
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import single_question_paper
from quizgen.question.contract import Control, QuestionKind
from quizgen.render import render_paper as render

MARKING = '''
"""Kind ``compass``: one of the four directions, in words or by its letter."""

from quizgen.core.errors import FormulaError
from quizgen.grading.spec import Worded
from quizgen.grading.verdict import correct, wrong


class Spec(Worded, kw_only=True, frozen=True):
    toward: str

    def judge(self, typed, _options, /):
        letter = typed.strip().lower()[:1]
        return (correct if letter == self.toward[0] else wrong)(letter)

    def show(self):
        return self.toward
'''
ASKING = '''
"""Kind ``compass``: where a drawn phrase points."""

from compass_marking import Spec

from quizgen.question.contract import Built, Control
from quizgen.question.specs import specification


def build(drawn, index):
    return Built(specification(Spec, drawn, index, toward=drawn.words["way"]),
                 Control("lines", lines=2))


def hints(_spec, _lang):
    return ("One of the four directions.",)


def printed(spec, _lang):
    return f"toward the {spec.toward}"
'''


def module(folder, name, source):
    path = folder / f"{name}.py"
    path.write_text(dedent(source), encoding="utf-8")
    found = importlib.util.spec_from_file_location(name, path)
    made = importlib.util.module_from_spec(found)
    found.loader.exec_module(made)
    return made


@pytest.fixture
def compass(monkeypatch, tmp_path):
    """A kind that the project does not have, in both tables."""
    monkeypatch.syspath_prepend(tmp_path)
    marking = module(tmp_path, "compass_marking", MARKING)
    monkeypatch.setitem(sys.modules, "compass_marking", marking)
    asking: QuestionKind = module(tmp_path, "compass_asking", ASKING)
    monkeypatch.setitem(quizgen.grading.kinds.KINDS, "compass", marking.Spec)
    monkeypatch.setitem(quizgen.question.kinds.KINDS, "compass", asking)


TEXT = """# Directions
Where does a needle point that turns {{ way }}?
## words
- north: up
- west: to the left
"""


@pytest.fixture
def template():
    rules = Rules(
        topic="image",
        tier="A",
        part=(PartRule(answer={"kind": "compass"}, points=2),),
        draw={"way": DrawRule(words=("north", "west"))},
    )
    return Template(
        "needle", rules, Chain({}, ()), {"en": parse_language_file(TEXT)}, "needle-1", Path()
    )


@pytest.mark.usefixtures("compass")
def test_a_paper_with_an_invented_kind_is_made_printed_and_marked(template):
    paper = single_question_paper(template, 1, "en")
    (field,) = [part.field for part in paper.items[0].questions[0].parts]
    assert field.control == Control("lines", lines=2)
    assert field.hints == ("One of the four directions.",)
    way = draw_variant(template, 1).words["way"]
    assert to_builtins(paper.items[0].keys[0].specs[0]) == {"kind": "compass", "toward": way}

    page = render(paper, "exam", "html").decode()
    assert "One of the four directions." in page
    assert re.search(r'<input type="text"[^>]* id="a-1"', page)
    assert f"toward the {way}" in render(paper, "solutions", "html").decode()
    assert render(paper, "solutions", "pdf").startswith(b"%PDF")

    key = parse_answer_key(json.loads(write_answer_key(paper)))
    for typed, points in ((way[0], 2), ("south", 0)):
        assert grade_paper(key, {"1": typed}).marks == points
