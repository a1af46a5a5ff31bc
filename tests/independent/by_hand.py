"""The table of solvers: which template is worked out by which function, and which one is not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from printed_page import Page

Solve = Callable[[Page], dict[str, Any]]
SOLVERS: dict[str, Solve] = {}
WITH_FIGURE: set[str] = set()
"""Templates whose page says something only in its figure."""


def solves(*templates: str, figure: bool = False) -> Callable[[Solve], Solve]:
    """Enter a function that answers the parts of a printed page, by their letters."""

    def enter(solve: Solve) -> Solve:
        SOLVERS.update(dict.fromkeys(templates, solve))
        WITH_FIGURE.update(templates if figure else ())
        return solve

    return enter
