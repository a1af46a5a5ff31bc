"""The folder ``scans`` of a class: what was read of each page, what people said, what follows.

A line of ``pages.jsonl`` is written once its pictures are on the disk, so that a run that is killed
goes on where it was. All else follows from these lines and ``typed.csv``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import msgspec

from quizgen.classes.class_folder import ANSWERS, KEYS, ClassFolder, PrintedHead
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.part_names import PartNames
from quizgen.classes.rulings import read_filled_rows
from quizgen.classes.scanning.pages import (
    FOREIGN,
    NO_CODE,
    PAGE,
    UNREADABLE,
    PageReading,
    PartReading,
    ReadPicture,
    read_assigned_picture,
    read_student_sheet,
)
from quizgen.core.decoding import json_decoder
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, open_private, write_all
from quizgen.core.untrusted import format_csv
from quizgen.grading.echo import safe_echo

SCANS, PAGES, TYPED, REPORT = "scans", "pages.jsonl", "typed.csv", "report.json"
STRAYS = "strays"
ANSWER_FILE = "scan.csv"
"""What was read, among the answers of the class."""
ON_PAPER = "see paper"
"""Stands for an answer that nobody has read: it has no marks until somebody decides."""
NO_FIELD, NOT_SCANNED, DIFFERS = "no_field", "missing", "differs"
COLUMNS = ("id", "part", "answer")
LOGGED = (*COLUMNS, "who", "when")
_LINE = json_decoder(PageReading).decode
_PAGE_ROW = re.compile(rf"{PAGE}\s*(\d{{1,3}})?")
_PART = re.compile(r"\d{1,3}[a-z]{0,2}")


class _ReportPart(msgspec.Struct):
    """What ``report.json`` says of a part."""

    answer: str | None
    why: str = ""
    proposal: str = ""


class _ReportSheet(msgspec.Struct):
    """What ``report.json`` says of a student."""

    parts: dict[str, _ReportPart]


class _Report(msgspec.Struct):
    """What ``report.json`` says."""

    students: dict[str, _ReportSheet] = {}


_REPORT = json_decoder(_Report).decode


class ReadPart(NamedTuple):
    """What is known of a part of a student.

    Parameters
    ----------
    reading : PartReading
        Its answer is None while a person is asked.
    crop : str
        Its picture below ``scans``; empty if there is none.
    typed : bool
        Whether a person said it.
    """

    reading: PartReading
    crop: str = ""
    typed: bool = False


@dataclass(frozen=True)
class ReadSheet:
    """What came back of a student.

    Parameters
    ----------
    student : str
    paper : str
        The code of the paper, and its folder below ``scans``.
    parts : mapping of str to ReadPart
        All parts of the paper, in its order.
    missing : tuple of int
        Pages that did not come.
    twice : tuple of int
        Pages of which there are several pictures.
    pictures : tuple of str
        Of whole pages, below ``scans``.
    faults : mapping of int to str
        Why all of a page is asked, by the page.
    """

    student: str
    paper: str
    parts: Mapping[str, ReadPart]
    missing: tuple[int, ...] = ()
    twice: tuple[int, ...] = ()
    pictures: tuple[str, ...] = ()
    faults: Mapping[int, str] = field(default_factory=dict)

    @property
    def open_parts(self) -> dict[str, ReadPart]:
        """Return the parts that a person is asked about."""
        return {name: one for name, one in self.parts.items() if one.reading.answer is None}


class ScanFolder:
    """Reads and writes what was read of the answer sheets of a class.

    Parameters
    ----------
    folder : ClassFolder
    """

    def __init__(self, folder: ClassFolder) -> None:
        self.folder, self.path = folder, folder.path / SCANS
        self._copies: dict[tuple[str, int], int] = {}

    def iter_pages(self) -> Iterator[PageReading]:
        """Yield what was read of each picture: of one that was assigned, what was said last."""
        found = [*self._iter_lines()]
        since = {(one.digest, one.number): place for place, one in enumerate(found) if one.assigned}
        for place, one in enumerate(found):
            if place >= since.get((one.digest, one.number), 0):
                yield one

    def _iter_lines(self) -> Iterator[PageReading]:
        """Yield all lines of pages; one that was left half written is not there."""
        path = self.path / PAGES
        if path.exists():
            with path.open("rb") as stream:
                for number, line in enumerate(stream, 1):
                    if line.endswith(b"\n"):
                        try:
                            yield _LINE(line)
                        except msgspec.DecodeError as error:
                            raise ClassError(
                                f"{path}: line {number}: {error}", rule="QG612"
                            ) from None

    def find_done(self) -> dict[str, set[int]]:
        """Return the pictures that have been read, from 0, by the digest of their file."""
        found: dict[str, set[int]] = {}
        self._copies.clear()
        for one in self.iter_pages():
            found.setdefault(one.digest, set()).add(one.number - 1)
            self._count_copy(one)
        return found

    def _count_copy(self, one: PageReading) -> int:
        """Return which picture of its page this is, from 1: a sound one takes a bad one's place."""
        whose = one.student, one.page
        copy = self._copies.get(whose, 0) + 1
        if one.student and not one.fault:
            self._copies[whose] = copy
        return copy

    def add_pages(self, read: Sequence[ReadPicture]) -> list[PageReading]:
        """Keep the pictures of what was read, then a line for each; return the lines."""
        kept: list[PageReading] = []
        files: dict[str, bytes] = {}
        for reading, pictures in read:
            made = msgspec.structs.replace(reading, copy=self._count_copy(reading))
            kept.append(made)
            files |= {name_picture(made, part): data for part, data in pictures.items()}
        self.path.mkdir(mode=0o700, exist_ok=True)
        _write_pictures(self.path, files)
        path = self.path / PAGES
        _cut_torn_line(path)
        with open_private(path) as stream:
            stream.write(b"".join(msgspec.json.encode(one) + b"\n" for one in kept))
            stream.flush()
            os.fsync(stream.fileno())
        return kept

    def assign_picture(self, picture: str, student: str, page: int) -> None:
        """Read a picture that was kept as a page of a student; of nobody with an empty id.

        What was said of it before stays among the lines of pages.

        Raises
        ------
        ClassError
            If no picture without a code has the name, or the student's paper no such page.
        """
        now = next((one for one in self.iter_pages() if name_stray(one) == picture
                    and (one.fault == NO_CODE or one.assigned)), None)  # fmt: skip
        if now is None:
            said = f"there is no picture {safe_echo(picture)} without a code"
            raise ClassError(said, rule="QG613")
        if (now.student, now.page) == (student, page):
            return
        when = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        base = PageReading(now.file, now.digest, now.number, assigned=when)
        made = ReadPicture(msgspec.structs.replace(base, fault=NO_CODE), {})
        if student:
            head, at = self.folder.places()[student]
            pages = read_student_sheet(self.folder.path / KEYS, at).places.pages
            if not 1 <= page <= pages:
                said = f"the paper of {safe_echo(student)} has {pages} pages, and no page {page}"
                raise ClassError(said, rule="QG613")
            base = msgspec.structs.replace(base, student=student, paper=head.code, page=page)
            made = read_assigned_picture(self.folder, base, self.path / STRAYS / f"{picture}.jpg")
        if now.student:
            for part in (PAGE, *now.parts):
                (self.path / name_picture(now, part)).unlink(missing_ok=True)
        self.find_done()  # counts copies anew
        self.add_pages([made])

    def list_assigned(self) -> list[PageReading]:
        """Return the pictures of which a person said whose page they are."""
        return [one for one in self.iter_pages() if one.assigned and one.student]

    def add_typed(self, rows: Iterable[tuple[str, str, str]], who: str = "") -> int:
        """Add what people typed to ``typed.csv``, whose last row of a part counts.

        Nothing is taken out of it. Return how many answers are new.
        """
        path, now = self.path / TYPED, datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        before = [cells for _, cells in read_filled_rows(path, {*COLUMNS})]
        known, fresh = self.read_typed(), list[tuple[str, ...]]()
        for row in rows:
            if known.get(row[:2]) != row[2]:
                known[row[:2]] = row[2]
                fresh.append((*row, who, now))
        if fresh:
            kept = [[cells.get(name, "") for name in LOGGED] for cells in before]
            text = format_csv([LOGGED, *kept, *fresh])
            write_all(self.path, {TYPED: text.encode("utf-8-sig")}, PRIVATE)
        return len(fresh)

    def take_typed(self, row: tuple[str, str, str], who: str) -> None:
        """Add what somebody typed for a part, and put it among the answers of the class."""
        self.add_typed([row], who)
        path = self.folder.path / ANSWERS / ANSWER_FILE
        answers = {
            (cells["id"], cells["part"]): cells["answer"]
            for _, cells in read_filled_rows(path, {*COLUMNS})
        }
        answers[row[:2]] = row[2]
        made = format_csv([COLUMNS, *((*key, answer) for key, answer in answers.items())])
        write_all(path.parent, {path.name: made.encode("utf-8-sig")}, PRIVATE)

    def read_typed(self) -> dict[tuple[str, str], str]:
        """Return what people typed, by student and part."""
        rows = read_filled_rows(self.path / TYPED, {*COLUMNS})
        return {(cells["id"], cells["part"]): cells["answer"] for _, cells in rows}

    def join_sheets(self) -> list[ReadSheet]:
        """Return what came back of each student, in the order in which papers were made."""
        found: dict[str, list[PageReading]] = {}
        for one in self.iter_pages():
            if one.student:
                found.setdefault(one.student, []).append(one)
        typed = self.read_typed()
        keys = self.folder.path / KEYS
        sheets = []
        for student, (_, at) in self.folder.places().items():
            if student in found:
                whole = read_student_sheet(keys, at)
                sheets.append(_join_pages(student, found[student], whole.places.pages, whole.kinds,
                                          typed))  # fmt: skip
        return sheets

    def count_boxes(self) -> tuple[int, int]:
        """Return the boxes on all pages, each page counted once, and how many were not read."""
        best: dict[tuple[str, int], PageReading] = {}
        for one in self.iter_pages():
            whose = one.student, one.page
            if whose not in best or (best[whose].fault and not one.fault):
                best[whose] = one
        return sum(one.boxes for one in best.values()), sum(one.doubtful for one in best.values())

    def list_strays(self) -> list[PageReading]:
        """Return pictures that are of no sheet and not empty."""
        odd = {FOREIGN, NO_CODE, UNREADABLE}
        return [one for one in self.iter_pages() if one.fault in odd]

    def write_results(self, sheets: Sequence[ReadSheet]) -> Path:
        """Write the answers that are known as a hand-in of the class, and the report as JSON.

        What nobody has read is ``ON_PAPER`` there: it is neither right nor wrong.
        """
        rows = [
            (sheet.student, name, ON_PAPER if one.reading.answer is None else one.reading.answer)
            for sheet in sheets
            for name, one in sheet.parts.items()
        ]
        report = {"version": 1, "students": {one.student: _describe_sheet(one) for one in sheets}}
        write_all(self.path, {REPORT: msgspec.json.format(msgspec.json.encode(report))}, PRIVATE)
        made = {ANSWER_FILE: format_csv([COLUMNS, *rows]).encode("utf-8-sig")}
        return write_all(self.folder.path / ANSWERS, made, PRIVATE)[0]


