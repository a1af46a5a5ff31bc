"""The folder of a class: its settings and secret, its roster, the key of every paper.

``class.toml`` and ``keys.jsonl`` are for the examiner alone (mode 0600). Keys are written a line a
student as papers are made; a line that a killed run left half written counts as not there.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import msgspec

from quizgen.bank.combined import BankSource
from quizgen.classes.pseudonyms import student_code
from quizgen.classes.roster import RosterStudent, read_roster, write_roster
from quizgen.core.decoding import convert, decode_json, json_decoder
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, open_private, restrict_folder, write_all
from quizgen.core.untrusted import parse_json, parse_toml, read_text
from quizgen.paper.answer_key import AnswerKey, answer_key_digest, parse_answer_key

SETTINGS, ROSTER, KEYS = "class.toml", "roster.csv", "keys.jsonl"
PAPERS, SOLUTIONS, FORMS, ANSWERS = "papers", "solutions", "forms", "answers"
SHEETS = "sheets"
"""Compact answer sheets, where the class has them."""
DATA = "data"
"""Files with drawn data, in a folder for each student whose questions name some."""


class ClassSettings(msgspec.Struct, frozen=True):
    """What a class is generated from: ``class.toml``, which stays as it is once there are papers.

    Parameters
    ----------
    name : str
        Of the class: that of its folder.
    secret : str
        128 bits, from which every number follows.
    blueprint : str
        Its name or its file.
    banks : tuple of BankSource
        What it asks.
    lang : str
        Of students whose row names none.
    digest : str
        Of the blueprint and the templates.
    templates : tuple of tuple of str
        For each question, the templates that it may be made from.
    without : tuple of str
        Templates that no question may be made from: those of earlier classes.
    scan : bool
        Whether papers have marks and codes for a scanner.
    """

    name: str
    secret: str
    blueprint: str
    banks: tuple[BankSource, ...]
    lang: str
    digest: str
    templates: tuple[tuple[str, ...], ...]
    without: tuple[str, ...] = ()
    scan: bool = False


class PrintedHead(msgspec.Struct, frozen=True):
    """What a line of ``keys.jsonl`` holds apart from the key.

    Parameters
    ----------
    id, code : str
    made : str
        Blueprint, language and digest of the files that the paper was made with.
    stamp : str
        Digest of the row of the roster and of ``made``.
    beside : tuple of str
        Ids of neighbours that this paper gave way to.
    digest : str
        Of the key as it was written: who edits it by hand is told.
    former : tuple of str
        Codes that the paper had in another language: it may have been handed out.
    minutes : int
        Working time of the paper; 0 if it is not known.
    """

    id: str
    code: str
    made: str
    stamp: str
    beside: tuple[str, ...] = ()
    digest: str = ""
    former: tuple[str, ...] = ()
    minutes: int = 0

    @property
    def codes(self) -> tuple[str, ...]:
        """Return all codes under which the paper may come back."""
        return (self.code, *self.former)


class PaperRecord(msgspec.Struct, frozen=True):
    """One line of ``keys.jsonl``: what was printed, and the key that grades it."""

    head: PrintedHead
    key: AnswerKey


class ClassFolder:
    """Reads and writes the folder of a class.

    Parameters
    ----------
    path : pathlib.Path
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def __repr__(self) -> str:
        return f"<ClassFolder {self.path}>"

    @property
    def is_new(self) -> bool:
        """Whether no class has been generated here yet.

        Raises
        ------
        ClassError
            If the folder holds something else.
        """
        if (self.path / SETTINGS).exists():
            return False
        if self.path.exists() and (not self.path.is_dir() or any(self.path.iterdir())):
            raise ClassError(
                f"{self.path}: holds something else than a class; name another folder with --out"
            )
        return True

    @cached_property
    def settings(self) -> ClassSettings:
        """Return the settings of ``class.toml``; read once.

        Raises
        ------
        ClassError
            If it is no folder of a class.
        """
        place = self.path / SETTINGS
        if not place.exists():
            raise ClassError(f"{self.path}: is not the folder of a class (it has no {SETTINGS})")
        table = parse_toml(read_text(place, ClassError), place, ClassError)
        if "bank" in table:  # of a class that was made when there was but one
            table["banks"] = [(table.pop("bank"), table.pop("trust", False))]
        try:
            found = convert(table, ClassSettings)
            bytes.fromhex(found.secret)
        except (msgspec.ValidationError, ValueError) as error:
            raise ClassError(f"{place}: {error}") from None
        return found

    def create(self, settings: ClassSettings, students: Sequence[RosterStudent]) -> None:
        """Write settings, roster and an empty file of keys for a new class.

        Settings come first: no paper may exist that they do not explain.
        """
        contents = {ROSTER: write_roster(students), KEYS: b"", SETTINGS: format_settings(settings)}
        write_all(self.path, contents, mode=PRIVATE)
        restrict_folder(self.path)  # it may have been there, empty

    def change_settings(self, settings: ClassSettings) -> None:
        """Replace the settings of a class that has no papers yet.

        Raises
        ------
        ClassError
            If there are papers, which would no longer follow from them.
        """
        if self.places():
            raise ClassError(f"{self.path}: has papers; other questions need a new folder (--out)")
        write_all(self.path, {SETTINGS: format_settings(settings)}, PRIVATE)
        self.__dict__.pop("settings", None)

    def students(self) -> list[RosterStudent]:
        """Return the students of the roster, in the order of their seats."""
        return read_roster(self.path / ROSTER)

    def write_roster(self, students: Sequence[RosterStudent]) -> None:
        """Replace the roster file."""
        write_all(self.path, {ROSTER: write_roster(students)}, mode=PRIVATE)

    def heads(self) -> dict[str, PrintedHead]:
        """Return what was printed last for each student, by the student's id."""
        return {head.id: head for head, _ in self.places().values()}

    def find_by_code(self, code: str) -> PaperRecord:
        """Return the paper with a printed code, after checking its key against the code.

        Raises
        ------
        ClassError
            If no paper has it, or the paper's key has been changed.
        """
        wanted, secret = code.strip().upper(), self.settings.secret
        places = [place for head, place in self.places().values() if wanted in head.codes]
        if not places:
            raise ClassError(f"{self.path}: no paper of this class has the code {wanted!r}")
        found = self._read_record(places[0])
        digest = answer_key_digest(found.key, found.head.made)
        if student_code(secret, found.head.id, digest) != found.head.code:
            raise ClassError(f"{self.path / KEYS}: the key of {wanted} has been changed")
        return found

    def append(self, lines: Iterable[bytes]) -> None:
        """Append lines to ``keys.jsonl``; they are on the disk when this returns."""
        with open_private(self.path / KEYS) as stream:
            if self._is_last_line_torn:
                stream.write(b"\n")
            stream.write(b"".join(lines))
            stream.flush()
            os.fsync(stream.fileno())

    @property
    def _is_last_line_torn(self) -> bool:
        """Return whether an interrupted run left the last line incomplete."""
        place = self.path / KEYS
        if not place.exists() or not place.stat().st_size:
            return False
        with place.open("rb") as stream:
            stream.seek(-1, os.SEEK_END)
            return stream.read() != b"\n"

    def compact(self, order: Sequence[str]) -> None:
        """Rewrite ``keys.jsonl`` with each student's last line only.

        Students in ``order`` come first, then those who have left the roster.
        """
        index = self.places()
        ids = [one for one in dict.fromkeys((*order, *index)) if one in index]
        fresh = self.path / f".{KEYS}.new"
        with (self.path / KEYS).open("rb") as lines, open_private(fresh, truncate=True) as stream:
            for one in ids:
                lines.seek(index[one][1])
                stream.write(lines.readline())
            stream.flush()
            os.fsync(stream.fileno())
        fresh.replace(self.path / KEYS)

    def places(self) -> dict[str, tuple[PrintedHead, int]]:
        """Return each student's last complete line: its head and its byte offset."""
        found: dict[str, tuple[PrintedHead, int]] = {}
        at = 0
        with (self.path / KEYS).open("rb") as stream:
            for line in stream:
                head = _decode_head(line)
                if head is not None:
                    found[head.id] = head, at
                at += len(line)
        return found

    def _read_record(self, at: int) -> PaperRecord:
        """Return the paper in the line at byte ``at``; ``ClassError`` if it is damaged."""
        place = self.path / KEYS
        with place.open("rb") as stream:
            stream.seek(at)
            line = stream.readline()
        table = parse_json(original_key_bytes(line, place).decode(), place, ClassError)
        head = decode_json(line, PrintedHead)
        if not isinstance(table, dict):
            raise ClassError(f"{place}: a table is expected in each line")
        return PaperRecord(head, parse_answer_key(table, f"{place}: {head.id}"))


