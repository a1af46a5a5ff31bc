"""What goes to the examination office: nothing in it is a date, and nothing that is not final."""

from __future__ import annotations

import csv
import io
import zipfile
from fractions import Fraction
from xml.etree import ElementTree as ET

from quizgen.classes.class_folder import PrintedHead
from quizgen.classes.grade_scale import BonusRule, GradeScale
from quizgen.classes.gradebook import GradeBasis, grade_students
from quizgen.classes.grading import GradedClassPart, StudentMarks
from quizgen.classes.office_tables import build_office_tables
from quizgen.classes.roster import RosterStudent
from quizgen.core.errors import ClassError
from quizgen.core.spreadsheets import iter_spreadsheet_rows

SCALE = GradeScale(bonus=BonusRule(most=10))
POINTS = {"1": 87.5, "2": 52.0, "3": 40.0, "4": 88.0, "5": 70.0, "6": 70.0, "7": 70.0, "9": 60.0}
OPEN = "7"
STATUSES = {"3": "sick", "4": "deception", "5": "withdrawn", "8": "absent", "10": "present"}


def graded():
    students = [
        RosterStudent(str(n), f"=N{n}", bonus="6,5" if n == 2 else "") for n in range(1, 12)
    ]
    marked = {
        who: StudentMarks(
            who,
            (
                GradedClassPart("1", "x", "4", "right", 90.0, points),
                GradedClassPart("2", "y", "4", "open", 10.0, None if who == OPEN else 0.0),
            ),
        )
        for who, points in POINTS.items()
    }
    heads = {one.id: PrintedHead(one.id, f"G-{one.id}", "", "") for one in students}
    basis = GradeBasis(heads, marked, SCALE, STATUSES, {"6"}, {"9"})
    return grade_students(students, basis)


EXPECTED = """
Matrikelnummer;Name;Punkte;von;Bonuspunkte;Note;Bestanden;Status;Vermerk
1;'=N1;87,5;100;0;1,7;ja;;
2;'=N2;52;100;6,5;3,7;ja;;
3;'=N3;;;;;;krank;
4;'=N4;;;;5,0;nein;Täuschung;
5;'=N5;;;;;;Rücktritt;
6;'=N6;;;;;;;zu klären
7;'=N7;70;100;0;;;;vorläufig
8;'=N8;;;;;;nicht erschienen;
9;'=N9;;;;;;;zu klären
10;'=N10;;;;5,0;nein;;
11;'=N11;;;;;;nicht erschienen;
"""


def test_the_table_of_a_german_office():
    """58.5 points are a 3.7 by the usual scale: 52 and a bonus of 6.5, as the exam was passed."""
    text = build_office_tables(graded(), SCALE, "de")["office.csv"].decode("utf-8-sig")
    assert text.replace("\r\n", "\n") == EXPECTED.lstrip()


def test_grades_of_the_workbook_are_text(tmp_path):
    data = build_office_tables(graded(), SCALE, "de")["office.xlsx"]
    with zipfile.ZipFile(io.BytesIO(data)) as book:
        sheet = ET.fromstring(book.read("xl/worksheets/sheet1.xml"))
    cells = {cell.get("r"): cell for cell in sheet.iter() if cell.tag.endswith("}c")}
    assert [cells[f"F{row}"].get("t") for row in (2, 3, 5)] == ["s"] * 3
    assert not [cell for cell in sheet.iter() if cell.tag.endswith("}f")]
    path = tmp_path / "office.xlsx"
    path.write_bytes(data)
    table = [row for _, row in iter_spreadsheet_rows(path, ClassError)]
    theirs = list(csv.reader(io.StringIO(EXPECTED.strip()), delimiter=";"))
    assert [row[5:7] for row in table[:3]] == [row[5:7] for row in theirs[:3]]
    assert table[1][1:3] == ["=N1", "87.5"]


def test_what_is_no_final_grade_is_said_in_the_own_table():
    found = {one.student.id: (one.grade, one.remark, one.bonus) for one in graded()}
    assert found["2"] == ("3.7", "", Fraction(13, 2))
    assert {who: remark for who, (_, remark, _) in found.items() if remark} == {
        "3": "sick", "4": "deception", "5": "withdrawn", "6": "key changed", "7": "provisional",
        "8": "no answers", "9": "answers differ", "10": "blank", "11": "no answers",
    }  # fmt: skip
