"""Levels: the same draw as in an exam, step by step, or turned round; a module for each.

In: a draw and a language. Out: an ``Asking``: stem, parts with their specifications, solution.
Must never know: an output, a paper.
"""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.levels import CHOICES, EXAM, MIXED
from quizgen.bank.plan import pick
from quizgen.errors import one_of
from quizgen.question.levels import exam, guided, transfer
from quizgen.question.levels.asking import Level
from quizgen.question.levels.steps import key_of

LEVELS: dict[str, Level] = {EXAM: exam, "guided": guided, "transfer": transfer}
"""Level to its module."""


def level_of(drawn: Draw, wanted: str) -> str:
    """The level at which a draw is asked: the wanted one if it has such a form, else the exam's.

    Raises
    ------
    ChoiceError
        If there is no such level.
    """
    one_of("level", wanted, CHOICES)
    if wanted == MIXED:
        found = [name for name, level in LEVELS.items() if level.fits(drawn)]
        return found[pick(f"{key_of(drawn)}/level", len(found))]
    return wanted if LEVELS[wanted].fits(drawn) else EXAM
