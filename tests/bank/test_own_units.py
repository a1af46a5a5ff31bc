"""Units and figures that a bank brings: read, printed, marked, and nobody else's."""

from __future__ import annotations

import json
import pickle
import sys
from pathlib import Path

import pytest
from sweep import together

sys.path.insert(0, str(Path(__file__).parent))

from click.testing import CliRunner
from mechanics import FILES, write

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.cli.main import root_group
from quizgen.core.errors import BankError, FormulaError
from quizgen.kinds.grade import grade_answer
from quizgen.maths.units import UnitRegistry, build_unit_registry, unit_factor
from quizgen.paper.answer_key import parse_answer_key
from quizgen.paper.grading import grade_paper
from quizgen.question.compose import compose_question

LINES = ("crate = [goods] = cr = crates", "haul = kcr * m / s**2 = hu", "shift = 28800 * s = sh")


def test_a_unit_is_defined_as_pint_defines_it():
    units = build_unit_registry(LINES)
    assert units.unit("hu").dimension == (("cr", 1), ("m", 1), ("s", -2))
    assert (units.factor("hu"), units.factor("kcr"), units.factor("mcr")) == (
        1000,
        1000,
        units.factor("cr") / 1000,
    )
    assert units.factor("hu*sh") == 28800 * 1000
    assert units.unit("hu/kcr").dimension == units.unit("m/s^2").dimension


@together(
    ("line", "said"),
    [
        ("haul", "expected"),
        ("haul = = hu", "expected"),
        ("metre = [length] = m", "already"),
        ("haul = kgg * m = hu", "unknown unit"),
        ("pound 2 = [mass]", "no name"),
        ("haul = [goods] = N2", "no symbol"),
        ("zero = 0 * m = z", "no size"),
        ("celsius = s; offset: 3 = C", "expected"),
        ("odd = m s = o", "no product"),
    ],
)
def test_a_definition_that_cannot_be_meant_is_refused(line, said):
    with pytest.raises(FormulaError, match=said):
        UnitRegistry((line,))


FORCE = {"kind": "quantity", "value": "6", "unit": "hu", "rel": "0.01", "define": list(LINES)}


@together(
    "typed",
    [
        "6 hu",
        "6 hauls",
        "6000 mhu",
        "0.006 khu",
        "6 kcr*m/s^2",
        "6 kcr m/s²",
        "6 Haul",
        "0.006 kilohaul",
        "F = 6 hu",
    ],
)
def test_a_unit_of_the_bank_is_read(typed):
    assert grade_answer(FORCE, typed).verdict == "correct"


def test_units_of_the_bank_are_judged_and_asked_back_as_ours_are():
    assert grade_answer(FORCE, "6").note == "unit-missing"
    assert grade_answer(FORCE, "6 kcr").note == "unit-wrong"
    assert grade_answer(FORCE, "6 furlongs").verdict == "unreadable"


def test_cells_of_a_table_know_them():
    table = {"kind": "table", "values": {"a": "6", "b": "2"}, "units": {"a": "hu", "b": "kcr"},
             "rel": "0.01", "define": list(LINES)}  # fmt: skip
    assert grade_answer(table, "6 hu; 2000 cr").verdict == "correct"


def test_no_other_question_knows_them():
    other = {"kind": "quantity", "value": "6", "unit": "m", "rel": "0.01"}
    assert grade_answer(FORCE, "6 hu").verdict == "correct"
    assert grade_answer(other, "6 kcr").verdict == "unreadable"
    with pytest.raises(FormulaError, match="unknown unit"):
        unit_factor("hu")


def test_a_paper_prints_marks_and_draws_with_what_the_bank_brings(tmp_path):
    root, out = write(tmp_path / "bank"), tmp_path / "paper"
    done = CliRunner().invoke(root_group, ["exam", "--bank", str(root), "--trust", "--topic", "forces",
                                      "--seed", "4", "--format", "html", "--out", str(out)])  # fmt: skip
    assert done.exit_code == 0, done.output
    exam, solved = ((out / name).read_text("utf-8") for name in ("exam.html", "solutions.html"))
    assert "pushed by a force of unknown size" in exam
    assert "of unknown size" not in solved
    key = parse_answer_key(json.loads((out / "key.json").read_bytes()))
    given = key.questions[0].chain.given
    force = int(given["m"].value) * int(given["a"].value) // 1000
    (part,) = grade_paper(key, {key.questions[0].parts[0].id: f"{force} hu"}).parts
    assert part.verdict.verdict == "correct"


def test_a_bank_that_is_not_trusted_draws_nothing(tmp_path):
    root = write(tmp_path, {"templates/forces/push/template.toml": FILES[
        "templates/forces/push/template.toml"].replace('"forces/newton"', '""')})  # fmt: skip
    with pytest.raises(BankError, match="--trust"):
        Bank(root).template("push")


def test_python_of_a_figure_that_fails_is_located(tmp_path):
    figure = FILES["templates/figures/block.py"].replace("sketch.arrow", "sketch.narrow")
    bank = Bank(write(tmp_path, {"templates/figures/block.py": figure}), trusted=True)
    with pytest.raises(BankError, match=r"block\.py:11: AttributeError: .*narrow"):
        compose_question(bank.template("push"))


def test_no_question_of_the_built_in_bank_holds_definitions():
    _, key = compose_question(builtin_bank().template("thin-lens-image-distance"), figures=False)
    assert not any(getattr(spec, "define", ()) for spec in key.specs)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ('units = ["haul = hu"]', r"bank\.toml:1: units: .*unknown unit 'hu'"),
        ('requires = ">=99"', r"bank\.toml:1: requires: quizgen >=99, and this is 1\.0"),
        ('requires = "new"', r"bank\.toml:1: requires: 'new' is not like"),
    ],
)
def test_what_bank_toml_cannot_hold_is_located(tmp_path, wrong, said):
    bank = Bank(write(tmp_path, {"templates/bank.toml": wrong}))
    with pytest.raises(BankError, match=said):
        assert bank.metadata


def test_a_template_goes_to_another_process_with_its_figure(tmp_path):
    template = Bank(write(tmp_path), trusted=True).template("push")
    again = pickle.loads(pickle.dumps(template))
    assert again.figure.__file__ == template.figure.__file__
    assert again.chain == template.chain
