"""How far a sweep goes: little by default, the rest with ``-m slow``, more with ``QUIZGEN_SEEDS``."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import pytest


def draws(usual: int) -> int:
    """Return how many draws a sweep takes: as many as CI does, or what ``QUIZGEN_SEEDS`` says."""
    return int(os.environ.get("QUIZGEN_SEEDS", usual))


def spread(items: Iterable[Any], usual: int) -> list[Any]:
    """Return the parameters of a sweep: ``usual`` of the items by default, the others slow.

    Those of the default are spread evenly, so that neighbours, which are much alike, take turns.
    """
    every = list(items)
    chosen = {place * len(every) // usual for place in range(usual)}
    return [
        item if place in chosen else pytest.param(*_values(item), marks=pytest.mark.slow)
        for place, item in enumerate(every)
    ]


def _values(item: Any) -> tuple[Any, ...]:
    return item if isinstance(item, tuple) else (item,)
