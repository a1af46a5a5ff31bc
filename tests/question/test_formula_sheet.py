"""The formula sheet in words: what stands on it, and what it says when nothing can."""

from __future__ import annotations

import pytest

from quizgen.bank.bank import Bank
from quizgen.cards.checks import check_cards
from quizgen.core.errors import BankError
from quizgen.question.formula_sheet import compose_sheet
from quizgen.typeset.prose import PlainText


def lines(made):
    return [line for group in made.groups for line in group.lines]


def test_every_formula_stands_on_the_sheet_once_in_both_languages(bank):
    found = lines(compose_sheet(bank, "both"))
    assert sorted(line.id for line in found) == [f"F{n:02}" for n in range(1, 47)]
    assert {tuple(said.lang for said in line.said) for line in found} == {("en", "bn")}


def test_topics_stand_in_the_order_in_which_they_are_learnt(bank):
    made = compose_sheet(bank, "en")
    assert [group.topic for group in made.groups[:3]] == ["projection", "normalisation", "aperture"]
    assert made.groups[0].titles == {"en": "Projection"}


def test_a_topic_alone_has_its_own_formulas(bank):
    made = compose_sheet(bank, "bn", ["distortion"])
    assert [line.id for line in lines(made)] == ["F20", "F21", "F22"]
    assert made.langs == ("bn",)


def test_units_questions_and_section_are_told(bank):
    (line,) = (
        line for line in lines(compose_sheet(bank, "both", ["projection"])) if line.id == "F05"
    )
    told = [part.text if isinstance(part, PlainText) else part.typed_text for part in line.units]
    assert "".join(told).replace("\u00a0", " ") == "p_x, p_y, p_z [m]; f, p'_x, p'_y [mm]"
    assert line.section == "4.1"
    english, bangla = (dict(said.questions) for said in line.said)
    assert english.keys() == bangla.keys()
    name = "point-to-image-plane-fractions"
    for lang, titles in (("en", english), ("bn", bangla)):
        written = (bank.folder_of(name) / f"{lang}.md").read_text("utf-8")
        assert written.splitlines()[0] == f"# {titles[name]}"


def test_nothing_to_show_is_said_with_the_place(bank, tmp_path):
    (tmp_path / "templates").mkdir()
    with pytest.raises(BankError, match=r"no formulas here .*templates/cards/formulas\.toml"):
        compose_sheet(Bank(tmp_path), "en")
    with pytest.raises(BankError, match="no formulas of the topic camera here"):
        compose_sheet(bank, "en", ["camera"])


def test_a_formula_has_a_sketch_described_in_each_language(bank):
    (lens,) = (line for line in lines(compose_sheet(bank, "both", ["optics"])) if line.id == "F42")
    english, bangla = lens.figures
    assert english.alt == "A thin lens with an object at z and its upside-down image at z′."
    assert bangla.alt.startswith("Thin lens")
    (scaled,) = (
        line for line in lines(compose_sheet(bank, "en", ["projection"])) if line.id == "F07"
    )
    assert scaled.figures == ()


WITHOUT = """
[[entry]]
id = "G1"
topic = "waves"
tier = "A"
section = "1"
title.en = "Speed"
figure = { name = "ripples" }
lines = ["v = s/t"]
about.en = "$s$: way; $t$: time."
beware.en = "Units."
"""


def test_a_sketch_that_there_is_not_is_named_with_its_formula_by_sheet_and_lint(tmp_path):
    cards = tmp_path / "templates" / "cards"
    cards.mkdir(parents=True)
    (cards / "formulas.toml").write_text(WITHOUT)
    (tmp_path / "templates" / "bank.toml").write_text(
        'name = "waves"\nlanguages = ["en"]\n[title]\nen = "Waves"\n[topics]\nwaves = { en = "Waves" }\n'
    )
    waves = Bank(tmp_path)
    with pytest.raises(
        BankError, match=r"formulas\.toml:\d+: entry 'G1': unknown figure 'ripples'"
    ):
        compose_sheet(waves, "en")
    assert [one for one in check_cards(waves) if "entry 'G1': unknown figure 'ripples'" in str(one)]
