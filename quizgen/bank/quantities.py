"""What the letters of a solver mean: ``templates/quantities/*.toml``.

::

    ["forces/newton"]
    fixed = ["a"]                  # given quantities that nobody can change alone
    ["forces/newton".names]
    m = { en = "the mass of the block", bn = "..." }

A name stands in the middle of a sentence, before its letter in brackets. Only questions made from
the chain use it, not those of an exam.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import msgspec

from quizgen.bank.prose import Inline, inlines
from quizgen.errors import BankError
from quizgen.outside import parse_toml, read_text
from quizgen.shapes import converted


class Quantities(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The quantities of one solver: each name by language, and those that are fixed."""

    names: dict[str, dict[str, str]] = {}
    fixed: tuple[str, ...] = ()

    def name(self, quantity: str, lang: str) -> tuple[Inline, ...]:
        """What a quantity is called in a sentence; empty if nobody has said so."""
        return _parsed(self.names.get(quantity, {}).get(lang, ""))

    @property
    def digest(self) -> str:
        """Changes with every name."""
        return hashlib.sha256(msgspec.json.encode(self)).hexdigest()


@cache
def _parsed(text: str) -> tuple[Inline, ...]:
    return inlines(text)


def read_quantities(paths: Iterable[Path]) -> dict[str, Quantities]:
    """Solver to its quantities, from several files.

    Raises
    ------
    BankError
        Naming the file and the key, or a solver that stands twice.
    """
    found: dict[str, Quantities] = {}
    for path in paths:
        table = parse_toml(read_text(path, BankError), path, BankError)
        try:
            read = converted(table, dict[str, Quantities])
        except msgspec.ValidationError as error:
            raise BankError(f"{path}: {error}") from error
        for solver in read:
            if solver in found:
                raise BankError(f"{path}: solver {solver!r} stands twice")
        found |= read
    return found
