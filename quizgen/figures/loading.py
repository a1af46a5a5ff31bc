"""Load matplotlib once, by one thread."""

from __future__ import annotations

from functools import cache

from quizgen.core.imports import LOCK


@cache
def load_engine() -> None:
    """Import what draws; whoever draws calls this before imports of its own."""
    with LOCK:
        import quizgen.figures.engine  # noqa: F401
