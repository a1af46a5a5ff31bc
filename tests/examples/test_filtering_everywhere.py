"""The second bank wherever the first one goes: paper, cards, terminal, page, exports, class."""

from __future__ import annotations

import io
import json
import re
import sqlite3
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import pikepdf
import pytest
from click.testing import CliRunner
from starlette.testclient import TestClient

from quizgen.bank.bank import Bank
from quizgen.bank.combined import open_banks
from quizgen.cli import practice
from quizgen.cli.main import root_group
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

ROOT = Path(__file__).parent.parent.parent / "examples" / "filtering"
FEW = """
title.en = "Filters"
title.de = "Filter"
[[slot]]
templates = ["count-components"]
[[slot]]
templates = ["cost-of-separable-filter"]
"""
PICTURES = "image-acquisition"


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.setattr(practice, "state_folder", lambda: tmp_path / "state")
    Path("few.toml").write_text(FEW, "utf-8")
    Path("roster.csv").write_text("id,name\nS1,A. Student\n", "utf-8")
    return tmp_path


def run(*words, typed: str | None = None, banks=(ROOT,)):
    named = [part for bank in banks for part in ("--bank", str(bank))]
    done = CliRunner().invoke(root_group, [*map(str, words), *named, "--trust"], input=typed)
    assert done.exit_code == 0, (done.output, done.exception)
    return done.output


@pytest.mark.parametrize(
    ("lang", "said"),
    [("en", "What a separable filter saves"), ("de", "Was ein separierbares Filter spart")],
)
def test_a_paper_in_each_language(here, lang, said):
    run("exam", "--blueprint", "few.toml", "--seed", "1", "--lang", lang, "--out", lang)
    page = Path(lang, "exam.html").read_text("utf-8")
    assert f'lang="{lang}"' in page
    assert said in page
    assert page.count("<svg") >= 1
    for kind in ("exam", "solutions"):
        pdf = pikepdf.open(Path(lang, f"{kind}.pdf"))
        assert str(pdf.Root.Lang).startswith(lang)
        assert len(pdf.pages) >= 1
    told = run("check", f"{lang}/key.json", f"{lang}/answers.toml")
    assert re.search(r"0 / \d", told)


def test_cards(here):
    run("cards", "--topic", "binary", "--lang", "both", "--format", "apkg,csv", "--out", "cards")
    assert "Komponente" in Path("cards/quizgen.csv").read_text("utf-8")
    with zipfile.ZipFile("cards/quizgen.apkg") as package:
        name = next(name for name in package.namelist() if name.startswith("collection"))
        Path("notes.db").write_bytes(package.read(name))
    with sqlite3.connect("notes.db") as notes:
        kinds = notes.execute("select tags from notes").fetchall()
    assert len(kinds) == 4
    assert all("quizgen::lang::de quizgen::lang::en" in tags for (tags,) in kinds)


def test_a_session_in_the_terminal(here):
    """Otsu on a histogram of 90, 10, 5 and 20 pixels: 0.8 of them are dark, with mean 0.1."""
    words = ("practice", "--topic", "histogram", "--lang", "de", "--count", "1", "--seed", "s")
    told = run(*words, "--database", "sqlite:///p.sqlite3", typed="-77\n1,166\nB\n")
    assert "90, 10, 5" in told
    assert told.count("Nicht richtig.") == 1
    assert len(re.findall(r"^.*(?<!Nicht )Richtig\.", told, re.MULTILINE)) == 2
    assert "Histogramme: 1 von 2 Teilen auf Anhieb richtig" in told


@pytest.mark.parametrize("target", ["moodle", "canvas", "qti21", "qti3"])
def test_an_export(here, target):
    run("export", target, "--blueprint", "few.toml", "--variants", "2", "--lang", "de",
        "--out", "out")  # fmt: skip
    data = Path("out").read_bytes()
    if target == "moodle":
        assert len(ET.fromstring(data).findall("question")) >= 4
    else:
        with zipfile.ZipFile(io.BytesIO(data)) as package:
            items = [ET.fromstring(package.read(one)) for one in package.namelist()
                     if one.endswith(".xml")]  # fmt: skip
        assert len(items) >= 2
    assert len(Path("out.keys.jsonl").read_text("utf-8").splitlines()) >= 4


def test_a_preview(here):
    assert "Answer:" in run("preview", "sobel-gradient")
    quiz = run("preview", "sobel-gradient", "--quiz", "--html", "quiz.html", "--lang", "de")
    assert quiz == "quiz.html\n"
    assert "<svg" in Path("quiz.html").read_text("utf-8")


@pytest.mark.parametrize("banks", [(ROOT,), (PICTURES, ROOT)])
def test_a_class_of_one(here, banks):
    run("class", "make", "roster.csv", "--out", "class", "--blueprint", "few.toml", "--jobs", "1",
        banks=banks)  # fmt: skip
    (line,) = Path("class/keys.jsonl").read_text("utf-8").splitlines()
    assert {one["template"] for one in json.loads(line)["key"]["questions"]} == {
        "count-components", "cost-of-separable-filter",
    }  # fmt: skip
    assert len(list(Path("class/papers").glob("*.pdf"))) == 1


@pytest.mark.parametrize(
    "bank", [Bank(ROOT, trusted=True), open_banks([("", True), (str(ROOT), True)])]
)
def test_the_first_question_in_the_browser(here, bank, jobs_in_this_process):
    app = create_app(ServerSettings("sqlite:///l.sqlite3", bank, workers=1))
    with TestClient(app, "http://127.0.0.1:8000") as client:
        key = app.state.site.settings.token
        assert "Binary pictures" in client.get(f"/enter?key={key}").text
        wish = {"template": "count-components", "token": csrf_token(client.cookies[COOKIE])}
        page = client.post("/practice", data=wish)
        assert page.status_code == 200
        assert "<svg" in page.text
        assert "Mock exam: Filtering" in client.get("/exam").text


def test_a_paper_mixed_with_the_built_in_bank(here):
    both = (PICTURES, ROOT)
    told = run("exam", "--minutes", "30", "--seed", "2", "--format", "html", "--out", "mixed",
               banks=both)  # fmt: skip
    assert "--bank image-acquisition --bank" in told
    key = json.loads(Path("mixed/key.json").read_text("utf-8"))
    assert [one["name"] for one in key["banks"]] == [PICTURES, "filtering"]
    assert "Mock exam: Image Acquisition + Filtering" in Path("mixed/exam.html").read_text("utf-8")
    code = key["code"]
    run("exam", "--code", code, "--format", "html", "--out", "again", banks=both)
    assert Path("again/key.json").read_bytes() == Path("mixed/key.json").read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("lang", ["en", "de"])
def test_every_question_everywhere(here, lang):
    for target in ("moodle", "qti3"):
        run("export", target, "--variants", "3", "--lang", lang, "--out", target)
    run("cards", "--lang", lang, "--out", "cards")
    run("exam", "--topic", "all", "--lang", lang, "--seed", "1", "--out", "all")
    mixed = run("exam", "--topic", "all", "--lang", "en", "--format", "html", "--seed", "1",
                "--out", "mixed", banks=(PICTURES, ROOT))  # fmt: skip
    assert "questions" in mixed
