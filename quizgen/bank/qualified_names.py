"""Names that two banks have: told apart by the name of the bank before them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from quizgen.bank.bank import Bank

BETWEEN = ":"
"""Stands between a bank's name and what is called so in it."""


def qualify_names(names: Mapping[Bank, Iterable[str]]) -> dict[Bank, dict[str, str]]:
    """Return names of several banks as one: with the bank's in front of those that two have."""
    own = {part: [*dict.fromkeys(there)] for part, there in names.items()}
    counts = Counter(name for there in own.values() for name in there)
    return {
        part: {name: _qualify_name(part, name, counts[name]) for name in there}
        for part, there in own.items()
    }


def _qualify_name(part: Bank, name: str, count: int) -> str:
    """Return a name with its bank's in front if several banks have it, else as it is."""
    return f"{part.name}{BETWEEN}{name}" if count > 1 else name
