"""A bank in a language that quizgen has no words for: its own words, and English for the rest."""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from pathlib import Path

import pikepdf
import pytest
from sweep import together

from quizgen import locale
from quizgen.bank.bank import Bank
from quizgen.lint.bank_checks import check_bank_files
from quizgen.locale import custom
from quizgen.web.auth import _make_visitor

FRENCH = """# Durée d'un trajet
Une cycliste parcourt {{ s }} à la vitesse constante de {{ v }}.

**Combien de temps met-elle ?** Répondez en secondes.

## steps
- t: Le temps est la distance divisée par la vitesse.

## traps
- multiplied: Vous avez multiplié la distance par la vitesse.
- upside-down: Vous avez divisé la vitesse par la distance.

## check
En {{ t }}, à {{ v }}, la cycliste parcourt {{ s }}.
"""
LANGUAGE = 'name = "français"\nenglish = "French"\ndecimal = ","\n'
INTERFACE = '[paper]\nexam = "Examen blanc"\npage = "Page {page} sur {pages}"\n'


def quizgen(where: Path, *words: str, typed: str = "", fails: bool = False) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "quizgen", *words], cwd=where, input=typed, capture_output=True,
        text=True, check=False, encoding="utf-8",
    )  # fmt: skip
    assert (done.returncode != 0) is fails, done.stderr
    assert "Traceback" not in done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A French bank as its lecturer leaves it, with some words of its own."""
    folder = tmp_path_factory.mktemp("french")
    quizgen(folder, "new", "bank", "trajets", "--lang", "fr")
    templates = folder / "trajets" / "templates"
    (templates / "example" / "travel-time" / "fr.md").write_text(FRENCH, "utf-8")
    (templates / "locale" / "fr" / "language.toml").write_text(LANGUAGE, "utf-8")
    (templates / "locale" / "fr" / "interface.toml").write_text(INTERFACE, "utf-8")
    return folder


BANK = ("--bank", "trajets", "--trust")


@pytest.fixture(scope="module")
def paper(place):
    quizgen(place, "exam", *BANK, "--topic", "all", "--seed", "5", "--out", "paper")
    return place / "paper"


def test_a_bank_begun_in_other_languages_is_sound(tmp_path):
    quizgen(tmp_path, "new", "bank", "rutas", "--lang", "es", "--lang", "PT-br")
    quizgen(tmp_path, "lint", "rutas", "--trust", "--seeds", "5")
    words = ("--bank", "rutas", "--trust", "--topic", "all", "--format", "html")
    quizgen(tmp_path, "exam", *words, "--lang", "pt-br", "--out", "paper")
    page = (tmp_path / "paper" / "exam.html").read_text("utf-8")
    assert '<html lang="pt-BR"' in page
    assert "Mock exam" in page
    code = json.loads((tmp_path / "paper" / "key.json").read_text("utf-8"))["code"]
    assert "-pt-BR-" in code
    quizgen(tmp_path, "exam", *words[:3], "--format", "html", "--code", code, "--out", "again")
    assert (tmp_path / "again" / "exam.html").read_text("utf-8") == page


@pytest.mark.slow
def test_papers_speak_it_without_being_asked(paper):
    page = (paper / "solutions.html").read_text("utf-8")
    assert '<html lang="fr"' in page
    assert "Examen blanc" in page
    assert "37,5" in page
    assert "37.5" not in re.sub(r"<(style|script|svg|math)\b.*?</\1>", "", page, flags=re.DOTALL)
    assert "Worked solutions" in page  # what the bank does not say is English


def test_its_printed_pages_say_which_it_is(paper):
    with pikepdf.open(paper / "exam.pdf") as pdf:
        assert str(pdf.Root.Lang) == "fr"
        assert "Examen blanc" in str(pdf.docinfo.Title)


def test_what_is_typed_is_marked_and_explained_in_it(place, paper):
    form = (paper / "answers.toml").read_text("utf-8")
    for typed, told in (("37,5 s", "37.5"), ("2400 s", "Vous avez multiplié")):
        (place / "typed.toml").write_text(form.replace('"1" = ""', f'"1" = "{typed}"'), "utf-8")
        said = quizgen(place, "check", "paper/key.json", "typed.toml", "--json")
        (part,) = json.loads(said)["parts"]
        assert told in part["message"] + part["read_as"]
    assert '"right"' not in said


def test_cards_and_practice_speak_it(place):
    quizgen(place, "cards", *BANK, "--format", "csv", "--out", "cards")
    with (place / "cards" / "quizgen.csv").open(encoding="utf-8-sig") as stream:
        (row,) = csv.DictReader(stream)
    assert "Combien de temps" in row["front"]
    words = ("practice", *BANK, "--count", "1", "--database", f"sqlite:///{place}/l.sqlite3")
    assert "Une cycliste parcourt" in quizgen(place, *words, typed="!\n")


PLAN = 'title = { fr = "Essai" }\n[[slot]]\ntemplates = ["travel-time"]\n'
WORD = """[[entry]]
id = "vitesse"
number = 1
topic = "example"
tier = "A"
section = "1"
group = "mechanics"
term.fr = "Vitesse"
meaning.fr = "La distance parcourue par unité de temps."
"""


@pytest.mark.slow
def test_a_blueprint_and_words_to_learn_need_no_english(tmp_path):
    quizgen(tmp_path, "new", "bank", "trajets", "--lang", "fr")
    (tmp_path / "plan.toml").write_text(PLAN, "utf-8")
    quizgen(tmp_path, "exam", *BANK, "--blueprint", "plan.toml", "--format", "html", "--out", "p")
    assert ">Essai</h1>" in (tmp_path / "p" / "exam.html").read_text("utf-8")
    (tmp_path / "trajets" / "templates" / "cards").mkdir()
    (tmp_path / "trajets" / "templates" / "cards" / "vocabulary.toml").write_text(WORD, "utf-8")
    quizgen(tmp_path, "cards", *BANK, "--kind", "vocab", "--format", "csv", "--out", "c")
    with (tmp_path / "c" / "quizgen.csv").open(encoding="utf-8-sig") as stream:
        sides = [(row["front"], row["back"]) for row in csv.DictReader(stream)]
    word, meaning = "Vitesse", "La distance parcourue par unité de temps."
    assert sides == [(word, meaning), (meaning, word)]


def test_another_language_names_those_of_the_bank(place):
    said = quizgen(place, "exam", *BANK, "--topic", "all", "--lang", "it", fails=True)
    assert "language: 'it' (allowed: fr, both)" in said
    said = quizgen(place, "exam", *BANK, "--topic", "all", "--lang", "French", fails=True)
    assert "'French' is no language" in said


@together(
    "hostile",
    [
        "{page.__class__.__mro__}", "{page[0]}", "{page!r}", "{page:>99999999}",
        "{page:{pages}}", "{other}", "{", "{0}",
    ],
)  # fmt: skip
def test_a_sentence_that_asks_for_more_than_its_words_is_not_used(hostile):
    """Where nobody has run lint: a bank's text is read without trust, and never runs."""
    english = {"paper": {"page": "Page {page} of {pages}", "notes": ["See {page}"]}}
    own = {"paper": {"page": hostile, "notes": [hostile]}, "more": {"open": hostile}}
    assert custom.merge_translation(english, own) == english
    sound = {"paper": {"page": "{pages}/{page} {{", "notes": ["Voir {page}"]}}
    assert custom.merge_translation(english, sound) == sound


