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
from pathlib import Path

import msgspec

from quizgen.bank.compiled import Compiled
from quizgen.bank.prose import Inline, inlines
from quizgen.errors import BankError
from quizgen.outside import located, parse_toml, read_text
from quizgen.shapes import converted


class _Written(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What stands in a file."""

    names: dict[str, dict[str, str]] = {}
    fixed: tuple[str, ...] = ()


class Quantities(_Written, frozen=True):
    """The quantities of one solver: each name by language, and those that are fixed."""

    said: dict[str, dict[str, tuple[Inline, ...]]] = {}

    def name(self, quantity: str, lang: str) -> tuple[Inline, ...]:
        """What a quantity is called in a sentence; empty if nobody has said so."""
        return self.said.get(quantity, {}).get(lang, ())

    @property
    def digest(self) -> str:
        """Changes with every name."""
        written = _Written(self.names, self.fixed)
        return hashlib.sha256(msgspec.json.encode(written)).hexdigest()


_FILES = Compiled("quantities", dict[str, Quantities], "markdown_it")


def read_quantities(paths: Iterable[Path]) -> dict[str, Quantities]:
    """Solver to its quantities, from several files.

    Raises
    ------
    BankError
        Naming the file and the key, or a solver that stands twice.
    """
    found: dict[str, Quantities] = {}
    for path in paths:
        source = read_text(path, BankError)
        read = _FILES.find(source.encode())
        if read is None:
            read = _FILES.keep(_read(path, source), source.encode())
        for solver in read:
            if solver in found:
                raise BankError(f"{path}: solver {solver!r} stands twice")
        found |= read
    return found


def _read(path: Path, source: str) -> dict[str, Quantities]:
    table = parse_toml(source, path, BankError)
    try:
        read = converted(table, dict[str, _Written])
    except msgspec.ValidationError as error:
        raise BankError(f"{path}: {error}") from error
    with located(path, BankError):
        return {solver: _said(written) for solver, written in read.items()}


def _said(written: _Written) -> Quantities:
    said = {
        quantity: {lang: inlines(text) for lang, text in names.items()}
        for quantity, names in written.names.items()
    }
    return Quantities(written.names, written.fixed, said)
