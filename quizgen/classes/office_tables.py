"""The grades as an examination office takes them: ``office.csv`` and ``office.xlsx``.

Numbers have the decimal sign of the office's language and cells are parted by semicolons, so that a
spreadsheet in that language reads numbers and no dates; grades of the workbook are text. Who has no
final grade has none here.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from fractions import Fraction

from quizgen.classes.grade_scale import GradeScale
from quizgen.classes.gradebook import Cell, GradedStudent, build_workbook
from quizgen.classes.statuses import PRESENT
from quizgen.core.untrusted import escape_control_characters, escape_csv_formula
from quizgen.locale import fallback_language, load_words, localise_numbers

CSV, BOOK = "office.csv", "office.xlsx"
COLUMNS = ("id", "name", "points", "of", "bonus", "grade", "passed", "status", "remark")


def build_office_tables(
    lines: Sequence[GradedStudent], scale: GradeScale, lang: str
) -> dict[str, bytes]:
    """Return the two files by name.

    Parameters
    ----------
    lines : sequence of GradedStudent
    scale : GradeScale
    lang : str
        Of the office.
    """
    lang = fallback_language(lang)
    words: Mapping[str, str] = load_words(lang, "classes")["office"]
    head: list[Cell] = [words[name] for name in COLUMNS]
    rows = [_build_row(line, scale, words, lang) for line in lines]
    out = io.StringIO()
    writer = csv.writer(out, delimiter=";", lineterminator="\r\n")
    table = [head, *rows]
    writer.writerows([_format_cell(cell, lang) for cell in row] for row in table)
    return {
        CSV: out.getvalue().encode("utf-8-sig"),
        BOOK: build_workbook({words["sheet"]: table}),
    }


def _build_row(
    line: GradedStudent, scale: GradeScale, words: Mapping[str, str], lang: str
) -> list[Cell]:
    """Return a student's cells, in the order of ``COLUMNS``."""
    student, marks = line.student, line.marks
    reached: list[Cell] = ["", "", ""]
    if marks and line.status == PRESENT and not line.held:
        points = float(scale.round_points(Fraction(marks.marks)))
        reached = [points, marks.points, float(line.bonus)]
    final = line.grade if line.is_final else ""
    passed = words["yes" if line.passed else "no"] if final else ""
    status = "" if line.status == PRESENT or line.held else words[line.status]
    remark = "" if line.is_final else words["held" if line.held else "provisional"]
    grade = localise_numbers(lang, final)
    return [student.id, student.name, *reached, grade, passed, status, remark]


def _format_cell(cell: Cell, lang: str) -> str:
    """Return a cell as text, numbers with the decimal sign of the language."""
    if isinstance(cell, str):
        return escape_csv_formula(escape_control_characters(cell))
    return localise_numbers(lang, f"{cell:g}")
