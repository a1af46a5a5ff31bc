"""What an export leaves behind so that its responses can be marked: a line for each question.

The lines are a file of their own, since a table of a thousand questions could not be read in parts.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Literal, TypeVar

import msgspec

from quizgen.core.decoding import json_decoder
from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import read_text
from quizgen.kinds.contract import InputForm
from quizgen.paper.answer_key import FORMAT as KEY_FORMAT
from quizgen.paper.answer_key import KeyQuestion, parse_answer_key
from quizgen.paper.provenance import BankRecord

Line = TypeVar("Line")
FORMAT = "quizgen-responses/1"
LARGEST = 200_000_000
"""Bytes of the largest file of keys that is read."""

_LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
"""Those of a mark; none is taken for another."""
MARK = rf"\[([{_LETTERS}]{{4}}-[{_LETTERS}]{{4}})\]"
"""What a mark in a text looks like."""

Kind = Literal["number", "words", "truth", "one", "many", "pairs", "order", "written"]


class Asked(msgspec.Struct, frozen=True, omit_defaults=True):
    """What a field of a system holds.

    Parameters
    ----------
    kind : str
    part : str
        The part of the question that it belongs to.
    unit : str
        What stands behind the field, and is not typed.
    options, targets : mapping
        Letter of an option, a step or the left side of a pair, and of what it goes to; with the
        texts that a system may give for it.
    name : str
        What the system calls it, if it names its variables.
    """

    kind: Kind
    part: str
    unit: str = ""
    options: dict[str, list[str]] = {}
    targets: dict[str, list[str]] = {}
    name: str = ""


class Entry(msgspec.Struct, frozen=True):
    """A question of a system: the mark in its text, its id there, and its fields.

    ``embedded`` if these stand within its text (a cloze).
    """

    mark: str
    id: str
    asks: list[Asked]
    embedded: bool = False


class Shape(msgspec.Struct, frozen=True, omit_defaults=True):
    """How a part is answered in one line: see ``quizgen.kinds.contract.InputControl``."""

    form: InputForm
    names: list[str] = []
    named: bool = False


class Kept(msgspec.Struct, dict=True):
    """A question as it was exported, in one language, with all that marks it."""

    id: str
    slot: str
    lang: str
    question: msgspec.Raw
    shapes: dict[str, Shape]
    entries: list[Entry]

    @cached_property
    def key(self) -> KeyQuestion:
        """What marks it.

        Raises
        ------
        KeyFileError
            Naming the question.
        """
        table = {"format": KEY_FORMAT, "questions": [msgspec.json.decode(self.question)]}
        (found,) = parse_answer_key(table, f"question {self.id!r}").questions
        return found


class Head(msgspec.Struct, frozen=True):
    """The first line: what the file is, and the banks that its questions stand in."""

    format: str
    banks: tuple[BankRecord, ...] = ()


def mark(text: str) -> str:
    """Two times four letters that tell one question from every other one of an export."""
    number = int.from_bytes(hashlib.sha256(text.encode()).digest())
    letters = []
    for _ in range(8):
        number, place = divmod(number, len(_LETTERS))
        letters.append(_LETTERS[place])
    return f"{''.join(letters[:4])}-{''.join(letters[4:])}"


def written(kept: Iterable[Kept], banks: tuple[BankRecord, ...] = ()) -> bytes:
    """The file of keys."""
    return msgspec.json.Encoder().encode_lines([Head(FORMAT, banks), *kept])


def keys_of(text: str) -> bool:
    """Whether a text begins as the keys of an export do."""
    return text.startswith(f'{{"format":"{FORMAT}"')


class Keys:
    """The questions of an export, by mark and by id, and the banks that they stand in."""

    def __init__(self, kept: Iterable[Kept], banks: tuple[BankRecord, ...] = ()) -> None:
        self.banks = banks
        self.found: dict[str, tuple[Kept, Entry]] = {}
        for one in kept:
            for entry in one.entries:
                self.found[entry.mark] = self.found[entry.id] = (one, entry)


def read(path: Path) -> Keys:
    """Read the keys of an export.

    Raises
    ------
    KeyFileError
        Naming the file and the line.
    """
    text = read_text(path, KeyFileError, LARGEST)
    if not keys_of(text):
        raise KeyFileError(f"{path}: not the keys of an export (their first line says {FORMAT!r})")
    (head,) = _lines(path, Head, text.splitlines()[:1])
    return Keys(_lines(path, Kept, text.splitlines()[1:], 2), head.banks)


def _lines(path: Path, shape: type[Line], lines: list[str], first: int = 1) -> Iterator[Line]:
    read = json_decoder(shape).decode
    for number, line in enumerate(lines, first):
        try:
            yield read(line)
        except (msgspec.MsgspecError, RecursionError) as error:
            raise KeyFileError(f"{path}: line {number}: {error}") from None
