"""Whole papers and the commands around them."""

from __future__ import annotations

import csv
import io
import json
from fractions import Fraction

import pytest
from click.testing import CliRunner
from sweep import together

from quizgen.cli.check import check as check_command
from quizgen.cli.mark import mark as mark_command
from quizgen.core.errors import InvalidChoiceError, KeyFileError
from quizgen.kinds.batch import grade_lines
from quizgen.paper import grading
from quizgen.paper.answer_form import read_filled_form
from quizgen.paper.answer_key import read_answer_key
from quizgen.paper.grading import grade_paper, round_to_quarters

CHAIN = {
    "given": {
        "f": {"value": "1/20", "unit": "mm"},
        "X": {"value": "30", "unit": "m"},
        "Z": {"value": "600", "unit": "m"},
        "pitch": {"value": "1/200000", "unit": "um"},
    },
    "steps": [["h", "f*X/Z", "mm"], ["n", "h/pitch", "px"]],
}
KEY = {
    "format": "quizgen-key/2",
    "code": "mock-1",
    "title": {"en": "Mock", "bn": "মক"},
    "langs": ["en", "bn"],
    "questions": [
        {
            "number": "1",
            "template": "image-height-and-fill-distance",
            "points": "5",
            "chain": CHAIN,
            "parts": [
                {
                    "id": "1a",
                    "points": "3",
                    "spec": {
                        "kind": "quantity",
                        "value": "5/2",
                        "unit": "mm",
                        "rel": "0.005",
                        "of": ["h"],
                        "traps": {"no-f": "50"},
                        "notes": {"en": {"no-f": "You left out f."}, "bn": {"no-f": "f বাদ।"}},
                    },
                },
                {
                    "id": "1b",
                    "points": "2",
                    "spec": {"kind": "number", "value": "500", "exact": True, "of": ["n"]},
                },
            ],
        },
        {
            "number": "2",
            "template": "define-image-pixel-channel",
            "points": "3",
            "chain": None,
            "parts": [
                {
                    "id": "2a",
                    "points": "1",
                    "spec": {
                        "kind": "rubric",
                        "full": "1",
                        "criteria": {"grid": {"points": "1", "accept": ["a grid"]}},
                    },
                },
                {
                    "id": "2b",
                    "points": "2",
                    "spec": {"kind": "match", "pairs": {"A": "1", "B": "2", "C": "3"}},
                },
            ],
        },
    ],
}


def marks(answers, **options):
    result = grade_paper(KEY, answers, **options)
    return {part.id: part.marks for part in result.parts}, result


def test_right_wrong_blank_and_text():
    found, result = marks({"1a": "2,5 mm", "1b": "499", "2a": "a grid", "2b": "A1 B3 C2"})
    assert found == {"1a": 3, "1b": 0, "2a": None, "2b": Fraction(3, 4)}  # a third of 2 is 0.67
    assert (result.marks, result.points, result.to_decide) == (Fraction(15, 4), 8, 1)
    blank = grade_paper(KEY, {})
    assert {part.status for part in blank.parts} == {"blank"}
    assert (blank.marks, blank.asked_back) == (0, 0)


def test_the_students_own_value_is_carried_to_the_next_part():
    found, result = marks({"1a": "50 mm", "1b": "10000"})
    assert found["1a"] == 0
    assert found["1b"] == 2
    assert [part.verdict.note for part in result.parts[:2]] == ["trap:no-f", "carried-forward"]
    assert result.parts[0].verdict.message == "You left out f."
    bangla = grade_paper(KEY, {"1a": "50 mm"}, "bn")
    assert bangla.parts[0].verdict.message == "f বাদ।"


def test_an_unreadable_answer_is_asked_back_and_not_carried():
    found, result = marks({"1a": "2.5 parsec", "1b": "10000"})
    assert result.asked_back == 1
    assert result.parts[0].status == "unreadable"
    assert found["1b"] == 0


def test_quarters_of_a_point():
    for exact, rounded in ((Fraction(1, 3), "1/4"), (Fraction(3, 8), "1/2"), (Fraction(2), "2")):
        assert round_to_quarters(exact) == Fraction(rounded)


def test_answers_to_unknown_parts_are_named():
    assert grade_paper(KEY, {"9z": "1", "8": ""}).unknown == ("9z",)


@pytest.fixture
def files(tmp_path):
    key, form = tmp_path / "key.json", tmp_path / "answers.toml"
    key.write_text(json.dumps(KEY), "utf-8")
    form.write_text(
        '[student]\nname = "Rahim"\nlang = "bn"\ndecimal = "comma"\n[answers]\n"1a" = "২,৫ মিমি"\n"1b" = 500\n',
        "utf-8",
    )
    return key, form


