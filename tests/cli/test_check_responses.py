"""``quizgen check`` with the keys of an export: from a report to marks."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path

from inside import run

HERE = Path(__file__).parents[1] / "lms" / "moodle"
KEYS, GOOD = str(HERE / "quiz.keys.jsonl"), str(HERE / "responses.csv")


def test_a_line_for_each_attempt_and_each_question(tmp_path):
    done = run("check", KEYS, GOOD, cwd=tmp_path)
    assert done.returncode == 0
    people, questions = done.stdout.split("\n\n")
    assert [line.split("  ")[0] for line in people.splitlines()] == [
        "name",
        "Ada Lovelace",
        "Ben =1+1",
        "Cem Öz",
        "Cem Öz (2)",
    ]
    assert "14.25 / 31" in people
    assert len(questions.splitlines()) == 12
    assert done.stderr == f"quizgen: {GOOD}: line 2: Dana Sen: no attempt\n"


def test_the_documents_show_it(tmp_path):
    shown = run("check", KEYS, GOOD, cwd=tmp_path).stdout
    page = Path(__file__).parents[2] / "docs" / "export.md"
    assert f"```text\n{shown}```" in page.read_text(encoding="utf-8"), shown


def test_cells_are_inert_and_nothing_is_lost(tmp_path):
    done = run("check", KEYS, GOOD, "--csv", cwd=tmp_path)
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert rows[1]["1 question"] == "demosaic-at-border.4.en"
    assert (rows[1]["10 typed"], rows[1]["10 note"]) == ("১০", "trap:modulo-255")
    table = json.loads(run("check", KEYS, GOOD, "--json", cwd=tmp_path).stdout)
    assert [one["marks"] for one in table] == [27, 14.25, 0, 27]
    assert [float(row["marks"]) for row in rows] == [27, 14.25, 0, 27]


def test_a_name_that_is_a_formula(tmp_path):
    text = Path(GOOD).read_text(encoding="utf-8-sig").replace("=1+1,Ben", "Hax,=1+1")
    (tmp_path / "r.csv").write_text(text, encoding="utf-8")
    done = run("check", KEYS, "r.csv", "--csv", cwd=tmp_path)
    assert "'=1+1 Hax" in done.stdout


def test_a_file_that_cannot_be_read_stops_no_other(tmp_path):
    (tmp_path / "bad.csv").write_bytes(b"\xff\xfe\x00")
    done = run("check", KEYS, "bad.csv", GOOD, cwd=tmp_path)
    assert done.returncode == 1
    assert "Ada Lovelace" in done.stdout
    assert done.stderr.startswith("quizgen: bad.csv: not UTF-8 text")
    assert run("check", KEYS, "bad.csv", cwd=tmp_path).returncode == 2


def test_from_an_export_to_marks(tmp_path):
    """The file beside an export is nobody else's to read, and marks what comes back."""
    run("export", "moodle", "--template", "uint8-product", "--variants", "2", "--out", "u.xml",
        cwd=tmp_path)  # fmt: skip
    keys = tmp_path / "u.xml.keys.jsonl"
    assert keys.stat().st_mode & 0o777 == 0o600
    lines = [json.loads(line) for line in keys.read_text(encoding="utf-8").splitlines()[1:]]
    page = (tmp_path / "u.xml").read_text(encoding="utf-8")
    rows = ["Last name;First name;Question 1;Response 1"]
    for one in lines:
        mark = one["entries"][0]["mark"]
        assert page.count(f"[{mark}]") == 1
        right = one["question"]["parts"][0]["spec"]["value"]
        rows.append(f"Li;{one['id']};What is it? [{mark}];{right},0")
    (tmp_path / "r.csv").write_text("\n".join(rows), encoding="utf-8")
    done = run("check", "u.xml.keys.jsonl", "r.csv", "--json", cwd=tmp_path)
    assert [one["marks"] for one in json.loads(done.stdout)] == [2, 2]


def test_the_table_has_the_decimal_sign_of_the_language_chosen(tmp_path):
    table = run("check", KEYS, GOOD, "--lang", "de", cwd=tmp_path).stdout
    assert "14,25 / 31" in table
    assert not re.search(r"\d\.\d", table)
