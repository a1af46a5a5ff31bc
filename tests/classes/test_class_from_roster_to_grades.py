"""A class of thirty through files and commands alone; every mark is known beforehand.

More than a moment's work, because the papers of thirty students are typeset.
"""

from __future__ import annotations

import csv
import json
import random
import shutil
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from made import made, run
from simulated import SENTENCES, UNREADABLE, keys, truth

NAMES = [
    'Ada "the first" Lovelace',
    "=1+1",
    "-2",
    "@home",
    "রহিমা খাতুন",
    "مريم",
    "a/b\\c",
    "O'Neil, Jo",
]
TEXT = "blur-and-light-factors/b"
DROPPED, GIVEN, TRAPPED = (
    "normalise-from-8-bit-range/a",
    "blur-and-light-factors/d",
    "exposure-equivalence/b",
)
LATE, FOREIGN_OWN, TWICE, NOBODY = "1004", "1005", "1006", "1007"


@pytest.fixture(scope="module")
def there(tmp_path_factory):
    """The class with its papers, and what its students will hand in."""
    rows = [(str(1000 + n), NAMES[n % 8], ["en", "bn"][n % 3 == 1]) for n in range(30)]
    folder = made(tmp_path_factory.mktemp("class"), rows)
    chance = random.Random(7)
    return folder, {line["id"]: truth(line, chance) for line in keys(folder)}


def form(folder: Path, student, typed: dict[str, str], number: str) -> dict:
    return {"code": student.code, "student": {"matriculation": number}, "answers": typed}


@pytest.fixture(scope="module")
def marked(there, tmp_path_factory):
    """Handed in as forms and one table, with what goes wrong; marked once."""
    folder, students = there
    inbox = tmp_path_factory.mktemp("inbox")
    forms = ["1000", "1001", "1002", "1003", FOREIGN_OWN, TWICE]
    for one in forms:
        wrong_name = "1008" if one == FOREIGN_OWN else one
        table = form(folder, students[one], students[one].typed, wrong_name)
        (inbox / f"{one}.json").write_text(json.dumps(table), "utf-8")
    again = form(folder, students[TWICE], dict.fromkeys(students[TWICE].typed, "5"), TWICE)
    (inbox / f"{TWICE}-again.json").write_text(json.dumps(again), "utf-8")
    (inbox / "foreign.json").write_text(
        json.dumps({"code": "mock-1-en-abcdef", "answers": {"1": "2"}}), "utf-8"
    )
    (inbox / "photo.jpg").write_bytes(b"\xff\xd8\xff")
    (inbox / "torn.json").write_text('{"code": "G-', "utf-8")
    parts = [*students["1000"].typed]
    with (inbox / "rest.csv").open("w", encoding="utf-16", newline="") as stream:
        stream.write("sep=;\r\n")  # as spreadsheets are told which sign parts cells
        rows = csv.writer(stream, delimiter=";")
        rows.writerow(["id", "minutes", *parts])
        for one, student in students.items():
            if one not in {*forms, LATE, NOBODY}:
                rows.writerow([one, 12, *(student.typed[part] for part in parts)])
        rows.writerow(["9999", "", *("1" for _ in parts)])
    assert run("class", "mark", folder, *sorted(inbox.iterdir())) == 1
    assert run("class", "rule", folder, "use", f"{TWICE}.json", "--student", TWICE) == 0
    assert run("class", "mark", folder) == 1
    return folder, {one: s for one, s in students.items() if one not in {FOREIGN_OWN, LATE, NOBODY}}


def grades(folder: Path) -> dict[str, dict[str, str]]:
    assert run("class", "grade", folder, "--reports", "none") == 1, "some files are not marked"
    with (folder / "results" / "grades.csv").open(encoding="utf-8-sig", newline="") as stream:
        return {row["id"]: row for row in csv.DictReader(stream)}


def differences(folder: Path, expected: dict[str, dict[str, float | None]]) -> list[tuple]:
    """Where the table of grades says something else than the simulation knows."""
    table = grades(folder)
    return [
        (one, item, table[one][item], marks)
        for one, each in expected.items()
        for item, marks in each.items()
        if table[one][item] != ("" if marks is None else f"{marks:g}")
    ]


def known(students) -> dict[str, dict[str, float | None]]:
    return {one: dict(student.marks) for one, student in students.items()}


