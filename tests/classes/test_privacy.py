"""What a class keeps of its students: closed to others, and gone when it is forgotten."""

from __future__ import annotations

import datetime as dt
import re
import shutil
import stat
import subprocess

import pytest
from made import made, run

from quizgen.classes import forgetting
from quizgen.classes.exam_details import describe_overdue

ROWS = [("4711001", "Ada Lovelace", "en"), ("4711002", "রহিমা খাতুন", "bn"), ("4711003", "Cem", "en")]
SENTENCE = "the lens of my brother Kemal"


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    root = tmp_path_factory.mktemp("class")
    folder = made(root, ROWS)
    (folder / "exam.toml").write_text('course = "Optics"\nkeep_until = 2027-03-31\n', "utf-8")
    table = f"id,1a,1b,2a,3a,3b\n4711001,5,6,7,3,{SENTENCE}\n4711002,1,2,3,4,{SENTENCE}\n4711003,4,9,1,2,so\n"
    (root / "in.csv").write_text(table, "utf-8")
    assert run("class", "mark", folder, root / "in.csv") == 0
    comment = ("--who", "Prof. Adler", "--comment", "Kemal again")
    assert run("class", "rule", folder, "points", "3b", "--student", "4711001", "--value", "0.5", *comment) == 0  # fmt: skip
    assert run("class", "rule", folder, "accept", "3b", "--answer", SENTENCE, "--value", "0.25", *comment) == 0  # fmt: skip
    assert run("class", "status", folder, "4711003", "sick") == 0
    assert run("class", "object", folder, "4711001", "1a", "Kemal said so") == 0
    assert run("class", "mark", folder) == 0
    assert run("class", "grade", folder, "--reports", "html,pdf") == 0
    return folder


@pytest.fixture
def folder(graded, tmp_path):
    return shutil.copytree(graded, tmp_path / "class")


def items(folder):
    assert run("class", "analyse", folder) == 0
    return (folder / "results" / "items.csv").read_text("utf-8-sig")


def codes(folder):
    return re.findall(r"G-(?:\w{4}-){3}\w{4}", (folder / "keys.jsonl").read_text("utf-8"))


def test_what_is_forgotten_is_in_no_file_and_statistics_are_as_they_were(folder, capsys):
    before, secret = items(folder), (folder / "class.toml").read_text("utf-8").split('"')[3]
    gone = [*(word for row in ROWS for word in row[:2]), *codes(folder), secret, "Kemal", "Adler"]
    assert len(codes(folder)) >= 3
    assert run("class", "forget", folder, "--yes") == 0
    assert "3 students forgotten" in capsys.readouterr().out
    assert items(folder) == before
    for path in (one for one in folder.rglob("*") if one.is_file()):
        text = path.read_bytes().decode("utf-8", "replace")
        assert not [word for word in gone if word in text], path
        assert not [word for word in gone if word in path.name], path
    assert {path.name for path in folder.iterdir()} <= {
        "class.toml", "exam.toml", "keys.jsonl", "marks", "results", "roster.csv", "rulings.csv", ".lock",
    }  # fmt: skip
    assert describe_overdue(folder, dt.date(2040, 1, 1)) == ""


def test_a_run_that_was_killed_in_between_is_run_again(folder, monkeypatch):
    before = items(folder)

    seen = []

    def killed(path, delete=forgetting.delete_path):
        delete(path)
        seen.append(path.name)
        if "class.toml" in seen:
            raise OSError(5, "no such disk")

    with monkeypatch.context() as dying:
        dying.setattr(forgetting, "delete_path", killed)
        assert run("class", "forget", folder, "--yes") != 0
    assert run("class", "forget", folder, "--yes") == 0
    assert items(folder) == before
    assert not (folder / "papers").exists()


def test_nothing_is_deleted_without_being_asked_for_twice(folder, tmp_path, capsys):
    assert run("class", "forget", folder) == 2
    assert "add --yes" in capsys.readouterr().err
    assert (folder / "papers").exists()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").write_text("mine", "utf-8")
    assert run("class", "forget", tmp_path / "other", "--yes") == 2
    assert (tmp_path / "other" / "thesis.txt").exists()


def test_no_papers_are_made_of_what_was_forgotten(folder, capsys):
    assert run("class", "forget", folder, "--yes") == 0
    assert run("class", "make", folder / "roster.csv", "--out", folder, "--jobs", 1) == 2
    assert "was forgotten" in capsys.readouterr().err


@pytest.mark.parametrize(("today", "said"), [((2027, 3, 31), False), ((2027, 4, 1), True)])
def test_a_folder_that_is_kept_too_long_is_named(folder, today, said):
    found = describe_overdue(folder, dt.date(*today))
    assert bool(found) == said
    assert not said or f"quizgen class forget {folder}" in found


def test_only_the_owner_looks_into_any_folder_or_file(folder):
    (folder / "results" / "later.txt").touch(0o644)
    assert run("class", "grade", folder, "--reports", "html") == 0
    modes = {path: stat.S_IMODE(path.stat().st_mode) for path in (folder, *folder.rglob("*"))}
    assert {mode for path, mode in modes.items() if path.is_dir()} == {0o700}
    assert {mode for path, mode in modes.items() if path.is_file()} == {0o600}


@pytest.mark.skipif(not shutil.which("pdftotext"), reason="reads PDF with poppler")
def test_markers_of_pages_read_codes_alone_where_that_is_wished(folder, tmp_path):
    about = folder / "exam.toml"
    about.write_text(about.read_text("utf-8") + "pseudonyms = true\n", "utf-8")
    assert run("class", "make", folder / "roster.csv", "--out", folder, "--jobs", 1) == 0
    done = subprocess.run(["pdftotext", folder / "papers" / "4711001.pdf", "-"], capture_output=True, check=True)  # fmt: skip
    cover, *pages = done.stdout.decode().split("\f")
    code = codes(folder)[0]
    assert "Ada Lovelace" in cover
    assert code in pages[0]
    assert not [page for page in pages if "Ada" in page or "4711001" in page]
    table = tmp_path / "points.csv"
    table.write_text(f"code,1a\n{code.lower()},1\n", "utf-8")
    assert run("class", "points", folder, table) == 0
    assert ",points,normalise-from-8-bit-range/a,,1,4711001," in (folder / "rulings.csv").read_text("utf-8")  # fmt: skip
