"""The table of points and grades: for the office (CSV, XLSX), and to be posted by code."""

from __future__ import annotations

import io
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from quizgen.classes.class_folder import PrintedHead
from quizgen.classes.grade_scale import GradeScale
from quizgen.classes.grading import StudentMarks
from quizgen.classes.roster import RosterStudent
from quizgen.classes.statuses import ABSENT, DECEPTION, PRESENT
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import escape_control_characters, format_csv

FOLDER = "results"
KEY_CHANGED, RIVALS, UNREAD = "key changed", "answers differ", "maybe in what was not marked"
"""Why a grade waits: somebody edited the key, did not say which answers count, or left answers
that could not be marked, among which may be those of a student of whom nothing else came."""
TABLE, BOOK, POSTED = "grades.csv", "grades.xlsx", "posted.csv"
TEXT = 49
"""Number of the format in which spreadsheets leave a cell as it was typed."""
Cell = str | float


@dataclass(frozen=True)
class GradeBasis:
    """All that grades follow from, each by student id.

    Parameters
    ----------
    heads : mapping of str to PrintedHead
    marked : mapping of str to StudentMarks
    scale : GradeScale
    statuses : mapping of str to str
        What somebody said of those of whom anything was said.
    changed : collection of str
        Whose key was edited since the paper was made.
    rivals : collection of str
        Whose answers came twice and differ.
    unread : bool
        Whether something that came back could not be marked.
    """

    heads: Mapping[str, PrintedHead]
    marked: Mapping[str, StudentMarks]
    scale: GradeScale
    statuses: Mapping[str, str] = field(default_factory=dict)
    changed: Collection[str] = ()
    rivals: Collection[str] = ()
    unread: bool = False


@dataclass(frozen=True)
class GradedStudent:
    """A student of the roster with marks and grade: one line of the table.

    Parameters
    ----------
    student : RosterStudent
    code : str
        That of the paper, which only this student and the examiner know.
    marks : StudentMarks or None
        None if nothing came back.
    grade : str
        Empty if there is none, or none yet.
    passed : bool
    status : str
        One of ``statuses.STATUSES``: ``absent`` if nothing came back and nobody said otherwise.
    bonus : Fraction
        Points earned before the exam, as far as they count.
    held : str
        What has to be seen to before there is a grade; empty if nothing.
    """

    student: RosterStudent
    code: str
    marks: StudentMarks | None
    grade: str
    passed: bool
    status: str = PRESENT
    bonus: Fraction = Fraction(0)
    held: str = ""

    @property
    def is_final(self) -> bool:
        """Whether nothing can change the grade any more, as far as anybody knows."""
        return not self.held and not (self.marks and self.marks.undecided_count and self.grade)

    @property
    def remark(self) -> str:
        """Return why the grade is not final, or why there is none; empty if all is well."""
        if self.held:
            return self.held
        if self.status not in {PRESENT, ABSENT} or (self.status == ABSENT and self.marks):
            return self.status
        if self.marks is None:
            return "blank" if self.status == PRESENT else "no answers"
        return "" if self.is_final else "provisional"


def grade_students(students: Iterable[RosterStudent], basis: GradeBasis) -> list[GradedStudent]:
    """Return marks and grade of every student on the roster, in its order.

    Who handed in nothing has no grade, nor has who is said to be absent, sick or withdrawn, nor
    anybody whose key was edited; who deceived has the one that fails.
    """
    return [_grade_student(student, basis) for student in students]


def _grade_student(student: RosterStudent, basis: GradeBasis) -> GradedStudent:
    """Return a student with marks and grade."""
    scale, marks = basis.scale, basis.marked.get(student.id)
    status = basis.statuses.get(student.id) or (PRESENT if marks else ABSENT)
    held = KEY_CHANGED if student.id in basis.changed else ""
    held = held or (RIVALS if student.id in basis.rivals else "")
    if basis.unread and not marks and student.id not in basis.statuses:
        held = held or UNREAD
    grade, bonus = "", Fraction(0)
    if status == DECEPTION or (status == PRESENT and not marks):  # deceived, or blank paper
        grade = scale.fail
    elif marks and status == PRESENT and held != KEY_CHANGED:
        reached = Fraction(marks.marks), Fraction(marks.points)
        bonus = scale.count_bonus(student.bonus_points, *reached)
        grade = scale.grade(reached[0] + bonus, reached[1])
    code = basis.heads[student.id].code if student.id in basis.heads else ""
    return GradedStudent(student, code, marks, grade, scale.passes(grade), status, bonus, held)