def test_all_that_is_said_can_be_translated(place):
    quizgen(place, "new", "language", "nl", "--bank", "trajets", "--all")
    made = place / "trajets" / "templates" / "locale" / "nl"
    assert {path.stem for path in made.iterdir()} == {
        path.stem for path in (locale.SHIPPED / "en").glob("*.toml")
    }
    assert "itself" in quizgen(place, "new", "language", "de", "--bank", "trajets", fails=True)


@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("fr/interface.toml", '[paper]\nexan = "Examen"', ":2:1: QG507 paper.exan: quizgen has no such word"),
        ("fr/interface.toml", '[paper]\npage = "{seite}"', ":2:1: QG507 paper.page: there is nothing to fill"),
        ("fr/interface.toml", '[paper]\npage = "{page:>99999999}"', "a name between braces and nothing"),
        ("fr/interface.toml", '[paper]\npage = "{page!r}"', "a name between braces and nothing"),
        ("fr/interface.toml", '[paper]\npage = "{page.real}"', "a name between braces and nothing"),
        ("fr/interface.toml", '[paper]\npage = "{page[0]}"', "a name between braces and nothing"),
        ("fr/speech.toml", '[letters]\nx = "{0.__class__}"', ":1:1: QG507 letters: there is nothing to fill"),
        ("fr/answers.toml", '[labels]\nnear = ["{a:>9}"]', "near: there is nothing to fill"),
        ("fr/interface.toml", '[paper]\npage = "{page"', ":2:1: QG507 paper.page: expected '}'"),
        ("fr/interface.toml", "[paper]\nexam = 3", ":2:1: QG507 paper.exam: is to be a text"),
        ("fr/interface.toml", "paper = 'x'", ":1:1: QG507 paper: is to be a table, and not a text"),
        ("fr/interface.toml", "[paper\n", ":1:1: QG103 not valid TOML"),
        ("fr/inter.toml", "", ": QG508 is none of language.toml, answers.toml, cards.toml"),
        ("fr/language.toml", "name = 7", ":1:1: QG106 name: Expected `str`, got `int`"),
        ("fr/language.toml", 'nam = "x"', "contains unknown field `nam`"),
        ("French/language.toml", "", ": QG508 'French' is no language (call the folder fr, or pt-BR)"),
    ],
)  # fmt: skip
def test_a_mistake_in_its_words_is_named_with_its_place(tmp_path, monkeypatch, file, text, said):
    monkeypatch.setattr(locale, "PLACES", [*locale.PLACES])
    monkeypatch.setattr(locale, "_HEARD", [])
    wrong = tmp_path / "templates" / "locale" / file
    wrong.parent.mkdir(parents=True)
    wrong.write_text(text, "utf-8")
    locale.get_language.cache_clear()
    found = [str(problem) for problem in check_bank_files(Bank(tmp_path))]
    assert any(one.startswith(f"{wrong}{said}") or (str(wrong) in one and said in one)
               for one in found), found  # fmt: skip