class _Line(msgspec.Struct):
    """The fields of a line that tell whether its key was edited."""

    id: str
    key: msgspec.Raw
    digest: str = ""


_LINE = json_decoder(_Line).decode


def format_record(head: PrintedHead, key: AnswerKey, **more: object) -> bytes:
    """Return a paper as a line of ``keys.jsonl``, with the digest of its key.

    ``more`` stands beside the key, such as places of an answer sheet; what is empty is left out.
    """
    written = msgspec.json.encode(key)
    whole = msgspec.structs.replace(head, digest=_compute_key_digest(written))
    shown = {name: value for name, value in more.items() if value}
    table = {**msgspec.structs.asdict(whole), "key": msgspec.Raw(written), **shown}
    return msgspec.json.encode(table) + b"\n"


def original_key_bytes(line: bytes, place: Path) -> bytes:
    """Return the key in a line, exactly as it was written.

    Raises
    ------
    ClassError
        If somebody has edited it.
    """
    try:
        found = _LINE(line)
    except msgspec.DecodeError as error:
        raise ClassError(f"{place}: {error}") from None
    if found.digest not in {"", _compute_key_digest(found.key)}:  # older classes have none
        raise ClassError(
            f"{place}: the key of {found.id} has been changed; to have it as it was, delete its "
            "line and run quizgen class make (rulings change marks: quizgen class rule)"
        )
    return bytes(found.key)


def _compute_key_digest(written: bytes | msgspec.Raw) -> str:
    """Return 16 hexadecimal digits of a written key."""
    return hashlib.sha256(written).hexdigest()[:16]


def _decode_head(line: bytes) -> PrintedHead | None:
    """Return the head in a line; None if an interrupted run left the line incomplete."""
    if not line.endswith(b"\n"):
        return None
    try:
        return decode_json(line, PrintedHead)
    except msgspec.DecodeError:
        return None


def format_settings(settings: ClassSettings) -> bytes:
    """Return the settings as TOML: its strings and arrays are written as those of JSON."""
    table: Mapping[str, Any] = msgspec.structs.asdict(settings)
    lines = [f"{name} = {json.dumps(value, ensure_ascii=False)}" for name, value in table.items()]
    return ("\n".join(lines) + "\n").encode()
