"""Draws: reproducible, independent of one another, bounded."""

from __future__ import annotations

import hashlib
import shutil
from fractions import Fraction
from pathlib import Path

import pytest

from quizgen.bank.draw import draw
from quizgen.bank.folder import Bank, builtin_root
from quizgen.bank.plan import candidates, pick, plan_of, shuffled
from quizgen.errors import BankError, DrawError


def make_bank(tmp_path: Path, toml: str, name: str = "mine", **languages: str) -> Bank:
    folder = tmp_path / "templates" / "topic" / name
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(toml, encoding="utf-8")
    for lang, text in (languages or {"en": "# T\nstem"}).items():
        (folder / f"{lang}.md").write_text(text, encoding="utf-8")
    return Bank(tmp_path)


BASE = """
topic = "projection"
tier = "A"
solver = "projection/perspective"
[draw]
f = { range = [2, 6, 1] }
p_x = { range = [-15, 15, 1], skip = [0] }
p_y = { range = [-15, 15, 1], skip = [0] }
p_z = { range = [2, 12, 1] }
[[part]]
answer = { kind = "point", of = ["p'_x", "p'_y"], exact = true }
"""


def test_pick_is_sha256_of_the_key():
    digest = hashlib.sha256(b"A3/1/42/1/f/0").digest()
    assert pick("A3/1/42/1/f/0", 5) == int.from_bytes(digest[:8], "big") % 5


def test_a_new_variable_changes_no_other_value(tmp_path):
    before = make_bank(tmp_path / "a", BASE).template("mine")
    extra = BASE.replace("[draw]", "[draw]\nspare = { range = [1, 100, 1] }")
    after = make_bank(tmp_path / "b", extra).template("mine")
    for seed in range(20):
        old, new = draw(before, seed).shown, dict(draw(after, seed).shown)
        new.pop("spare")
        assert old == new


def test_seed_slot_and_version_matter(bank):
    template = bank.template("point-to-image-plane")
    assert draw(template, 1).shown == draw(template, "1").shown
    assert len({str(draw(template, 1, slot).shown) for slot in range(12)}) > 6


def test_an_impossible_condition_is_named(tmp_path):
    bank = make_bank(tmp_path, 'where = ["f > 100"]\n' + BASE)
    with pytest.raises(DrawError, match="'f > 100' rejected 5000"):
        draw(bank.template("mine"), 0)


def test_a_draw_that_lets_a_wrong_method_score_is_rejected(tmp_path):
    # f = 1: leaving out the focal length gives the right answer
    bank = make_bank(tmp_path, BASE.replace("[2, 6, 1]", "[1, 1, 1]"))
    with pytest.raises(DrawError, match="cannot be told from"):
        draw(bank.template("mine"), 0)


def test_ranges_hold_their_ends():
    assert [Fraction(int(v.p), int(v.q)) for v in candidates((), ("0.1", "0.5", "0.2"), ("0.3",))] == [
        Fraction(1, 10), Fraction(1, 2)]  # fmt: skip


def test_shuffling_is_a_permutation_and_balanced():
    first = [shuffled(f"key{i}", "abcd")[0] for i in range(4000)]
    assert all(abs(first.count(c) - 1000) < 150 for c in "abcd")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("p_z = {", "p_w = {"), r"draw lacks \['p_z'\]"),
        (('tier = "A"', 'tier = "E"'), "tier"),
        (("topic", "topics"), "allowed: .*topic"),
        (("range = [2, 6, 1]", "rang = [2, 6, 1]"), "allowed: .*range"),
        (("range = [2, 6, 1]", "range = [2, 6]"), "first, last, step"),
        (("range = [2, 12, 1]", 'range = [2, 12, 1], unit = "parsec"'), "unknown unit"),
        (('solver = "projection/perspective"', 'solver = "nothing"'), "no such solver"),
        (("[draw]", "[draw"), "not valid TOML"),
        (("[draw]", 'where = ["f >"]\n[draw]'), "formula"),
        (("[draw]", 'where = ["g > 1"]\n[draw]'), "formula"),
        (('of = ["p', 'of = ["q'), "unknown"),
        (("[draw]", 'drop = ["nonsense"]\n[draw]'), "not a trap"),
    ],
)
def test_mistakes_in_a_template_are_located(tmp_path, change, message):
    bank = make_bank(tmp_path, BASE.replace(*change))
    with pytest.raises(BankError, match=message):
        plan_of(bank.template("mine"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("no title", "first line"),
        ("# T\n{{ f + 1 }}", "double braces"),
        ("# T\n{% for x in y %}", "double braces"),
        ("# T\n{{ f.__class__ }}", "double braces"),
        ("# T\n$f *$", "mathematics"),
        ("# T\nstem\n## surprise\nx", "unknown"),
        ("# T\nstem\n## steps\n- x", "lacks"),
        ("# T\n![x](y)", ""),
    ],
)
def test_mistakes_in_prose_are_located(tmp_path, text, message):
    bank = make_bank(tmp_path, BASE, en=text)
    if not message:
        assert bank.template("mine").texts["en"].stem  # images are plain text, never loaded
        return
    with pytest.raises(BankError, match=message) as caught:
        bank.template("mine")
    assert "en.md" in str(caught.value)


def test_unknown_template_suggests_a_near_one(bank):
    with pytest.raises(BankError, match="did you mean point-to-image-plane"):
        bank.template("point-to-image-plan")


def test_a_template_asked_for_by_its_first_name_is_found(bank):
    with pytest.raises(BankError, match="now called 'point-to-image-plane-fractions'"):
        bank.template("Q4a")


def test_a_renamed_template_keeps_its_numbers(tmp_path):
    before = draw(make_bank(tmp_path, BASE).template("mine"), 5)
    moved = BASE.replace('tier = "A"', 'tier = "A"\nformerly = "mine"')
    shutil.rmtree(tmp_path / "templates")
    make_bank(tmp_path, moved, name="yours")
    after = draw(Bank(tmp_path).template("yours"), 5)
    assert after.template.id == "yours"
    assert after.shown == before.shown


def test_a_foreign_bank_runs_no_python_unless_trusted(tmp_path):
    make_bank(tmp_path, BASE)
    shutil.copytree(builtin_root() / "solvers", tmp_path / "solvers",
                    ignore=shutil.ignore_patterns("__pycache__"))  # fmt: skip
    with pytest.raises(BankError, match="--trust"):
        Bank(tmp_path).template("mine")
    assert draw(Bank(tmp_path, trusted=True).template("mine"), 0).values


def test_a_folder_of_solvers_needs_no_init_file(tmp_path):
    make_bank(tmp_path, BASE)
    solver = Path("solvers") / "projection" / "perspective.py"
    (tmp_path / solver).parent.mkdir(parents=True)
    shutil.copy(builtin_root() / solver, tmp_path / solver)
    assert draw(Bank(tmp_path, trusted=True).template("mine"), 0).values
