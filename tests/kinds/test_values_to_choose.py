"""``choice`` with ``of``: the value of a step among those that its misconceptions give."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent.parent / "bank"))

from click.testing import CliRunner
from mechanics import FILES, write

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.cli.main import root_group
from quizgen.core.errors import BankError
from quizgen.kinds.grade import grade_answer
from quizgen.question.compose import compose_question
from quizgen.question.part_context import ask_part

TEMPLATE, SOLVER, WORDS = (
    f"{name}" for name in ("templates/forces/push/template.toml", "solvers/forces/newton.py",
                           "templates/forces/push/en.md")
)  # fmt: skip
TRAPS = """{
            "halved": Step(F, m * a / 2, "hu"),
            "doubled": Step(F, 2 * m * a, "hu"),
            "squared": Step(F, m * a**2, "hu"),
        }"""
SENTENCES = """- halved: You halved it.
- doubled: You doubled it.
- squared: You took the acceleration twice."""


def make_bank(root: Path, answer: str = 'kind = "choice", of = "F"') -> Bank:
    """The bank of mechanics with three traps, and a choice between numbers."""
    rules, solver, words = FILES[TEMPLATE], FILES[SOLVER], FILES[WORDS]
    changes = {
        TEMPLATE: rules.replace('kind = "quantity", of = "F", unit = "hu", rel = "0.01"', answer),
        SOLVER: solver.replace('{"added": Step(F, m + a, "hu")}', TRAPS).replace(
            "m * a**2, ", "m * a * 3, "
        ),
        WORDS: words.replace("- added: You added mass and acceleration.", SENTENCES),
    }
    return Bank(write(root, changes), trusted=True)


def force(variant) -> int:
    return int(variant.shown["m"]) * int(variant.shown["a"])


def test_the_options_are_the_key_and_what_misconceptions_give(tmp_path):
    variant = draw_variant(make_bank(tmp_path).template("push"), 3)
    spec, right = ask_part(variant, 0).spec, force(variant)
    values = [float(text.split("\N{NO-BREAK SPACE}")[0]) for text in spec.options]
    assert values == sorted([right / 2, right, 2 * right, 3 * right])
    assert spec.options[spec.correct[0] - 1] == f"{right}\N{NO-BREAK SPACE}hu"


def test_a_wrong_choice_is_told_what_was_done(tmp_path):
    variant = draw_variant(make_bank(tmp_path).template("push"), 3)
    spec = ask_part(variant, 0).spec
    assert grade_answer(spec, "ABCD"[spec.correct[0] - 1]).verdict == "correct"
    verdict = grade_answer(spec, "ABCD"[spec.traps["doubled"] - 1])
    assert (verdict.verdict, verdict.note) == ("wrong", "trap:doubled")
    assert "You doubled it." in verdict.message


def test_take_is_the_number_of_options(tmp_path):
    template = make_bank(tmp_path, 'kind = "choice", of = "F", take = 3').template("push")
    specs = [ask_part(draw_variant(template, seed), 0).spec for seed in range(20)]
    assert {len(spec.options) for spec in specs} == {3}
    assert {trap for spec in specs for trap in spec.traps} == {"halved", "doubled", "squared"}


def test_the_paper_shows_numbers_with_units_and_the_solution_why(tmp_path):
    question, key = compose_question(make_bank(tmp_path).template("push"), 3)
    assert [mark for mark, _ in question.parts[0].field.options] == ["A", "B", "C", "D"]
    assert len(key.solution.parts[0].mistakes) == 3


@pytest.mark.parametrize("form", ["moodle", "canvas", "qti21", "qti3"])
def test_it_goes_to_learning_management_systems_as_a_choice(tmp_path, form):
    bank = make_bank(tmp_path / "bank")
    out = tmp_path / "out"
    done = CliRunner().invoke(
        root_group,
        ["export", form, "--bank", str(bank.root), "--trust", "--topic", "forces", "--seed", "3",
         "--out", str(out)],
    )  # fmt: skip
    assert done.exit_code == 0, done.output


def test_an_exam_is_marked(tmp_path):
    bank, out = make_bank(tmp_path / "bank"), tmp_path / "paper"
    run = CliRunner().invoke
    done = run(root_group, ["exam", "--bank", str(bank.root), "--trust", "--topic", "forces",
                            "--seed", "4", "--format", "html", "--out", str(out)])  # fmt: skip
    assert done.exit_code == 0, done.output
    (spec,) = (
        part["spec"]
        for part in json.loads((out / "key.json").read_bytes())["questions"][0]["parts"]
    )
    form = (out / "answers.toml").read_text("utf-8")
    letter = "ABCD"[spec["correct"][0] - 1]
    (out / "answers.toml").write_text(form.replace('= ""', f'= "{letter}"'), "utf-8")
    done = run(root_group, ["check", str(out / "key.json"), str(out / "answers.toml")])
    assert "2 / 2" in done.output


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ('kind = "choice", of = ["F", "m"]', "names one quantity"),
        ('kind = "choice", of = "F", take = 1', "must be 2 to"),
        ('kind = "choice", of = "Q"', "unknown to the solver"),
        ('kind = "choice", options = { a = true, b = false }, unit = "m"', "is of values"),
        ('kind = "choice"', "1 to"),
    ],
)
def test_what_cannot_be_chosen_from_is_located(tmp_path, answer, said):
    with pytest.raises(BankError, match=said):
        draw_variant(make_bank(tmp_path, answer).template("push"), 1)
