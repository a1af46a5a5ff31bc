"""What comes back under odd names, twice, or not at all: nothing of it is lost without a word."""

from __future__ import annotations

import csv
import json
import shutil
import zipfile

import pytest
from made import made, run
from sweep import together

from quizgen.classes.part_names import PartNames

ROWS = [("101", "Ada", "en"), ("102", "Ben", "en"), ("103", "Cem", "en")]
PARTS = ["1a", "1b", "2a", "2b", "2c", "3a", "3b", "3c", "3d", "3e"]


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    return made(tmp_path_factory.mktemp("class"), ROWS)


@pytest.fixture
def folder(printed, tmp_path):
    return shutil.copytree(printed, tmp_path / "class")


def mark(folder, text, name="in.csv"):
    path = folder.parent / name
    path.write_text(text, "utf-8")
    return run("class", "mark", folder, path)


def typed(folder, student="101"):
    """What the marks of a student are made from, part by part."""
    last = {}
    for path in sorted((folder / "marks").glob("*.jsonl")):
        for line in path.read_text("utf-8").splitlines():
            found = json.loads(line)
            last[found["student"]] = {
                one["id"]: one["typed"] for one in found["parts"] if one["typed"]
            }
    return last.get(student, {})


def form(folder, student, answers):
    lines = (folder / "keys.jsonl").read_text("utf-8").splitlines()
    code = next(json.loads(one)["code"] for one in lines if json.loads(one)["id"] == student)
    return json.dumps({"code": code, "answers": answers})


@together(("name", "part"), [
    ("7a", "7a"), ("7A", "7a"), ("Q7a", "7a"), ("Frage 7 b", "7b"), ("question 7.B", "7b"), ("7 (c)", "7c"), ("Aufgabe 7c)", "7c"),
    ("07a", "7a"), ("৭a", "7a"), ("13", "13"), ("13a", "13"), ("Q13.", "13"), ("13b", ""), ("7", ""), ("7d", ""), ("99z", ""), ("", ""),
    ("Bemerkung", ""), ("7aa", ""), ("x7a", ""), ("9" * 5000, ""),
])  # fmt: skip
def test_a_part_is_found_by_any_name_that_can_mean_no_other(name, part):
    assert PartNames(["7a", "7b", "7c", "13"]).find(name) == part


def test_answers_under_odd_names_arrive(folder):
    assert mark(folder, "id,part,answer\n101,Q1a,5\n101,1 B,6\n101,Frage 2a,7\n") == 0
    assert typed(folder) == {"1a": "5", "1b": "6", "2a": "7"}
    assert mark(folder, form(folder, "102", {"Q3A": "x", "3 b": "y"}), "f.json") == 0
    assert typed(folder, "102") == {"3a": "x", "3b": "y"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("id,part,answer\n101,1a,5\n101,99z,x\n", "paper of 101 has no part 99z (it has 1a to 3e)"),
        ("id,1a,99z\n101,5,x\n102,5,\n", "column '99z' is no part of the papers"),
        ("id,1a,Q1A\n101,5,\n", "1a and Q1A are both part 1a"),
        ("id,1a,1a\n101,5,6\n", "two columns are called '1a'"),
        ("id,1a,\n101,5,6\n", "line 2: something stands in a column without a name"),
        ("id,1a\n101,5,6\n", "line 2: more cells than columns"),
        ("id,1a\n101,\n", "101: nothing is filled in in.csv"),
        ("id,1a\n101,#NAME?\n", "line 2: 1a is #NAME?: a spreadsheet has made something else of"),
        ("MatNo,1a\n101,5\n", "no column is called 'id' (or Matrikelnummer, student number, ...)"),
        ("", "is empty"),
        ("id,1a\n101,5\n101,6\n", "line 3: 101 has other answers in line 2, which count"),
    ],
)
def test_what_could_be_lost_is_named_and_ends_with_a_failure(folder, capsys, text, said):
    assert mark(folder, text) == 1
    assert said in " ".join(capsys.readouterr().out.split())


def test_a_column_of_remarks_is_left_out_where_its_name_says_so(folder):
    assert mark(folder, "id,Nachname,Raum,1a,#Bemerkung,\n101,Ada,HS1,5,was late,\n") == 0
    assert typed(folder) == {"1a": "5"}