def write_grades(
    folder: Path,
    lines: Sequence[GradedStudent],
    scale: GradeScale,
    more: Mapping[str, bytes] | None = None,
) -> list[Path]:
    """Write the tables of grades as CSV, XLSX and by code; return the paths.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    lines : sequence of GradedStudent
    scale : GradeScale
    more : mapping of str to bytes, optional
        Other files that belong to the same grades.
    """
    items = _list_items(lines)
    rows = [_build_table_head(items), *(_build_grade_row(line, items, scale) for line in lines)]
    posted: list[list[Cell]] = [
        ["code", "points", "grade", "remark"],
        *_build_posted_rows(lines, scale),
    ]
    bounds: list[list[Cell]] = [
        [grade, float(100 * share)]
        for grade, share in [*scale.grade_bounds(), (scale.fail, Fraction(0))]
    ]
    made = {
        **(more or {}),
        POSTED: _encode_csv(posted),
        BOOK: build_workbook({"grades": rows, "scale": bounds}),
        TABLE: _encode_csv(rows),
    }
    return write_all(folder / FOLDER, made, mode=PRIVATE)


def _list_items(lines: Iterable[GradedStudent]) -> list[str]:
    """Return the item names of all papers, in the order of the first paper that has each."""
    return list(dict.fromkeys(p.item for one in lines if one.marks for p in one.marks.parts))


def _build_table_head(items: list[str]) -> list[Cell]:
    """Return the column names of the table of grades."""
    return ["id", "name", "group", "code", "points", "of", "bonus", "percent", "grade", "passed",
            "status", "filled", "undecided", "remark", *items]  # fmt: skip


def _build_grade_row(line: GradedStudent, items: list[str], scale: GradeScale) -> list[Cell]:
    """Return a student's cells, in the order of the table's columns."""
    student, marks = line.student, line.marks
    who: list[Cell] = [student.id, student.name, student.group, line.code]
    passed = ("yes" if line.passed else "no") if line.grade else ""
    if marks is None:
        return [*who, "", "", "", "", line.grade, passed, line.status, "", "", line.remark,
                *("" for _ in items)]  # fmt: skip
    counted = float(scale.round_points(Fraction(marks.marks)))
    bonus = float(line.bonus)
    percent = round(100 * (counted + bonus) / marks.points, 1) if marks.points else 0.0
    got = {part.item: part.marks for part in marks.parts}
    each: list[Cell] = ["" if (given := got.get(item)) is None else given for item in items]
    return [*who, counted, marks.points, bonus, percent, line.grade, passed, line.status,
            marks.filled_count, marks.undecided_count, line.remark, *each]  # fmt: skip


def _build_posted_rows(lines: Iterable[GradedStudent], scale: GradeScale) -> list[list[Cell]]:
    """Return code, points, grade and remark of each student who has a grade, without names.

    Sorted by code: the order of the roster would tell neighbours whose line is whose.
    """
    rows: list[list[Cell]] = [
        [one.code, float(scale.round_points(Fraction(one.marks.marks))), one.grade, one.remark]
        for one in lines
        if one.marks and one.status == PRESENT and one.grade
    ]
    return sorted(rows, key=lambda row: str(row[0]))


def _encode_csv(rows: Iterable[Sequence[Cell]]) -> bytes:
    """Return a table as CSV in UTF-8 with a byte order mark, by which spreadsheets detect it."""
    text = format_csv(map(_format_cell, row) for row in rows)
    return text.encode("utf-8-sig")


def _format_cell(cell: Cell) -> str:
    """Return a cell as text."""
    return cell if isinstance(cell, str) else f"{cell:g}"


def build_workbook(sheets: Mapping[str, Sequence[Sequence[Cell]]]) -> bytes:
    """Return tables as XLSX bytes, a sheet for each, the first with its head in view.

    Text is written as text, whatever it begins with, so that no spreadsheet runs it as a formula
    or takes a grade for a date.
    """
    import xlsxwriter

    out = io.BytesIO()
    with xlsxwriter.Workbook(out, {"in_memory": True}) as book:
        bold, text = book.add_format({"bold": True}), book.add_format({"num_format": TEXT})
        for name, rows in sheets.items():
            table = book.add_worksheet(name)
            if name == next(iter(sheets)):
                table.freeze_panes(1, 2)
                table.autofilter(0, 0, len(rows) - 1, len(rows[0]) - 1)
            for at, row in enumerate(rows):
                for column, cell in enumerate(row):
                    if isinstance(cell, str):
                        shown = escape_control_characters(cell)
                        table.write_string(at, column, shown, text if at else bold)
                    else:
                        table.write_number(at, column, cell)
    return out.getvalue()
