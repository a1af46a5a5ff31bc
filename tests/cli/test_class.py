"""``quizgen class``: from a roster to a folder, and what it refuses."""

from __future__ import annotations

import json

import pytest
from inside import run

ROSTER = "Nummer;Name\n104;Ada\n=1+1;@Bo\n"
ONE = '[title]\nen = "One"\n[[slot]]\ntemplates = ["rods-cones-and-peaks"]\n'
MAKE = ("class", "make", "roster.csv", "--out", "midterm")
FIRST = (*MAKE, "--blueprint", "one.toml", "--columns", "id=Nummer,name=Name")


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    folder = tmp_path_factory.mktemp("home")
    (folder / "roster.csv").write_text(ROSTER, encoding="utf-8")
    (folder / "one.toml").write_text(ONE, encoding="utf-8")
    done = run(*FIRST, cwd=folder)
    assert done.returncode == 0, done.stderr
    assert "midterm: 2 papers made, 0 kept as they were" in done.stdout
    assert "Each of them: 1 of tier " in done.stdout
    return folder


def codes(home):
    lines = (home / "midterm/keys.jsonl").read_text(encoding="utf-8").splitlines()
    return {one["id"]: one["code"] for one in map(json.loads, lines)}


def test_a_second_run_knows_what_the_class_was_made_with(home):
    done = run(*MAKE, "--columns", "id=Nummer,name=Name", cwd=home)
    assert "0 papers made, 2 kept as they were" in done.stdout
    assert "'=1+1,'@Bo," in (home / "midterm/roster.csv").read_text(encoding="utf-8-sig")


def test_a_printed_code_leads_to_its_student(home):
    found = codes(home)
    assert (
        run("class", "code", "midterm", found["104"], cwd=home).stdout == f"{found['104']}: 104\n"
    )
    wrong = run("class", "code", "midterm", "G-0000-0000-0000-0000", cwd=home)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert "no paper of this class" in wrong.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((*FIRST[:-4], "--blueprint", "trial", *FIRST[-2:]), "another blueprint"),
        ((*FIRST, "--lang", "bn"), "was made with lang 'en', not 'bn'"),
        ((*FIRST, "--vary"), "was made without --vary"),
        ((*MAKE[:3], "--out", ".", *FIRST[-2:]), "something else than a class"),
        (MAKE, "has no column 'id' (it has Nummer, Name)"),
        ((*MAKE, "--columns", "Nummer"), "write id=Matrikel"),
        (("class", "code", ".", "G-1"), "is not the folder of a class"),
    ],
)
def test_what_would_spoil_a_class_is_refused(home, words, said):
    before = sorted((str(p), p.stat().st_mtime_ns) for p in (home / "midterm").rglob("*"))
    done = run(*words, cwd=home)
    assert done.returncode == 2
    assert said in " ".join(done.stderr.split())
    assert sorted((str(p), p.stat().st_mtime_ns) for p in (home / "midterm").rglob("*")) == before


def test_a_graded_code_makes_no_paper(home):
    done = run("exam", "--code", codes(home)["104"], cwd=home)
    assert done.returncode == 2
    assert "is the code of a graded paper" in done.stderr
    assert not (home / "exam").exists()