def run(command, *arguments, **options):
    return CliRunner().invoke(command, [str(a) for a in arguments], **options)


def test_one_form_prints_a_table_in_its_own_language(files):
    done = run(check_command, *files)
    assert done.exit_code == 0
    assert "মোট: 5 / 8" in done.output
    assert "Total: 5 / 8" in run(check_command, *files, "--lang", "en").output


def test_json_holds_the_five_members_per_part(files):
    table = json.loads(run(check_command, *files, "--json").output)
    assert (table["marks"], table["points"], table["name"]) == (5.0, 8.0, "Rahim")
    assert {"verdict", "credit", "read_as", "note", "message"} <= table["parts"][0].keys()


def test_several_forms_print_marks_and_notes_per_part(files, tmp_path):
    other = tmp_path / "other.json"
    other.write_text(json.dumps({"student": {"name": "=1+1"}, "answers": {"1a": "50 mm"}}))
    done = run(check_command, *files, other)
    rows = list(csv.DictReader(io.StringIO(done.output)))
    assert [row["marks"] for row in rows] == ["5", "0"]
    assert rows[1]["1a note"] == "trap:no-f"
    assert rows[1]["1b note"] == "blank"
    assert rows[1]["name"] == "'=1+1"


@pytest.mark.parametrize(
    ("key_text", "form_text", "message"),
    [
        ("{", "[answers]", "key.json: line 1"),
        ("[]", "[answers]", "key.json: a table is expected"),
        ('{"format": "x"}', "[answers]", "format is 'x'"),
        (json.dumps({**KEY, "questions": 3}), "[answers]", "$.questions"),
        (None, "answers", "answers.toml"),
        (None, "x = 1", "no table [answers]"),
        (None, '[answers]\n"1a" = [1]', "$.answers"),
        (None, '[answers]\n[student]\ndecimal = "dot"', "student.decimal 'dot'"),
        (None, 'code = "other"\n[answers]', "code other belongs to another paper"),
    ],
)
def test_bad_files_are_one_located_line(files, key_text, form_text, message):
    key, form = files
    if key_text is not None:
        key.write_text(key_text)
    form.write_text(form_text)
    done = run(check_command, key, form)
    told = done.stderr.strip() or str(done.exception)
    assert done.exit_code != 0
    assert message in told
    assert "\n" not in told


