"""Fields of parts inside sentences and cells, in every output."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.cards.kinds.question import template_notes
from quizgen.cards.markup import to_card_text
from quizgen.cards.request import DeckRequest
from quizgen.core.errors import BankError
from quizgen.kinds.grade import grade_answer
from quizgen.lint.template_checks import lint_template
from quizgen.lms.canvas import canvas_questions
from quizgen.lms.items import ExportItem
from quizgen.lms.moodle import moodle_questions
from quizgen.paper.answer_form import write_blank_form
from quizgen.paper.blueprint import find_blueprint
from quizgen.paper.paper import build_paper
from quizgen.question.compose import compose_question
from quizgen.question.levels import effective_level
from quizgen.question.part_context import ask_part
from quizgen.render.html import render_paper_html
from quizgen.render.pdf import render_paper_pdf, typst_sources
from quizgen.render.text import blocks_to_plain_text, format_question

TIDE = """topic = "sea"
tier = "A"
solver = "tide"
[draw]
h = { range = [3, 9, 1] }
[[part]]
points = "0.5"
answer = { kind = "gap", gaps = ["moon"] }
[[part]]
points = "0.5"
answer = { kind = "choice", in_order = true, options = { higher = true, lower = false } }
[[part]]
answer = { kind = "tf", true = "h > 5" }
[[part]]
answer = { kind = "number", of = "d", exact = true }
[[part]]
answer = { kind = "number", of = "q", exact = true }
"""
SOLVER = """from sympy import evaluate, symbols
from quizgen.maths.model import Model, Step
h, d, q = symbols("h d q")
with evaluate(False):
    MODEL = Model(given={h: ""}, steps=(Step(d, 2 * h, ""), Step(q, d / h + h, "")),
                  traps={"once": Step(d, h, "")})
"""
SECTION = """The tides follow the {{ ?a }}. At new moon the flood is **{{ ?b }} than** usual.

| tide | true | twice |
|---|---|---|
| high | {{ ?c }} | {{ ?d }} m |

