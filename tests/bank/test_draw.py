"""Draws: reproducible, independent of one another, bounded."""

from __future__ import annotations

import hashlib
import shutil
from fractions import Fraction
from pathlib import Path

import pytest
from flint import fmpq

from quizgen.bank import sampler as plans
from quizgen.bank.bank import Bank, builtin_root
from quizgen.bank.sampler import list_candidates, pick_index, sampler_for, shuffle
from quizgen.bank.variant import draw_variant, reference_variant
from quizgen.core.errors import BankError, SamplingError
from quizgen.kinds.grade import grade_answer
from quizgen.maths.precision import working_precision
from quizgen.question.part_context import ask_part


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
    for count in (5, 10**6):
        assert pick_index("A3/1/42/1/f/0", count) == int.from_bytes(digest[:8], "big") % count


def test_a_new_variable_changes_no_other_value(tmp_path):
    before = make_bank(tmp_path / "a", BASE).template("mine")
    extra = BASE.replace("[draw]", "[draw]\nspare = { range = [1, 100, 1] }")
    after = make_bank(tmp_path / "b", extra).template("mine")
    for seed in range(20):
        old, new = draw_variant(before, seed).shown, dict(draw_variant(after, seed).shown)
        new.pop("spare")
        assert old == new


def test_seed_slot_and_version_matter(bank):
    template = bank.template("point-to-image-plane")
    assert draw_variant(template, 1).shown == draw_variant(template, "1").shown
    assert len({str(draw_variant(template, 1, slot).shown) for slot in range(12)}) > 6


def test_an_impossible_condition_is_named(tmp_path):
    bank = make_bank(tmp_path, 'where = ["f > 100"]\n' + BASE)
    with pytest.raises(SamplingError, match="'f > 100' rejected 5000"):
        draw_variant(bank.template("mine"), 0)


def test_a_draw_that_lets_a_wrong_method_score_is_rejected(tmp_path):
    # f = 1: leaving out the focal length gives the right answer
    bank = make_bank(tmp_path, BASE.replace("[2, 6, 1]", "[1, 1, 1]"))
    with pytest.raises(SamplingError, match="cannot be told from"):
        draw_variant(bank.template("mine"), 0)


def test_ranges_hold_their_ends():
    assert [Fraction(int(v.p), int(v.q)) for v in list_candidates((), ("0.1", "0.5", "0.2"), ("0.3",))] == [
        Fraction(1, 10), Fraction(1, 2)]  # fmt: skip


def test_shuffling_is_a_permutation_and_balanced():
    first = [shuffle(f"key{i}", "abcd")[0] for i in range(4000)]
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
        (('of = ["p', 'of = ["q'), "part 1: answer: of: unknown"),
        (("[draw]", 'drop = ["nonsense"]\n[draw]'), "not a trap"),
    ],
)
def test_mistakes_in_a_template_are_located(tmp_path, change, message):
    bank = make_bank(tmp_path, BASE.replace(*change))
    with pytest.raises(BankError, match=message):
        sampler_for(bank.template("mine"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("no title", "first line"),
        ("# T\n{{ f + 1 }}", "double braces"),
        ("# T\n{% for x in y %}", "double braces"),
        ("# T\n{{ f.__class__ }}", "double braces"),
        ("# T\n$f *$", "mathematics"),
        ("# T\nabout 1e400 of them", r"en\.md:2: mathematics \$1e400\$: .*too large"),
        ("# T\nstem\n## surprise\nx", "unknown"),
        ("# T\nstem\n## steps\n- x", "lacks"),
        ("# T\n![x](y)", "picture 'y': not the name of a file"),
    ],
)
def test_mistakes_in_prose_are_located(tmp_path, text, message):
    bank = make_bank(tmp_path, BASE, en=text)
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
    before = draw_variant(make_bank(tmp_path, BASE).template("mine"), 5)
    moved = BASE.replace('tier = "A"', 'tier = "A"\nformerly = "mine"')
    shutil.rmtree(tmp_path / "templates")
    make_bank(tmp_path, moved, name="yours")
    after = draw_variant(Bank(tmp_path).template("yours"), 5)
    assert after.template.id == "yours"
    assert after.shown == before.shown


