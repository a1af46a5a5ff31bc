"""Tables that refuse strangers: what a printer does not know is named, never guessed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from quizgen.core.errors import RenderError

V = TypeVar("V")


def strict_lookup(medium: str) -> Callable[[Mapping[str, V], str, str], V]:
    """Look-up in a medium's tables that names what it does not know."""

    def look_up(table: Mapping[str, V], key: str, what: str) -> V:
        try:
            return table[key]
        except KeyError:
            raise RenderError(f"no {medium} for the {what} {key!r}") from None

    return look_up