def test_every_run_says_how_much_was_filled_in(folder, capsys):
    whole = ",".join("5" for _ in PARTS)
    assert mark(folder, f"id,{','.join(PARTS)}\n101,5,,6,,,,,,,\n102,{whole}\n") == 0
    said = capsys.readouterr().out
    assert "101: 2 of 10 parts filled\n1 student: all parts filled\n" in said


def test_blank_paper_counts_only_of_those_who_are_said_to_have_been_there(folder):
    assert mark(folder, "id,1a\n101,\n102,5\n") == 1
    assert grades(folder) == {
        "101": ("", "absent"),
        "102": ("5.0", "present"),
        "103": ("", "absent"),
    }
    assert run("class", "status", folder, "101", "present") == 0
    assert run("class", "mark", folder) == 0
    assert grades(folder)["101"] == ("5.0", "present")


def grades(folder):
    run("class", "grade", folder, "--reports", "none")
    with (folder / "results/grades.csv").open(encoding="utf-8-sig", newline="") as stream:
        return {row["id"]: (row["grade"], row["status"]) for row in csv.DictReader(stream)}


def test_what_was_marked_stays_until_somebody_says_otherwise(folder, capsys):
    """A code can be read from a neighbour's desk: a second hand-in replaces nothing."""
    assert mark(folder, form(folder, "101", {"1a": "5"}), "101.json") == 0
    assert mark(folder, form(folder, "101", {"1a": "6"}), "0late.json") == 1
    assert typed(folder) == {"1a": "5"}
    said = capsys.readouterr().out
    assert (
        "101: 0late.json (1 part filled) does not count\n101: 101.json (1 part filled) counts"
        in said
    )
    assert "mark changed" not in said
    with (folder / "conflicts.csv").open(encoding="utf-8-sig", newline="") as stream:
        assert [row["counts"] for row in csv.DictReader(stream)] == ["no", "yes"]
    assert run("class", "rule", folder, "use", "0late.json", "--student", "101") == 0
    assert run("class", "mark", folder) == 0
    assert typed(folder) == {"1a": "6"}
    assert not (folder / "conflicts.csv").exists()


def test_of_two_that_came_at_once_neither_counts_and_no_grade_goes_out(folder, capsys):
    for name, answer in (("a.json", "5"), ("b.json", "6")):
        (folder / "answers").mkdir(exist_ok=True)
        (folder / "answers" / name).write_text(form(folder, "101", {"1a": answer}), "utf-8")
    assert mark(folder, "id,1a\n102,5\n") == 1
    assert typed(folder) == {}
    capsys.readouterr()
    assert run("class", "grade", folder, "--reports", "none") == 1
    assert "101: answers differ" in capsys.readouterr().out


def test_nobody_is_called_absent_while_a_file_waits_that_may_be_theirs(folder, capsys):
    assert mark(folder, "id,1a\n101,5\n") == 0
    assert mark(folder, "id,9z\n102,5\n", "odd.csv") == 1
    assert grades(folder) == {
        "101": ("5.0", "present"),
        "102": ("", "absent"),
        "103": ("", "absent"),
    }
    assert "102: maybe in what was not marked" in capsys.readouterr().out
    office = (folder / "results" / "office.csv").read_text("utf-8-sig")
    assert "absent" not in office
    assert run("class", "status", folder, "103", "absent") == 0
    (folder / "answers" / "odd.csv").unlink()
    assert run("class", "mark", folder) == 0
    assert run("class", "grade", folder, "--reports", "none") == 0
    assert (folder / "results" / "office.csv").read_text("utf-8-sig").count("absent") == 2


def test_a_report_from_before_is_gone_where_there_is_no_grade_any_more(folder):
    assert mark(folder, "id,1a\n101,5\n102,5\n") == 0
    assert run("class", "grade", folder, "--reports", "html,pdf") == 0
    assert run("class", "status", folder, "101", "sick") == 0
    assert run("class", "grade", folder) == 0
    names = {path.name for path in (folder / "results" / "reports").iterdir()}
    assert names == {"102.html", "102.pdf"}


def test_the_same_answers_again_are_no_conflict(folder):
    assert mark(folder, "id,1a\n101,5\n") == 0
    assert mark(folder, form(folder, "101", {"1a": " 5 ", "1b": ""}), "again.json") == 0


