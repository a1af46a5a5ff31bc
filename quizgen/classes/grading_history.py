"""Every mark that was ever given: ``marks/001.jsonl``, ``002.jsonl``, ... and ``changes.csv``.

The first run writes a line for each student, every later one a line for each student whose marks
changed. Nothing is ever written over: a student's last line counts, the others are the history.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import msgspec

from quizgen.classes.grading import GradedClassPart, StudentMarks
from quizgen.core.decoding import json_decoder
from quizgen.core.errors import ClassError
from quizgen.core.files import open_private, sync_folder
from quizgen.core.untrusted import format_csv

FOLDER, CHANGES, STAGED = "marks", "changes.csv", ".changes"
HEAD = ("run", "when", "student", "part", "item", "answer", "before", "after", "why")

_ENCODE = msgspec.json.Encoder().encode
_DECODE = json_decoder(StudentMarks).decode


class MarkChange(NamedTuple):
    """A mark that a run changed; None stands for no mark or an undecided one."""

    student: str
    part: str
    item: str
    answer: str
    before: float | None
    after: float | None
    why: str


class TotalChange(NamedTuple):
    """What a student reached of which points, before a run and after it."""

    student: str
    before: tuple[float, float]
    after: tuple[float, float]


class GradingOutcome(NamedTuple):
    """How many students a run graded, how many were new, what is undecided or changed."""

    students: int
    new: int
    undecided: int
    changes: list[MarkChange]
    totals: list[TotalChange]


class GradingHistory:
    """The marks of a class over all grading runs; nothing is overwritten.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def runs(self) -> list[Path]:
        """Return the files of all runs, oldest first."""
        found = (self.folder / FOLDER).glob("[0-9]*.jsonl")
        return sorted(found, key=lambda path: int(path.stem))

    def places(self) -> dict[str, tuple[Path, int]]:
        """Return file and byte offset of each student's last line."""
        found: dict[str, tuple[Path, int]] = {}
        for path in self.runs():
            at = 0
            with path.open("rb") as stream:
                for line in stream:
                    found[_read_student(line, path)] = path, at
                    at += len(line)
        return found

    def current(self) -> Iterator[StudentMarks]:
        """Yield the current marks of each student, without holding all in memory."""
        places = self.places()
        with _Lines() as lines:
            for path, at in places.values():
                yield _decode_marks(lines.at(path, at), path)

    def marks_of(self, student: str) -> list[tuple[str, StudentMarks]]:
        """Return all marks that a student ever had, each with the number of its run."""
        found = []
        for path in self.runs():
            with path.open("rb") as stream:
                marked = (
                    _decode_marks(line, path)
                    for line in stream
                    if _read_student(line, path) == student
                )
                found += [(path.stem, one) for one in marked]
        return found

    def write(self, marked: Iterable[StudentMarks], *, keep: bool = True) -> GradingOutcome:
        """Append the marks that changed as a new run; return what changed.

        Parameters
        ----------
        marked : iterable of StudentMarks
            At most one for each student.
        keep : bool
            Whether anything is written, or only found out.

        Raises
        ------
        ClassError
            If the history cannot be read.
        """
        places, number = self.places(), len(self.runs()) + 1
        (self.folder / FOLDER).mkdir(mode=0o700, exist_ok=True)
        self._settle_changes()
        final = self.folder / FOLDER / f"{number:03}.jsonl"
        fresh = final.with_suffix(".part")
        students = new = undecided = written = 0
        changes: list[MarkChange] = []
        totals: list[TotalChange] = []
        with _Lines() as lines, open_private(fresh, truncate=True) as stream:
            for one in marked:
                students, undecided = students + 1, undecided + one.undecided_count
                line = _format_line(one)
                before = places.get(one.student)
                old = lines.at(*before) if before else b""
                if old == line:
                    continue
                stream.write(line)
                written += 1
                new += not before
                if before:
                    was = _decode_marks(old, final)
                    changes += _iter_changed_parts(was, one)
                    both = (was.marks, was.points), (one.marks, one.points)
                    totals += [TotalChange(one.student, *both)] if both[0] != both[1] else []
            _sync(stream)
        if written and keep:
            self._stage_changes(changes, number)
            fresh.replace(final)
            sync_folder(final.parent)
            self._settle_changes()
        else:
            fresh.unlink()
        return GradingOutcome(students, new, undecided, changes, totals)

    def _stage_changes(self, changes: list[MarkChange], number: int) -> None:
        """Write what ``changes.csv`` is to be as soon as the marks of a run are there."""
        if not changes:
            return
        now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        path = self.folder / CHANGES
        before = path.read_bytes() if path.exists() else format_csv([HEAD]).encode()
        rows = [[str(number), now, *map(_format_cell, change)] for change in changes]
        staged = self.folder / FOLDER / f"{number:03}{STAGED}"
        with open_private(staged, truncate=True) as stream:
            stream.write(before + format_csv(rows).encode())
            _sync(stream)

    def _settle_changes(self) -> None:
        """Bring ``changes.csv`` up to the last run, whether or not that one came to its end."""
        for staged in (self.folder / FOLDER).glob(f"*{STAGED}"):
            if staged.with_suffix(".jsonl").exists():
                staged.replace(self.folder / CHANGES)
                sync_folder(self.folder)
            else:  # of a run that was killed before there were any marks of it
                staged.unlink()


