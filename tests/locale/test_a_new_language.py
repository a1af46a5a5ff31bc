"""A language is a folder and one file per template: no Python knows its name."""

from __future__ import annotations

import csv
import io
import json
import sqlite3
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest
from pseudo import LANG, accented, write_bank, write_language

from quizgen import figures, locale, mark_part, typeset
from quizgen.bank.bank import builtin_bank
from quizgen.locale import check_translations, custom, list_languages, load_words
from quizgen.maths.notation import parse_formula

pytestmark = pytest.mark.slow
ROOT = Path(__file__).parent.parent.parent
NAMES = ("point-to-image-plane", "thin-lens-image-distance", "ccd-and-cmos-artefacts",
         "hsv-edit-effects")  # fmt: skip
RUN = """
import sys
from pathlib import Path
from quizgen import locale
locale.PLACES.append(Path("locale"))
from quizgen.cli.main import main
main(sys.argv[1:])
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("accents")
    write_language(folder / "locale")
    write_bank(folder / "bank", NAMES)
    return folder


@pytest.fixture
def known(place, monkeypatch):
    monkeypatch.setattr(locale, "PLACES", [*locale.PLACES, place / "locale"])


def quizgen(place, *arguments, typed=""):
    run = subprocess.run(
        [sys.executable, "-c", RUN, *arguments], cwd=place, input=typed, capture_output=True,
        text=True, check=False, encoding="utf-8",
        env={"PYTHONPATH": str(ROOT), "PYTHONUTF8": "1", "HOME": str(place), "PATH": "/usr/bin:/bin"},
    )  # fmt: skip
    assert "Traceback" not in run.stderr, run.stderr
    return run


@pytest.fixture(scope="module")
def paper(place):
    run = quizgen(place, "exam", "--bank", "bank", "--trust", "--topic", "all", "--lang", LANG, "--seed", "4",
                  "--out", "paper")  # fmt: skip
    assert run.returncode == 0, run.stderr
    return place / "paper"


def test_languages_are_the_folders(place, known):
    shipped = {path.parent.name for path in ROOT.glob("quizgen/locale/*/language.toml")}
    assert list_languages()[0] == "en"
    assert list_languages()[-1] == LANG
    assert set(list_languages()) == shipped | {LANG}
    assert locale.get_language(LANG).name == "Áccénts"


def test_pages_are_in_the_language(paper):
    page = (paper / "solutions.html").read_text(encoding="utf-8")
    assert f'<html lang="{LANG}" ' in page
    for english in ("Mock exam", "Worked solutions", "Sanity check", "Thin lens: where is the image?"):  # fmt: skip
        assert english not in page
    for english in ("Mock exam", "Worked solutions", "Thin lens: where is the image?"):
        assert accented(english) in page
    assert (paper / "exam.pdf").read_bytes().startswith(b"%PDF")
    assert (paper / "solutions.pdf").stat().st_size > 10_000


def test_figures_are_told_in_the_language(paper, known):
    page = (paper / "exam.html").read_text(encoding="utf-8")
    assert accented("Ray diagram of a thin lens") in page


def test_a_figure_without_words_in_the_language_is_told_in_english(known):
    values = {"f": 2, "p_z": 6, "p_y": 3}
    drawn = figures.draw_figure(builtin_bank().figure("pinhole"), values, quiz=True, lang=LANG)
    assert drawn.alt.startswith("Pinhole model")


def test_mathematics_is_read_aloud_in_the_language(known):
    node = typeset.lay_out(parse_formula("sqrt(x + 1)/2"))
    assert (
        typeset.to_speech(node, "en")
        == "the fraction the square root of x plus 1, end of root, over 2, end of fraction"
    )
    assert typeset.to_speech(node, LANG) == accented(typeset.to_speech(node, "en"))


def test_marks_come_with_messages_in_the_language(place, paper):
    form = tomllib.loads((paper / "answers.toml").read_text(encoding="utf-8"))
    typed = {"code": form["code"], "answers": dict.fromkeys(form["answers"], "3 +* ")}
    (place / "typed.json").write_text(json.dumps(typed))
    run = quizgen(place, "check", "paper/key.json", "typed.json", "--lang", LANG, "--json")
    parts = json.loads(run.stdout)["parts"]
    english = quizgen(place, "check", "paper/key.json", "typed.json", "--lang", "en", "--json")
    said = [part["message"] for part in json.loads(english.stdout)["parts"]]
    assert sum(bool(message) for message in said) >= 3
    assert all(("á" in p["message"] or "é" in p["message"]) for p in parts if p["message"])


ESPERANTO = """
[letters]
nigraj = "b"
blankaj = "w"
"senŝanĝaj" = "0"

[said]
yellow = ["flava"]

[around]
before = ["la respondo estas"]

[numbers]
counted = ["nul", "unu", "du", "tri", "kvar", "kvin", "ses", "sep", "ok", "naŭ", "dek"]
larger = ["14 dek kvar"]
multiples = ["1000 mil"]