## e
Twice over once is {{ ?e }}.
"""
REST = """
## gaps
- moon: Moon
## options
- higher: higher
- lower: lower
## reasons
- higher: Both pull.
- lower: Both pull.
## steps
- d: Twice.
- q: Over once.
## traps
- once: Once only.
## check
Twice.
"""


def make_bank(root: Path, section: str = SECTION, rules: str = TIDE) -> Bank:
    folder = root / "templates" / "sea" / "tide"
    folder.mkdir(parents=True)
    (root / "solvers").mkdir()
    (root / "solvers" / "tide.py").write_text(SOLVER)
    (folder / "template.toml").write_text(rules)
    (folder / "en.md").write_text(f"# Tides\nThe tide is {{{{ h }}}}.\n\n## a\n{section}{REST}")
    return Bank(root, trusted=True)


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    return make_bank(tmp_path_factory.mktemp("bank"))


@pytest.fixture(scope="module")
def paper(bank):
    return build_paper(bank, find_blueprint("all.10", bank), 1, "en")


def test_each_field_is_a_part_with_its_own_points_mistakes_and_words(bank):
    question, key = compose_question(bank.template("tide"), 1)
    assert [part.label for part in question.parts] == list("abcde")
    assert [float(part.points) for part in question.parts] == [0.5, 0.5, 1, 1, 1]
    assert [part.field.near for part in question.parts] == [
        "The tides follow the", "At new moon the flood is", "high: true", "high: twice: m",
        "Twice over once is",
    ]  # fmt: skip
    wrong = grade_answer(key.specs[3], f"{key.draw.shown['h']}")
    assert wrong.note == "trap:once"


def test_a_later_field_carries_an_earlier_mistake_forward(bank, paper):
    from quizgen.grading.options import GradingOptions
    from quizgen.paper.answer_key import make_key_question
    from quizgen.paper.grading import QuestionGrader

    key = make_key_question(paper.items[0])
    grader = QuestionGrader(key, GradingOptions("en"))
    h = paper.items[0].keys[0].draw.shown["h"]
    assert grader.grade_part(key.parts[3], f"{h}").verdict.note == "trap:once"
    assert grader.grade_part(key.parts[4], f"{h + 1}").verdict.credit > 0


def test_lint_finds_nothing_to_mend_but_that_words_hardly_vary(bank):
    found = lint_template(bank.template("tide"), 30, bank.languages).problems
    assert {one.code for one in found} <= {"QG301", "QG304", "QG305"}


def test_in_text_blanks_are_numbered_and_asked_one_by_one(paper):
    text = format_question(paper.items[0], solved=False)
    assert "The tides follow the (a)\u00a0____. At new moon the flood is (b)\u00a0____ than" in text
    assert "high | (c)\u00a0____ | (d)\u00a0____ m" in text
    form = write_blank_form(paper).decode()
    assert '"1a" = ""   # The tides follow the\n' in form
    assert re.search(r'"1d" = ""   # high: twice: m: ', form)


def test_on_a_page_inputs_and_lists_stand_in_the_sentence(paper):
    page = render_paper_html(paper, "exam").decode()
    sentence = re.search(r"<p>The tides follow.*?</p>", page, re.DOTALL)[0]
    assert re.search(
        r'<input type="text" id="a-1a" name="1a"[^>]*aria-label="[^"]*follow the"', sentence
    )
    assert re.search(r'<select id="a-1b" name="1b".*<option value="A">higher</option>', sentence)
    assert re.search(r'<td>[^|]*<option value="true">.*</td>', page)
    assert page.count('name="1d"') == 1
    assert "____" not in page
    assert 'class="blank"' in render_paper_html(paper, "solutions").decode()


def test_in_print_blanks_are_ruled_and_options_have_boxes(paper):
    source = typst_sources(paper, "exam")["main.typ"].decode()
    assert source.count("#blank(") == 3
    assert "higher" in source
    assert "answer-line" not in source
    assert render_paper_pdf(paper, "exam").startswith(b"%PDF")
    assert render_paper_pdf(paper, "solutions").startswith(b"%PDF")


def test_moodle_has_the_fields_in_the_text_and_other_courses_below(paper):
    item = ExportItem("t.en", "t", paper.items[0].questions[0], paper.items[0].keys[0])
    (moodle,) = moodle_questions(item)
    text = re.sub(r"\{[^}]*:([A-Z]+):[^}]*\}", r"<\1>", str(moodle.text))
    assert "the (a)\u00a0<SHORTANSWER>." in text
    assert "<td>(c)\u00a0<MULTICHOICE></td><td>(d)\u00a0<NUMERICAL> m</td>" in text
    assert "____" not in text
    assert re.findall("<([A-Z]+)>", text) == [
        "SHORTANSWER", "MULTICHOICE", "MULTICHOICE", "NUMERICAL", "NUMERICAL",
    ]  # fmt: skip
    canvas = list(canvas_questions(item))
    assert len(canvas) == 5
    assert all("(a)\u00a0____" in one.html for one in canvas[:4])


def test_each_card_shows_the_text_with_its_blanks(bank):
    cards = list(template_notes(bank.template("tide"), DeckRequest(bank=bank, langs=("en",))))
    assert len(cards) == 5
    for card in cards[:4]:
        assert "(a)\u00a0____" in to_card_text(card.words["Front"]["en"])


def test_one_field_stands_in_a_section_of_its_own(tmp_path):
    rules = TIDE.split("[[part]]", maxsplit=1)[0] + "[[part]]" + TIDE.split("[[part]]")[4]
    bank = make_bank(tmp_path, "The flood is {{ ?a }} m.\n", rules)
    question, _ = compose_question(bank.template("tide"), 1)
    assert list(blocks_to_plain_text(question.parts[0].body)) == ["The flood is ____ m."]


def test_such_a_question_is_not_asked_step_by_step(bank):
    assert effective_level(draw_variant(bank.template("tide"), 1), "guided") == "exam"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("{{ ?b }}", "{{ ?j }}", "no such part"),
        ("{{ ?b }}", "{{ ?a }}", "stands twice"),
        ("{{ ?b }}", "{{ ?e }}", "may stand in the section of part 'e'"),
        ("{{ ?d }} m |", "2 m |", "section 'd' is missing"),
        ("is {{ ?e }}", "{{ ?b }} {{ ?e }}", "twice"),
    ],
)
def test_a_field_in_the_wrong_place_is_an_error_at_its_line(tmp_path, old, new, said):
    bank = make_bank(tmp_path, SECTION.replace(old, new))
    with pytest.raises(BankError, match=said) as found:
        compose_question(bank.template("tide"), 1)
    assert found.value.rule in {"QG160", "QG157"}


def test_a_field_stands_neither_in_a_stem_nor_in_a_solution(tmp_path):
    bank = make_bank(tmp_path, SECTION)
    file = tmp_path / "templates/sea/tide/en.md"
    file.write_text(file.read_text().replace("Twice.\n", "Twice {{ ?a }}.\n"))
    with pytest.raises(BankError, match="section of a part alone"):
        compose_question(bank.reload().template("tide"), 1)


def test_fields_of_moodle_stand_below_where_the_text_has_another_order(tmp_path):
    section = SECTION.replace("{{ ?a }}", "{{ ?x }}").replace("{{ ?b }}", "{{ ?a }}")
    bank = make_bank(tmp_path, section.replace("{{ ?x }}", "{{ ?b }}"))
    item = ExportItem("t.en", "t", *compose_question(bank.template("tide"), 1))
    (moodle,) = moodle_questions(item)
    assert moodle.text.count("____") == 5
    assert moodle.text.count(":SHORTANSWER:") == 1


def test_a_point_in_a_sentence_is_one_line(tmp_path):
    rules = TIDE.replace('{ kind = "number", of = "q", exact = true }',
                         '{ kind = "point", of = ["d", "q"], exact = true }')  # fmt: skip
    question, key = compose_question(make_bank(tmp_path, SECTION, rules).template("tide"), 1)
    assert not question.parts[4].field.control.boxes
    h = int(re.search(r"is (\d)", "".join(blocks_to_plain_text(question.stem)))[1])
    assert grade_answer(key.specs[4], f"({2 * h}; {2 + h})").verdict == "correct"


def test_names_of_several_values_cannot_stand_in_a_sentence(tmp_path):
    rules = TIDE.replace('{ kind = "number", of = "q", exact = true }',
                         '{ kind = "table", of = { D = "d", Q = "q" }, exact = true }')  # fmt: skip
    bank = make_bank(tmp_path, SECTION, rules)
    assert ask_part(draw_variant(bank.template("tide"), 1), 4).control.boxes
    with pytest.raises(BankError, match="more than a line"):
        compose_question(bank.template("tide"), 1)


def test_the_example_of_the_manual_is_read(tmp_path):
    manual = (Path(__file__).parents[2] / "docs" / "banks.md").read_text("utf-8")
    section = manual[manual.index("## Fields in sentences and tables") :]
    words = section[section.index("## a\n") + 5 :].split("```", 1)[0]
    rules = TIDE.replace(
        '{ kind = "tf", true = "h > 5" }', '{ kind = "number", of = "d", exact = true }'
    )
    rules = "[[part]]".join(rules.split("[[part]]")[:4])
    question, _ = compose_question(make_bank(tmp_path, words, rules).template("tide"), 1)
    assert [part.field.near for part in question.parts][2] == "high: height: m"
