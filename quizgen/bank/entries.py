"""What people write about a bank beside its templates: TOML files of entries, checked.

Each file is one array of tables, ``[[entry]]``. Errors name the file, the entry and the key.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Literal, TypeVar

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.qualified_names import qualify_names
from quizgen.core.complaints import complaint_of
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError
from quizgen.core.positions import Place
from quizgen.core.untrusted import parse_toml, read_text

Tier = Literal["A", "B", "C", "D"]

_FROM, _INDEX = "/file", "/index"
"""Under what names an entry is told its file and place in it; no key is taken for them."""

Passage = dict[str, str]
"""One sentence or passage: language to text."""


class Entry(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """The fields of every entry of a bank's content, and the file that it was read from."""

    id: str
    topic: str
    tier: Tier
    section: str
    refs: tuple[str, ...] = ()
    file: str = msgspec.field(default="", name=_FROM)
    index: int = msgspec.field(default=0, name=_INDEX)

    def fault(self, what: str, rule: str, *keys: str) -> BankError:
        """Return an error about the entry, or about one of its keys."""
        place: Place = ("entry", self.index, *keys)
        return BankError(f"entry {self.id!r}: {what}", rule=rule, file=Path(self.file), place=place)

    @contextmanager
    def name_in_errors(self, *keys: str) -> Iterator[None]:
        """Add the entry's name to errors about what it says."""
        try:
            yield
        except BankError as error:
            error.args = (f"entry {self.id!r}: {error.message}",)
            if error.file is None:
                error.file, error.place = Path(self.file), ("entry", self.index, *keys)
            raise


E = TypeVar("E", bound=Entry)


def load_entries(
    source: str, kind: type[E], where: str, langs: tuple[str, ...] = ()
) -> tuple[E, ...]:
    """Return the entries of a file's text, each converted to its type.

    Parameters
    ----------
    source : str
        TOML with one array of tables, ``[[entry]]``.
    kind : type
        What the entries are.
    where : str
        Name of the file, for errors.
    langs : tuple of str
        Languages that every passage must have.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    file = Path(where)
    table = parse_toml(source, file, BankError)
    rows = table.get("entry")
    if set(table) != {"entry"} or not isinstance(rows, list):
        what = f"expected [[entry]] and nothing else, found {sorted(table)}"
        raise BankError(what, rule="QG106", file=file, place=(next(iter(table), ""),))
    for index, row in enumerate(rows):
        if not isinstance(row, dict):
            what = f"entry {index + 1} is no table"
            raise BankError(what, rule="QG106", file=file, place=("entry", index))
    found = tuple(_read_entry(row, kind, where, index, langs) for index, row in enumerate(rows))
    names = [entry.id for entry in found]
    for index, name in enumerate(names):
        if name in names[:index]:
            what, place = f"two entries have the id {name!r}", ("entry", index, "id")
            raise BankError(what, rule="QG125", file=file, place=place)
    return found


def _read_entry(
    row: dict[str, object], kind: type[E], where: str, index: int, langs: tuple[str, ...]
) -> E:
    """Return one row of a file as an entry.

    Raises ``BankError`` at the entry if it has another form or lacks a language.
    """
    try:
        entry = convert({**row, _FROM: where, _INDEX: index}, kind)
    except msgspec.ValidationError as error:
        fault = complaint_of(error, kind, row)
        fault.args = (f"entry {row.get('id', '?')!r}: {fault.message}",)
        fault.file, fault.place = Path(where), ("entry", index, *fault.place)
        raise fault from error
    for name in filter(row.__contains__, localised_fields(kind)):
        for lang in langs:
            if lang not in getattr(entry, name):
                raise entry.fault(f"{name}.{lang} is missing", "QG105", name)
    return entry


def localised_fields(kind: type[Entry]) -> list[str]:
    """Return the names of the fields that are written in every language."""
    return [field.name for field in msgspec.structs.fields(kind) if field.type == Passage]


@cache
def read_entries(bank: Bank, name: str, kind: type[E]) -> tuple[E, ...]:
    """Return the entries of one file of a bank, read once; none if it has no such file.

    Of several banks as one those of each in turn, and what two call the same is told apart.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    found = {part: _load_own_entries(part, name, kind) for part in bank.members}
    ids = qualify_names({part: [entry.id for entry in rows] for part, rows in found.items()})
    return tuple(
        msgspec.structs.replace(entry, id=ids[part][entry.id])
        for part, rows in found.items()
        for entry in rows
    )


def _load_own_entries(bank: Bank, name: str, kind: type[E]) -> tuple[E, ...]:
    """Return the entries of a single bank's file; empty if it has none of this name."""
    if name not in bank.cards:
        return ()
    file = bank.cards[name]
    return load_entries(read_text(file, BankError), kind, str(file), bank.languages)