[reading]
and = ["kaj"]
point = ["komo"]
"""
"""Words with which answers are read, and nothing else of the language but its name."""


@pytest.mark.parametrize(
    ("question", "part", "typed", "meant"),
    [
        ("rolling-shutter-skew", "a", "la respondo estas dek kvar komo kvar", "14.4"),
        ("rgb-to-cmyk", "c", "flava", "yellow"),
        (
            "salt-and-pepper-counts", "a",
            "nigraj 16 mil, blankaj 16 mil kaj senŝanĝaj 608 mil", "16000; 16000; 608000",
        ),
    ],
)  # fmt: skip
def test_answers_are_read_in_words_of_the_language(
    tmp_path, monkeypatch, question, part, typed, meant
):
    def mark(text):
        template = builtin_bank().template(question)
        return mark_part(template, text, part=part, seed=41, lang="en")

    assert not mark(typed).is_graded
    (tmp_path / "eo").mkdir()
    (tmp_path / "eo" / "language.toml").write_text('name = "Esperanto"\n', encoding="utf-8")
    (tmp_path / "eo" / "answers.toml").write_text(ESPERANTO, encoding="utf-8")
    monkeypatch.setattr(locale, "PLACES", [*locale.PLACES])
    try:
        locale.register_languages(place=tmp_path)
        assert mark(typed).verdict == mark(meant).verdict == "correct"
    finally:
        monkeypatch.undo()
        locale.forget_words()
    assert not mark(typed).is_graded


def test_a_row_of_a_bank_without_its_number_is_told_of_and_left_out(tmp_path):
    (tmp_path / "eo").mkdir()
    (tmp_path / "eo" / "language.toml").write_text('name = "Esperanto"\n', encoding="utf-8")
    (tmp_path / "eo" / "answers.toml").write_text(
        f'{ESPERANTO}[functions]\nradiko = "sqrt"\n'.replace("14 dek kvar", "cent"),
        encoding="utf-8",
    )
    said = [problem.message for problem in check_translations(tmp_path)]
    (row,) = [one for one in said if one.startswith(("numbers", "functions", "said"))]
    assert "begin with its number" in row
    english = load_words("en", "answers")
    own = custom.merge_translation(english, {"numbers": {"larger": ["cent"]}})
    assert own["numbers"]["larger"] == english["numbers"]["larger"]


def test_practice_speaks_the_language(place):
    run = quizgen(place, "practice", "--bank", "bank", "--trust", "--lang", LANG, "--count", "1", "--seed", "3",
                  typed="?\n" * 60)  # fmt: skip
    words = {
        accented(text)
        for text in load_words("en", "messages")["practice"].values()
        if "{" not in text
    }
    assert any(word and word in run.stdout for word in words)


def test_cards_have_fields_of_the_language(place):
    run = quizgen(
        place, "cards", "--bank", "bank", "--trust", "--lang", LANG, "--format", "apkg,csv"
    )
    assert run.returncode == 0, run.stderr
    with zipfile.ZipFile(place / "cards" / "quizgen.apkg") as archive:
        data = archive.read("collection.anki2")
    connection = sqlite3.connect(":memory:")
    connection.deserialize(data)
    models = json.loads(connection.execute("SELECT models FROM col").fetchone()[0])
    term = next(m for m in models.values() if m["name"].startswith("Quizgen term"))
    assert [f["name"] for f in term["flds"]] == [
        "Key", "Term", f"Term {LANG}", "Meaning", f"Meaning {LANG}", "Source",
    ]  # fmt: skip
    assert [t["name"] for t in term["tmpls"]] == ["Term", "Meaning", "Accents"]
    assert accented("In English?") in term["tmpls"][2]["qfmt"]
    rows = list(csv.DictReader(io.StringIO(
        (place / "cards" / "quizgen.csv").read_text(encoding="utf-8-sig"))))  # fmt: skip
    assert {row["deck"] for row in rows} >= {"Quizgen::Optics", "Quizgen::Projection"}
    assert any("Bénds líght." in row["front"] + row["back"] for row in rows)


def test_the_tradeoff_page_has_the_language(known):
    from quizgen.tradeoff.page import whole_page
    from quizgen.tradeoff.report import measure_tradeoff

    few = SimpleNamespace(template_paths=["photon-energy-and-band", "dynamic-range-of-sensor"],
                          template=builtin_bank().template)  # fmt: skip
    page = whole_page(measure_tradeoff(few), "quizgen tradeoff")
    assert accented("What accuracy costs") in page
    assert f'<label for="{LANG}" lang="{LANG}">Áccénts</label>' in page


@pytest.mark.parametrize("lang", [lang for lang in list_languages() if lang != "en"])
def test_every_language_has_every_file_and_every_word(lang):
    def keys(table, path=""):
        for key, value in table.items():
            yield from keys(value, f"{path}{key}.") if isinstance(value, dict) else [f"{path}{key}"]

    for path in (ROOT / "quizgen" / "locale" / "en").glob("*.toml"):
        # Speech: what is not called as written; words of this language that answers in English hold.
        open_tables = tuple(f"{table}." for table in locale.OPEN)
        english, other = (
            {
                key
                for key in keys(
                    tomllib.loads((path.parents[1] / one / path.name).read_text("utf-8"))
                )
                if not key.startswith(open_tables)
            }
            for one in ("en", lang)
        )
        assert english ^ other <= {"line_height", "decimal", "quotes", "common"}, path.name
