"""Functions to write: each solution is right, and each wrong program is known by what it does."""

from __future__ import annotations

import pytest
from sweep import draws

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.grading.programs import can_run_programs
from quizgen.kinds.grade import grade_answer
from quizgen.question.part_context import ask_part

pytestmark = pytest.mark.skipif(not can_run_programs(), reason="no process can be locked here")
BANK = builtin_bank()
NAMES = [
    name
    for name in BANK.template_paths
    if any(part.answer["kind"] == "program" for part in BANK.rules(name).part)
]


def asked(name, seed):
    return ask_part(draw_variant(BANK.template(name), seed), 0).spec


@pytest.mark.parametrize("name", NAMES)
def test_the_solution_is_right(name):
    spec = asked(name, 1)
    verdict = grade_answer(spec, spec.solution)
    assert (verdict.verdict, verdict.fields["of"]) == ("correct", len(spec.cases) + 1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 2 + draws(2, full=20)))
@pytest.mark.parametrize("name", NAMES)
def test_every_wrong_program_is_named_and_earns_less(name, seed):
    spec = asked(name, seed)
    assert grade_answer(spec, spec.solution).verdict == "correct"
    for trap, text in spec.traps.items():
        verdict = grade_answer(spec, text)
        assert verdict.note == f"trap:{trap}"
        assert verdict.credit < 1
