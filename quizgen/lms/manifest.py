"""What an export leaves so that its responses can be graded: a line of JSON for each question.

The lines are a file of their own, since a report of a thousand questions could not be read in
parts. Field names are those of the file.
"""

from __future__ import annotations

import hashlib
import re
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
MANIFEST_FORMAT = "quizgen-responses/1"
# Bytes of the largest manifest that is read.
LARGEST_MANIFEST = 200_000_000

# Without 0, 1, i, l and o: people copy tokens by hand.
_LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
# A token as it stands in the text of a question.
TOKEN_PATTERN = rf"\[([{_LETTERS}]{{4}}-[{_LETTERS}]{{4}})\]"

_LETTER = re.compile(r"[\w-]{1,20}")
_PLACE = re.compile(r"\d{1,4}|-")

# What an interaction is, in an export and in its manifest.
InteractionKind = Literal["number", "words", "truth", "one", "many", "pairs", "order", "written"]


class ResponseField(msgspec.Struct, frozen=True, omit_defaults=True):
    """How the response to one interaction is read back.

    Parameters
    ----------
    kind : str
    part : str
        Id of the part of the question that it belongs to.
    unit : str
        Printed after the field, so that it is not typed.
    options, targets : mapping
        Letter of an option, a step or a stem, and of what a stem goes to; with the texts that a
        system may give for it.
    name : str
        Of the system's variable, if its variables have names.
    """

    kind: InteractionKind
    part: str
    unit: str = ""
    options: dict[str, list[str]] = {}
    targets: dict[str, list[str]] = {}
    name: str = ""

    def __post_init__(self) -> None:
        """Raise ``ValueError`` for what no export writes, and no response could be read by."""
        if self.kind in {"one", "many", "pairs", "order"} and not any(self.options.values()):
            raise ValueError("a field to choose in has no options")
        if not all(map(_LETTER.fullmatch, (*self.options, *self.targets))):
            raise ValueError("the letter of an option or a target is no letter or number")
        if self.kind == "order" and not all(map(_PLACE.fullmatch, self.targets)):
            raise ValueError("the place of a step is no number")


class ManifestQuestion(msgspec.Struct, frozen=True):
    """A question of the system: the token in its text, its id there, and its fields.

    ``embedded`` if the fields stand within its text (Moodle's cloze).
    """

    mark: str
    id: str
    asks: list[ResponseField]
    embedded: bool = False


class ResponseShape(msgspec.Struct, frozen=True, omit_defaults=True):
    """How a part is answered in one line: see ``quizgen.kinds.contract.InputControl``.

    ``rows`` are those that fields for single numbers stand in: of a matrix.
    """

    form: InputForm
    names: list[str] = []
    named: bool = False
    rows: int = 0


class ManifestItem(msgspec.Struct, dict=True):
    """An exported item in one language, with all that grades it."""

    id: str
    slot: str
    lang: str
    question: msgspec.Raw
    shapes: dict[str, ResponseShape]
    entries: list[ManifestQuestion]

    def __post_init__(self) -> None:
        """Raise ``ValueError`` for a field of a part that is not described."""
        parts = {field.part for question in self.entries for field in question.asks}
        if not parts <= self.shapes.keys():
            raise ValueError("a field belongs to no part")

    @cached_property
    def key(self) -> KeyQuestion:
        """The key that grades it.

        Raises
        ------
        KeyFileError
            Naming the question.
        """
        table = {"format": KEY_FORMAT, "questions": [msgspec.json.decode(self.question)]}
        (found,) = parse_answer_key(table, f"question {self.id!r}").questions
        return found


class ManifestHead(msgspec.Struct, frozen=True):
    """The first line: the format, and the banks that the questions come from."""

    format: str
    banks: tuple[BankRecord, ...] = ()


class ExportManifest:
    """The items of an export by the token and the id of each of their questions, with the banks."""

    def __init__(self, items: Iterable[ManifestItem], banks: tuple[BankRecord, ...] = ()) -> None:
        self.banks = banks
        self.found: dict[str, tuple[ManifestItem, ManifestQuestion]] = {}
        for item in items:
            for question in item.entries:
                self.found[question.mark] = self.found[question.id] = (item, question)


def question_token(text: str) -> str:
    """Return two times four letters that tell a question from every other one of an export."""
    number = int.from_bytes(hashlib.sha256(text.encode()).digest())
    letters = []
    for _ in range(8):
        number, place = divmod(number, len(_LETTERS))
        letters.append(_LETTERS[place])
    return f"{''.join(letters[:4])}-{''.join(letters[4:])}"


def write_manifest(items: Iterable[ManifestItem], banks: tuple[BankRecord, ...] = ()) -> bytes:
    """Return the manifest's file."""
    return msgspec.json.Encoder().encode_lines([ManifestHead(MANIFEST_FORMAT, banks), *items])


def is_manifest(text: str) -> bool:
    """Whether a text begins as a manifest does."""
    return text.startswith(f'{{"format":"{MANIFEST_FORMAT}"')


def read_manifest(path: Path) -> ExportManifest:
    """Return the manifest in a file.

    Raises
    ------
    KeyFileError
        Naming the file and the line.
    """
    text = read_text(path, KeyFileError, LARGEST_MANIFEST)
    if not is_manifest(text):
        raise KeyFileError(
            f"{path}: not the keys of an export (their first line says {MANIFEST_FORMAT!r})"
        )
    (head,) = _read_lines(path, ManifestHead, text.splitlines()[:1])
    items = _read_lines(path, ManifestItem, text.splitlines()[1:], 2)
    return ExportManifest(items, head.banks)


def _read_lines(path: Path, shape: type[Line], lines: list[str], first: int = 1) -> Iterator[Line]:
    """Yield the values on lines of JSON; ``KeyFileError`` names file and line (from ``first``)."""
    decode = json_decoder(shape).decode
    for number, line in enumerate(lines, first):
        try:
            yield decode(line)
        except (msgspec.MsgspecError, RecursionError) as error:
            raise KeyFileError(f"{path}: line {number}: {error}") from None
