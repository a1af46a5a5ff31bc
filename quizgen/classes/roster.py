"""The roster: who sits the exam, in the order in which they sit.

A CSV file with a row per student. ``id`` is needed; ``name``, ``lang`` (a language or ``both``),
``extra`` (time: ``25%`` or ``30`` minutes), ``group`` and ``seat`` may follow. Without seats, who
stands in the row before sits in the seat before. Groups do not see each other.
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
import re
import unicodedata
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import msgspec

from quizgen.core.errors import ClassError
from quizgen.core.untrusted import (
    escape_control_characters,
    escape_csv_formula,
    is_identifier,
    parse_csv,
    read_text,
    unescape_csv_formula,
)
from quizgen.locale import BOTH, list_language_choices
from quizgen.locale.custom import is_language_tag
from quizgen.paper.paper import ProgressCallback, silent

COLUMNS = ("id", "name", "lang", "extra", "group", "seat")
ALSO_CALLED = {"lang": ("language",), "extra": ("extra time", "extra_time")}
"""Other names under which a column is known."""
LONGEST = 200
"""Characters of a cell."""
LONGEST_FILE = 60
_EXTRA = re.compile(r"(\d{1,3}) ?(%|min)?")
_JOINERS = "\u200c\u200d"
_DEVICES = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
"""Names that Windows gives to devices."""


class RosterStudent(msgspec.Struct, frozen=True):
    """A student: one row of the roster.

    Parameters
    ----------
    id : str
        As the office writes it; unique whatever the case of its letters.
    name : str
    lang : str
        A language, ``both``, or empty for that of the class.
    extra : str
        More time: ``25%``, or minutes.
    group : str
        A room or a sitting: only within it are there neighbours.
    seat : str
    """

    id: str
    name: str = ""
    lang: str = ""
    extra: str = ""
    group: str = ""
    seat: str = ""

    @property
    def file(self) -> str:
        """Return a file name for the student, safe on any system and unique in the class."""
        if (
            is_identifier(self.id)
            and self.id[0] not in ".-"
            and self.id[-1] != "."
            and self._is_safe_file_name
        ):
            return self.id
        kept = re.sub(r"[^A-Za-z0-9_]+", "-", self.id)[:LONGEST_FILE].strip("-") or "student"
        return f"{kept}-{hashlib.sha256(self.id.encode()).hexdigest()[:8]}"

    @property
    def _is_safe_file_name(self) -> bool:
        """Return whether the id is short enough and no device name of Windows."""
        return len(self.id) <= LONGEST_FILE and not _DEVICES.fullmatch(self.id)

    def extra_minutes(self, minutes: int) -> int:
        """Return the student's extra time in minutes for a paper of so many minutes."""
        found = _EXTRA.fullmatch(self.extra)
        if found is None:
            return 0
        count = int(found[1])
        return math.ceil(minutes * count / 100) if found[2] == "%" else count


def read_roster(
    path: Path,
    columns: Mapping[str, str] | None = None,
    tell: ProgressCallback = silent,
) -> list[RosterStudent]:
    """Return the students of a roster file, in the order of their seats.

    Parameters
    ----------
    path : pathlib.Path
        A CSV file.
    columns : mapping of str to str, optional
        What each of ``COLUMNS`` is called in the file, where it is called otherwise.
    tell : callable, optional
        Told each column that is not read.

    Raises
    ------
    ClassError
        Naming the file and the line or the column.
    """
    rows = parse_csv(read_text(path, ClassError), path, ClassError)
    if not rows:
        raise ClassError(f"{path}: is empty (a row of column names is needed, then one a student)")
    places = _find_columns(rows[0][1], columns or {}, path)
    for place, name in enumerate(map(clean_cell, rows[0][1])):
        if name and place not in places.values():
            tell(escape_control_characters(name))
    found: dict[str, tuple[int, RosterStudent]] = {}
    for line, row in rows[1:]:
        one = _parse_student(row, places, f"{path}: line {line}")
        before = found.setdefault(one.id.casefold(), (line, one))
        if before[0] != line:
            raise ClassError(f"{path}: lines {before[0]} and {line} have the same id {one.id!r}")
    if not found:
        raise ClassError(f"{path}: has no students")
    return sorted((one for _, one in found.values()), key=_make_seating_key)


