"""How many draws a sweep takes: few enough for CI, as many as one likes with ``QUIZGEN_SEEDS``."""

from __future__ import annotations

import os


def draws(usual: int) -> int:
    return int(os.environ.get("QUIZGEN_SEEDS", usual))
