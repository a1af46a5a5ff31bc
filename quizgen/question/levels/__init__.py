"""Levels: one variant as in an exam, step by step, or turned round; a module for each.

In: a variant and a language. Out: a ``LevelQuestion``: stem, parts with their specifications,
solution. Must never know: an output, a paper.
"""

from __future__ import annotations

from typing import get_args

from quizgen.bank.levels import CHOICES, EXAM, MIXED, DerivedLevel
from quizgen.bank.sampler import pick_index
from quizgen.bank.variant import Variant
from quizgen.core.errors import require_one_of
from quizgen.question.levels import exam
from quizgen.question.levels.contract import Level
from quizgen.question.levels.steps import level_seed

LEVELS = (EXAM, *get_args(DerivedLevel))
"""The levels there are."""


def load_level(name: str) -> Level:
    """Return the module of a level; those for learners are imported on use."""
    match require_one_of("level", name, LEVELS):
        case "guided":
            from quizgen.question.levels import guided

            return guided
        case "transfer":
            from quizgen.question.levels import transfer

            return transfer
        case _:
            return exam


def effective_level(drawn: Variant, wanted: str) -> str:
    """Return the level at which a variant is asked: the wanted one, else the exam's.

    A level may have no form for a template.

    Raises
    ------
    InvalidChoiceError
        If there is no such level.
    """
    require_one_of("level", wanted, CHOICES)
    if wanted == MIXED:
        found = [name for name in LEVELS if load_level(name).is_applicable(drawn)]
        return found[pick_index(f"{level_seed(drawn)}/level", len(found))]
    return wanted if load_level(wanted).is_applicable(drawn) else EXAM
