"""A class is marked many times: what was judged is known, and nothing else comes of it."""

from __future__ import annotations

import shutil

import pytest
from made import made, run

from quizgen.classes import grading_run, manual_grading
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.judged_answers import FILE
from quizgen.classes.marking import AnswerIndex

ROWS = [("101", "Ada", "en"), ("102", "Ben", "en")]


@pytest.fixture(scope="module")
def marked(tmp_path_factory):
    folder = made(tmp_path_factory.mktemp("class"), ROWS)
    path = folder.parent / "in.csv"
    path.write_text("id,1a,1b,2a\n101,A,3 mm,no idea\n102,B,,4\n", "utf-8")
    run("class", "mark", folder, path)
    return folder


@pytest.fixture
def folder(marked, tmp_path):
    return shutil.copytree(marked, tmp_path / "class")


@pytest.fixture
def judged(monkeypatch):
    """Whose answers were judged anew."""
    found, judge = [], grading_run.judge_submission
    monkeypatch.setattr(grading_run, "judge_submission",
                        lambda key, sheet, book: (found.append(sheet.student), judge(key, sheet, book))[1])  # fmt: skip
    return found


def parts(folder, student):
    return next(one.parts for one in GradingHistory(folder).current() if one.student == student)


def test_what_is_as_it_was_is_judged_once_and_rulings_hold_all_the_same(
    folder, judged, monkeypatch
):
    assert (folder / "decisions.csv").read_bytes().count(b"\n") > 1
    monkeypatch.setattr(manual_grading, "_build_review_case", None)
    run("class", "rule", folder, "give", "1b")
    run("class", "mark", folder)
    assert judged == []
    given = [part for part in parts(folder, "101") if part.id == "1b"]
    assert [(part.marks, part.by.split()[0]) for part in given] == [(given[0].points, "give")]


def seen_on_page(folder) -> dict[str, str]:
    """What the page of markers says of each group of answers."""
    cards = [card for listed in AnswerIndex(folder).items.values() for card in listed]
    return {case.answer.group: case.seen for card in cards for case in card.cases}


def test_the_page_of_markers_judges_nothing_anew_decided_or_not(folder, monkeypatch):
    before = seen_on_page(folder)
    one, *rest = sorted(before)
    assert rest
    queue = (folder / "decisions.csv").read_text("utf-8-sig")
    (row,) = [line for line in queue.splitlines() if line.endswith(one)]
    decided = f"{row.removesuffix(',,,,,' + one)},0,,,,{one}"
    (folder / "decisions.csv").write_text(queue.replace(row, decided), "utf-8")
    monkeypatch.setattr(manual_grading, "_build_review_case", None)
    run("class", "mark", folder)
    run("class", "mark", folder)
    assert one not in (folder / "decisions.csv").read_text("utf-8-sig")
    assert seen_on_page(folder) == before


def test_without_the_file_and_with_a_forged_one_the_marks_are_the_same(folder, judged):
    before = {student: parts(folder, student) for student, *_ in ROWS}
    kept = (folder / FILE).read_bytes()
    assert b'"marks":0.0' in kept
    for data in (b"", b"\xff{", kept.replace(b'"marks":0.0', b'"marks":9.0')):
        judged.clear()
        (folder / FILE).write_bytes(data)
        run("class", "mark", folder)
        assert sorted(judged) == ["101", "102"]
        assert {student: parts(folder, student) for student, *_ in ROWS} == before


def test_another_answer_is_judged_anew(folder, judged):
    answers = folder / "answers" / "in.csv"
    answers.write_text(answers.read_text("utf-8").replace("3 mm", "3.5 mm"), "utf-8")
    run("class", "mark", folder)
    assert judged == ["101"]
    assert next(part.typed for part in parts(folder, "101") if part.id == "1b") == "3.5 mm"
