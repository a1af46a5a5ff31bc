"""Load matplotlib once, by one thread."""

from __future__ import annotations

from functools import cache

from quizgen.core.imports import LOCK


@cache
def load_engine() -> None:
    """Import the drawing engine; call this before other imports when drawing."""
    with LOCK:
        import quizgen.figures.engine  # noqa: F401
