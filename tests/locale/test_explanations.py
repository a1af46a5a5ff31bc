"""Diagnostics in the language of an author."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from quizgen.cli.author_language import explain_error
from quizgen.core.diagnostics import CODES, diagnose
from quizgen.core.errors import QuizgenError
from quizgen.locale import SHIPPED
from quizgen.locale.explanations import (
    choose_explained_language,
    explain_diagnostic,
    load_explanations,
    translate_error,
)


def test_every_code_is_explained_with_a_hint_where_english_has_one():
    files = sorted(SHIPPED.glob("*/diagnostics.toml"))
    assert [file.parent.name for file in files] == ["de"]
    said = load_explanations("de")
    assert said.keys() == CODES.keys()
    for code, rule in CODES.items():
        assert len(said[code]) == (2 if rule.hint else 1), code
        assert said[code][0].endswith("."), code


def test_a_german_author_reads_german_with_the_names_of_the_place():
    found = diagnose("QG105", Path("template.toml"), "points is missing", line=3)
    said = str(explain_diagnostic(found, "de"))
    assert said == "template.toml:3:1: QG105 Ein Schlüssel fehlt (points is missing); ergänzen"
    assert explain_diagnostic(found, "en") == found


def test_a_bank_without_english_is_told_of_in_its_own_language():
    chosen = {
        langs: choose_explained_language(langs) for langs in (("de",), ("de", "en"), ("fr",), ())
    }
    assert chosen == {("de",): "de", ("de", "en"): "en", ("fr",): "en", (): "en"}


CODE = SHIPPED.parent
RAISING = ("classes", "cli", "lms", "paper", "web/class_room.py")
"""Where the errors are raised that have no rule."""


def read_sources() -> str:
    """These modules, texts that go on in the next line joined."""
    files = [file for part in RAISING for file in [*(CODE / part).rglob("*.py"), CODE / part]]
    text = "\n".join(file.read_text("utf-8") for file in files if file.is_file())
    return re.sub(r"[\"']\n\s*f?[\"']", "", text)


def test_each_sentence_of_an_error_is_still_said():
    sentences = tomllib.loads((SHIPPED / "de" / "errors.toml").read_text("utf-8"))["sentences"]
    sources = read_sources()
    for english, german in sentences.items():
        for piece in re.split(r"\{\d\}", english):
            assert piece in sources, english
        assert sorted(re.findall(r"\{\d\}", german)) == sorted(re.findall(r"\{\d\}", english))


@pytest.mark.parametrize(
    ("said", "german"),
    [
        ("out: nothing has been marked yet (quizgen class mark)",
         "out: noch ist nichts bewertet (quizgen class mark)"),
        ("r.csv: lines 2 and 3 have the same id '1'", "r.csv: die Zeilen 2 und 3 haben dieselbe id '1'"),
        ("out/rulings.csv: line 4: value: '9' (points, in quarters)",
         "out/rulings.csv: Zeile 4: value: '9' (Punkte, in Vierteln)"),
        ("no such sentence", "no such sentence"),
    ],
)  # fmt: skip
def test_an_error_about_a_class_is_said_in_german_with_its_place(said, german):
    assert translate_error(said, "de") == german


def test_the_language_is_not_looked_for_in_a_class_file_that_no_reader_takes(tmp_path):
    (tmp_path / "class.toml").write_text("lang = " + "[" * 100_000, "utf-8")
    error = QuizgenError("out: nothing has been marked yet (quizgen class mark)")
    assert explain_error(error, ["class", "lists", str(tmp_path)]) == str(error)
