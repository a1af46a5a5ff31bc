"""quizgen: mock exams from parametric templates, answers checked as people type them.

The Python interface, in the order of the line: a bank of templates gives questions, a blueprint
gives a paper, a key marks what was typed. Each name is loaded when it is first used;
``docs/api.md`` shows them at work.

In: Python values. Out: questions, papers, verdicts. Must never know: a terminal.

Examples
--------
>>> import quizgen
>>> template = quizgen.builtin_bank().template("point-to-image-plane")
>>> question, key = quizgen.compose_question(template, seed="reference")
>>> question.title
'Perspective projection of a point'
>>> key.solution.parts[0].answer
'(4.00; 6.00)'
>>> quizgen.grade_answer(key.specs[0], "(4; 6)").verdict
'correct'
>>> quizgen.grade_answer(key.specs[0], "(6; 4)").note
'trap:swapped'
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank, builtin_bank
    from quizgen.bank.template import Template
    from quizgen.core.errors import QuizgenError
    from quizgen.figures import Figure
    from quizgen.grading.verdict import Verdict
    from quizgen.kinds.grade import grade_answer, show_key
    from quizgen.lint.template_checks import lint_template
    from quizgen.maths.model import Model, Step
    from quizgen.paper.answer_key import make_answer_key
    from quizgen.paper.blueprint import Blueprint, load_blueprint
    from quizgen.paper.grading import PaperResult, grade_paper
    from quizgen.paper.one_part import mark_part
    from quizgen.paper.paper import Paper, build_paper, rebuild_paper
    from quizgen.question.compose import Question, QuestionKey, compose_question
    from quizgen.render import render_paper

    __version__: str

HOMES = {
    "Bank": "bank.bank",
    "builtin_bank": "bank.bank",
    "Template": "bank.template",
    "Model": "maths.model",
    "Step": "maths.model",
    "Question": "question.compose",
    "QuestionKey": "question.compose",
    "Figure": "figures",
    "compose_question": "question.compose",
    "Blueprint": "paper.blueprint",
    "load_blueprint": "paper.blueprint",
    "Paper": "paper.paper",
    "build_paper": "paper.paper",
    "rebuild_paper": "paper.paper",
    "make_answer_key": "paper.answer_key",
    "render_paper": "render",
    "Verdict": "grading.verdict",
    "grade_answer": "kinds.grade",
    "show_key": "kinds.grade",
    "PaperResult": "paper.grading",
    "grade_paper": "paper.grading",
    "mark_part": "paper.one_part",
    "lint_template": "lint.template_checks",
    "QuizgenError": "core.errors",
}
"""Public name to the module that holds it, in the order of the line."""

__all__ = [  # noqa: RUF022 - in the order of the line
    "Bank",
    "builtin_bank",
    "Template",
    "Model",
    "Step",
    "Question",
    "QuestionKey",
    "Figure",
    "compose_question",
    "Blueprint",
    "load_blueprint",
    "Paper",
    "build_paper",
    "rebuild_paper",
    "make_answer_key",
    "render_paper",
    "Verdict",
    "grade_answer",
    "show_key",
    "PaperResult",
    "grade_paper",
    "mark_part",
    "lint_template",
    "QuizgenError",
    "__version__",
]


def __dir__() -> list[str]:
    return __all__


if not TYPE_CHECKING:  # a type checker reads the imports above and refuses any other name

    def __getattr__(name: str) -> object:
        from importlib import import_module

        if name == "__version__":
            from importlib.metadata import version

            return version("quizgen")
        if name not in HOMES:
            raise AttributeError(f"module 'quizgen' has no attribute {name!r}")
        return getattr(import_module(f"quizgen.{HOMES[name]}"), name)