def test_every_mark_is_the_one_that_is_known(marked):
    folder, students = marked
    assert differences(folder, known(students)) == []
    table = grades(folder)
    assert {
        one for one, row in table.items() if row["remark"] == "maybe in what was not marked"
    } == {
        LATE,
        FOREIGN_OWN,
        NOBODY,
    }
    assert all(row["remark"] == "provisional" for one, row in table.items() if one in students)
    with (folder / "results" / "posted.csv").open(encoding="utf-8-sig", newline="") as stream:
        assert {row["remark"] for row in csv.DictReader(stream)} == {"provisional"}


def test_posted_grades_say_nothing_of_the_roster(marked):
    """Lines in the order of the roster would tell neighbours in it whose line is whose."""
    folder, _ = marked
    roster = [row["code"] for row in grades(folder).values()]
    with (folder / "results" / "posted.csv").open(encoding="utf-8-sig", newline="") as stream:
        rows = list(csv.DictReader(stream))
    codes = [row["code"] for row in rows]
    assert rows[0].keys() == {"code", "points", "grade", "remark"}
    assert codes == sorted(codes)
    assert codes != [code for code in roster if code in codes], "or the class is too small to tell"


def test_what_was_not_marked_is_named_with_its_reason(marked, capsys):
    folder, _ = marked
    capsys.readouterr()
    assert run("class", "mark", folder) == 1
    said = capsys.readouterr().out
    for piece in ("foreign.json: code mock-1-en-abcdef is of no paper", "photo.jpg: no form", "torn.json: ",
                  "9999", "1005's paper, but the number of 1008"):  # fmt: skip
        assert piece in said
    assert "changed:" not in said
    assert len(list((folder / "marks").iterdir())) == 2


def queue(folder: Path) -> tuple[list[str], list[dict[str, str]]]:
    with (folder / "decisions.csv").open(encoding="utf-8-sig", newline="") as stream:
        found = csv.DictReader(stream)
        return list(found.fieldnames or ()), list(found)


@pytest.fixture(scope="module")
def decided(marked, tmp_path_factory):
    """Sentences and what could not be read, decided in the spreadsheet by the first row of each group."""
    students = marked[1]
    folder = shutil.copytree(marked[0], tmp_path_factory.mktemp("decided") / "class")
    head, rows = queue(folder)
    sentences = [row for row in rows if row["item"] == TEXT]
    # with and without capitals and signs is one answer, a comma more is similar: one group
    assert sum(SENTENCES[row["answer"]] == 1.0 for row in sentences) == len(
        {r["answer"] for r in sentences} & {s for s, p in SENTENCES.items() if p == 1.0}
    )
    assert len({row["together"] for row in sentences}) == 3
    seen = set()
    for row in rows:
        if row["together"] not in seen:
            row["points"] = f"{SENTENCES[row['answer']]:g}" if row["item"] == TEXT else "0"
            row["second"] = "1" if row["item"] == TEXT else "0"
            row["who"], row["comment"] = "=AM", "see the notes"
        seen.add(row["together"])
    with (folder / "decisions.csv").open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, head, delimiter=";")
        writer.writeheader()
        writer.writerows(rows)
    assert run("class", "mark", folder) == 1, "still not marked: what was not before"
    expected = known(students)
    for one, student in students.items():
        for item, marks in student.marks.items():
            if marks is None:
                typed = (
                    next(t for part, t in student.typed.items() if part.endswith("3b"))
                    if item == TEXT
                    else UNREADABLE
                )
                expected[one][item] = SENTENCES.get(typed, 0.0)
    return folder, students, expected


def test_one_decision_settles_a_group(decided):
    folder, _, expected = decided
    assert differences(folder, expected) == []
    assert queue(folder)[1] == []
    assert all(row["remark"] == "" for one, row in grades(folder).items() if one in expected)