def _find_columns(head: Sequence[str], columns: Mapping[str, str], path: Path) -> dict[str, int]:
    """Return the index of each roster column that the file has.

    ``columns`` gives the file's name of a column where it differs from ours.
    """
    there = {clean_cell(cell).casefold(): place for place, cell in reversed([*enumerate(head)])}
    said = ", ".join(escape_control_characters(clean_cell(cell)) for cell in head)
    for ours, theirs in columns.items():
        if ours not in COLUMNS:
            raise ClassError(f"no column {ours!r} of a roster (there are {', '.join(COLUMNS)})")
        if clean_cell(theirs).casefold() not in there:
            raise ClassError(f"{path}: has no column {theirs!r} (it has {said})")
    names = {
        ours: [clean_cell(columns[ours]).casefold()]
        if ours in columns
        else _list_column_names(ours)
        for ours in COLUMNS
    }
    found = {
        ours: next((there[one] for one in theirs if one in there), None)
        for ours, theirs in names.items()
    }
    if found["id"] is None:
        raise ClassError(
            f"{path}: has no column 'id' (it has {said}); name the one that is: --columns id=NAME"
        )
    return {ours: place for ours, place in found.items() if place is not None}


def _list_column_names(column: str) -> list[str]:
    """Return the names that a column may have in a file."""
    return [column, *ALSO_CALLED.get(column, ())]


def _parse_student(row: Sequence[str], places: Mapping[str, int], where: str) -> RosterStudent:
    """Return the student of a row; ``ClassError`` located by ``where`` if a cell is wrong."""
    cells = {
        name: unescape_csv_formula(clean_cell(row[place])) if place < len(row) else ""
        for name, place in places.items()
    }
    for name, cell in cells.items():
        if len(cell) > LONGEST:
            raise ClassError(f"{where}: {name} is longer than {LONGEST} characters")
    one = RosterStudent(**cells)
    if not one.id:
        raise ClassError(f"{where}: has no id")
    if one.lang and one.lang != BOTH and not is_language_tag(one.lang):
        known = ", ".join(list_language_choices())
        raise ClassError(f"{where}: lang {one.lang!r} (allowed: {known}, or another of the bank)")
    if one.extra and not _EXTRA.fullmatch(one.extra):
        raise ClassError(f"{where}: extra {one.extra!r} (allowed: such as 25%, or 30 for minutes)")
    return one


def clean_cell(cell: str) -> str:
    """Return a cell on one line, without invisible characters.

    Such as those that reverse the direction of writing and could disguise a name.
    """
    whole = unicodedata.normalize("NFC", cell)
    seen = (c if _is_visible(c) else " " if c.isspace() else "" for c in whole)
    return " ".join("".join(seen).split())


def _is_visible(character: str) -> bool:
    """Return whether a character is visible, or joins letters."""
    return character in _JOINERS or unicodedata.category(character) not in {"Cc", "Cf", "Cs", "Co"}


def _make_seating_key(one: RosterStudent) -> tuple[str, list[tuple[int, str]]]:
    """Return a sort key: by group, then by seat with numbers in their order (9 before 10)."""
    pieces = re.findall(r"\d+|\D+", one.seat)
    return one.group, [(int(p), "") if p.isdecimal() else (0, p.casefold()) for p in pieces]


def seat_neighbours(students: Sequence[RosterStudent]) -> dict[str, list[str]]:
    """Return for each student's id the ids in the adjacent seats of the same group."""
    found: dict[str, list[str]] = {one.id: [] for one in students}
    for left, right in pairwise(students):
        if left.group == right.group:
            found[left.id].append(right.id)
            found[right.id].append(left.id)
    return found


def write_roster(students: Sequence[RosterStudent]) -> bytes:
    """Return the roster as CSV bytes that ``read_roster`` and any spreadsheet can read."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(
        [escape_csv_formula(getattr(one, name)) for name in COLUMNS] for one in students
    )
    return out.getvalue().encode("utf-8-sig")
