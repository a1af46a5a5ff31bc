"""quizgen: mock exams from parametric templates, answers checked as people type them.

The small Python interface; each name is loaded when it is first used.

Examples
--------
>>> import quizgen
>>> template = quizgen.builtin().template("point-to-image-plane")
>>> question, key = quizgen.compose(template, seed="reference")
>>> question.title
'Perspective projection of a point'
>>> key.solution.parts[0].answer
'(4; 6)'
>>> quizgen.mark(key.specs[0], "(4; 6)").verdict
'correct'
>>> quizgen.mark(key.specs[0], "(6; 4)").note
'trap:swapped'
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOMES = {
    "Bank": "quizgen.bank.folder",
    "builtin": "quizgen.bank.folder",
    "Model": "quizgen.maths.model",
    "Step": "quizgen.maths.model",
    "compose": "quizgen.question.compose",
    "build": "quizgen.paper.paper",
    "rebuild": "quizgen.paper.paper",
    "load": "quizgen.paper.blueprint",
    "mark_paper": "quizgen.paper.marking",
    "render_paper": "quizgen.render",
    "mark": "quizgen.marking.mark",
    "show": "quizgen.marking.mark",
    "lint_template": "quizgen.audit.lint",
    "QuizgenError": "quizgen.errors",
}

_NAMES = {"render_paper": "render", "lint_template": "lint"}
"""Names that a submodule would hide, and what they are called at home."""

__all__ = [  # noqa: RUF022 - in the order of the line
    "Bank",
    "builtin",
    "Model",
    "Step",
    "compose",
    "build",
    "rebuild",
    "load",
    "render_paper",
    "mark",
    "mark_paper",
    "show",
    "lint_template",
    "QuizgenError",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'quizgen' has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), _NAMES.get(name, name))