def _cut_torn_line(path: Path) -> None:
    """Take away what a run that was killed left of a last line."""
    if not path.exists():
        return
    with path.open("r+b") as stream:
        end = stream.seek(0, os.SEEK_END)
        while end:
            stream.seek(end - 1)
            if stream.read(1) == b"\n":
                break
            end -= 1
        stream.truncate(end)


def name_picture(one: PageReading, part: str) -> str:
    """Return the file below ``scans`` that has the picture of a part, or of the page."""
    if not one.student:
        return f"{STRAYS}/{name_stray(one)}.jpg"
    stem = f"{PAGE}-{one.page}" if part == PAGE else part
    more = f"-{one.copy}" if one.copy > 1 else ""
    return f"{one.paper}/{stem}{more}{'.jpg' if part == PAGE else '.png'}"


def name_stray(one: PageReading) -> str:
    """Return what a picture is called while it is of no sheet."""
    return f"{one.digest}-{one.number}"


def find_page_pictures(folder: ClassFolder, head: PrintedHead) -> list[Path]:
    """Return the pictures of the scanned pages of a student's sheet, with what was read."""
    found = (folder.path / SCANS / head.code).glob(f"{PAGE}-*.jpg")
    return sorted(found, key=lambda path: [int(one) for one in path.stem.split("-")[1:]])


