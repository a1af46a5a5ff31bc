"""What people write about a bank beside its templates: TOML files of entries, checked.

Each file is one array of tables, ``[[entry]]``. Errors name the file, the entry and the key.
"""

from __future__ import annotations

from functools import cache
from typing import Literal, TypeVar

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.complaints import explain_validation_error
from quizgen.bank.qualified_names import qualify_names
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError
from quizgen.core.untrusted import parse_toml, read_text

Tier = Literal["A", "B", "C", "D"]

_FROM = "/file"
"""Under what name an entry is told its file; no key of a file is taken for it."""

Passage = dict[str, str]
"""One sentence or passage: language to text."""


class Entry(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """What every entry has, and the file that it was read from."""

    id: str
    topic: str
    tier: Tier
    section: str
    refs: tuple[str, ...] = ()
    file: str = msgspec.field(default="", name=_FROM)

    @property
    def place(self) -> str:
        """Where it stands, for errors."""
        return f"{self.file}: entry {self.id!r}"


E = TypeVar("E", bound=Entry)


def load_entries(
    source: str, kind: type[E], where: str, langs: tuple[str, ...] = ()
) -> tuple[E, ...]:
    """Read entries.

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
    table = parse_toml(source, where, BankError)
    rows = table.get("entry")
    if set(table) != {"entry"} or not isinstance(rows, list):
        raise BankError(f"{where}: expected [[entry]] and nothing else, found {sorted(table)}")
    for place, row in enumerate(rows, 1):
        if not isinstance(row, dict):
            raise BankError(f"{where}: entry {place} is no table")
    found = tuple(_read_entry(row, kind, where, langs) for row in rows)
    names = [entry.id for entry in found]
    for name in names:
        if names.count(name) > 1:
            raise BankError(f"{where}: two entries have the id {name!r}")
    return found


def _read_entry(row: dict[str, object], kind: type[E], where: str, langs: tuple[str, ...]) -> E:
    try:
        entry = convert({**row, _FROM: where}, kind)
    except msgspec.ValidationError as error:
        place = f"{where}: entry {row.get('id', '?')!r}"
        raise BankError(f"{place}: {explain_validation_error(error, kind)}") from error
    for name in filter(row.__contains__, localised_fields(kind)):
        for lang in langs:
            if lang not in getattr(entry, name):
                raise BankError(f"{where}: entry {entry.id!r}: {name}.{lang} is missing")
    return entry


def localised_fields(kind: type[Entry]) -> list[str]:
    """Names of the fields that are written in every language."""
    return [field.name for field in msgspec.structs.fields(kind) if field.type == Passage]


@cache
def read_entries(bank: Bank, name: str, kind: type[E]) -> tuple[E, ...]:
    """Entries of one file of a bank, read once; none if the bank has no such file.

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
    if name not in bank.cards:
        return ()
    file = bank.cards[name]
    return load_entries(read_text(file, BankError), kind, str(file), bank.languages)
