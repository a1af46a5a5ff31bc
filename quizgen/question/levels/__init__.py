"""Levels: the same draw as in an exam, step by step, or turned round; a module for each.

In: a draw and a language. Out: an ``Asking``: stem, parts with their specifications, solution.
Must never know: an output, a paper.
"""

from __future__ import annotations

from typing import get_args

from quizgen.bank.draw import Draw
from quizgen.bank.levels import CHOICES, EXAM, MIXED, Made
from quizgen.bank.plan import pick
from quizgen.errors import one_of
from quizgen.question.levels import exam
from quizgen.question.levels.asking import Level
from quizgen.question.levels.steps import key_of

LEVELS = (EXAM, *get_args(Made))
"""The levels there are."""


def level(name: str) -> Level:
    """What asks at a level; those of learners are loaded for who learns."""
    match one_of("level", name, LEVELS):
        case "guided":
            from quizgen.question.levels import guided

            return guided
        case "transfer":
            from quizgen.question.levels import transfer

            return transfer
        case _:
            return exam


def level_of(drawn: Draw, wanted: str) -> str:
    """The level at which a draw is asked: the wanted one if it has such a form, else the exam's.

    Raises
    ------
    ChoiceError
        If there is no such level.
    """
    one_of("level", wanted, CHOICES)
    if wanted == MIXED:
        found = [name for name in LEVELS if level(name).fits(drawn)]
        return found[pick(f"{key_of(drawn)}/level", len(found))]
    return wanted if level(wanted).fits(drawn) else EXAM
