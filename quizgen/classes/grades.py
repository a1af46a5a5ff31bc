"""The table of points and grades: for the office (CSV, XLSX), and to be posted by code."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from quizgen.classes.folder import Head
from quizgen.classes.mark import Marks
from quizgen.classes.roster import Student
from quizgen.classes.scale import Scale
from quizgen.files import PRIVATE, write_all
from quizgen.outside import csv_text, visible

FOLDER = "results"
TABLE, BOOK, POSTED = "grades.csv", "grades.xlsx", "posted.csv"
Cell = str | float


@dataclass(frozen=True)
class Graded:
    """A student's line.

    Parameters
    ----------
    student : Student
    code : str
        That of the paper, which only this student and the examiner know.
    marks : Marks or None
        None if nothing came back.
    grade : str
        Empty if nothing came back.
    passed : bool
    """

    student: Student
    code: str
    marks: Marks | None
    grade: str
    passed: bool

    @property
    def remark(self) -> str:
        """Why the line is not the last word."""
        if self.marks is None:
            return "no answers"
        return "provisional" if self.marks.undecided else ""


def graded(
    students: Iterable[Student],
    heads: Mapping[str, Head],
    marked: Mapping[str, Marks],
    scale: Scale,
) -> list[Graded]:
    """Give a grade to everybody of the roster, in its order."""
    lines = []
    for student in students:
        marks = marked.get(student.id)
        grade = _grade(marks, scale) if marks else ""
        code = heads[student.id].code if student.id in heads else ""
        lines.append(Graded(student, code, marks, grade, scale.passes(grade)))
    return lines


def _grade(marks: Marks, scale: Scale) -> str:
    return scale.grade(Fraction(marks.marks), Fraction(marks.points))


def write_grades(folder: Path, lines: Sequence[Graded], scale: Scale) -> list[Path]:
    """Write the tables of grades.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    lines : sequence of Graded
    scale : Scale
    """
    items = _items(lines)
    rows = [_head(items), *(_row(line, items, scale) for line in lines)]
    posted: list[list[Cell]] = [["code", "points", "grade", "remark"], *_posted(lines, scale)]
    made = {POSTED: _csv(posted), BOOK: _xlsx(rows, scale), TABLE: _csv(rows)}
    return write_all(folder / FOLDER, made, mode=PRIVATE)


def _items(lines: Iterable[Graded]) -> list[str]:
    """What was asked, in the order of the first paper in which it stands."""
    return list(dict.fromkeys(p.item for one in lines if one.marks for p in one.marks.parts))


def _head(items: list[str]) -> list[Cell]:
    return ["id", "name", "group", "code", "points", "of", "percent", "grade", "passed",
            "undecided", "remark", *items]  # fmt: skip


def _row(line: Graded, items: list[str], scale: Scale) -> list[Cell]:
    student, marks = line.student, line.marks
    who: list[Cell] = [student.id, student.name, student.group, line.code]
    if marks is None:
        return [*who, "", "", "", "", "", "", line.remark, *("" for _ in items)]
    counted = float(scale.rounded(Fraction(marks.marks)))
    percent = round(100 * counted / marks.points, 1) if marks.points else 0.0
    got = {part.item: part.marks for part in marks.parts}
    each: list[Cell] = ["" if (given := got.get(item)) is None else given for item in items]
    return [*who, counted, marks.points, percent, line.grade, "yes" if line.passed else "no",
            marks.undecided, line.remark, *each]  # fmt: skip


def _posted(lines: Iterable[Graded], scale: Scale) -> list[list[Cell]]:
    """Without names, in the order of the codes, which says nothing of the roster."""
    rows: list[list[Cell]] = [
        [one.code, float(scale.rounded(Fraction(one.marks.marks))), one.grade, one.remark]
        for one in lines
        if one.marks
    ]
    return sorted(rows, key=lambda row: str(row[0]))


def _csv(rows: Iterable[Sequence[Cell]]) -> bytes:
    text = csv_text(map(_text, row) for row in rows)
    return text.encode("utf-8-sig")


def _text(cell: Cell) -> str:
    return cell if isinstance(cell, str) else f"{cell:g}"


def _xlsx(rows: Sequence[Sequence[Cell]], scale: Scale) -> bytes:
    """A workbook: the table, and the scale; texts are texts whatever they begin with."""
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
                    table.write_string(at, column, visible(cell), None if at else bold)
                else:
                    table.write_number(at, column, cell)
        steps = book.add_worksheet("scale")
        for at, (grade, share) in enumerate([*scale.bounds(), (scale.fail, Fraction(0))]):
            steps.write_string(at, 0, grade)
            steps.write_number(at, 1, float(100 * share))
    return out.getvalue()
