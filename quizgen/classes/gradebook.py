"""The table of points and grades: for the office (CSV, XLSX), and to be posted by code."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from quizgen.classes.class_folder import PrintedHead
from quizgen.classes.grade_scale import GradeScale
from quizgen.classes.grading import StudentMarks
from quizgen.classes.roster import RosterStudent
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import escape_control_characters, format_csv

FOLDER = "results"
TABLE, BOOK, POSTED = "grades.csv", "grades.xlsx", "posted.csv"
Cell = str | float


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
        Empty if nothing came back.
    passed : bool
    """

    student: RosterStudent
    code: str
    marks: StudentMarks | None
    grade: str
    passed: bool

    @property
    def remark(self) -> str:
        """Return why the grade is not final; empty if it is."""
        if self.marks is None:
            return "no answers"
        return "provisional" if self.marks.undecided_count else ""


def grade_students(
    students: Iterable[RosterStudent],
    heads: Mapping[str, PrintedHead],
    marked: Mapping[str, StudentMarks],
    scale: GradeScale,
) -> list[GradedStudent]:
    """Return marks and grade of every student on the roster, in its order.

    ``heads`` and ``marked`` are by student id; who handed in nothing has no grade.
    """
    lines = []
    for student in students:
        marks = marked.get(student.id)
        grade = _compute_grade(marks, scale) if marks else ""
        code = heads[student.id].code if student.id in heads else ""
        lines.append(GradedStudent(student, code, marks, grade, scale.passes(grade)))
    return lines


def _compute_grade(marks: StudentMarks, scale: GradeScale) -> str:
    """Return the grade for a student's points."""
    return scale.grade(Fraction(marks.marks), Fraction(marks.points))


def write_grades(folder: Path, lines: Sequence[GradedStudent], scale: GradeScale) -> list[Path]:
    """Write the tables of grades as CSV, XLSX and by code; return the paths.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    lines : sequence of GradedStudent
    scale : GradeScale
    """
    items = _list_items(lines)
    rows = [_build_table_head(items), *(_build_grade_row(line, items, scale) for line in lines)]
    posted: list[list[Cell]] = [
        ["code", "points", "grade", "remark"],
        *_build_posted_rows(lines, scale),
    ]
    made = {
        POSTED: _encode_csv(posted),
        BOOK: _build_workbook(rows, scale),
        TABLE: _encode_csv(rows),
    }
    return write_all(folder / FOLDER, made, mode=PRIVATE)


def _list_items(lines: Iterable[GradedStudent]) -> list[str]:
    """Return the item names of all papers, in the order of the first paper that has each."""
    return list(dict.fromkeys(p.item for one in lines if one.marks for p in one.marks.parts))


def _build_table_head(items: list[str]) -> list[Cell]:
    """Return the column names of the table of grades."""
    return ["id", "name", "group", "code", "points", "of", "percent", "grade", "passed",
            "undecided", "remark", *items]  # fmt: skip


def _build_grade_row(line: GradedStudent, items: list[str], scale: GradeScale) -> list[Cell]:
    """Return a student's cells, in the order of the table's columns."""
    student, marks = line.student, line.marks
    who: list[Cell] = [student.id, student.name, student.group, line.code]
    if marks is None:
        return [*who, "", "", "", "", "", "", line.remark, *("" for _ in items)]
    counted = float(scale.round_points(Fraction(marks.marks)))
    percent = round(100 * counted / marks.points, 1) if marks.points else 0.0
    got = {part.item: part.marks for part in marks.parts}
    each: list[Cell] = ["" if (given := got.get(item)) is None else given for item in items]
    return [*who, counted, marks.points, percent, line.grade, "yes" if line.passed else "no",
            marks.undecided_count, line.remark, *each]  # fmt: skip


def _build_posted_rows(lines: Iterable[GradedStudent], scale: GradeScale) -> list[list[Cell]]:
    """Return code, points, grade and remark of each student, without names.

    Sorted by code: the order of the roster would tell neighbours whose line is whose.
    """
    rows: list[list[Cell]] = [
        [one.code, float(scale.round_points(Fraction(one.marks.marks))), one.grade, one.remark]
        for one in lines
        if one.marks
    ]
    return sorted(rows, key=lambda row: str(row[0]))


def _encode_csv(rows: Iterable[Sequence[Cell]]) -> bytes:
    """Return a table as CSV in UTF-8 with a byte order mark, by which spreadsheets detect it."""
    text = format_csv(map(_format_cell, row) for row in rows)
    return text.encode("utf-8-sig")


def _format_cell(cell: Cell) -> str:
    """Return a cell as text."""
    return cell if isinstance(cell, str) else f"{cell:g}"


def _build_workbook(rows: Sequence[Sequence[Cell]], scale: GradeScale) -> bytes:
    """Return the table and the scale as XLSX bytes.

    Text is written as text, whatever it begins with, so that no spreadsheet runs it as a formula.
    """
    import xlsxwriter

    out = io.BytesIO()
    with xlsxwriter.Workbook(out, {"in_memory": True}) as book:
        bold = book.add_format({"bold": True})
        table = book.add_worksheet("grades")
        table.freeze_panes(1, 2)
        table.autofilter(0, 0, len(rows) - 1, len(rows[0]) - 1)
        for at, row in enumerate(rows):
            for column, cell in enumerate(row):
                if isinstance(cell, str):
                    table.write_string(
                        at, column, escape_control_characters(cell), None if at else bold
                    )
                else:
                    table.write_number(at, column, cell)
        steps = book.add_worksheet("scale")
        for at, (grade, share) in enumerate([*scale.grade_bounds(), (scale.fail, Fraction(0))]):
            steps.write_string(at, 0, grade)
            steps.write_number(at, 1, float(100 * share))
    return out.getvalue()
