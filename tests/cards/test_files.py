"""The files themselves: reproducible, well-formed, and right for programs other than Anki."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import re
import sqlite3
import subprocess
import sys
import zipfile
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from click.testing import CliRunner

from quizgen.cards import build_deck
from quizgen.cards.delimited import COLUMNS, HEADER, write_csv, write_tsv
from quizgen.cards.update_versions import raise_versions
from quizgen.cards.versions import BASE, STEP, modification_time
from quizgen.cli.main import root_group
from quizgen.typeset.prose import Paragraph, PlainText

ROOT = Path(__file__).parent.parent.parent
SCRIPT = """
import hashlib
from quizgen.cards import build_deck
from quizgen.cards.apkg import write_apkg
from quizgen.cards.delimited import write_csv, write_tsv
deck = build_deck("both", seed=1, kinds=("vocab", "formula", "figure", "trap"))
for data in (write_apkg(deck), write_tsv(deck), write_csv(deck)):
    print(hashlib.sha256(data).hexdigest())
"""
VOID = {"img", "br", "hr"}


def digests(hash_seed):
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True, cwd=ROOT,
        env={**os.environ, "PYTHONHASHSEED": hash_seed},
    )  # fmt: skip
    return run.stdout.split()


@pytest.mark.slow
def test_the_same_bytes_in_every_process():
    one, other = digests("1"), digests("2")
    assert len(one) == 3
    assert one == other


def test_nothing_of_the_machine_is_in_the_package(packed):
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {entry.compress_type for entry in archive.infolist()} == {zipfile.ZIP_STORED}
        database = archive.read("collection.anki2")
    assert database[:16] == b"SQLite format 3\0"
    assert int.from_bytes(database[96:100], "big") == 3_040_000


def test_the_database_is_sound(packed, tmp_path):
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        path = tmp_path / "collection.anki2"
        path.write_bytes(archive.read("collection.anki2"))
    with sqlite3.connect(path) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert connection.execute("SELECT count(DISTINCT guid) = count(*) FROM notes").fetchone()[0]
    connection.close()


def test_media_of_a_deck_are_listed_once_and_all_named_for_us(packed, deck):
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        listed = json.loads(archive.read("media"))
        assert set(archive.namelist()) == {"collection.anki2", "media", *listed}
    assert all(name.lstrip("_").startswith("qg_") for name in listed.values())
    assert set(deck.media) == {name for name in listed.values() if name.endswith(".svg")}


def test_pictures_have_alt_texts_and_parse(deck):
    for note in deck.notes:
        fields = "".join(note.fields())
        shown = dict(re.findall(r'<img class="[^"]*" src="([^"]*)" alt="([^"]*)"', fields))
        media = note.media()
        assert shown.keys() == media.keys()
        assert all(len(alt) > 40 for alt in shown.values())
        for data in media.values():
            ET.fromstring(data)
            assert b"http" not in data.replace(b"http://www.w3.org/", b"")


class Balance(HTMLParser):
    """Complains about tags that are not closed in order."""

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)
        if tag == "img":
            assert dict(attrs)["alt"]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_every_field_is_well_formed_html(deck):
    for note in deck.notes:
        for text in note.fields():
            parser = Balance()
            parser.feed(text)
            assert not parser.open, note.key
            assert not re.search(r"&(?!amp;|lt;|gt;|quot;|#x27;)", text), note.key


def test_guids_depend_on_the_key_alone(deck):
    other = {note.key: note.guid for note in build_deck("bn", seed=9).notes}
    for note in deck.notes:
        assert other[note.key] == note.guid
        assert note.guid == hashlib.sha256(f"quizgen/{note.key}".encode()).hexdigest()[:20]


def test_times_rise_with_version_then_seed_then_languages(deck):
    note = next(note for note in deck.notes if note.kind == "question")
    term = next(note for note in deck.notes if note.kind == "vocab")
    alone = replace(note, langs=("en",))
    assert (
        modification_time(note, 0)
        < modification_time(note, 1)
        < modification_time(replace(note, version=note.version + 1), 0)
    )
    assert modification_time(alone, 3) < modification_time(note, 3) < modification_time(alone, 4)
    assert modification_time(note, 10**9) < modification_time(
        replace(note, version=note.version + 1), 0
    )
    assert modification_time(term, 0) == modification_time(term, 5)
    assert BASE + 1000 * STEP < 1_700_000_000, "a thousand versions stay in the past"


def test_a_change_raises_only_its_own_version():
    old = {"a": (3, "x"), "b": (1, "y"), "gone": (2, "z")}
    new = raise_versions(old, {"a": "x", "b": "changed", "c": "new"})
    assert new == {"a": (3, "x"), "b": (2, "changed"), "c": (1, "new"), "gone": (2, "z")}


def nasty(deck):
    """A deck of one note that holds everything a table might trip over."""
    text = 'tab\there, "quotes", comma, line\nbreak; # <b>&amp;'
    note = next(note for note in deck.notes if note.kind == "trap")
    words = {name: {"en": (Paragraph((PlainText(text),)),)} for name in ("Front", "Back")}
    return text, replace(deck, notes=(replace(note, words=words, langs=("en",)),))


def test_csv_gives_every_text_back(deck):
    text, single = nasty(deck)
    data = write_csv(single).decode("utf-8-sig")
    head, row = csv.reader(io.StringIO(data, newline=""))
    assert tuple(head) == COLUMNS
    assert row[3] == row[4] == text


def test_csv_has_a_row_per_card_and_formulas_in_plain_text(deck):
    rows = list(csv.DictReader(io.StringIO(write_csv(deck).decode("utf-8-sig"), newline="")))
    sides = sum(1 if note.form == "cloze" else len(note.cards()) for note in deck.notes)
    assert len(rows) == sides
    assert len({row["id"] for row in rows}) == sides
    projection = next(row for row in rows if "p′ₓ = f·pₓ/p_z" in row["back"])
    assert "p′ₓ = [...]" in projection["front"]
    assert not any(re.search(r"\\\(|<p>|<div", row["front"] + row["back"]) for row in rows)


def test_tsv_stays_one_line_per_card(deck):
    text, single = nasty(deck)
    lines = write_tsv(single).decode().splitlines()
    assert tuple(lines[: len(HEADER)]) == HEADER
    (row,) = csv.reader(lines[len(HEADER) :], delimiter="\t")
    assert len(row) == len(COLUMNS)
    assert "&lt;b&gt;&amp;amp;" in row[3]
    assert text.split("\n")[0].split("\t")[1] in row[3]


def test_anki_reads_the_tsv(deck, collection, tmp_path):
    """Anki takes the header lines as they are: deck, tags and stable ids."""
    from anki.import_export_pb2 import ImportCsvRequest

    path = tmp_path / "quizgen.tsv"
    path.write_bytes(write_tsv(deck))

    def bring_in():
        metadata = collection.get_csv_metadata(path=str(path), delimiter=None)
        return collection.import_csv(ImportCsvRequest(path=str(path), metadata=metadata)).log

    rows = len(write_tsv(deck).decode().splitlines()) - len(HEADER)
    first = bring_in()
    assert len(first.new) == rows
    assert collection.find_cards("deck:Quizgen::Noise")
    assert collection.find_notes("tag:quizgen::kind::trap")
    again = bring_in()
    assert not again.new
    assert len(collection.find_notes("")) == rows


def run(*arguments):
    return CliRunner().invoke(root_group, ["cards", *map(str, arguments)])


def test_the_command_writes_what_is_asked(tmp_path):
    result = run("--lang", "bn", "--topic", "noise", "--kind", "vocab,trap", "--format",
                 "apkg,tsv,csv", "--out", tmp_path / "out")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "quizgen.apkg", "quizgen.tsv", "quizgen.csv"
    }  # fmt: skip
    text = (tmp_path / "out" / "quizgen.csv").read_text("utf-8-sig")
    assert "Quizgen::Noise" in text
    assert "Quizgen::Colour" not in text
    assert "quizgen::lang::en" not in text


def test_pictures_of_a_table_lie_beside_it(tmp_path):
    result = run("--kind", "figure", "--format", "tsv", "--out", tmp_path)
    assert result.exit_code == 0, result.output
    used = set(re.findall(r'src=""(.*?)""', (tmp_path / "quizgen.tsv").read_text("utf-8")))
    assert used == {path.name for path in (tmp_path / "media").iterdir()}
    assert used


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--format", "pdf"], ["pdf", "apkg, tsv, csv"]),
        (["--kind", "terms"], ["terms", "vocab"]),
        (["--topic", "cooking"], ["cooking", "noise"]),
        (["--from-marks", "missing.json"], ["missing.json"]),
    ],
)
def test_bad_wishes_get_one_clear_line(arguments, words, tmp_path):
    result = run(*arguments, "--out", tmp_path / "out")
    assert result.exit_code != 0
    message = result.output + str(result.exception)
    for word in words:
        assert word in message
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_any_number_of_processes_makes_the_same_deck(tmp_path):
    for jobs in ("1", "2"):
        done = CliRunner().invoke(root_group, ["cards", "--lang", "both", "--topic", "noise", "--seed", "7",
            "--format", "apkg,tsv,csv", "--jobs", jobs, "--out", str(tmp_path / jobs)])  # fmt: skip
        assert done.exit_code == 0, done.output
    one, two = (
        {path.relative_to(tmp_path / jobs): path.read_bytes()
         for path in (tmp_path / jobs).rglob("*") if path.is_file()}
        for jobs in ("1", "2")
    )  # fmt: skip
    assert one == two
    assert len(one) > 3