def find_crop(folder: Path, head: PrintedHead, part: str) -> Path | None:
    """Return the picture of a part of a student's paper; None if there is none.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    head : PrintedHead
        Of the paper.
    part : str
        As it is printed, such as ``7a``. Nothing outside the folder of scans is ever returned.
    """
    scans = (folder / SCANS).resolve()
    for paper in head.codes if _PART.fullmatch(part) else ():
        path = (scans / paper / f"{part}.png").resolve()
        if path.is_relative_to(scans) and path.is_file():
            return path
    return None


def read_proposals(folder: Path) -> dict[tuple[str, str], str]:
    """Return what may stand on pictures that nobody has read, by student and part.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.

    Raises
    ------
    ClassError
        If the report of what was read is damaged.
    """
    path = folder / SCANS / REPORT
    if not path.exists():
        return {}
    try:
        found = _REPORT(path.read_bytes())
    except msgspec.DecodeError as error:
        raise ClassError(f"{path}: {error}", rule="QG612") from None
    return {
        (student, part): one.proposal
        for student, sheet in found.students.items()
        for part, one in sheet.parts.items()
        if one.answer is None and one.why != DIFFERS and one.proposal
    }


def _write_pictures(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write pictures; they are on the disk before the line that names them is."""
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(mode=0o700, exist_ok=True)
        with open_private(path, truncate=True) as stream:
            stream.write(data)


def _join_pages(
    student: str,
    pages: Sequence[PageReading],
    count: int,
    kinds: Mapping[str, str],
    typed: Mapping[tuple[str, str], str],
) -> ReadSheet:
    """Return what the pictures of a student's pages say together, and what people typed."""
    known = {one.page for one in pages}
    missing = tuple(page for page in range(1, count + 1) if page not in known)
    parts = {}
    for part in kinds:
        found = _join_readings(part, pages, missing)
        if (student, part) in typed:
            told = msgspec.structs.replace(found.reading, answer=typed[student, part], why="")
            found = ReadPart(told, found.crop, typed=True)
        parts[part] = found
    sound = {one.page for one in pages if not one.fault}
    return ReadSheet(
        student,
        pages[0].paper,
        parts,
        missing,
        tuple(sorted({one.page for one in pages if one.copy > 1})),
        tuple(sorted({name_picture(one, PAGE) for one in pages})),
        {one.page: one.fault for one in pages if one.page not in sound},
    )


def _join_readings(part: str, pages: Sequence[PageReading], missing: Sequence[int]) -> ReadPart:
    """Return what the pictures of a page say of a part: what is certain, unless two differ."""
    seen = [(one, one.parts[part]) for one in pages if part in one.parts]
    if not seen:
        why = NOT_SCANNED if missing else NO_FIELD
        return ReadPart(PartReading(None, 0.0, 0, (0.0, 0.0, 0.0, 0.0), why))
    certain = {one.answer for _, one in seen if one.answer is not None}
    page, best = next((pair for pair in seen if pair[1].answer is not None), seen[0])
    if len(certain) == 1:
        return ReadPart(best, name_picture(page, PAGE))
    if certain:
        said = " / ".join(sorted(map(str, certain)))
        best = msgspec.structs.replace(best, answer=None, why=DIFFERS, proposal=said)
        return ReadPart(best, name_picture(page, PAGE))
    sharp = next((pair for pair in seen if pair[0].fault == ""), seen[0])
    return ReadPart(sharp[1], name_picture(sharp[0], part))


def _describe_sheet(sheet: ReadSheet) -> dict[str, object]:
    """Return a student's sheet as plain values for ``report.json``."""
    parts = {
        name: msgspec.to_builtins(one.reading)
        | {"crop": one.crop, "typed": one.typed, "answer": one.reading.answer}
        for name, one in sheet.parts.items()
    }
    return {
        "folder": sheet.paper,
        "pages": list(sheet.pictures),
        "missing": list(sheet.missing),
        "twice": list(sheet.twice),
        "faults": {str(page): fault for page, fault in sheet.faults.items()},
        "parts": parts,
    }


def read_typed_rows(path: Path, keys: KeyIndex) -> list[tuple[str, str, str]]:
    """Return what a person typed beside the pictures: rows of student, part and answer.

    A part that begins with ``page`` assigns a picture, which the answer names, to that page; to
    nobody where no student is named.

    Raises
    ------
    ClassError
        Naming the line, if nobody has the number or the paper has no such part.
    """
    if not path.exists():
        raise ClassError("there is no such file", rule="QG612", file=path)
    rows = []
    for line, cells in read_filled_rows(path, {*COLUMNS}):
        page = _PAGE_ROW.fullmatch(cells["part"].strip().lower())
        try:
            student = "" if page and not cells["id"].strip() else keys.find_student(cells["id"])
        except ClassError as error:
            raise ClassError(error.message, rule="QG612", file=path, line=line) from None
        if page:
            rows.append((student, f"{PAGE} {page[1] or 0}", cells["answer"].strip()))
            continue
        part = PartNames(keys.outline(student).items).find(cells["part"])
        if not part:
            said = f"the paper of {safe_echo(student)} has no part {safe_echo(cells['part'])}"
            raise ClassError(said, rule="QG612", file=path, line=line)
        rows.append((student, part, cells["answer"].strip()))
    return rows
