"""The levels at which a variant can be asked, by name; ``question.levels`` makes them."""

from __future__ import annotations

from typing import Literal, get_args

DerivedLevel = Literal["guided", "transfer"]
"""Levels that are made from the chain."""
EXAM = "exam"
"""As its author wrote it: the level where none is asked for."""
GUIDED = "guided"
"""Its steps, one after another."""
MIXED = "mixed"
"""One of the others for each question, by the seed."""
CHOICES: tuple[str, ...] = (EXAM, *get_args(DerivedLevel), MIXED)
"""What can be asked for."""