def test_regrading_names_who_changes_and_keeps_every_mark(decided, capsys):
    folder, students, expected = decided
    name = next(t for s in students.values() for i, t in s.trapped.items() if i == TRAPPED)
    lines = [
        ("drop", DROPPED, "--value", "always"), ("give", GIVEN),
        ("accept", TRAPPED, "--answer", f"trap:{name}", "--value", "0.5", "--who", "AM"),
    ]  # fmt: skip
    for line in lines:
        assert run("class", "rule", folder, *line) == 0
    capsys.readouterr()
    before = (folder / "rulings.csv").read_bytes()
    assert run("class", "rule", folder, "accept", TRAPPED, "--answer", "trap:zzz") == 2
    said = capsys.readouterr().err
    assert "no mistake 'zzz'" in said
    assert name in said
    assert (folder / "rulings.csv").read_bytes() == before
    assert run("class", "mark", folder) == 1
    said = capsys.readouterr().out
    after = {one: dict(each) for one, each in expected.items()}
    for one, student in students.items():
        after[one][DROPPED] = 0.0
        after[one][GIVEN] = student.points[GIVEN]
        if student.trapped.get(TRAPPED) == name:
            after[one][TRAPPED] = 0.5
    assert differences(folder, after) == []
    table = grades(folder)
    assert all(row["of"] == "11" for one, row in table.items() if one in students)
    with (folder / "changes.csv").open(encoding="utf-8", newline="") as stream:
        changed = {(r["student"], r["item"]) for r in csv.DictReader(stream) if r["run"] == "4"}
    expected_changes = {
        (one, item)
        for one, student in students.items()
        for item in (DROPPED, GIVEN, TRAPPED)
        if after[one][item] != expected[one][item] or item == DROPPED
    }
    assert changed == expected_changes
    assert f"{len(changed)} marks changed" in said
    for what, item in (("restore", DROPPED), ("restore", GIVEN), ("restore", TRAPPED)):
        assert run("class", "rule", folder, what, item) == 0
    assert run("class", "mark", folder) == 1
    assert differences(folder, expected) == []
    one = next(iter(students))
    capsys.readouterr()
    assert run("class", "history", folder, one) == 0
    story = capsys.readouterr().out
    assert [f"Run {number:03}" in story for number in (1, 4, 5)] == [True] * 3
    assert "drop (" in story


def test_students_get_a_report_and_nobody_a_formula(decided):
    folder, students, _ = decided
    assert run("class", "grade", folder, "--reports", "html,pdf") == 1
    reports = folder / "results" / "reports"
    assert len(list(reports.glob("*.pdf"))) == len(list(reports.glob("*.html"))) == len(students)
    page = (reports / "1000.html").read_text("utf-8")
    assert "Ada &#34;the first&#34; Lovelace" in page
    assert "see the notes" in page
    assert "The aperture is the base of the light cone" in page, "the model answer"
    assert "decide yourself" not in page
    assert 'lang="bn"' in (reports / "1001.html").read_text("utf-8")
    with (folder / "results" / "grades.csv").open(encoding="utf-8-sig", newline="") as stream:
        cells = [cell for row in csv.reader(stream) for cell in row]
    assert not [cell for cell in cells if cell[:1] in {"=", "+", "@"} or cell == "-2"]
    with zipfile.ZipFile(folder / "results" / "grades.xlsx") as book:
        sheet = ET.fromstring(book.read("xl/worksheets/sheet1.xml"))
        words = book.read("xl/sharedStrings.xml").decode()
    assert not [node for node in sheet.iter() if node.tag.endswith("}f")]
    assert "=1+1" in words


def test_reports_can_do_without_names(decided, tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(decided[0], folder)
    shutil.rmtree(folder / "results", ignore_errors=True)
    assert run("class", "grade", folder, "--anonymous") == 1
    pages = list((folder / "results" / "anonymous").glob("*.html"))
    assert {page.stem for page in pages} == {student.code for student in decided[1].values()}
    assert not [
        p for p in pages if any(n in p.read_text("utf-8") for n in ("Lovelace", "রহিমা", "1001"))
    ]


def test_the_analysis_shows_the_class(decided, capsys):
    folder, students, _ = decided
    capsys.readouterr()
    assert run("class", "analyse", folder) == 0
    page = (folder / "results" / "analysis.html").read_text("utf-8")
    assert f"{len(students)} students" in capsys.readouterr().out
    assert "Cohen&#39;s kappa" in page or "Cohen's kappa" in page
    assert "12 minutes (median)" in page
    assert page.count("<svg") >= 2
    assert '"QuizText", "QuizBangla", system-ui' in page[: page.index("</style>")]


def test_what_is_wrong_in_a_file_is_named_and_changes_nothing(decided, tmp_path, capsys):
    folder = tmp_path / "copy"
    shutil.copytree(decided[0], folder)
    before = sorted(path.name for path in (folder / "marks").iterdir())
    with (folder / "rulings.csv").open("a", encoding="utf-8") as stream:
        stream.write("2026-11-22,AM,drop,no-such-item,,,,,\n")
    assert run("class", "mark", folder) == 2
    assert "no-such-item" in capsys.readouterr().err
    assert sorted(path.name for path in (folder / "marks").iterdir()) == before