def test_points_for_working_come_from_a_table(folder, capsys):
    table = folder.parent / "points.csv"
    assert mark(folder, "id,1a\n101,\n102,5\n103,5\n") == 1
    assert run("class", "status", folder, "101", "present") == 0
    for cells, said in (("9", "line 2: value: 9 points of 1"), ("1.1", "quarters"), ("x", "value"),
                        ("1\n101;0.5", "line 3: 101 stands in line 2, too")):  # fmt: skip
        table.write_text(f"id;Q1a\n101;{cells}\n", "utf-8")
        assert run("class", "points", folder, table) == 2
        assert said in capsys.readouterr().err
    assert not (folder / "rulings.csv").exists()
    table.write_text("id;Q1a;3b\n101;0,75;\n102;;0,5\n", "utf-8")
    assert run("class", "points", folder, table, "--who", "AM") == 0
    assert run("class", "mark", folder) == 0
    assert run("class", "history", folder, "101") == 0
    assert "0.75 / 1, blank, points (AM)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("give", "1a", "--value", "0.75"), "give takes none"),
        (("points", "1a", "--student", "101", "--value", "10"), "10 points of 1"),
        (("points", "1a", "--student", "999", "--value", "1"), "nobody of this class"),
        (("accept", "1a", "--answer", "5", "--value", "10"), "10 points of 1"),
        (("drop", "9z"), "no part '9z'"),
        (("use", "nothing.csv", "--student", "101"), "no file 'nothing.csv'"),
        (("use", "../roster.csv", "--student", "101"), "no file '../roster.csv'"),
        (("tolerance", "3b", "--value", "rel=0.1"), "no tolerance holds there"),
    ],
)
def test_a_ruling_that_cannot_be_is_refused_when_it_is_given(folder, capsys, words, said):
    assert run("class", "rule", folder, *words) == 2
    assert said in " ".join(capsys.readouterr().err.split())
    assert not (folder / "rulings.csv").exists()


def test_who_loses_or_gains_a_grade_is_said_before_all_other_changes(folder, capsys):
    with (folder / "scale.toml").open("w", encoding="utf-8") as stream:
        stream.write("passed = 5\nbest = 90\n")
    assert mark(folder, "id,1a\n101,5\n102,5\n") == 0
    assert run("class", "rule", folder, "points", "2b", "--student", "102", "--value", "2") == 0
    capsys.readouterr()
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    assert run("class", "mark", folder, "--try") == 0
    assert "1 grade changed:\n102: 5.0 -> " in capsys.readouterr().out
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before
    assert run("class", "mark", folder) == 0
    said = capsys.readouterr().out
    assert said.index("1 grade changed:\n102: 5.0 -> ") < said.index("1 mark changed:")


def test_a_table_to_type_into_is_marked_as_it_was_typed(folder, tmp_path):
    """Cells are text already: a spreadsheet would make the first of February of 1/2."""
    out = tmp_path / "typed.xlsx"
    assert run("class", "table", folder, out) == 0
    assert run("class", "table", folder, out) == 2, "what was typed is not written over"
    with zipfile.ZipFile(out) as book:
        names = book.namelist()
        contents = {name: book.read(name).decode() for name in names}
    sheet = "xl/worksheets/sheet1.xml"
    cell = '<c r="D2" s="2" t="inlineStr"><is><t>1/2</t></is></c>'
    assert 'numFmtId="49"' in contents["xl/styles.xml"]
    contents[sheet] = contents[sheet].replace("</row>", f"{cell}</row>", 2).replace(cell, "", 1)
    with zipfile.ZipFile(tmp_path / "filled.xlsx", "w") as book:
        for name in names:
            book.writestr(name, contents[name])
    assert run("class", "mark", folder, tmp_path / "filled.xlsx") == 1, "two are blank"
    assert typed(folder) == {"1a": "1/2"}


@pytest.mark.parametrize(
    "words",
    ["mark", "lists", "inspect", "object", "grade", "analyse", "forget --yes", "redraw . 1", "table . x.xlsx",
     "status . 101 sick", "points . x.csv", "rule . drop 1a"],
)  # fmt: skip
def test_a_folder_that_is_none_of_a_class_is_said_to_be_none(tmp_path, capsys, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.csv").write_text("id,1a\n", "utf-8")
    name, *rest = words.split()
    assert run("class", name, *(rest if "." in rest else [".", *rest])) == 2
    said = capsys.readouterr().err
    assert "is not the folder of a class" in said or "nothing has been marked yet" in said
    assert [path.name for path in tmp_path.iterdir()] == ["x.csv"]
