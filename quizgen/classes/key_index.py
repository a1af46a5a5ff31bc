"""The keys of a class where many are needed at once: found without reading, read without proving.

``folder`` checks each specification of a key as that of a stranger; these are our own, and a wrong
one still ends marking with a ``KeyFileError``.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from quizgen.classes.class_folder import KEYS, ClassFolder, PrintedHead, original_key_bytes
from quizgen.classes.grading import item_name_from_parts
from quizgen.core.decoding import json_decoder
from quizgen.core.errors import ClassError
from quizgen.grading.echo import safe_echo
from quizgen.paper.answer_key import AnswerKey


@dataclass(frozen=True)
class PaperOutline:
    """What a paper asks, as far as item analysis needs it.

    Parameters
    ----------
    identities : mapping of str to str
        Template to the draw that this paper has of it.
    options : mapping of str to sequence of str
        Item to the options that stand there.
    """

    identities: Mapping[str, str]
    options: Mapping[str, tuple[str, ...]]


class _ShortSpec(msgspec.Struct):
    """The options of a specification, without what grades it."""

    options: tuple[str, ...] = ()


class _ShortPart(msgspec.Struct):
    """A part's id and options."""

    id: str
    spec: _ShortSpec


class _ShortQuestion(msgspec.Struct):
    """A question without its solution: decoding a full key takes far longer."""

    number: str
    template: str
    identity: str
    parts: list[_ShortPart]

    def items(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield each part's item name and its options."""
        for part in self.parts:
            yield item_name_from_parts(self.template, self.number, part.id), part.spec.options


class _ShortKey(msgspec.Struct):
    """The questions of a key, in their short form."""

    questions: list[_ShortQuestion]


class _ShortLine(msgspec.Struct):
    """A line of ``keys.jsonl``, as far as item analysis needs it."""

    key: _ShortKey


_KEY = json_decoder(AnswerKey).decode
_SHORT = json_decoder(_ShortLine).decode


class KeyIndex:
    """Random access to the keys of a class, by byte offsets in ``keys.jsonl``.

    Parameters
    ----------
    folder : ClassFolder
    """

    def __init__(self, folder: ClassFolder) -> None:
        self.path, self.folder = folder.path / KEYS, folder
        self.places: dict[str, tuple[PrintedHead, int]] = folder.places()

    def key(self, student: str) -> AnswerKey:
        """Return the answer key of a student's paper.

        Raises
        ------
        ClassError
            If there is none, or it cannot be read; it names the file.
        """
        return read_key_at(self.path, self._find_line(student))

    def outline(self, student: str) -> PaperOutline:
        """Return what a student's paper asks, without decoding all of its key."""
        try:
            found = _SHORT(_read_line_at(self.path, self._find_line(student))).key
        except msgspec.DecodeError as error:
            raise ClassError(f"{self.path}: {student}: {error}") from None
        return PaperOutline(
            {question.template: question.identity for question in found.questions},
            {item: options for question in found.questions for item, options in question.items()},
        )

    def _find_line(self, student: str) -> int:
        """Return where a student's line begins; ``ClassError`` if a damaged file has lost it."""
        if student not in self.places:
            raise ClassError(f"{self.path}: has no key of {safe_echo(student)}, who was marked")
        return self.places[student][1]

    def items(self) -> set[str]:
        """Return the item names of all papers; stops as soon as every template has been seen."""
        families = self.folder.settings.templates  # of a quiz that was played none are known
        missing = {name for family in families for name in family}
        found: set[str] = set()
        for student in self.places:
            outline = self.outline(student)
            found |= outline.options.keys()
            missing -= outline.identities.keys()
            if families and not missing:
                break
        return found


def read_key_at(path: Path, at: int) -> AnswerKey:
    """Return the answer key in the line that begins at byte ``at``.

    Raises
    ------
    ClassError
        If it is none, or not the one that was made.
    """
    try:
        return _KEY(original_key_bytes(_read_line_at(path, at), path))
    except msgspec.DecodeError as error:
        raise ClassError(f"{path}: byte {at}: {error}") from None


def _read_line_at(path: Path, at: int) -> bytes:
    """Return the line that begins at byte ``at``."""
    with path.open("rb") as stream:
        stream.seek(at, os.SEEK_SET)
        return stream.readline()
