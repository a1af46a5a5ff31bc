"""Several banks as one: each keeps its own, and what two call the same is told apart."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from mechanics import write

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.combined import CombinedBank, bank_sources, open_banks
from quizgen.bank.variant import draw_variant
from quizgen.cards import build_deck
from quizgen.core.errors import BankError, FormulaError
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.paper.selection import select_templates
from quizgen.question.compose import compose_question
from quizgen.question.formula_sheet import compose_sheet

FILTERING = Path(__file__).parent.parent.parent / "examples" / "filtering"


@pytest.fixture(scope="module")
def both():
    return open_banks([("", True), (str(FILTERING), True)])


@pytest.fixture
def twins(tmp_path):
    """Two banks of the same template, whose hauls and figures are not the same."""
    one = write(tmp_path / "one")
    other = write(tmp_path / "other")
    about = other / "templates" / "bank.toml"
    said = about.read_text("utf-8")
    about.write_text(
        said.replace('"mechanics"', '"statics"').replace("= kcr * m", "= 2 * kcr * m"), "utf-8"
    )
    return CombinedBank((Bank(one, trusted=True), Bank(other, trusted=True)))


def test_a_name_of_one_bank_alone_is_kept(both):
    assert len(both) == len(builtin_bank()) + 15
    assert "otsu-threshold" in both.template_paths
    assert not [name for name in both.template_paths if ":" in name]
    assert list(both.template_paths) == sorted(both.template_paths)
    assert both.topics == (*builtin_bank().topics, *Bank(FILTERING).topics)
    assert both.topic_title("edges", "de") == "Kanten"


def test_what_two_banks_call_the_same_is_told_apart(twins):
    assert list(twins.template_paths) == ["mechanics:push", "statics:push"]
    assert [twins.origin(name) for name in twins.template_paths] == [
        "mechanics:push",
        "statics:push",
    ]
    with pytest.raises(BankError, match="did you mean mechanics:push or statics:push"):
        twins.template("push")


def test_each_bank_has_its_own_units_and_figures(twins, both):
    first, second = (twins.template(name) for name in twins.template_paths)
    assert second.unit_factor("hu") == 2 * first.unit_factor("hu") == 2 * first.unit_factor("kcr")
    assert Path(first.figure.__file__).is_relative_to(twins.members[0].root)
    assert Path(second.figure.__file__).is_relative_to(twins.members[1].root)
    with pytest.raises(FormulaError, match="op"):
        both.template("thin-lens-image-distance").unit_factor("op")


def test_questions_are_those_of_the_bank_alone(both):
    alone = Bank(FILTERING, trusted=True)
    pair = [draw_variant(bank.template("otsu-threshold"), 3).shown_values for bank in (both, alone)]
    assert pair[0] == pair[1]


def test_another_process_opens_the_same_banks(both):
    again = pickle.loads(pickle.dumps(both))
    assert list(again.template_paths) == list(both.template_paths)
    assert again.members[0] is builtin_bank()
    assert bank_sources(again) == bank_sources(both)


def test_a_blueprint_of_a_bank_asks_its_own_questions(both):
    alone = Bank(FILTERING, trusted=True)
    assert {"trial", "filtering:mock", "image-acquisition:mock"} <= {*both.blueprints}
    mixed = build_paper(both, load_blueprint("filtering:mock", both), 4, figures=False)
    own = build_paper(alone, load_blueprint("mock", alone), 4, figures=False)
    assert mixed.code == f"filtering:{own.code}"
    names = {*select_templates(both, load_blueprint("image-acquisition:mock", both), 4)}
    assert names <= {*builtin_bank().template_paths}


def test_a_paper_of_all_asks_every_bank(both):
    for seed in range(5):
        names = select_templates(both, load_blueprint("all.60", both), seed)
        share = sum(name in both.members[1].template_paths for name in names) / len(names)
        assert 0.3 < share < 0.7


def test_languages_are_those_of_all(both, tmp_path):
    assert both.languages == ("en",)
    assert both.resolve_languages("both") == ("en",)
    with pytest.raises(BankError, match="filtering is written in en, de"):
        both.resolve_languages("bn")
    other = write(tmp_path / "other")
    about = other / "templates" / "bank.toml"
    about.write_text(about.read_text("utf-8").replace('["en"]', '["de"]'), "utf-8")
    third = write(tmp_path / "third")
    about = third / "templates" / "bank.toml"
    about.write_text(about.read_text("utf-8").replace('"mechanics"', '"third"'), "utf-8")
    with pytest.raises(BankError, match=r"no language is common.*mechanics is written in de"):
        assert CombinedBank((Bank(third), Bank(other))).languages


def test_two_banks_of_one_name_are_refused(tmp_path):
    roots = [write(tmp_path / name) for name in ("one", "other")]
    with pytest.raises(BankError, match=r"one and .*other: both are called 'mechanics'"):
        CombinedBank(tuple(Bank(root) for root in roots))


def test_a_topic_of_two_banks_is_one(twins):
    assert twins.topics == ("forces",)
    assert [twins.rules(name).topic for name in twins.template_paths] == ["forces", "forces"]


def test_cards_of_both_keep_their_notes(both):
    kinds = ("truth", "vocab")
    mixed = build_deck(kinds=kinds, bank=both)
    alone = [build_deck(kinds=kinds, bank=part) for part in both.members]
    assert {note.guid for note in mixed.notes} == {n.guid for one in alone for n in one.notes}
    assert {note.columns for note in mixed.notes} == {("en", "bn"), ("en", "de")}


def test_cards_of_the_same_template_are_two(twins):
    keys = {note.key for note in build_deck(kinds=("question",), bank=twins).notes}
    assert len(keys) == 2 * len(build_deck(kinds=("question",), bank=twins.members[0]).notes)
    assert all(key.partition(":")[0] in {"mechanics", "statics"} for key in keys)


FORMULA = """
[[entry]]
id = "F01"
topic = "forces"
tier = "A"
section = "1"
lines = ["F = m*a"]
title.en = "Newton"
about.en = "A force."
beware.en = "Units."
"""


def test_formulas_of_one_number_are_told_apart(tmp_path):
    root = write(tmp_path / "own")
    (root / "templates" / "cards").mkdir()
    (root / "templates" / "cards" / "formulas.toml").write_text(FORMULA, "utf-8")
    rules = root / "templates" / "forces" / "push" / "template.toml"
    rules.write_text(rules.read_text("utf-8").replace("\n\n", '\ncovers = ["F01"]\n\n', 1), "utf-8")
    mixed = CombinedBank((builtin_bank(), Bank(root, trusted=True)))
    assert mixed.rules("push").covers == ("mechanics:F01",)
    found = {line.id: line for group in compose_sheet(mixed, "en").groups for line in group.lines}
    assert [name for name, _ in found["mechanics:F01"].said[0].questions] == ["push"]
    assert "push" not in {name for name, _ in found["image-acquisition:F01"].said[0].questions}


def test_a_question_of_each_can_be_asked(both, twins):
    for bank, name in ((both, "count-components"), (twins, "statics:push")):
        question, key = compose_question(bank.template(name), 1, "en")
        assert question.figure
        assert key.template == name