def test_what_a_word_stands_for_stays_where_it_does_not_fit():
    english = {"paper": {"exam": "Mock exam", "page": "Page {page}"}, "letters": {}}
    own = {"paper": {"exam": "Examen", "page": 3}, "letters": {"x": "iks"}}
    assert custom.merge_translation(english, own) == {
        "paper": {"exam": "Examen", "page": "Page {page}"}, "letters": {"x": "iks"},
    }  # fmt: skip


@together("lang", ["../../etc", "e", "EN", "english", "en_GB", "en-gb", "", "en\n"])
def test_what_names_no_language_is_taken_up_by_nothing(lang):
    before = locale.list_languages()
    locale.register_languages([lang])
    assert locale.list_languages() == before
    assert not custom.is_language_tag(lang)


@pytest.mark.parametrize(
    ("asked", "spoken"),
    [("fr-CH, de;q=0.9", "fr"), ("pt-br", "pt-BR"), ("pt", "pt-BR"), ("it,en;q=0.5", "fr"), ("", "fr")],
)  # fmt: skip
def test_a_browser_is_answered_in_the_nearest_language(asked, spoken):
    scope = {"query_string": b"", "headers": [(b"accept-language", asked.encode())]}
    assert _make_visitor(scope, ("fr", "pt-BR")).settings["lang"] == spoken


def test_a_language_from_right_to_left_is_written_so(tmp_path):
    """Its formulas and the words of other languages are not."""
    assert custom.script_of("he") == "Hebr"
    assert "rtl" not in locale.language_css(":lang({})")
    quizgen(tmp_path, "new", "bank", "masa", "--lang", "he")
    asked = ("exam", "--bank", "masa", "--trust", "--topic", "example")
    quizgen(tmp_path, *asked, "--format", "html", "--out", "p", "--seed", "5")
    for name in ("exam", "solutions"):
        page = (tmp_path / "p" / f"{name}.html").read_text("utf-8")
        assert '<html lang="he"' in page
        assert '[lang="he"] { direction: rtl; }' in page
        assert ":is(math, code, pre, svg) { direction: ltr;" in page
        assert re.search(
            r"\u200e\d+\u00a0m\b", page
        )  # the mark keeps a unit to the right of its number


@pytest.mark.slow
def test_lint_advises_once_which_words_to_begin_with(tmp_path):
    quizgen(tmp_path, "new", "bank", "viajes", "--lang", "pt-BR")
    lint = ("lint", "--bank", "viajes", "--trust", "--seeds", "3")
    said = quizgen(tmp_path, *lint)
    file = Path("viajes/templates/locale/pt-BR/interface.toml")
    assert said.count("advice: ") == said.count(str(file)) == 1
    quizgen(tmp_path, "new", "language", "pt-BR", "--bank", "viajes", "--all")
    assert (tmp_path / file).is_file()
    assert "advice: " not in quizgen(tmp_path, *lint)
