"""Figures that move: named by formulas, worded in every language, begun at a question's numbers."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import get_args

import pytest

import quizgen.web
from quizgen.bank.bank import Bank
from quizgen.bank.formulas import MovingName, read_formulas
from quizgen.core.errors import BankError
from quizgen.locale import list_languages
from quizgen.maths.numbers import to_float
from quizgen.question.compose import draw_instance
from quizgen.web.moving import find_moving_figure

MODULES = Path(quizgen.web.__file__).parent / "static" / "moving"
LOCALES = Path(quizgen.web.__file__).parent.parent / "locale"
NAMES = set(get_args(MovingName))

FORMULA = """[[entry]]
id = "D1"
topic = "light"
tier = "A"
section = "1"
title.en = "Half"
lines = ["b = a/2"]
about.en = "A half."
beware.en = "Not the double."
moves = "{}"
"""
TEMPLATE = """topic = "light"
tier = "A"
covers = ["D1"]

[draw]
N_1 = {{ pick = [2] }}
N_2 = {{ is = "{}" }}

[[part]]
answer = {{ kind = "tf", true = "N_1 > 4" }}
"""
PROSE = "# Two rings\nFrom f/{{ N_1 }} to f/{{ N_2 }}.\n\n**Is it?**\n\n## why\nLook.\n"


@pytest.fixture
def strangers(tmp_path):
    """Makes a bank of one question and one formula, whose figure is called like that."""

    def made(moves: str, number: str = "8") -> Bank:
        folder = tmp_path / "templates"
        (folder / "rings").mkdir(parents=True)
        (folder / "cards").mkdir()
        (folder / "cards" / "formulas.toml").write_text(FORMULA.format(moves), "utf-8")
        (folder / "rings" / "template.toml").write_text(TEMPLATE.format(number), "utf-8")
        (folder / "rings" / "en.md").write_text(PROSE, "utf-8")
        return Bank(tmp_path)

    return made


def begins(bank, template: str, seed: str = "3", lang: str = "en"):
    """The figure of a question, and the values that it begins at."""
    found = find_moving_figure(bank, template, draw_instance(bank.template(template), seed), lang)
    return found, json.loads(found.values)


def test_each_has_a_module_a_formula_and_words(bank):
    helper = (MODULES / "moving.js").read_text("utf-8")
    table = re.findall(r'^  "([\w-]+)": \(\) =>', helper, re.MULTILINE)
    assert set(table) == NAMES
    assert {path.stem for path in MODULES.glob("*.js")} == {*NAMES, "lines", "moving", "scene"}
    assert {entry.moves for entry in read_formulas(bank)} - {None} == NAMES


def test_every_language_says_the_same_with_the_same_blanks():
    def said(lang: str) -> dict:
        words = tomllib.loads((LOCALES / lang / "moving.toml").read_text("utf-8"))
        return {
            (section, name): set(re.findall(r"\{\w+\}", text))
            for section, texts in words.items()
            for name, text in texts.items()
        }

    english = said("en")
    assert {section for section, _ in english} == {*NAMES, "words"}
    assert [lang for lang in list_languages() if said(lang) != english] == []


@pytest.mark.parametrize(("template", "begin"), [
    ("point-to-image-plane", ("f", "p_y", "p_z")),
    ("blur-and-light-factors", ("f", "N_1", "r")),
    ("depth-of-field-limits", ("f", "N", "c", "s")),
    ("radial-point-off-axis", ("k_1", "k_2", "x", "y")),
    ("normalise-from-offset-range", ("I", "I_min", "I_max", "N_min", "N_max")),
    ("gaussian-peak-and-tail-shares", ("sigma", "M")),
    ("hsv-to-rgb", ("H", "S", "V")),
])  # fmt: skip
def test_it_begins_at_the_numbers_of_its_question(bank, template, begin):
    drawn = draw_instance(bank.template(template), "3")
    _, values = begins(bank, template)
    given = {name: to_float(drawn.shown_values[name]) for name in begin}
    assert {name: values[name] for name in begin} == pytest.approx(given)


def test_a_colour_that_is_given_as_rgb_begins_at_its_hue(bank):
    drawn = draw_instance(bank.template("rgb-to-hsv"), "3").shown_values
    red, green, blue = (to_float(drawn[name]) for name in "RGB")
    _, values = begins(bank, "rgb-to-hsv")
    assert values["V"] == max(red, green, blue)
    assert values["S"] == pytest.approx((values["V"] - min(red, green, blue)) / values["V"])


def test_a_number_of_stops_leads_to_another_number_of_the_ring(bank):
    template = "stopping-down-or-opening-effects"
    leads = {
        (0, 1): 5.6, (0, 2): 8, (0, 3): 11, (0, 4): 16,
        (1, 1): 2.8, (1, 2): 2, (1, 3): 1.4, (1, 4): 1,
    }  # fmt: skip
    for seed in map(str, range(12)):
        drawn = draw_instance(bank.template(template), seed).shown_values
        _, values = begins(bank, template, seed)
        led = leads[to_float(drawn["opening"]), to_float(drawn["stops"])]
        assert (values["N_1"], values["N"]) == (4, led)


def test_more_levels_stretch_a_histogram(bank):
    for seed in map(str, range(40)):
        most = to_float(
            draw_instance(bank.template("normalise-and-clamp"), seed).shown_values["I_max"]
        )
        figure, values = begins(bank, "normalise-and-clamp", seed)
        assert values["I_max"] == most
        assert values["scale"] == {235: 1, 255: 1, 1023: 4, 4095: 16}[most]
        assert {one.name: one.most for one in figure.sliders}["I_max"] == 256 * values["scale"]


def test_a_bank_of_strangers_names_one(strangers):
    figure, values = begins(strangers("aperture-ring"), "rings")
    assert (figure.name, values["N_1"], values["N"]) == ("aperture-ring", 2, 8)
    assert values["f"] == 50  # their question has none


@pytest.mark.parametrize(("number", "place"), [("6.3", 6), ("10/3", 4), ("250/0.7", 11)])
def test_a_value_between_two_stops_is_a_stop_of_its_own(strangers, number, place):
    figure, values = begins(strangers("aperture-ring", number), "rings")
    (ring,) = figure.sliders
    stops = [float(stop) for stop in ring.stops.split()]
    assert (len(stops), ring.at, stops.index(values["N"])) == (12, place, place)


@pytest.mark.parametrize("number", ["100000", "10^400", "0"])
def test_what_the_figure_has_no_room_for_is_left_out(strangers, number):
    _, values = begins(strangers("aperture-ring", number), "rings")
    assert values["N"] == 8


def test_a_misspelt_name_is_said_where_it_stands(strangers):
    with pytest.raises(BankError, match=r"formulas\.toml.*moves.*aperture-rign"):
        read_formulas(strangers("aperture-rign"))


def test_a_question_has_it_once_no_part_is_open(client, token, begin):
    at = begin("depth-of-field-limits")
    parts = ["1a", "1b", "1c", "1d", "1e"]
    for part in parts:
        assert "moving-figure" not in client.get(at).text
        client.post(f"{at}/{part}", data={"token": token, "do": "solution"})
    assert 'data-figure="focus-distance"' in client.get(at).text