def _sync(stream: io.BufferedWriter) -> None:
    """Wait until what was written is on the disk."""
    stream.flush()
    os.fsync(stream.fileno())


class _Lines(contextlib.AbstractContextManager["_Lines"]):
    """Reads single lines from several files, which it keeps open until it is closed."""

    def __init__(self) -> None:
        self.open = contextlib.ExitStack()
        self.streams: dict[Path, io.BufferedReader] = {}

    def at(self, path: Path, start: int) -> bytes:
        """Return the line that begins at byte ``start``."""
        if path not in self.streams:
            self.streams[path] = self.open.enter_context(path.open("rb"))
        stream = self.streams[path]
        stream.seek(start)
        return stream.readline()

    def __exit__(self, *_: object) -> None:
        self.open.close()


class _Who(msgspec.Struct):
    """The one field of a line of marks that tells whose it is."""

    student: str


_WHO = json_decoder(_Who).decode


def _read_student(line: bytes, path: Path) -> str:
    """Return the student's id in a line, without decoding the rest; ``ClassError`` if damaged."""
    try:
        return _WHO(line).student
    except msgspec.DecodeError as error:
        raise ClassError(f"{path}: {error}") from None


def _format_line(marks: StudentMarks) -> bytes:
    """Return marks as a line, the same wherever they were made.

    msgspec leaves out a default that is the same object, which no text from another process is.
    """
    return _ENCODE(msgspec.structs.replace(marks, decimal=sys.intern(marks.decimal))) + b"\n"


def _decode_marks(line: bytes, path: Path) -> StudentMarks:
    """Return the marks in a line; ``ClassError`` naming the file if it is damaged."""
    try:
        return _DECODE(line)
    except msgspec.DecodeError as error:
        raise ClassError(f"{path}: {error}") from None


def _iter_changed_parts(old: StudentMarks, new: StudentMarks) -> Iterator[MarkChange]:
    """Yield the parts whose marks or points differ between two runs."""
    before = {part.id: part for part in old.parts}
    for part in new.parts:
        was = before.get(part.id)
        if was is None or (was.marks, was.points) != (part.marks, part.points):
            yield MarkChange(
                new.student,
                part.id,
                part.item,
                part.typed,
                was.marks if was else None,
                part.marks,
                _explain_change(was, part),
            )


def _explain_change(was: GradedClassPart | None, now: GradedClassPart) -> str:
    """Return why a mark changed, in words for ``changes.csv``."""
    if was is not None and was.typed != now.typed:
        return "another answer came in"
    return now.by or (f"without {was.by}" if was and was.by else "marked anew")


def _format_cell(value: str | float | None) -> str:
    """Return a cell as text; empty for None."""
    if isinstance(value, str):
        return value
    return "" if value is None else f"{value:g}"
