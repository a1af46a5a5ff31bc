"""Reports of students whose names and answers no font here has."""

from __future__ import annotations

from pathlib import Path

import pytest

from quizgen.bank.folder import Bank
from quizgen.classes.grades import Graded
from quizgen.classes.mark import Marks, PartMark, item_of
from quizgen.classes.reports import Report, Row, Section, report_html, report_of, report_pdf
from quizgen.classes.roster import Student
from quizgen.paper.key import key_of
from quizgen.paper.paper import single

MARKS = Marks("1", (PartMark("1", "x", "3", "wrong", 1.0, 0.0),))


def report(lang, **said):
    row = Row("a", said.get("typed", "3"), "4", "0 / 1", said.get("message", ""), "")
    section = Section("1", "Far away", 0.0, 1.0, 0.0, (row,), "projection", lang)
    return Report(lang, "Test", said.get("who", "Ada"), "G-1", "5.0", MARKS, (section,))


@pytest.mark.parametrize(
    "said", [{"who": "李小龙"}, {"typed": "三 m"}, {"message": "«三»?"}], ids=str
)
def test_a_character_that_no_font_has_stops_no_report(said):
    made = report("bn", **said)
    assert report_pdf(made).startswith(b"%PDF")
    assert next(iter(said.values())) in report_html(made).decode()


@pytest.mark.parametrize(("marks", "said"), [(1.0, True), (None, False)])
def test_all_points_are_said_only_where_nothing_is_open(marks, said):
    part = PartMark("1", "x", "3", "open", 1.0, marks)
    section = Section("1", "Far", marks or 0.0, 1.0, 0.0 if marks else 1.0, (), "projection", "en")
    made = Report("en", "Test", "Ada", "G-1", "1.0", Marks("1", (part,)), (section,))
    assert ("There is nothing to revise." in report_html(made).decode()) == said


@pytest.mark.parametrize("said", [{"who": "রুবাইয়াত"}, {"typed": "৬,৬৭ মি"}], ids=str)
def test_bangla_in_an_english_report_brings_its_font(said):
    assert "@font-face" not in report_html(report("en")).decode()
    assert "@font-face" in report_html(report("en", **said)).decode()


@pytest.mark.parametrize(
    ("lang", "right"),
    [("en", ["0.09091 cycle/px", "0.689"]), ("de", ["0,09091 cycle/px", "0,689"])],
)
def test_what_is_right_has_the_decimal_sign_of_the_language(lang, right):
    """1/11 of a cycle per pixel, and what that leaves of the contrast."""
    bank = Bank(Path(__file__).parents[2] / "examples" / "filtering", trusted=True)
    paper = single(bank.template("spectrum-of-a-mean"), 0, lang, figures=False)
    key = key_of(paper)
    given = [
        PartMark(part.id, item_of(key.questions[0], part), "3", "wrong", 1.0, 0.0)
        for part in key.questions[0].parts
    ]
    line = Graded(Student("1", "Ada"), "G-1", Marks("1", tuple(given), lang), "5", passed=False)
    (section,) = report_of(line, key).sections
    assert [row.right for row in section.rows] == right
