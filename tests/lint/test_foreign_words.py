"""Words in another language than their file are found, and nothing else is."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write

from quizgen import locale
from quizgen.bank.bank import Bank
from quizgen.lint.foreign_words import find_foreign_words

ENGLISH = FILES["templates/forces/push/en.md"]
GERMAN = """# Ein Stoß
Ein Klotz von {{ m }} wird mit {{ a }} beschleunigt.

**Wie groß ist die Kraft?**

## steps
- F: Kraft ist Masse mal Beschleunigung: {{ F }}.

## traps
- added: Sie haben Masse und Beschleunigung addiert.

## check
Die Kraft ist in die Richtung der Beschleunigung gerichtet.
"""


@pytest.fixture(autouse=True)
def languages_stay_as_they_were(monkeypatch):
    """A bank adds its languages for the whole process, and other tests have none of them."""
    monkeypatch.setattr(locale, "_HEARD", [*locale._HEARD])
    monkeypatch.setattr(locale, "PLACES", [*locale.PLACES])


def found(tmp_path, **pages):
    files = {f"templates/forces/push/{lang}.md": text for lang, text in pages.items()}
    bank = Bank(write(tmp_path, files), trusted=True)
    return [(one.file.name, one.span.line) for one in find_foreign_words(bank.template("push"))]


@pytest.mark.parametrize(
    ("pages", "places"),
    [
        ({"de": GERMAN}, []),
        ({"de": ENGLISH}, [("de.md", 2)]),
        ({"bn": ENGLISH}, [("bn.md", 2)]),
        ({"en": GERMAN}, [("en.md", 2)]),
        ({"fr": ENGLISH}, []),  # quizgen began it with these words
        ({"de": GERMAN.replace("Kraft ist Masse mal", "The force is the mass times")}, [("de.md", 7)]),
        ({"de": GERMAN.replace("Masse mal", "`what is the mass` mal $what + is + the$")}, []),
        ({"de": GERMAN + "\n```python\nprint('what is the force')\n```\n"}, []),
        ({"de": GERMAN.replace("Ein Klotz", "Ein Klotz (im Buch: the block)")}, []),
    ],
    ids=["German", "English", "no Bangla", "no English", "unknown", "a line", "code", "program", "a word"],
)  # fmt: skip
def test_a_file_in_another_language_is_found(tmp_path, pages, places):
    assert found(tmp_path, **pages) == places
