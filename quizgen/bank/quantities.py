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

from quizgen.bank.compile_cache import CompileCache
from quizgen.bank.markdown import parse_inlines
from quizgen.core.complaints import complaint_of
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError
from quizgen.core.untrusted import error_context, parse_toml, read_text
from quizgen.typeset.prose import Inline


class _Written(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The names of one solver's quantities as a file holds them."""

    names: dict[str, dict[str, str]] = {}
    fixed: tuple[str, ...] = ()


class QuantityNames(_Written, frozen=True):
    """The quantities of one solver: each name by language, and those that are fixed."""

    said: dict[str, dict[str, tuple[Inline, ...]]] = {}

    def name(self, quantity: str, lang: str) -> tuple[Inline, ...]:
        """Return what a quantity is called in a sentence; empty if the bank does not say."""
        return self.said.get(quantity, {}).get(lang, ())

    @property
    def digest(self) -> str:
        """Return a digest that changes with every name."""
        written = _Written(self.names, self.fixed)
        return hashlib.sha256(msgspec.json.encode(written)).hexdigest()


_FILES = CompileCache("quantities", dict[str, QuantityNames], "markdown_it", "math_core")


def read_quantities(paths: Iterable[Path]) -> dict[str, QuantityNames]:
    """Return the quantities of each solver, from several files.

    Raises
    ------
    BankError
        Naming the file and the key, or a solver that stands twice.
    """
    found: dict[str, QuantityNames] = {}
    for path in paths:
        source = read_text(path, BankError)
        read = _FILES.get(source.encode())
        if read is None:
            read = _FILES.store_compiled(_read_quantities(path, source), source.encode())
        for solver in read:
            if solver in found:
                what = f"solver {solver!r} stands twice"
                raise BankError(what, rule="QG125", file=path, place=(solver,))
        found |= read
    return found


def _read_quantities(path: Path, source: str) -> dict[str, QuantityNames]:
    """Return the quantities of each solver in one file.

    Raises ``BankError`` at the key that is wrong.
    """
    table = parse_toml(source, path, BankError)
    with error_context(path, BankError):
        try:
            read = convert(table, dict[str, _Written])
        except msgspec.ValidationError as error:
            raise complaint_of(error, dict[str, _Written], table) from error
        return {solver: _parse_quantity_names(written) for solver, written in read.items()}


def _parse_quantity_names(written: _Written) -> QuantityNames:
    """Return the names of a solver's quantities, each also parsed as a sentence."""
    said = {
        quantity: {lang: parse_inlines(text) for lang, text in names.items()}
        for quantity, names in written.names.items()
    }
    return QuantityNames(written.names, written.fixed, said)
