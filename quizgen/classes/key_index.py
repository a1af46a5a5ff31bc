"""The keys of a class where many are needed at once: found without reading, read without proving.

``folder`` checks each specification of a key as that of a stranger; these are our own, and a wrong
one still ends marking with a ``KeyFileError``.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import msgspec

from quizgen.classes.class_folder import KEYS, ClassFolder, PrintedHead, original_key_bytes
from quizgen.classes.grading import item_name_from_parts
from quizgen.classes.part_names import PartNames
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
    items : mapping of str to str
        Part as it is printed, such as ``7a``, to its item.
    worth : mapping of str to float
        Item to its points.
    """

    identities: Mapping[str, str]
    options: Mapping[str, tuple[str, ...]]
    items: Mapping[str, str] = field(default_factory=dict)
    worth: Mapping[str, float] = field(default_factory=dict)


class _ShortSpec(msgspec.Struct):
    """The options of a specification, without what grades it."""

    options: tuple[str, ...] = ()


class _ShortPart(msgspec.Struct):
    """A part's id, points and options."""

    id: str
    points: str
    spec: _ShortSpec


class _ShortQuestion(msgspec.Struct):
    """A question without its solution: decoding a full key takes far longer."""

    number: str
    template: str
    identity: str
    parts: list[_ShortPart]

    def items(self) -> Iterator[tuple[str, _ShortPart]]:
        """Yield each part with the name of its item."""
        for part in self.parts:
            yield item_name_from_parts(self.template, self.number, part.id), part


class _ShortKey(msgspec.Struct):
    """The questions of a key, in their short form."""

    questions: list[_ShortQuestion]


_KEY = json_decoder(AnswerKey).decode
_SHORT = json_decoder(_ShortKey).decode


class KeyIndex:
    """Random access to the keys of a class, by byte offsets in ``keys.jsonl``.

    Parameters
    ----------
    folder : ClassFolder
    """

    def __init__(self, folder: ClassFolder) -> None:
        folder.settings  # noqa: B018 - a folder that is none of a class says so
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

    def find_changed(self) -> set[str]:
        """Return the students whose keys somebody has edited, or that cannot be read."""
        found = set()
        with self.path.open("rb") as stream:
            for student, (_, at) in self.places.items():
                stream.seek(at)
                try:
                    original_key_bytes(stream.readline(), self.path)
                except ClassError:
                    found.add(student)
        return found

    def outline(self, student: str) -> PaperOutline:
        """Return what a student's paper asks, without decoding all of its key."""
        try:
            line = read_line_at(self.path, self._find_line(student))
            found = _SHORT(original_key_bytes(line, self.path))
        except msgspec.DecodeError as error:
            raise ClassError(f"{self.path}: {student}: {error}") from None
        parts = [(item, part) for question in found.questions for item, part in question.items()]
        return PaperOutline(
            {question.template: question.identity for question in found.questions},
            {item: part.spec.options for item, part in parts},
            {part.id: item for item, part in parts},
            {item: float(Fraction(part.points)) for item, part in parts},
        )

    def _find_line(self, student: str) -> int:
        """Return where a student's line begins; ``ClassError`` if a damaged file has lost it."""
        if student not in self.places:
            raise ClassError(f"{self.path}: has no key of {safe_echo(student)}, who was marked")
        return self.places[student][1]

    def find_student(self, student: str) -> str:
        """Return the id of a student as the roster writes it; capitals do not matter.

        Raises
        ------
        ClassError
            If nobody has it.
        """
        folded = student.strip().casefold()
        found = next((one for one in self.places if one.casefold() == folded), None)
        if found is None:
            raise ClassError(f"nobody of this class has the number {safe_echo(student)!r}")
        return found

    def find_by_code(self, code: str) -> str:
        """Return the id of the student whose paper has a printed code.

        Raises
        ------
        ClassError
            If no paper has it.
        """
        wanted = code.strip().upper()
        for head, _ in self.places.values():
            if wanted in head.codes:
                return head.id
        raise ClassError(f"no paper of this class has the code {safe_echo(wanted)!r}")

    def worth(self) -> dict[str, float]:
        """Return the points of each item of all papers.

        Stops as soon as every template has been seen; a key that was edited counts as not there.
        """
        families = self.folder.settings.templates  # of a quiz that was played none are known
        missing = {name for family in families for name in family}
        found: dict[str, float] = {}
        for student in self.places:
            try:
                outline = self.outline(student)
            except ClassError:
                continue
            for item, points in outline.worth.items():
                found[item] = max(points, found.get(item, 0.0))
            missing -= outline.identities.keys()
            if families and not missing:
                break
        return found

    def check_trap(self, item: str, name: str) -> None:
        """Raise ``ClassError`` if no paper knows a mistake of this name in an item.

        Which mistakes are told apart depends on the numbers drawn, so all papers are asked.

        Raises
        ------
        ClassError
            Naming the mistakes that there are.
        """
        known: set[str] = set()
        for student in self.places:
            with suppress(ClassError):  # a key that was edited counts as not there
                known.update(*_iter_traps(self.key(student), item))
            if name in known:
                return
        there = f"there are {', '.join(sorted(known))}" if known else "none is known there"
        raise ClassError(f"answer: no mistake {safe_echo(name)!r} ({there})")

    def find_item(self, name: str, student: str = "") -> str:
        """Return the item that a name means: itself, or a part as it is printed, such as ``7b``.

        Parameters
        ----------
        name : str
        student : str
            On whose paper it is printed; without one, all papers must agree.

        Raises
        ------
        ClassError
            If there is none, or papers differ.
        """
        if name in self.worth():
            return name
        whose = [student] if student else [*self.places]
        meant = {
            outline.items.get(PartNames(outline.items).find(name), "")
            for outline in map(self.outline, whose)
        }
        if len(meant) > 1:
            raise ClassError(f"{safe_echo(name)} is not the same part on all papers: --student")
        if not any(meant):
            raise ClassError(
                f"no part {safe_echo(name)!r} (there are {', '.join(sorted(self.worth()))})"
            )
        return meant.pop()


def _iter_traps(key: AnswerKey, item: str) -> Iterator[Iterable[str]]:
    """Yield the names of the mistakes that a paper knows in an item."""
    for question in key.questions:
        for part in question.parts:
            if item_name_from_parts(question.template, question.number, part.id) == item:
                yield part.spec.get("traps", ())


def read_key_at(path: Path, at: int) -> AnswerKey:
    """Return the answer key in the line that begins at byte ``at``.

    Raises
    ------
    ClassError
        If it is none, or not the one that was made.
    """
    try:
        return _KEY(original_key_bytes(read_line_at(path, at), path))
    except msgspec.DecodeError as error:
        raise ClassError(f"{path}: byte {at}: {error}") from None


def read_line_at(path: Path, at: int) -> bytes:
    """Return the line that begins at byte ``at``."""
    with path.open("rb") as stream:
        stream.seek(at, os.SEEK_SET)
        return stream.readline()
