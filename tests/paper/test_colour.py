"""A paper says which pages need colour, and a blueprint for a grey printer leaves them out."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from quizgen.bank.bank import Bank
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper, rebuild_paper
from quizgen.render import html, pdf

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write

PUSH = "templates/forces/push/"
PULL = {
    name.replace("push", "pull"): text.replace('name = "block"', 'name = "other"')
    for name, text in FILES.items()
    if name.startswith(PUSH)
}
BLOCK = FILES["templates/figures/block.py"]
LIGHT = "\n\ndef COLOUR(values):\n    return values['m'] > 5\n"  # about half of the draws
PLAN = """
colour = {colour}
title.en = "Forces"
[[slot]]
count = {count}
"""


def bank_of(root: Path, colour: str, other: str = "") -> Bank:
    """Two questions, push and pull, whose figures say what they say of colour."""
    figures = {"block": BLOCK + colour, "other": BLOCK + other}
    files = {f"templates/figures/{name}.py": text for name, text in figures.items()}
    return Bank(write(root / "bank", {**PULL, **files}), trusted=True)


def plan(root: Path, colour: bool = True, count: int = 2):
    file = root / "forces.toml"
    file.write_text(PLAN.format(colour=str(colour).lower(), count=count), "utf-8")
    return file


def paper_of(root: Path, bank: Bank, seed: int = 1, **wish):
    return build_paper(bank, load_blueprint(str(plan(root, **wish)), bank), seed)


def asked(paper) -> list[str]:
    return [item.questions[0].template for item in paper.items]


def test_the_cover_names_the_question_whose_page_needs_colour(tmp_path):
    paper = paper_of(tmp_path, bank_of(tmp_path, "\nCOLOUR = True\n"))
    number = asked(paper).index("push") + 1
    said = f"Print the page with question {number} in colour."
    assert html.render_paper_html(paper, "exam").decode().count(said) == 1
    assert pdf.typst_sources(paper, "exam")["main.typ"].decode().count(said) == 1
    assert said not in html.render_paper_html(paper, "solutions").decode()


@pytest.mark.parametrize(
    ("lang", "said"),
    [
        ("en", "Print the pages with questions 1, 2 in colour."),
        ("bn", "1, 2 নম্বর প্রশ্নের পৃষ্ঠাগুলো রঙিন ছাপতে হবে।"),
        ("de", "Die Seiten mit den Aufgaben 1, 2 sind in Farbe zu drucken."),
    ],
)
def test_several_questions_are_named_in_every_language(tmp_path, lang, said):
    colour = "\nCOLOUR = True\n"
    paper = paper_of(tmp_path, bank_of(tmp_path, colour, colour))
    assert paper.printing(lang) == said


def test_a_paper_that_needs_no_colour_says_nothing_of_it(tmp_path):
    paper = paper_of(tmp_path, bank_of(tmp_path, ""))
    assert paper.printing("en") == ""
    assert "in colour" not in html.render_paper_html(paper, "exam").decode()


def test_without_colour_no_template_is_asked_that_needs_it(tmp_path):
    bank = bank_of(tmp_path, "\nCOLOUR = True\n")
    for seed in range(5):
        assert asked(paper_of(tmp_path, bank, seed, colour=False, count=1)) == ["pull"]
    assert {"push", "pull"} == set(asked(paper_of(tmp_path, bank)))


def test_without_colour_no_template_is_asked_that_may_need_it(tmp_path):
    bank = bank_of(tmp_path, LIGHT)
    assert asked(paper_of(tmp_path, bank, colour=False)) == ["pull", "pull"]


def test_numbers_that_seldom_need_colour_are_drawn_again(tmp_path, monkeypatch):
    monkeypatch.setattr("quizgen.paper.selection.DRAWN", 0)  # as if no sample had met them
    bank = bank_of(tmp_path, LIGHT, LIGHT)
    for seed in range(5):
        paper = paper_of(tmp_path, bank, seed, colour=False)
        assert [item.keys[0].draw.shown["m"] <= 5 for item in paper.items] == [True, True]


def test_a_figure_of_the_solution_alone_needs_no_coloured_exam(tmp_path):
    rules = FILES[PUSH + "template.toml"].replace('name = "block"', 'name = "block"\nquiz = false')
    bank = bank_of(tmp_path, "\nCOLOUR = True\n")
    (bank.root / PUSH / "template.toml").write_text(rules, "utf-8")
    paper = paper_of(tmp_path, bank, colour=False)
    assert "push" in asked(paper)
    assert paper.printing("en") == ""


def test_a_slot_that_only_coloured_figures_fit_is_named(tmp_path):
    colour = "\nCOLOUR = True\n"
    bank = bank_of(tmp_path, colour, colour)
    with pytest.raises(BlueprintError, match=r"slot 1: no template has tier any .* without colour"):
        paper_of(tmp_path, bank, colour=False)


def test_the_code_of_a_paper_without_colour_makes_it_again(tmp_path):
    bank = bank_of(tmp_path, LIGHT)
    paper = paper_of(tmp_path, bank, colour=False)
    again = rebuild_paper(bank, paper.code, load_blueprint(str(plan(tmp_path, colour=False)), bank))
    assert [one.keys[0].identity for one in again.items] == [
        one.keys[0].identity for one in paper.items
    ]
