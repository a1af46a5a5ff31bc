"""Papers: the same code gives the same bytes, and nothing of the answer leaks."""

from __future__ import annotations

import hashlib
import json
import math
import os
import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path

import pytest
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import BlueprintError, PaperCodeError
from quizgen.paper.answer_form import write_blank_form
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.blueprint import Blueprint, SlotRule, load_blueprint
from quizgen.paper.code import parse_code
from quizgen.paper.paper import (
    build_paper,
    build_reference_paper,
    rebuild_paper,
    single_question_paper,
)
from quizgen.render import KINDS, RENDERERS, render_paper

ROOT = Path(__file__).parents[2]
SMALL = """
import hashlib
from quizgen.bank.bank import builtin_bank
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.answer_key import write_answer_key
from quizgen.paper.paper import build_paper
from quizgen.render import render_paper, KINDS, RENDERERS
paper = build_paper(builtin_bank(), load_blueprint("trial"), 5, "both")
print(paper.code)
print(hashlib.sha256(write_answer_key(paper)).hexdigest())
for output in RENDERERS:
    for kind in KINDS:
        print(output, kind, hashlib.sha256(render_paper(paper, kind, output)).hexdigest())
"""


def fresh_process(seed: str) -> str:
    return subprocess.run(
        [sys.executable, "-c", SMALL], capture_output=True, text=True, check=True, cwd=ROOT,
        env={**os.environ, "PYTHONHASHSEED": seed, "TZ": "Asia/Dhaka", "LC_ALL": "C"},
    ).stdout  # fmt: skip


def test_same_code_same_bytes_in_every_format_across_processes(bank):
    paper = build_paper(bank, load_blueprint("trial"), 5, "both")
    here = [paper.code, hashlib.sha256(write_answer_key(paper)).hexdigest()]
    here += [
        f"{output} {kind} {hashlib.sha256(render_paper(paper, kind, output)).hexdigest()}"
        for output in RENDERERS
        for kind in KINDS
    ]
    assert fresh_process("1").split("\n")[:-1] == here


def test_a_code_rebuilds_its_paper(bank):
    paper = build_paper(bank, load_blueprint("mock"), 12, "bn", figures=False)
    again = rebuild_paper(bank, paper.code, figures=False)
    assert write_answer_key(again) == write_answer_key(paper)
    code = parse_code(paper.code)
    assert (code.blueprint, code.seed, code.choice) == ("mock", "12", "bn")


def test_a_code_of_other_templates_is_refused(bank):
    with pytest.raises(PaperCodeError, match="other templates"):
        rebuild_paper(bank, "trial-5-en-000000", figures=False)
    with pytest.raises(PaperCodeError, match="not a paper's code"):
        rebuild_paper(bank, "hello")


def test_languages_and_figures_change_no_number(bank):
    papers = [
        build_paper(bank, load_blueprint("mock"), 3, lang, figures=False)
        for lang in ("en", "bn", "both")
    ]
    drawn = [[item.keys[0].draw.shown for item in paper.items] for paper in papers]
    assert drawn[0] == drawn[1] == drawn[2]


def test_a_mock_has_all_tiers_and_no_twins(bank):
    for seed in range(5):
        paper = build_paper(bank, load_blueprint("mock"), seed, figures=False)
        tiers = [item.questions[0].tier for item in paper.items]
        assert (tiers[0], tiers[-1]) == ("A", "D")
        assert all(2 <= tiers.count(tier) <= 9 for tier in "ABCD")
        names = [item.keys[0].identity for item in paper.items]
        assert len(set(names)) == len(names)


def test_questions_alone_do_not_hold_the_answer(bank):
    """Every rendered value of a key's solution must come from the key, not from the question."""
    paper = build_paper(bank, load_blueprint("mock"), 8, figures=False)
    for item in paper.items:
        question = item.questions[0]
        assert "Solution" not in repr(question)
        assert not hasattr(question, "draw")


def test_the_key_is_plain_json_with_exact_values(bank):
    table = json.loads(
        write_answer_key(build_paper(bank, load_blueprint("trial"), 5, figures=False))
    )
    assert table["format"] == "quizgen-key/2"
    for question in table["questions"]:
        for part in question["parts"]:
            assert part["spec"]["kind"]
            assert part["id"].startswith(question["number"])


def test_the_blank_form_asks_every_part(bank):
    paper = build_paper(bank, load_blueprint("mock"), 5, "both", figures=False)
    form = tomllib.loads(write_blank_form(paper).decode())
    fields = [part.field.id for item in paper.items for part in item.questions[0].parts]
    assert list(form["answers"]) == fields
    assert set(form["answers"].values()) == {""}


def test_adding_a_template_changes_no_number_of_another(bank, tmp_path):
    import shutil

    from quizgen.bank.bank import Bank, builtin_root

    shutil.copytree(builtin_root() / "templates", tmp_path / "templates")
    source = bank.template_paths["point-to-image-plane"]
    shutil.copytree(source, tmp_path / "templates" / "projection" / "A3copy")
    larger = Bank(tmp_path, trusted=True)
    blueprint = Blueprint(
        {"en": "x"}, (SlotRule(templates=("point-to-image-plane-fractions",), count=4),), name="x"
    )
    small = build_paper(bank, blueprint, 9, figures=False)
    big = build_paper(larger, blueprint, 9, figures=False)
    assert [i.keys[0].draw.shown for i in small.items] == [i.keys[0].draw.shown for i in big.items]