def test_a_foreign_bank_runs_no_python_unless_trusted(tmp_path):
    make_bank(tmp_path, BASE)
    shutil.copytree(builtin_root() / "solvers", tmp_path / "solvers",
                    ignore=shutil.ignore_patterns("__pycache__"))  # fmt: skip
    with pytest.raises(BankError, match="--trust"):
        Bank(tmp_path).template("mine")
    assert draw_variant(Bank(tmp_path, trusted=True).template("mine"), 0).values


def test_a_folder_of_solvers_needs_no_init_file(tmp_path):
    make_bank(tmp_path, BASE)
    solver = Path("solvers") / "projection" / "perspective.py"
    (tmp_path / solver).parent.mkdir(parents=True)
    shutil.copy(builtin_root() / solver, tmp_path / solver)
    assert draw_variant(Bank(tmp_path, trusted=True).template("mine"), 0).values


WORDS = """
topic = "colour"
tier = "A"
[draw]
a = { pick = [1, 2, 3, 4, 5, 6] }
w = { words = ["red", "green", "blue"] }
[[part]]
answer = { kind = "choice", options = { yes = "a < 4", no = "a > 3" } }
"""
PHRASES = "# T\n{{ w }}\n## options\n- yes: a\n- no: b\n## words\n- red: r\n- green: g\n- blue: b\n"


def test_a_phrase_is_the_documented_hash(tmp_path):
    template = make_bank(tmp_path, WORDS, en=PHRASES).template("mine")
    for seed in range(9):
        first = int.from_bytes(hashlib.sha256(f"mine/1/{seed}/0/w/0".encode()).digest()[:8], "big")
        assert draw_variant(template, seed).words == {"w": ("red", "green", "blue")[first % 3]}


def test_conditions_are_tried_before_and_after_solving(tmp_path):
    """What names drawn quantities alone costs no solving; a solved one waits for its value."""
    toml = BASE.replace("[draw]", 'where = ["f > 3", "abs(p\'_x) < 9"]\n[draw]')
    plan = sampler_for(make_bank(tmp_path, toml).template("mine"))
    assert [c.text for c in plan.early] == ["f > 3"]
    assert [c.text for c in plan.late] == ["abs(p'_x) < 9"]
    assert plan.early[0].needs == {"f"}
    for seed in range(30):
        one = draw_variant(plan.template, seed)
        assert one.shown["f"] > 3
        assert abs(one.values["p'_x"]) < 9


def test_a_condition_on_all_drawn_quantities_is_tried_before_solving(tmp_path):
    toml = BASE.replace("[draw]", 'where = ["f + p_x + p_y + p_z > 0"]\n[draw]')
    plan = sampler_for(make_bank(tmp_path, toml).template("mine"))
    assert (len(plan.early), len(plan.late)) == (1, 0)


@pytest.mark.parametrize(
    ("rule", "kept", "refused"),
    [
        ("min = 2", "2 5/2", "1 199/100"),
        ('max = "5/2"', "5/2 -3", "3"),
        ('multiple = "1/4"', "1/4 3/2 0", "1/3"),
        ("decimals = 1", "1/5 3", "1/4 1/3"),
        ("denominator = 4", "1/4 2/3", "1/5"),
        ("skip = [0, 1]", "2 1/2", "0 1"),
        ("min = 1, decimals = 0", "1 2", "0 3/2"),
    ],
)
def test_what_a_keep_rule_lets_through(tmp_path, rule, kept, refused):
    toml = BASE.replace("[[part]]", f'[keep]\n"p\'_x" = {{ {rule} }}\n[[part]]')
    (condition,) = sampler_for(make_bank(tmp_path, toml).template("mine")).late
    assert condition.text == "keep.p'_x"
    for text in kept.split():
        assert condition.test({"p'_x": fmpq(*map(int, text.split("/")))}), text
    for text in refused.split():
        assert not condition.test({"p'_x": fmpq(*map(int, text.split("/")))}), text


REFERENCE = BASE + "[reference]\nf = 4\np_x = 2\np_y = 3\np_z = 5\n"


def test_the_numbers_of_the_notes_are_taken_as_they_are(tmp_path):
    one = reference_variant(make_bank(tmp_path, REFERENCE).template("mine"))
    assert one.shown == {"f": 4, "p_x": 2, "p_y": 3, "p_z": 5}
    assert one.answer_of_part(0) == (fmpq(8, 5), fmpq(12, 5))
    assert (one.seed, one.slot, one.tries, one.words) == ("reference", "0", 1, {})
    assert one.misconception_answers(0)["forgot-f"] == (fmpq(2, 5), fmpq(3, 5))


