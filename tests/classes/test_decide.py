"""Which answers are decided together, and how far two markers agree."""

from __future__ import annotations

import csv

import pytest
from sweep import together

from quizgen.classes.grading import Submission, grade_submission
from quizgen.classes.manual_grading import (
    cohens_kappa,
    decision_cases,
    group_cases,
    marker_agreement,
    read_queue,
    undecided_answers,
    write_queue,
)
from quizgen.classes.rulings import Ruling, RulingBook
from quizgen.core.errors import ClassError
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion

POINTS = {
    "light": {"points": "1", "accept": ["light", "আলো"]},
    "noise": {"points": "1", "accept": ["noise"]},
}
KEY = AnswerKey("quizgen-key/2", [
    KeyQuestion("1", [KeyPart("1", "2", {"kind": "rubric", "full": "2", "criteria": POINTS})], template="why"),
    KeyQuestion("2", [KeyPart("2", "1", {"kind": "quantity", "value": "1/2", "unit": "m"})], template="far"),
])  # fmt: skip


def groups(sentences=(), numbers=()):
    """The groups of what students typed, each as its texts with their counts."""
    sheets = [Submission(f"s{n}", {"1": text}) for n, text in enumerate(sentences)]
    sheets += [Submission(f"n{n}", {"2": text}) for n, text in enumerate(numbers)]
    marked = [grade_submission(KEY, sheet, RulingBook([])) for sheet in sheets]
    return group_cases(decision_cases(undecided_answers(marked), lambda _: KEY, "en"))


def texts(found):
    return [[(case.answer.typed, case.answer.students) for case in group] for group in found]


def test_equal_answers_are_one_and_similar_ones_stand_with_it():
    said = [
        "More light, less noise.",
        "more light,  less noise",
        "More light, and so less noisse",
        "Cats",
    ]
    assert texts(groups(said)) == [
        [("More light, less noise.", 2), ("More light, and so less noisse", 1)],
        [("Cats", 1)],
    ]


@together(("one", "other"), [
    ("There is noise where there is light", "There is no noise where there is light"),
    ("The light is collected for long enough here", "The light is not collected for long enough here"),
    ("Twice the light gives 2 times the noise", "Twice the light gives 4 times the noise"),
    ("More light gives less noise", "Less light gives more noise"),
    ("The noise increases with the light", "The noise decreases with the light"),
    ("বেশি আলো এলে ছবিতে দাগ থাকে", "বেশি আলো এলে ছবিতে দাগ থাকে না"),
])  # fmt: skip
def test_what_says_something_else_is_another_group(one, other):
    assert len(groups([one, other])) == 2


def test_case_and_signs_matter_in_what_is_no_sentence():
    assert len(groups(numbers=["5 or 6 MW", "5 or 6 mW", "5 or 6  mW"])) == 2


@together(("said", "apart"), [
    ("see paper", True), ("s. Rückseite", True), ("Siehe Blatt 2", True), ("see the drawing", True), ("on the back", True),
    ("see that there is light", False), ("seemingly noise", False), ("noise", False),
])  # fmt: skip
def test_what_only_points_at_paper_is_decided_for_each_student(said, apart):
    found = groups([said, said])
    assert (len(found), len(found[0])) == ((2, 1) if apart else (1, 1))


def test_criteria_are_a_suggestion_and_are_shown_where_they_stand():
    [[case]] = groups(["More Light!"])
    assert (case.seen, case.suggestion) == ("light: found; noise: missing", 1)
    assert [case.answer.typed[start:end] for start, end in case.spots] == ["Light"]
    assert case.answer.marks is None


def test_many_different_answers_are_grouped_in_the_order_of_students():
    found = groups(["b"] * 3 + ["a"] * 5 + [f"word {n} of its own" for n in range(40)])
    assert [case.answer.typed for case in (found[0][0], found[1][0])] == ["a", "b"]
    assert len(found) == 42


def filled(folder, **said):
    """The queue of two similar answers and another one, its first row filled in."""
    write_queue(folder, groups(["much light", "much light", "much  lights", "=cats"]), {})
    with (folder / "decisions.csv").open(encoding="utf-8-sig", newline="") as stream:
        rows = list(csv.DictReader(stream))
    rows[0].update(said)
    with (folder / "decisions.csv").open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return rows


def test_one_line_of_the_spreadsheet_settles_what_stands_together(tmp_path):
    rows = filled(tmp_path, points="1,5", who="AM", comment="fine")
    assert rows[2]["answer"] == "'=cats"
    found, kept = read_queue(tmp_path)
    assert [(r.what, r.answer, r.value, r.who, r.comment) for r in found] == [
        ("decide", "much light", "1.5", "AM", "fine"), ("decide", "much  lights", "1.5", "AM", "fine"),
    ]  # fmt: skip
    assert kept == {rows[2]["group"]: ""}


def test_a_comment_on_what_is_still_open_stays(tmp_path):
    rows = filled(tmp_path, comment="ask BN")
    found, kept = read_queue(tmp_path)
    assert found == []
    assert kept[rows[0]["group"]] == "ask BN"


@pytest.mark.parametrize(
    ("points", "said"),
    [("2.5", "2.5 points of 2"), ("1.1", "quarters"), ("good", "line 2"), ("-1", "quarters")],
)
def test_points_that_cannot_be_are_refused_with_their_line(tmp_path, points, said):
    filled(tmp_path, points=points)
    with pytest.raises(ClassError, match=said):
        read_queue(tmp_path)


def test_a_row_that_ends_early_is_refused_with_its_line(tmp_path):
    (tmp_path / "decisions.csv").write_text("item,together,points,group\nwhy,1,1\n", "utf-8")
    with pytest.raises(ClassError, match="line 2: points: answer: missing"):
        read_queue(tmp_path)


def test_agreement_of_two_markers():
    said = [("1", "1"), ("1", "0"), ("0", "0"), ("0", "0")]
    lines = [Ruling(what, "why", "x", value, group=f"g{n}")
             for n, pair in enumerate(said) for what, value in zip(("decide", "second"), pair, strict=True)]  # fmt: skip
    found = marker_agreement([*lines, Ruling("decide", "why", "y", "1", group="g9")])
    # 3 of 4 agree; by chance 1/2*1/4 + 1/2*3/4 = 1/2: kappa (3/4 - 1/2)/(1/2) = 1/2
    assert (found.answers, found.kappa, len(found.apart)) == (4, 0.5, 1)


def test_kappa_of_two_readers_of_grant_proposals():
    """Wikipedia, Cohen's kappa, Simple example: 20 and 15 agreed, 5 and 10 not."""
    pairs = [("y", "y")] * 20 + [("y", "n")] * 5 + [("n", "y")] * 10 + [("n", "n")] * 15
    assert cohens_kappa(pairs) == pytest.approx(0.4)
    assert cohens_kappa([("y", "y")] * 3) is None
    assert cohens_kappa([]) is None
