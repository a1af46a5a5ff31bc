"""Diagnostics in the language of an author."""

from __future__ import annotations

from pathlib import Path

from quizgen.core.diagnostics import CODES, diagnose
from quizgen.locale import SHIPPED
from quizgen.locale.explanations import (
    choose_explained_language,
    explain_diagnostic,
    load_explanations,
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