@pytest.mark.parametrize(
    ("toml", "said"),
    [(BASE, "'mine' has no reference instance"),
     (REFERENCE.replace("p_z = 5", "p_z = 0"), r"mine.template\.toml:\d+: reference instance: no value")],
    ids=["none", "without a value"],
)  # fmt: skip
def test_a_reference_that_is_none_is_named(tmp_path, toml, said):
    with pytest.raises(SamplingError, match=said):
        reference_variant(make_bank(tmp_path, toml).template("mine"))


def test_the_numbers_of_the_notes_may_name_a_phrase(tmp_path):
    toml = WORDS + '[reference]\na = 2\nw = "green"\n'
    one = reference_variant(make_bank(tmp_path, toml, en=PHRASES).template("mine"))
    assert (one.shown, one.words) == ({"a": 2}, {"w": "green"})


def test_a_part_shows_the_steps_that_it_names(tmp_path):
    every = make_bank(tmp_path / "a", BASE).template("mine")
    some = make_bank(tmp_path / "b", BASE + 'show = ["p\'_y"]\n').template("mine")
    assert [step.name for step in draw_variant(every, 0).steps_of_part(0)] == ["p'_x", "p'_y"]
    assert [step.name for step in draw_variant(some, 0).steps_of_part(0)] == ["p'_y"]


def test_a_formula_is_computed_in_full_whatever_precision_is_stated_around_it(tmp_path):
    one = draw_variant(make_bank(tmp_path, BASE).template("mine"), 0)
    with working_precision(20):
        assert one.evaluate("sqrt(2)").rel_accuracy_bits() > 150


def test_a_phrase_may_follow_a_drawn_number(tmp_path):
    """Counted from 0 and round again: 1 is green, 2 blue, 3 red."""
    toml = WORDS.replace('"blue"] }', '"blue"], by = "a" }')
    template = make_bank(tmp_path, toml, en=PHRASES).template("mine")
    for seed in range(12):
        one = draw_variant(template, seed)
        assert one.words["w"] == ("red", "green", "blue")[int(one.shown["a"].p) % 3]


def test_a_number_that_the_solver_does_not_know_is_no_answer(tmp_path):
    """Drawn quantities beside the model's are the template's own: no mistake leads to them."""
    toml = BASE.replace("[[part]]", "side = { pick = [0, 1] }\n[[part]]").replace("p'_x", "side")
    with pytest.raises(BankError, match=r"part 1: answer: of: unknown to the solver: \['side'\]"):
        draw_variant(make_bank(tmp_path, toml).template("mine"), 0)


def test_plans_of_templates_that_were_edited_are_dropped(tmp_path, monkeypatch):
    monkeypatch.setattr(plans, "_PLANS", {})
    monkeypatch.setattr(plans, "MOST_PLANS", 2)
    first, *others = (
        make_bank(tmp_path / str(low), BASE.replace("[2, 6, 1]", f"[{low}, 6, 1]")).template("mine")
        for low in (2, 3, 4)
    )
    kept = sampler_for(first)
    assert sampler_for(first) is kept
    assert [len(sampler_for(one).variables[0].choices) for one in others] == [4, 3]
    assert [plan.template for plan in plans._PLANS.values()] == others


def test_a_draw_is_of_the_bank_that_was_asked(tmp_path):
    one, other = (make_bank(tmp_path / name, BASE).template("mine") for name in ("one", "other"))
    assert one.digest == other.digest
    assert [draw_variant(template, 0).template.path for template in (one, other)] == [
        one.path,
        other.path,
    ]


ASKED = """
topic = "topic"
tier = "A"
levels = []
[draw]
a = { range = [3, 40, 1], unit = "cm" }
b = { range = [2, 9, 1], unit = "m" }
s = { is = "a/100 + b", unit = "m" }
[[part]]
answer = { kind = "quantity", of = "s", unit = "cm", exact = true }
"""


def test_what_is_drawn_by_a_formula_may_be_asked_without_a_solver(tmp_path):
    template = make_bank(tmp_path, ASKED, en="# T\n{{ a }} and {{ b }} together?").template("mine")
    for seed in range(6):
        drawn = draw_variant(template, seed)
        a, b = (int(drawn.shown[name]) for name in "ab")
        spec = ask_part(drawn, 0).spec
        assert grade_answer(spec, f"{a + 100 * b} cm").verdict == "correct"
        assert grade_answer(spec, f"{a + b} cm").verdict == "wrong"
