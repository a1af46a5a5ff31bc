"""Marking from files: one bad form stops no other, and what does not belong together is told."""

from __future__ import annotations

import csv
import io
import json

import pytest
from click.testing import CliRunner

from quizgen.cli.check import check
from quizgen.paper.answer_form import write_blank_form
from quizgen.paper.answer_key import FORMAT, AnswerKey, KeyPart, KeyQuestion, write_answer_key
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.grade_report import result_rows
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import build_paper


@pytest.fixture
def folder(bank, tmp_path):
    paper = build_paper(bank, load_blueprint("trial"), 4, "en", figures=False)
    (tmp_path / "key.json").write_bytes(write_answer_key(paper))
    (tmp_path / "answers.toml").write_bytes(write_blank_form(paper))
    return tmp_path


def marked(folder, *names, options=()):
    paths = [str(folder / name) for name in ("key.json", *names)]
    return CliRunner().invoke(check, [*paths, *options])


BAD = {
    "empty.toml": b"",
    "broken.toml": b"[answers\n",
    "latin.toml": '[answers]\n"1" = "\u00e4"\n'.encode("latin-1"),
    "other.toml": b'code = "trial-5-en-000000"\n[answers]\n',
    "escape.toml": b'code = "\\u001b]0;pwned\\u0007"\n[answers]\n',
    "deep.json": b'{"answers":' + b"[" * 100_000,
    "huge.toml": b'[answers]\n"1a" = 0x' + b"f" * 5000 + b"\n",
    "missing.toml": None,
}


def test_one_bad_form_stops_no_other(folder):
    form = (folder / "answers.toml").read_text()
    for name in ("ada.toml", "ben.toml"):
        (folder / name).write_text(form.replace('name = ""', f'name = "{name[:3]}"', 1))
    for name, data in BAD.items():
        if data is not None:
            (folder / name).write_bytes(data)
    done = marked(folder, "ada.toml", *BAD, "ben.toml")
    assert done.exit_code == 1
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert [row["name"] for row in rows] == ["ada", "ben"]
    lines = done.stderr.splitlines()
    assert [line.split(":")[0] for line in lines] == ["quizgen"] * len(BAD)
    for name, line in zip(BAD, lines, strict=True):
        assert name in line
    assert "\x1b" not in done.stderr


def test_the_table_of_a_class_knows_the_student_of_every_form(folder):
    code = json.loads((folder / "key.json").read_text())["code"]
    form = (folder / "answers.toml").read_text()
    (folder / "ada.toml").write_text(
        form.replace('name = ""', 'name = "Ada"').replace('lation = ""', "lation = 4711", 1)
    )
    page = {"code": code, "student": {"name": "Ben", "matriculation": "0815"}, "answers": {}}
    (folder / "ben.json").write_text(json.dumps(page))
    (folder / "cem.csv").write_text("part;answer\nname;Cem\nmatriculation;=1+1\n")
    done = marked(folder, "ada.toml", "ben.json", "cem.csv")
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    found = [(row["name"], row["matriculation"]) for row in rows]
    assert found == [("Ada", "4711"), ("Ben", "0815"), ("Cem", "'=1+1")]
    (one, *_) = json.loads(marked(folder, "ben.json", "cem.csv", options=["--json"]).stdout)
    assert one["matriculation"] == "0815"


@pytest.mark.parametrize(
    ("lang", "count", "said"),
    [("en", 1, "1 answer could not be read as meant. Correct it"),
     ("en", 2, "2 answers could not be read as meant. Correct them"),
     ("bn", 1, "1টা উত্তর পড়া যায়নি"), ("bn", 2, "2টা উত্তর পড়া যায়নি")],
)  # fmt: skip
def test_answers_that_are_asked_back_are_counted_in_words(folder, lang, count, said):
    form = {"answers": dict.fromkeys(["2", "5"][:count], "3 +* (")}
    (folder / "form.json").write_text(json.dumps(form))
    assert said in marked(folder, "form.json", options=["--lang", lang]).stdout


def test_a_form_in_the_place_of_the_key_is_told(folder):
    paths = [str(folder / name) for name in ("answers.toml", "key.json")]
    said = str(CliRunner().invoke(check, paths).exception)
    assert "this is a form; the key comes first" in said


def test_only_bad_forms_are_exit_code_two(folder):
    done = marked(folder, "missing.toml", "gone.toml")
    assert done.exit_code == 2
    assert done.stdout == ""


def test_form_and_key_of_other_numbers_do_not_belong_together(folder):
    form = folder / "answers.toml"
    text = form.read_text()
    assert 'paper = "' in text
    form.write_text(text.replace('paper = "', 'paper = "00', 1))
    done = marked(folder, "answers.toml")
    assert done.exit_code == 2
    assert "other questions than the key" in done.stderr


def test_a_page_of_another_paper_beside_the_key_is_told(folder):
    page = folder / "exam.html"
    digest = json.loads((folder / "key.json").read_text())["paper"]
    page.write_text(f'<!DOCTYPE html>\n<html lang="en" data-paper="{digest}">')
    assert marked(folder, "answers.toml").exit_code == 0
    page.write_text('<!DOCTYPE html>\n<html lang="en" data-paper="0123456789abcdef">')
    done = marked(folder, "answers.toml")
    assert done.exit_code != 0
    assert "another paper" in str(done.exception)


READ = {
    "number": ({"value": "5/2"}, "2.50", "2,50"),
    "quantity": ({"value": "5/2", "unit": "mm"}, "2.5mm", "2,5 mm"),
    "code": ({"output": "2.5"}, "2.5", "2.5"),
    "gap": ({"accept": ["f/2.8"]}, "f/2.8", "f/2.8"),
}
"""Kind to the rest of its spec, what is typed, and how a German page reads it back."""


@pytest.mark.parametrize("kind", READ)
def test_what_was_read_has_the_decimal_sign_of_the_language(kind):
    more, typed, shown = READ[kind]
    part = KeyPart("1", "1", {"kind": kind, **more})
    key = AnswerKey(FORMAT, [KeyQuestion("1", [part])])
    result = grade_paper(key, {"1": typed}, "de")
    ((_, cells),) = result_rows(result, "de")
    assert cells[3] == shown
    assert result.parts[0].verdict.read_as == shown.replace(",", ".")
