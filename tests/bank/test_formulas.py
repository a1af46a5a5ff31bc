"""The formulas of a bank: each once, complete where it says something, and who asks for them."""

from __future__ import annotations

import json
import re
import shutil

import pytest
from sweep import together

from quizgen.bank.bank import Bank, builtin_root
from quizgen.bank.entries import load_entries
from quizgen.bank.formulas import (
    FormulaEntry,
    find_missing_formulas,
    find_unnamed_formulas,
    read_formulas,
    templates_by_formula,
)
from quizgen.core.errors import BankError

ENTRY = """
[[entry]]
id = "K1"
topic = "optics"
tier = "A"
section = "1"
title = { en = "Power", bn = "ক্ষমতা" }
lines = ["P = 1/f"]
about = { en = "In dioptres.", bn = "ডায়প্টারে।" }
beware = { en = "In metres.", bn = "মিটারে।" }
"""


def test_every_formula_of_the_inventory_is_there_once(bank):
    assert [entry.id for entry in read_formulas(bank)] == [f"F{n:02}" for n in range(1, 47)]


def test_steps_name_formulas_that_are_there(bank):
    named = {
        formula
        for name in bank.template_paths
        for formula in bank.template(name).chain.formulas.values()
    }
    assert len(named) >= 30
    assert not [name for name in bank.template_paths if find_missing_formulas(bank, name)]


def test_steps_that_have_the_form_of_a_formula_name_one(bank):
    assert not {
        name: found for name in bank.template_paths if (found := find_unnamed_formulas(bank, name))
    }


@pytest.fixture
def rewritten(tmp_path):
    """The bank with the solver of ``point-to-image-plane`` changed by hand."""

    def write(old, new):
        (tmp_path / "templates").symlink_to(builtin_root() / "templates")
        shutil.copytree(builtin_root() / "solvers", tmp_path / "solvers")
        file = tmp_path / "solvers" / "projection" / "perspective.py"
        assert old in file.read_text()
        file.write_text(file.read_text().replace(old, new))
        return Bank(tmp_path, trusted=True)

    return write


def test_a_formula_that_is_not_there_is_found(rewritten):
    bank = rewritten('"F05"', '"F99"')
    assert find_missing_formulas(bank, "point-to-image-plane") == ["F99"]


def test_a_step_that_applies_a_formula_without_naming_it_is_found(rewritten):
    bank = rewritten('formulas={"p\'_x": "F05", "p\'_y": "F05"},', "")
    found = find_unnamed_formulas(bank, "point-to-image-plane")
    assert sorted(found) == ["p'_x", "p'_y"]
    assert "F05" in found["p'_x"]


def test_letters_with_a_unit_stand_in_the_formula(bank):
    for entry in read_formulas(bank):
        text = json.dumps([entry.lines, entry.inside, entry.about["en"]])
        written = set(re.findall(r"[^\W\d]\w*'*(?:_\w+)?", text))
        for letters in entry.units.values():
            assert set(letters) <= written, entry.id


@together(
    ("formula", "condition"),
    [
        ("F05", "p_z > 0"), ("F11", "I_max != I_min"), ("F12", "I_max != I_min"),
        ("F20", "1 + 3*k_1*r^2 + 5*k_2*r^4 > 0"), ("F23", "V != 0"), ("F24", "Delta != 0"),
        ("F31", "D > 0"), ("F33", "z'_p > 0"), ("F39", "F > 0"), ("F42", "z != f"),
        ("F44", "d < zbar"),
    ],
)  # fmt: skip
def test_where_a_formula_would_divide_by_zero_or_fold_it_says_so(bank, formula, condition):
    (entry,) = (entry for entry in read_formulas(bank) if entry.id == formula)
    assert all(condition in entry.holds[lang] for lang in bank.languages)


@pytest.mark.parametrize("name", ["holds", "limits"])
def test_a_note_that_may_be_missing_is_there_in_every_language_or_in_none(name):
    assert load_entries(ENTRY, FormulaEntry, "f.toml", ("en", "bn"))[0].holds == {}
    half = f'{ENTRY}{name}.en = "Always."\n'
    with pytest.raises(BankError, match=rf"f\.toml: entry 'K1': {name}\.bn is missing"):
        load_entries(half, FormulaEntry, "f.toml", ("en", "bn"))


def test_a_required_passage_cannot_be_empty():
    empty = ENTRY.replace('about = { en = "In dioptres.", bn = "ডায়প্টারে।" }', "about = {}")
    with pytest.raises(BankError, match=r"f\.toml: entry 'K1': about\.en is missing"):
        load_entries(empty, FormulaEntry, "f.toml", ("en", "bn"))


def test_templates_are_found_by_the_formulas_that_they_cover(bank):
    asked = templates_by_formula(bank)
    assert "point-to-image-plane" in asked["F05"]
    assert [name for name, found in asked.items() if not found] == []


def test_a_bank_without_formulas_has_none(tmp_path):
    (tmp_path / "templates").mkdir()
    assert read_formulas(Bank(tmp_path)) == ()
    assert templates_by_formula(Bank(tmp_path)) == {}
