"""The authored content of a bank's deck: TOML files, checked, with errors that name the place.

Sentences are Markdown as in templates, in every language of the bank. Mathematics between dollar
signs and formula lines are written in the grammar that students type.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Literal, TypeVar

import msgspec

from quizgen.bank.about import in_language
from quizgen.bank.folder import Bank
from quizgen.bank.prose import Block, Formula, Inline, Slot, blocks, fill, fill_blocks, inlines
from quizgen.cards.equations import Piece, inline
from quizgen.errors import BankError
from quizgen.locale import table
from quizgen.outside import parse_toml, read_text

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


class Term(Entry, frozen=True, kw_only=True):
    """A word to know."""

    number: int
    group: str
    term: Passage
    meaning: Passage


class FormulaEntry(Entry, frozen=True, kw_only=True):
    """A formula: its lines, what the letters mean, where it fails."""

    title: Passage
    lines: tuple[str, ...]
    inside: dict[str, Piece] = msgspec.field(name="with", default={})
    separate: bool = False
    about: Passage
    beware: Passage


class Trap(Entry, frozen=True, kw_only=True):
    """A wrong claim or calculation, and the right one."""

    claim: Passage
    right: Passage


class Cheat(Entry, frozen=True, kw_only=True):
    """One entry of the cheat sheet."""

    ask: Passage
    answer: Passage


class Statement(Entry, frozen=True, kw_only=True):
    """A true or a false statement, and why."""

    text: Passage
    true: bool
    why: Passage


class FigureEntry(Entry, frozen=True, kw_only=True):
    """A picture to name."""

    figure: str
    values: dict[str, float] = {}
    quiz: bool = True
    ask: Passage
    answer: Passage


KINDS: dict[str, type[Entry]] = {
    "vocabulary": Term,
    "formulas": FormulaEntry,
    "traps": Trap,
    "cheat": Cheat,
    "statements": Statement,
    "figures": FigureEntry,
}
"""Content file to what its entries are."""

E = TypeVar("E", bound=Entry)


def load(source: str, kind: type[E], where: str, langs: tuple[str, ...] = ()) -> tuple[E, ...]:
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
    found = tuple(_entry(row, kind, where, langs) for row in rows)
    names = [entry.id for entry in found]
    for name in names:
        if names.count(name) > 1:
            raise BankError(f"{where}: two entries have the id {name!r}")
    return found


def _entry(row: dict[str, object], kind: type[E], where: str, langs: tuple[str, ...]) -> E:
    try:
        entry = msgspec.convert({**row, _FROM: where}, kind)
    except msgspec.ValidationError as error:
        names = {field.encode_name for field in msgspec.structs.fields(kind)}
        allowed = ", ".join(sorted(names - {_FROM}))
        hint = f" (allowed: {allowed})" if "unknown field" in str(error) else ""
        raise BankError(f"{where}: entry {row.get('id', '?')!r}: {error}{hint}") from error
    for name in passages(kind):
        for lang in langs:
            if lang not in getattr(entry, name):
                raise BankError(f"{where}: entry {entry.id!r}: {name}.{lang} is missing")
    return entry


def passages(kind: type[Entry]) -> list[str]:
    """Names of the fields that are written in every language."""
    return [field.name for field in msgspec.structs.fields(kind) if field.type == Passage]


@cache
def entries(bank: Bank, kind: type[E]) -> tuple[E, ...]:
    """Entries of one kind, read once; none if the bank has no such file.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    (name,) = (name for name, entry in KINDS.items() if entry is kind)
    if name not in bank.cards:
        return ()
    file = bank.cards[name]
    return load(read_text(file, BankError), kind, str(file), bank.languages)


def words(lang: str) -> dict[str, str]:
    """Short words on the cards, such as *What is wrong here?*, in one language."""
    return table(lang, "cards")


def passage(entry: Entry, name: str, lang: str) -> tuple[Block, ...]:
    """A passage of an entry as blocks, its mathematics ready for printing.

    Raises
    ------
    BankError
        Naming file, entry, field, language and column.
    """
    with _at(entry, name, lang) as text:
        return fill_blocks(blocks(text), _printed, _no_program)


def sentence(entry: Entry, name: str, lang: str) -> tuple[Inline, ...]:
    """The same as ``passage`` for a sentence, as inlines."""
    with _at(entry, name, lang) as text:
        return fill(inlines(text), _printed)


@contextmanager
def _at(entry: Entry, name: str, lang: str) -> Iterator[str]:
    """The text of a field; what is wrong with it is located."""
    texts: Passage = getattr(entry, name)
    try:
        yield in_language(texts, lang, "")
    except BankError as error:
        raise BankError(f"{entry.place}: {name}.{lang}: {error}") from error


def _printed(part: Slot | Formula) -> tuple[Inline, ...]:
    if isinstance(part, Slot):
        raise BankError(f"{{{{ {part.name} }}}} cannot be filled in on a card")
    return (inline(part.expr),)


def _no_program(text: str) -> str:
    raise BankError(f"program {text!r} cannot stand on a card")
