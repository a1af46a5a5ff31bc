"""What people decided: a file that is only added to, and survives spreadsheets."""

from __future__ import annotations

import csv
from fractions import Fraction

import pytest
from sweep import together

from quizgen.classes.grading import Submission, grade_submission
from quizgen.classes.rulings import Ruling, RulingBook, append_rulings, read_rulings
from quizgen.core.errors import ClassError
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion

KEY = AnswerKey("quizgen-key/2", [
    KeyQuestion("1", [
        KeyPart("1a", "2", {"kind": "number", "value": "4", "decimals": 2, "traps": {"halved": "2"}}),
        KeyPart("1b", "1", {"kind": "rubric", "full": "1", "criteria": {"light": {"points": "1", "accept": ["light"]}}}),
        KeyPart("1c", "1", {"kind": "multi", "correct": [1, 3], "options": ["one", "two", "three"]}),
    ], template="a-question"),
    KeyQuestion("2", [KeyPart("2", "3", {"kind": "quantity", "value": "1/2", "unit": "m"})], template="another"),
])  # fmt: skip


def marks(rulings=(), student="s1", **typed):
    found = grade_submission(KEY, Submission(student, typed), RulingBook(rulings))
    return {part.item: part.marks for part in found.parts}, found


A, B, C, D = "a-question/a", "a-question/b", "a-question/c", "another"


def test_without_a_ruling_the_checker_marks_and_people_are_asked():
    found, whole = marks(**{"1a": "4", "1b": "more light", "1c": "A, C", "2": "soon"})
    assert found == {A: 2.0, B: None, C: 1.0, D: None}
    assert (whole.marks, whole.points, whole.undecided_count) == (3.0, 7.0, 2)
    assert [part.chosen for part in whole.parts] == [(), (), ("one", "three"), ()]


RULED = [
    ([Ruling("tolerance", A, value="abs=0.5")], {"1a": "4.4"}, {A: 2.0}),
    ([Ruling("tolerance", A, value="abs=0.5"), Ruling("tolerance", A, value="abs=0.1")], {"1a": "4.4"}, {A: 0.0}),
    ([Ruling("accept", A, answer=" 4.4 ")], {"1a": "4.4"}, {A: 2.0}),
    ([Ruling("accept", A, answer="4.4", value="0.5")], {"1a": "4.4"}, {A: 0.5}),
    ([Ruling("accept", A, answer="4.4", value="9")], {"1a": "4.4"}, {A: 2.0}),
    ([Ruling("accept", A, answer="trap:halved", value="1")], {"1a": "2"}, {A: 1.0}),
    ([Ruling("accept", A, answer="trap:halved", value="1", student="s2")], {"1a": "2"}, {A: 0.0}),
    ([Ruling("decide", B, answer="MORE  light!", value="0.75")], {"1b": "more light"}, {B: 0.75}),
    ([Ruling("decide", D, answer="SOON", value="1")], {"2": "soon"}, {D: None}),
    ([Ruling("decide", B, answer="light", value="1"), Ruling("decide", B, answer="light")], {"1b": "light"}, {B: None}),
    ([Ruling("second", B, answer="light", value="1")], {"1b": "light"}, {B: None}),
    ([Ruling("give", D)], {}, {D: 3.0}),
    ([Ruling("drop", D)], {"2": "0.5 m"}, {D: 0.0}),
    ([Ruling("drop", D), Ruling("give", D)], {}, {D: 3.0}),
    ([Ruling("drop", D), Ruling("restore", D)], {"2": "0.5 m"}, {D: 3.0}),
    ([Ruling("decide", B, answer="light", value="1"), Ruling("restore", B)], {"1b": "light"}, {B: 1.0}),
    ([Ruling("give", D), Ruling("restore", D, student="s1")], {}, {D: 0.0}),
    ([Ruling("accept", A, answer="")], {"1a": ""}, {A: 0.0}),
]  # fmt: skip


@together(("rulings", "typed", "expected"), RULED)
def test_later_lines_count(rulings, typed, expected):
    found, _ = marks(rulings, **typed)
    assert {item: found[item] for item in expected} == expected


def test_what_was_ticked_is_kept_by_its_words():
    spec = {"kind": "tf", "correct": [2], "options": ["true", "false"]}
    key = AnswerKey("quizgen-key/2", [KeyQuestion("1", [KeyPart("1", "1", spec)], template="so")])
    found = grade_submission(key, Submission("s", {"1": "wahr"}), RulingBook([]))
    assert [(part.item, part.chosen, part.marks) for part in found.parts] == [
        ("so", ("true",), 0.0)
    ]


def test_what_is_dropped_can_no_longer_be_reached():
    _, whole = marks([Ruling("drop", D)], **{"1a": "4"})
    assert (whole.marks, whole.points) == (2.0, 4.0)


def test_a_tolerance_where_there_is_none_is_refused():
    with pytest.raises(ClassError, match="a-question/c: no tolerance"):
        marks([Ruling("tolerance", C, value="rel=0.1")], **{"1c": "A"})


def test_lines_are_added_and_read_back(tmp_path):
    first = Ruling("accept", A, answer='=1+1, "so"\nand', value="1", who="@me", comment="-1 শুভ")
    append_rulings(tmp_path, [first])
    before = (tmp_path / "rulings.csv").read_bytes()
    append_rulings(tmp_path, [Ruling("give", D, who="x")])
    assert (tmp_path / "rulings.csv").read_bytes().startswith(before)
    found = read_rulings(tmp_path)
    assert [(r.what, r.item, r.answer, r.who, r.comment) for r in found] == [
        ("accept", A, first.answer, "@me", "-1 শুভ"), ("give", D, "", "x", ""),
    ]  # fmt: skip
    assert found[0].points == Fraction(1)
    assert all(one.when for one in found)
    with (tmp_path / "rulings.csv").open(encoding="utf-8", newline="") as stream:
        cells = [cell for row in csv.reader(stream) for cell in row]
    assert not [cell for cell in cells if cell[:1] in set("=+-@")]


def test_as_a_spreadsheet_saves_it(tmp_path):
    rows = "what;item;value\r\ngive;another;\r\ntolerance;a-question/a;rel=0.1\r\n"
    (tmp_path / "rulings.csv").write_bytes(b"\xef\xbb\xbf" + rows.encode())
    assert [(r.what, r.value) for r in read_rulings(tmp_path)] == [
        ("give", ""),
        ("tolerance", "rel=0.1"),
    ]


WRONG = [
    ("what,item\nforget,x\n", "line 2: what"), ("what,item\ndrop,\n", "line 2: item"), ("item\nx\n", "'what'"),
    ("what,item,value\ntolerance,x,wide\n", "line 2: value"), ("what,item,value\ntolerance,x,decimals=2.5\n", "line 2: value"),
    ("what,item,value,answer\naccept,x,1/3,a\n", "quarters"), ("what,item,value,answer\naccept,x,-1,a\n", "quarters"),
    ("what,item,value,answer\naccept,x,much,a\n", "line 2: value"), ("what,item,value\naccept,x,1\n", "answer: missing"),
    ('what,item\ndrop,"x\n', "rulings.csv"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "said"), WRONG)
def test_a_line_that_says_nothing_is_refused_with_its_place(tmp_path, text, said):
    (tmp_path / "rulings.csv").write_text(text, "utf-8")
    with pytest.raises(ClassError, match=said):
        read_rulings(tmp_path)