@together("name", ["mock", "trial", "all", "code", "colour", "noise"])
def test_no_question_gives_the_answer_of_another(bank, name):
    for seed in range(2):
        paper = build_paper(bank, load_blueprint(name), seed, figures=False)
        chosen = {item.keys[0].template for item in paper.items}
        for one in chosen:
            assert not chosen & set(bank.rules(one).apart), (seed, one)


def test_a_topic_and_a_time_choose_the_questions(bank):
    paper = build_paper(bank, load_blueprint("optics.45"), 1, figures=False)
    assert 20 <= paper.minutes <= 45
    assert {item.questions[0].topic for item in paper.items} == {"optics"}
    whole = build_paper(bank, load_blueprint("all.90"), 1, figures=False)
    tiers = [item.questions[0].tier for item in whole.items]
    assert tiers == sorted(tiers)
    assert max(map(tiers.count, "ABCD")) - min(map(tiers.count, "ABCD")) <= 2


def test_the_number_of_possible_papers(bank):
    one = Blueprint({"en": "x"}, (SlotRule(templates=("point-to-image-plane",)),), name="x")
    two = Blueprint(
        {"en": "x"}, (SlotRule(templates=("point-to-image-plane",), count=2),), name="x"
    )
    either = Blueprint(
        {"en": "x"},
        (SlotRule(templates=("point-to-image-plane", "point-to-image-plane-fractions")),),
        name="x",
    )
    assert build_paper(bank, one, 0, figures=False).variety == 1368
    assert build_paper(bank, two, 0, figures=False).variety == 1368 * 1367 // 2
    assert build_paper(bank, either, 0, figures=False).variety == 1368 + 33976


def test_the_trial_exam_is_the_chapters_ten_points(bank):
    paper = build_paper(bank, load_blueprint("trial"), 2, figures=False)
    assert [item.keys[0].template for item in paper.items][1:] == [
        "mixing-kind-and-primaries",
        "aperture-two-effects",
        "sketch-barrel-or-pincushion",
        "point-to-image-plane",
    ]
    assert paper.points == 10
    key = json.loads(write_answer_key(paper))
    assert sum(Fraction(p["points"]) for q in key["questions"] for p in q["parts"]) == 10


def test_the_reference_paper_is_the_notes_own(bank):
    paper = build_reference_paper(bank, load_blueprint("mock"), "en")
    answers = {item.keys[0].template: item.keys[0].solution.parts for item in paper.items}
    assert answers["point-to-image-plane"][0].answer == "(4.00; 6.00)"
    assert answers["thin-lens-image-distance"][0].answer.startswith("200/3 mm")
    assert answers["point-to-pixel"][0].answer.startswith("(440; 160)")
    assert rebuild_paper(bank, paper.code).code == paper.code


@pytest.mark.parametrize("name", list(builtin_bank().blueprints))
def test_shipped_blueprints_load(name):
    assert load_blueprint(name).name == name


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("title = {en = 'x'}\n[[slots]]\ncount = 1", "allowed: aids, colour, figure_kinds"),
        ("topic = 'optics'\ntitle = {en = 'x'}\n[[slot]]\ntier = 'A'", "unknown key 'topic'"),
        (
            "title = {en = 'x'}\n[[slot]]\nkount = 1",
            "allowed: count, level, points, templates, tier, topic",
        ),
        ("title = {en = 'x'}\n[[slot]]\ntier = 'E'", "allowed: A, B, C, D"),
        ("title = {en = 'x'}\n[[slot]]\ncount = 0", "count must be"),
        ("title = {}\n[[slot]]\ncount = 1", "title: is empty"),
        ("title = {en = 'x'}\n[[slot]]\npoints = 0", "points must be"),
        ("title = {en = 'x'\n", "not valid TOML"),
        ("title = {en = 'x'}\nslot = []", "at least one"),
    ],
)
def test_mistakes_in_a_blueprint_are_located(tmp_path, text, message):
    file = tmp_path / "plan.toml"
    file.write_text(text)
    with pytest.raises(BlueprintError, match=message) as caught:
        load_blueprint(str(file))
    assert "plan.toml" in str(caught.value)


def test_a_slot_that_nothing_fits_is_named(bank):
    blueprint = Blueprint({"en": "x"}, (SlotRule(topic="cooking"),), name="x")
    with pytest.raises(BlueprintError, match="cooking"):
        build_paper(bank, blueprint, 0)


@pytest.mark.parametrize("name", ["thin-lens-image-distance", "uint8-sum"])
def test_a_template_looked_at_alone_takes_the_minutes_that_it_says(bank, name):
    said = math.ceil(bank.template(name).minutes)
    assert single_question_paper(bank.template(name), 1, "en", figures=False).minutes == said
