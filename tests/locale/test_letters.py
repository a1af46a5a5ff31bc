"""A word stands in a language's own letters: nothing about a script is written in Python."""

from __future__ import annotations

import pytest
from sweep import together

from quizgen import locale
from quizgen.kinds.grade import show_key

TERM = {"kind": "gap", "accept": [["ছবি", "picture", "εικόνα", "CCD এর ছবি"]]}


@pytest.fixture
def greek(tmp_path, monkeypatch):
    folder = tmp_path / "el"
    folder.mkdir()
    words = 'name = "Ελληνικά"\nenglish = "Greek"\norder = 9\nscript = "Grek"\n'
    (folder / "language.toml").write_text(words, "utf-8")
    monkeypatch.setattr(locale, "PLACES", [*locale.PLACES, tmp_path])


@pytest.mark.usefixtures("greek")
@pytest.mark.parametrize(
    ("lang", "word"), [("en", "picture"), ("bn", "ছবি"), ("el", "εικόνα"), ("??", "picture")]
)
def test_a_gap_shows_the_word_in_the_letters_of_the_language(lang, word):
    assert show_key(TERM, lang) == word


@together(
    ("lang", "text", "own"),
    [
        ("en", "CCD", True),
        ("en", "σ = 3", True),
        ("en", "CCD সেন্সর", False),
        ("bn", "CCD সেন্সর", True),
        ("bn", "CCD", False),
        ("bn", "555", False),
        ("en", "555", True),
    ],
)
def test_latin_terms_and_symbols_stand_in_every_text(lang, text, own):
    assert locale.is_written_in(lang, text) is own
