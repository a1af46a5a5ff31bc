"""Reports of students whose names and answers no font here has."""

from __future__ import annotations

from pathlib import Path

import pytest

from quizgen.bank.bank import Bank
from quizgen.classes.gradebook import GradedStudent
from quizgen.classes.grading import GradedClassPart, StudentMarks, item_name
from quizgen.classes.roster import RosterStudent
from quizgen.classes.student_reports import (
    ReportPart,
    ReportQuestion,
    StudentReport,
    make_report,
    report_to_html,
    report_to_pdf,
)
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion, make_answer_key
from quizgen.paper.paper import single_question_paper

MARKS = StudentMarks("1", (GradedClassPart("1", "x", "3", "wrong", 1.0, 0.0),))


def report(lang, **said):
    row = ReportPart("a", said.get("typed", "3"), "4", "0 / 1", said.get("message", ""), "")
    section = ReportQuestion("1", "Far away", 0.0, 1.0, 0.0, (row,), "projection", lang)
    return StudentReport(lang, "Test", said.get("who", "Ada"), "G-1", "5.0", MARKS, (section,))


@pytest.mark.parametrize(
    "said", [{"who": "李小龙"}, {"typed": "三 m"}, {"message": "«三»?"}], ids=str
)
def test_a_character_that_no_font_has_stops_no_report(said):
    made = report("bn", **said)
    assert report_to_pdf(made).startswith(b"%PDF")
    assert next(iter(said.values())) in report_to_html(made).decode()


@pytest.mark.parametrize(("marks", "said"), [(1.0, True), (None, False)])
def test_all_points_are_said_only_where_nothing_is_open(marks, said):
    part = GradedClassPart("1", "x", "3", "open", 1.0, marks)
    section = ReportQuestion(
        "1", "Far", marks or 0.0, 1.0, 0.0 if marks else 1.0, (), "projection", "en"
    )
    made = StudentReport("en", "Test", "Ada", "G-1", "1.0", StudentMarks("1", (part,)), (section,))
    assert ("There is nothing to revise." in report_to_html(made).decode()) == said


@pytest.mark.parametrize("said", [{"who": "রুবাইয়াত"}, {"typed": "৬,৬৭ মি"}], ids=str)
def test_bangla_in_an_english_report_brings_its_font(said):
    bangla = '@font-face { font-family: "QuizBangla"'
    assert bangla not in report_to_html(report("en")).decode()
    assert bangla in report_to_html(report("en", **said)).decode()


@pytest.mark.parametrize(
    ("lang", "right"),
    [("en", ["0.0909 cycle/px", "0.689"]), ("de", ["0,0909 cycle/px", "0,689"])],
)
def test_what_is_right_has_the_decimal_sign_of_the_language(lang, right):
    """1/11 of a cycle per pixel, and what that leaves of the contrast."""
    bank = Bank(Path(__file__).parents[2] / "examples" / "filtering", trusted=True)
    paper = single_question_paper(bank.template("spectrum-of-a-mean"), 0, lang, figures=False)
    key = make_answer_key(paper)
    given = [
        GradedClassPart(part.id, item_name(key.questions[0], part), "3", "wrong", 1.0, 0.0)
        for part in key.questions[0].parts
    ]
    line = GradedStudent(
        RosterStudent("1", "Ada"), "G-1", StudentMarks("1", tuple(given), lang), "5", passed=False
    )
    (section,) = make_report(line, key).sections
    assert [row.right for row in section.rows] == right


SENTENCES = AnswerKey("quizgen-key/2", [
    KeyQuestion("1", [
        KeyPart("1a", "2", {"kind": "rubric", "full": "2", "criteria": {"light": {"points": "1", "accept": ["light"]}, "noise": {"points": "1", "accept": ["noise"]}}, "model": {"en": "More light, less noise."}}),
        KeyPart("1b", "1", {"kind": "number", "value": "4", "traps": {"half": "2"}, "notes": {"en": {"half": "That is half of it."}}}),
    ], template="why", title={"en": "Why"}),
])  # fmt: skip


@pytest.mark.parametrize(
    ("by", "marks", "shown"),
    [
        ("", None, "still to be decided"),
        ("decide (AM)", 0.0, "0 / 2"),
        ("points (AM)", 1.0, "1 / 2"),
    ],
)
def test_where_a_person_decides_the_machine_says_nothing(by, marks, shown):
    given = (
        GradedClassPart("1a", "why/a", "no idea", "open", 2.0, marks, by=by),
        GradedClassPart("1b", "why/b", "2", "wrong", 1.0, 0.0, note="trap:half"),
    )
    line = GradedStudent(RosterStudent("1"), "G-1", StudentMarks("1", given), "5.0", passed=False)
    (section,) = make_report(line, SENTENCES).sections
    sentence, number = section.rows
    assert (sentence.marks, sentence.message) == (shown, "")
    assert sentence.right == "More light, less noise."
    assert number.message == "That is half of it."
    page = report_to_html(make_report(line, SENTENCES)).decode()
    assert "decide yourself" not in page
    assert "quizgen" not in page
    assert report_to_pdf(make_report(line, SENTENCES)).startswith(b"%PDF")


@pytest.mark.parametrize("by", ["tolerance (AM)", "drop (AM), kept: better with it"])
def test_a_ruling_that_leaves_judging_to_the_machine_keeps_what_it_says(by):
    given = (GradedClassPart("1b", "why/b", "2", "wrong", 1.0, 0.0, note="trap:half", by=by),)
    line = GradedStudent(RosterStudent("1"), "G-1", StudentMarks("1", given), "5.0", passed=False)
    assert make_report(line, SENTENCES).sections[0].rows[0].message == "That is half of it."
