"""Answers that an author's check.py judges: trusted, in time, and never an error for a student."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.cli.main import root_group
from quizgen.core import trusted_files
from quizgen.core.errors import BankError
from quizgen.grading import checking
from quizgen.kinds.grade import grade_answer
from quizgen.lint.template_checks import lint_template
from quizgen.maths.notation import FormulaReadError
from quizgen.question.part_context import ask_part

RULES = """topic = "t"
tier = "A"
[draw]
n = { pick = [6, 10, 15, 21] }
[[part]]
points = 2
answer = { kind = "checked", traps = ["itself"] }
[[part.example]]
answer = "1 {{ n }}"
points = 2
[[part.example]]
answer = "{{ n }} {{ n }}"
points = 1
[[part.example]]
answer = "bananas"
points = 0
"""
WORDS = """# Factors
**Which two numbers have the product {{ n }}?**

## traps
- itself: Both are {{ n }} itself.

## why
1 is a factor of any number.
"""
CHECK = """
def check(values, answer):
    pieces = answer.split()
    if len(pieces) != 2 or not all(piece.isdigit() for piece in pieces):
        return None
    a, b = map(int, pieces)
    if a == b == values["n"]:
        return 0.5, "itself"
    return a * b == values["n"]
"""


def make_bank(root: Path, check: str = CHECK, *, trusted: bool = True, rules: str = RULES) -> Bank:
    folder = root / "templates" / "t" / "factors"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(rules)
    (folder / "en.md").write_text(WORDS)
    (folder / "check.py").write_text(check)
    return Bank(root, trusted=trusted)


def make_spec(root: Path, check: str = CHECK):
    variant = draw_variant(make_bank(root, check).template("factors"), 1)
    return ask_part(variant, 0).spec, int(variant.shown["n"])


def test_a_check_gives_shares_sentences_and_asks_back(tmp_path):
    spec, n = make_spec(tmp_path)
    assert grade_answer(spec, f"{n} 1").verdict == "correct"
    half = grade_answer(spec, f"{n} {n}")
    assert (half.credit, half.note) == (Fraction(1, 2), "trap:itself")
    assert half.message == f"Both are {n} itself."
    assert grade_answer(spec, "1 1").verdict == "wrong"
    assert grade_answer(spec, "bananas").verdict == "unreadable"


@pytest.mark.parametrize("name", ["en", "bn", "de"])
def test_what_cannot_be_read_is_said_in_the_learners_language(tmp_path, name):
    spec, _ = make_spec(tmp_path)
    assert grade_answer(spec, "bananas", lang=name).message


def test_a_bank_that_nobody_trusts_asks_no_such_question(tmp_path):
    with pytest.raises(BankError) as found:
        make_bank(tmp_path, trusted=False).template("factors")
    assert found.value.rule == "QG128"


def test_a_person_decides_where_the_file_is_another_one(tmp_path):
    spec, n = make_spec(tmp_path, CHECK + "# mine\n")
    (tmp_path / "templates/t/factors/check.py").write_text(CHECK + "# changed\n")
    verdict = grade_answer(spec, f"{n} 1")
    assert verdict.needs_self_marking
    assert "decide yourself" in verdict.message


@pytest.mark.parametrize(
    ("body", "fault"),
    [
        ("raise SystemExit(3)", "SystemExit"),
        ("return 1 / 0", "ZeroDivisionError"),
        ("return 7", "a share from 0 to 1"),
        ("return 1, 2, 3", "a share from 0 to 1"),
        ("return {}", "a share from 0 to 1"),
    ],
)
def test_a_check_that_fails_leaves_the_answer_to_a_person(tmp_path, body, fault):
    spec, _ = make_spec(tmp_path, f"def check(values, answer):\n    {body}\n")
    verdict = grade_answer(spec, "1 2")
    assert verdict.needs_self_marking
    assert fault in verdict.fields["fault"]
    assert fault not in verdict.message


def test_a_check_that_does_not_end_is_stopped(tmp_path, monkeypatch):
    monkeypatch.setattr(checking, "SECONDS", 0.2)
    found = checking._run_within_time(
        b"def check(values, answer):\n    while True: pass\n", "check", {}, "1"
    )
    assert "TimeoutError" in found.fault


def test_a_check_that_does_not_load_leaves_the_answer_to_a_person(tmp_path):
    spec, _ = make_spec(tmp_path, "def other(): pass\n")
    assert grade_answer(spec, "1 2").needs_self_marking


def test_lint_holds_a_check_to_its_examples(tmp_path):
    assert not _codes(make_bank(tmp_path / "a"))
    harsh = CHECK.replace("0.5", "0.25")
    assert _codes(make_bank(tmp_path / "b", harsh)) == ["QG221"]
    broken = CHECK.replace("return None", "return int(answer)")
    (found,) = _lint(make_bank(tmp_path / "c", broken))
    assert "ValueError" in found.message
    assert found.span.line == 14


def test_three_examples_are_needed_one_of_them_right(tmp_path):
    rules = RULES[: RULES.rindex("[[part.example]]")]
    with pytest.raises(BankError, match="right, wrong"):
        ask_part(draw_variant(make_bank(tmp_path, rules=rules).template("factors"), 1), 0)


def _lint(bank: Bank):
    found = lint_template(bank.template("factors"), 8, bank.languages).problems
    return [one for one in found if one.code != "QG306"]


def _codes(bank: Bank) -> list[str]:
    return [one.code for one in _lint(bank)]


def test_a_typed_formula_becomes_a_sympy_expression():
    import sympy

    x, c = sympy.symbols("x C1")
    assert checking.read_as_sympy("2x^2 + C1 sin 3x", "x C1") == 2 * x**2 + c * sympy.sin(3 * x)
    assert checking.read_as_sympy("x log x", "x", log="ln") == x * sympy.log(x)
    matrix = checking.read_matrix_as_sympy(
        r"A = \begin{pmatrix} 1 & x \\\\ 1/2 & -3 \end{pmatrix}", "x"
    )
    assert matrix == sympy.Matrix([[1, x], [sympy.Rational(1, 2), -3]])
    for typed in ("x log x", "1/0", "0/0"):
        with pytest.raises(FormulaReadError):
            checking.read_as_sympy(typed, "x")


def test_the_example_of_the_manual_is_sound(tmp_path):
    manual = (Path(__file__).parents[2] / "docs" / "banks.md").read_text("utf-8")
    section = manual[manual.index("## Answers that no kind can judge") :]
    check, rules = (
        section[section.index(f"```{kind}\n") + len(kind) + 4 :].split("```", 1)[0]
        for kind in ("python", "toml")
    )
    assert not _codes(make_bank(tmp_path, check, rules=f'topic = "t"\ntier = "A"\n{rules}'))


def test_check_runs_it_for_a_filled_form_only_with_trust(tmp_path, monkeypatch):
    bank, out = make_bank(tmp_path / "bank", CHECK + "# of a form\n"), tmp_path / "paper"
    run = CliRunner().invoke
    sources = ["--bank", str(bank.root), "--trust"]
    made = run(
        root_group, ["exam", *sources, "--topic", "t", "--format", "html", "--out", str(out)]
    )
    assert made.exit_code == 0, made.output
    form = out / "answers.toml"
    n = int(
        json.loads((out / "key.json").read_text())["questions"][0]["parts"][0]["spec"]["values"][
            "n"
        ]
    )
    form.write_text(form.read_text().replace('"1" = ""', f'"1" = "{n} 1"'))
    monkeypatch.setattr(trusted_files, "_FOLDERS", {})
    checked = ["check", str(out / "key.json"), str(form)]
    assert "decide yourself" in run(root_group, checked).output
    assert "2 / 2" in run(root_group, [*checked, *sources]).output
