"""What a hasty assistant does to the folder of a class: nothing is lost, and nothing goes unsaid."""

from __future__ import annotations

import csv
import json
import shutil

import pytest
from made import made, run

ROWS = [("A007", "Bond", "en"), ("0042", "Ada", "en"), ("43", "Ben", "bn")]


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    return made(tmp_path_factory.mktemp("class"), ROWS)


@pytest.fixture
def folder(printed, tmp_path):
    """A class of one's own to spoil."""
    return shutil.copytree(printed, tmp_path / "class")


def keys(folder):
    lines = (folder / "keys.jsonl").read_text("utf-8").splitlines()
    return {table["id"]: table for table in map(json.loads, lines)}


def handed_in(folder, rows, head=("id", "1a")):
    with (folder.parent / "in.csv").open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream).writerows([head, *rows])
    return run("class", "mark", folder, folder.parent / "in.csv")


def marked(folder):
    assert run("class", "grade", folder, "--reports", "none") == 0
    with (folder / "results/grades.csv").open(encoding="utf-8-sig", newline="") as stream:
        return {row["id"] for row in csv.DictReader(stream) if row["remark"] != "no answers"}


def test_capitals_of_an_id_make_no_difference_to_who_handed_in(folder):
    assert handed_in(folder, [("a007", "1"), (" 43 ", "1")]) == 0
    assert marked(folder) == {"A007", "43"}


def test_an_id_whose_zeros_a_spreadsheet_ate_is_not_guessed_but_named(folder, capsys):
    assert handed_in(folder, [("42", "1")]) == 1
    said = capsys.readouterr().out
    assert "nobody of this class has the number '42' (0042 has it but for zeros in front)" in said


def test_a_form_with_the_right_code_may_say_the_number_without_its_zeros(folder, capsys):
    form = {"code": keys(folder)["0042"]["code"], "student": {"matriculation": "42"}}
    path = folder.parent / "form.json"
    path.write_text(json.dumps({**form, "answers": {"1a": "1"}}), "utf-8")
    assert run("class", "mark", folder, path) == 0
    assert "not marked" not in capsys.readouterr().out
    assert marked(folder) == {"0042"}


def test_who_handed_in_and_is_no_longer_on_the_roster_is_named_with_the_grades(folder, capsys):
    assert handed_in(folder, [("A007", "1"), ("43", "1")]) == 0
    roster = folder / "roster.csv"
    roster.write_text(roster.read_text("utf-8-sig").replace("43,Ben", "044,Ben"), "utf-8")
    capsys.readouterr()
    assert marked(folder) == {"A007"}
    assert "43 handed in, but is not on the roster: no grade" in capsys.readouterr().out


def test_reports_without_names_do_not_stand_among_those_with_names(folder):
    """Who hands out the folder of the anonymous ones gives nobody's name away."""
    assert handed_in(folder, [("A007", "1")]) == 0
    assert run("class", "grade", folder) == 0
    assert run("class", "grade", folder, "--anonymous") == 0
    code = keys(folder)["A007"]["code"]
    found = sorted(path for path in (folder / "results").rglob("*.html"))
    assert [path.stem for path in found] == [code, "A007"]
    assert found[0].parent != found[1].parent
    assert "Bond" not in found[0].read_text("utf-8")
    assert "A007" not in found[0].read_text("utf-8")


def test_who_gets_another_language_after_printing_may_hand_in_the_first_paper(folder, capsys):
    """Both papers ask the same, so the key is the same but for its code."""
    first = keys(folder)["A007"]
    for lang in ("bn", "both"):
        roster = folder / "roster.csv"
        row = roster.read_text("utf-8-sig").splitlines()[1]
        other = ",".join([*row.split(",")[:2], lang, *row.split(",")[3:]])
        roster.write_text(roster.read_text("utf-8-sig").replace(row, other), "utf-8")
        assert run("class", "make", roster, "--out", folder, "--jobs", 1) == 0
    assert keys(folder)["A007"]["code"] != first["code"]
    assert (
        keys(folder)["A007"]["key"]["questions"][0]["parts"]
        == first["key"]["questions"][0]["parts"]
    )
    path = folder.parent / "form.json"
    form = {"code": first["code"], "paper": first["key"]["paper"], "answers": {"1a": "1"}}
    path.write_text(json.dumps(form), "utf-8")
    assert run("class", "code", folder, first["code"]) == 0
    assert run("class", "mark", folder, path) == 0
    assert "not marked" not in capsys.readouterr().out
    assert marked(folder) == {"A007"}


@pytest.mark.parametrize("spoilt", ['"value":"', '"points":"', '"unit":"'])
def test_a_key_that_somebody_edited_gives_no_marks(folder, capsys, spoilt):
    path = folder / "keys.jsonl"
    lines = path.read_text("utf-8").splitlines(keepends=True)
    at = next(at for at, line in enumerate(lines) if json.loads(line)["id"] == "43")
    assert spoilt in lines[at]
    whole, lines[at] = lines[at], lines[at].replace(spoilt, f"{spoilt}1", 1)
    path.write_text("".join(lines), "utf-8")
    code = json.loads(whole)["code"]
    assert run("class", "code", folder, code) == 2
    assert handed_in(folder, [("43", "1"), ("0042", "1")]) == 1
    assert "the key of 43 has been changed" in capsys.readouterr().out
    assert run("class", "grade", folder) == 1
    assert "43: key changed" in capsys.readouterr().out
    assert {path.stem for path in (folder / "results" / "reports").iterdir()} == {"0042"}
    del lines[at]
    path.write_text("".join(lines), "utf-8")
    assert run("class", "make", folder / "roster.csv", "--out", folder, "--jobs", 1) == 0
    assert whole in path.read_text("utf-8")
    assert run("class", "mark", folder) == 0