def test_missing_and_binary_files(tmp_path):
    with pytest.raises(KeyFileError, match="No such file"):
        read_answer_key(tmp_path / "none.json")
    (tmp_path / "a.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(KeyFileError, match="not UTF-8"):
        read_filled_form(tmp_path / "a.json")


@together(
    ("spec", "message"),
    [
        ({"kind": "numbr", "value": "1"}, "unknown kind 'numbr'"),
        ({"value": "1"}, "unknown kind None"),
        ({"kind": "number"}, "value"),
        ({"kind": "number", "value": "1", "decimal": 3}, "decimal"),
        ({"kind": "number", "value": "1", "decimals": "x"}, "decimals"),
        ({"kind": "number", "value": "1", "decimals": 2, "rel": "0.1"}, "only one of"),
        ({"kind": "number", "value": "1/"}, "unfinished"),
        ({"kind": "quantity", "value": "1", "unit": "furlong"}, "furlong"),
        ({"kind": "choice", "options": ["a"], "correct": [2]}, "positions"),
        ({"kind": "order", "steps": ["a", "b"], "before": [["a", "b"], ["b", "a"]]}, "circle"),
        ({"kind": "expression", "value": "x+y", "symbols": {"x": "real"}}, "unknown name 'y'"),
        ({"kind": "expression", "value": "x", "symbols": {"x": "reel"}}, "symbols.x"),
        ({"kind": "interval", "value": "zero"}, "interval expected"),
    ],
)
def test_a_wrong_spec_names_its_field(spec, message):
    with pytest.raises(KeyFileError) as caught:
        grade_paper(
            {
                **KEY,
                "questions": [
                    {**KEY["questions"][1], "parts": [{"id": "2a", "points": "1", "spec": spec}]}
                ],
            },
            {"2a": "1"},
        )
    assert message in str(caught.value)
    assert "2a" in str(caught.value)


def test_mark_prints_one_verdict():
    done = run(mark_command, '{kind="number", value="20/3", decimals=3}', "6,67")
    table = json.loads(done.output)
    assert (table["verdict"], table["note"]) == ("partial", "decimals-asked")


def test_batch_keeps_order_and_survives_bad_lines():
    spec = {"kind": "number", "value": "2"}
    lines = [
        json.dumps({"spec": spec, "typed": "2"}),
        "not json",
        "",
        json.dumps({"spec": {"kind": "?"}, "typed": "2"}),
        json.dumps({"spec": spec, "typed": "১", "lang": "bn", "decimal": "comma"}),
    ]
    done = run(mark_command, "--batch", input="\n".join(lines))
    found = [json.loads(line) for line in done.output.splitlines()]
    assert [row.get("verdict", "error") for row in found] == ["correct", "error", "error", "wrong"]
    assert list(found[0]) == ["verdict", "credit", "read_as", "note", "message"]


def test_batch_reads_no_further_than_it_has_written():
    """Constant memory: a line is answered before the next one is read."""
    taken = []

    def source():
        for number in range(3):
            taken.append(number)
            yield json.dumps({"spec": {"kind": "number", "value": "2"}, "typed": "2"})

    answers = grade_lines(source())
    next(answers)
    assert taken == [0]


def test_a_marked_paper_as_plain_values():
    table = grade_paper(KEY, {"1a": "50 mm", "1b": "?", "2a": "a grid", "9z": "1"}).as_json()
    assert {name: table[name] for name in table if name != "parts"} == {
        "code": "mock-1",
        "marks": 0.0,
        "points": 8.0,
        "asked_back": 1,
        "to_decide": 1,
        "unknown_parts": ["9z"],
    }
    first, second, text, blank = table["parts"]
    own = ("id", "question", "template", "typed", "status", "points", "marks")
    assert [first[name] for name in own] == [
        "1a", "1", "image-height-and-fill-distance", "50 mm", "wrong", 3.0, 0.0]  # fmt: skip
    assert (first["verdict"], first["note"], first["credit"]) == ("wrong", "trap:no-f", 0.0)
    assert (second["status"], second["marks"]) == ("unreadable", 0.0)
    assert (text["status"], text["marks"]) == ("open", None)
    assert (blank["question"], blank["status"], blank["points"]) == ("2", "blank", 2.0)


@pytest.mark.parametrize(("decimal", "status"), [("comma", "correct"), ("point", "wrong")])
def test_a_paper_is_read_with_the_students_decimal_sign(decimal, status):
    spec = {"kind": "number", "value": "123456", "exact": True}
    part = {"id": "1", "points": "1", "spec": spec}
    key = {"format": "quizgen-key/2", "questions": [{"number": "1", "parts": [part]}]}
    assert grade_paper(key, {"1": "123.456"}, decimal=decimal).parts[0].status == status


@pytest.mark.parametrize(
    "options", [{"lang": "fr"}, {"decimal": "dot"}, {"lang": None}, {"decimal": None}]
)
def test_an_unknown_language_or_sign_of_a_paper_is_named(options):
    with pytest.raises(
        InvalidChoiceError, match=next(iter({"lang": "language"}.get(n, n) for n in options))
    ):
        grade_paper(KEY, {}, **options)


@pytest.mark.parametrize("settle", [False, True])
def test_a_paper_settles_formulas_only_when_asked(monkeypatch, settle):
    seen = []
    plain = grading.judge_answer
    monkeypatch.setattr(grading, "judge_answer", lambda *a: seen.append(a[2].settle) or plain(*a))
    grade_paper(KEY, {"1b": "500"}, **({"settle": True} if settle else {}))
    assert set(seen) == {settle}


def test_an_own_value_is_carried_in_the_unit_of_the_answer():
    """3.5 mm typed as 0.0035 m is 3.5 mm all the same: 3.5 mm / 5 µm = 700 px."""
    found, _ = marks({"1a": "0.0035 m", "1b": "700"})
    assert (found["1a"], found["1b"]) == (0, 2)


def test_a_wrong_chain_of_a_key_is_located():
    first = KEY["questions"][0]
    broken = {**first, "chain": {**CHAIN, "steps": [["h", "f*", "mm"]]}}
    with pytest.raises(KeyFileError, match=r"^key: question '1': chain: "):
        grade_paper({**KEY, "questions": [broken]}, {"1a": "1 mm"})


def test_an_own_value_without_a_unit_is_carried_in_that_of_the_chain():
    """A number asked in mm: 3.5 is 3.5 mm, which is 700 px of 5 µm."""
    first = KEY["questions"][0]
    bare = {"id": "1a", "points": "3", "spec": {"kind": "number", "value": "5/2", "of": ["h"]}}
    key = {**KEY, "questions": [{**first, "parts": [bare, first["parts"][1]]}]}
    assert [part.marks for part in grade_paper(key, {"1a": "3.5", "1b": "700"}).parts] == [0, 2]
