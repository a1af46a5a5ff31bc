"""The roster: who sits the exam, in the order in which they sit.

A table (CSV or XLSX) with a row per student. ``id`` is needed; ``name`` (or the names in two
columns), ``lang`` (a language or ``both``), ``extra`` (time: ``25%`` or ``30`` minutes), ``group``,
``seat`` and ``bonus`` may follow. Without seats, who stands in the row before sits in the seat
before. Groups do not see each other.
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
import re
import unicodedata
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import msgspec

from quizgen.core.errors import ClassError, FormulaError
from quizgen.core.spreadsheets import iter_spreadsheet_rows
from quizgen.core.untrusted import (
    escape_control_characters,
    escape_csv_formula,
    is_identifier,
    unescape_csv_formula,
)
from quizgen.locale import BOTH, list_language_choices
from quizgen.locale.custom import is_language_tag
from quizgen.maths.numbers import parse_written_number
from quizgen.paper.paper import ProgressCallback, silent

COLUMNS = ("id", "name", "lang", "extra", "group", "seat", "bonus")
FIRST_NAME, LAST_NAME = "first name", "last name"
ALSO_CALLED = {
    "id": ("matriculation", "matriculation number", "student number", "student id", "matrikel",
           "matrikelnr", "matrikel-nr", "matrikel-nr.", "matrikelnr.", "matrikelnummer", "mtknr",
           "matrnr", "matrnr.", "matr-nr", "matr.-nr.", "matr.-nr", "matr.nr.", "matr. nr.",
           "matriculation no.", "matriculation no", "student no."),
    "name": ("full name",),
    FIRST_NAME: ("firstname", "given name", "forename", "vorname"),
    LAST_NAME: ("lastname", "surname", "family name", "nachname", "familienname"),
    "lang": ("language", "sprache"),
    "extra": ("extra time", "extra_time", "zeitzuschlag"),
    "group": ("room", "gruppe", "raum", "hörsaal"),
    "seat": ("platz", "sitzplatz", "platznummer"),
    "bonus": ("bonus points", "bonuspunkte"),
}  # fmt: skip
"""Other names under which a column is known."""
JOIN = "+"
"""Between the names of two columns that are one of ours together."""
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
    bonus : str
        Points earned before the exam, as ``scale.toml`` counts them.
    """

    id: str
    name: str = ""
    lang: str = ""
    extra: str = ""
    group: str = ""
    seat: str = ""
    bonus: str = ""

    @property
    def bonus_points(self) -> Fraction:
        """Return the points earned before the exam; none where the roster says nothing."""
        return parse_written_number(self.bonus.replace(",", ".")) if self.bonus else Fraction(0)

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
        CSV or XLSX.
    columns : mapping of str to str, optional
        What each of ``COLUMNS`` is called in the file, where it is called otherwise: one name, or
        several with ``+`` between them.
    tell : callable, optional
        Told each column that is not read.

    Raises
    ------
    ClassError
        Naming the file and the line or the column.
    """
    rows = [*iter_spreadsheet_rows(path, ClassError)]
    if not rows:
        raise ClassError(f"{path}: is empty (a row of column names is needed, then one a student)")
    places = _find_columns(rows[0][1], columns or {}, path)
    for place, name in enumerate(map(clean_cell, rows[0][1])):
        if name and not any(place in own for own in places.values()):
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


def find_roster_column(name: str) -> str:
    """Return the column of a roster that a name means, in any language; empty if none."""
    folded = name.casefold()
    if folded in COLUMNS:
        return folded
    return next((ours for ours, names in ALSO_CALLED.items() if folded in (ours, *names)), "")


def _find_columns(
    head: Sequence[str], columns: Mapping[str, str], path: Path
) -> dict[str, tuple[int, ...]]:
    """Return the indices of each roster column that the file has: two where names stand apart.

    ``columns`` gives the file's name of a column where it differs from ours.
    """
    there = {clean_cell(cell).casefold(): place for place, cell in reversed([*enumerate(head)])}
    said = ", ".join(escape_control_characters(clean_cell(cell)) for cell in head)
    found: dict[str, tuple[int, ...]] = {}
    for ours, theirs in columns.items():
        if ours not in COLUMNS:
            raise ClassError(f"no column {ours!r} of a roster (there are {', '.join(COLUMNS)})")
        whole = clean_cell(theirs).casefold()
        names = [whole] if whole in there else [clean_cell(one) for one in whole.split(JOIN)]
        if missing := [one for one in names if one not in there]:
            shown = theirs if len(names) == 1 else missing[0]
            raise ClassError(f"{path}: has no column {shown!r} (it has {said})")
        found[ours] = tuple(there[one] for one in names)
    used = {place for own in found.values() for place in own}
    for name, place in there.items():
        ours = find_roster_column(name)
        if ours and ours not in columns and place not in used:
            before = found.get(ours)
            found[ours] = before if before and name != ours else (place,)
    if "id" not in found:
        raise ClassError(
            f"{path}: has no column 'id' (it has {said}); name the one that is: --columns id=NAME"
        )
    return _join_names(found, columns)


def _join_names(
    found: dict[str, tuple[int, ...]], columns: Mapping[str, str]
) -> dict[str, tuple[int, ...]]:
    """Return the columns with a first name before the last name, where they stand apart."""
    first, last = found.pop(FIRST_NAME, ()), found.pop(LAST_NAME, ())
    if "name" in columns:
        return found
    whole = first + (last or found.get("name", ()) if first else last)
    return {**found, "name": whole} if whole and (first or "name" not in found) else found


def _parse_student(
    row: Sequence[str], places: Mapping[str, tuple[int, ...]], where: str
) -> RosterStudent:
    """Return the student of a row; ``ClassError`` located by ``where`` if a cell is wrong."""
    cells = {
        name: " ".join(
            filter(None, (unescape_csv_formula(clean_cell(row[p])) for p in own if p < len(row)))
        )
        for name, own in places.items()
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
    try:
        if one.bonus_points < 0:
            raise ClassError(f"{where}: bonus {one.bonus!r} is less than 0")
    except FormulaError:
        raise ClassError(f"{where}: bonus {one.bonus!r} (points are a number)") from None
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
