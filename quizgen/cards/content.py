"""The authored content of the deck: TOML files, checked, with errors that name the place.

Sentences are Markdown as in templates, in English and Bangla. Mathematics between dollar signs and
formula lines are written in the grammar that students type.
"""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from typing import Any, Literal, TypeVar

import msgspec

from quizgen.bank.prose import Block, Formula, Inline, Slot, blocks, fill, fill_blocks, inlines
from quizgen.cards.equations import inline
from quizgen.errors import BankError
from quizgen.locale import table

Tier = Literal["A", "B", "C", "D"]


class Both(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One sentence or passage in both languages."""

    en: str
    bn: str

    def of(self, lang: str) -> str:
        """The passage in one language."""
        return self.bn if lang == "bn" else self.en


class Entry(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """What every entry has."""

    id: str
    topic: str
    tier: Tier
    section: str
    refs: tuple[str, ...] = ()


class Term(Entry, frozen=True, kw_only=True):
    """A word to know."""

    number: int
    group: str
    term: Both
    meaning: Both


class FormulaEntry(Entry, frozen=True, kw_only=True):
    """A formula: its lines, what the letters mean, where it fails."""

    title: Both
    lines: tuple[str, ...]
    inside: dict[str, dict[str, Any]] = msgspec.field(name="with", default={})
    separate: bool = False
    about: Both
    beware: Both


class Trap(Entry, frozen=True, kw_only=True):
    """A wrong claim or calculation, and the right one."""

    claim: Both
    right: Both


class Cheat(Entry, frozen=True, kw_only=True):
    """One entry of the cheat sheet."""

    ask: Both
    answer: Both


class Statement(Entry, frozen=True, kw_only=True):
    """A true or a false statement, and why."""

    text: Both
    true: bool
    why: Both


class FigureEntry(Entry, frozen=True, kw_only=True):
    """A picture to name."""

    figure: str
    values: dict[str, float] = {}
    quiz: bool = True
    ask: Both
    answer: Both


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


def read(name: str) -> str:
    """The text of a content file that ships with the package."""
    return (files("quizgen.cards") / "content" / f"{name}.toml").read_text(encoding="utf-8")


def load(source: str, kind: type[E], where: str) -> tuple[E, ...]:
    """Read entries.

    Parameters
    ----------
    source : str
        TOML with one array of tables, ``[[entry]]``.
    kind : type
        What the entries are.
    where : str
        Name of the file, for errors.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    try:
        table = tomllib.loads(source)
    except tomllib.TOMLDecodeError as error:
        raise BankError(f"{where}: not valid TOML: {error}") from error
    if set(table) != {"entry"}:
        raise BankError(f"{where}: expected [[entry]] and nothing else, found {sorted(table)}")
    found = tuple(_entry(row, kind, where) for row in table["entry"])
    names = [entry.id for entry in found]
    for name in names:
        if names.count(name) > 1:
            raise BankError(f"{where}: two entries have the id {name!r}")
    return found


def _entry(row: dict[str, Any], kind: type[E], where: str) -> E:
    try:
        return msgspec.convert(row, kind)
    except msgspec.ValidationError as error:
        allowed = ", ".join(sorted(field.encode_name for field in msgspec.structs.fields(kind)))
        hint = f" (allowed: {allowed})" if "unknown field" in str(error) else ""
        raise BankError(f"{where}: entry {row.get('id', '?')!r}: {error}{hint}") from error


@cache
def entries(name: str) -> tuple[Any, ...]:
    """Entries of a content file, read once.

    Raises
    ------
    BankError
        Naming file, entry and key.
    """
    return load(read(name), KINDS[name], f"{name}.toml")


def words(lang: str) -> dict[str, str]:
    """Short words on the cards, such as *What is wrong here?*, in one language."""
    return table(lang, "cards")


def passage(entry: Entry, name: str, lang: str) -> tuple[Block, ...]:
    """A passage of an entry as blocks, its mathematics ready for printing.

    Raises
    ------
    BankError
        Naming entry, field, language and column.
    """
    both: Both = getattr(entry, name)
    try:
        return fill_blocks(blocks(both.of(lang)), _printed, _no_program)
    except BankError as error:
        raise BankError(f"card {entry.id!r}, {name}.{lang}: {error}") from error


def sentence(entry: Entry, name: str, lang: str) -> tuple[Inline, ...]:
    """A sentence of an entry as inlines.

    Raises
    ------
    BankError
        Naming entry, field, language and column.
    """
    both: Both = getattr(entry, name)
    try:
        return fill(inlines(both.of(lang)), _printed)
    except BankError as error:
        raise BankError(f"card {entry.id!r}, {name}.{lang}: {error}") from error


def _printed(part: Slot | Formula) -> tuple[Inline, ...]:
    if isinstance(part, Slot):
        raise BankError(f"{{{{ {part.name} }}}} cannot be filled in on a card")
    return (inline(part.expr),)


def _no_program(text: str) -> str:
    raise BankError(f"program {text!r} cannot stand on a card")
