"""Decks for Anki: ``.apkg`` files that are a function of the deck and nothing else.

The file is a zip of an SQLite database in Anki's schema 11, a list of media and the media. Every
id comes from a hash, every time from the content version; the archive is stored uncompressed with
fixed times, because compressors differ between machines; and the version of SQLite that wrote the
database is taken out of its header.
"""

from __future__ import annotations

import hashlib
import json
import re
import sqlite3
from collections.abc import Iterator
from html import unescape
from typing import Any

from quizgen.bank.bank import Bank
from quizgen.cards.deck import Deck
from quizgen.cards.note import Note
from quizgen.cards.note_types import FONT, NAMES, note_type, stable_id
from quizgen.cards.versions import BASE, modification_time
from quizgen.core.files import build_zip
from quizgen.locale import FIRST

ROOT = "Quizgen"
_TAGS = re.compile(r"<[^>]*>")
_HEADER_VERSION = slice(96, 100)
_SQLITE = (3_040_000).to_bytes(4, "big")

_SCHEMA = """
CREATE TABLE col (id integer primary key, crt integer not null, mod integer not null,
  scm integer not null, ver integer not null, dty integer not null, usn integer not null,
  ls integer not null, conf text not null, models text not null, decks text not null,
  dconf text not null, tags text not null);
CREATE TABLE notes (id integer primary key, guid text not null, mid integer not null,
  mod integer not null, usn integer not null, tags text not null, flds text not null,
  sfld integer not null, csum integer not null, flags integer not null, data text not null);
CREATE TABLE cards (id integer primary key, nid integer not null, did integer not null,
  ord integer not null, mod integer not null, usn integer not null, type integer not null,
  queue integer not null, due integer not null, ivl integer not null, factor integer not null,
  reps integer not null, lapses integer not null, left integer not null, odue integer not null,
  odid integer not null, flags integer not null, data text not null);
CREATE TABLE revlog (id integer primary key, cid integer not null, usn integer not null,
  ease integer not null, ivl integer not null, lastIvl integer not null, factor integer not null,
  time integer not null, type integer not null);
CREATE TABLE graves (usn integer not null, oid integer not null, type integer not null);
CREATE INDEX ix_notes_usn ON notes (usn);
CREATE INDEX ix_cards_usn ON cards (usn);
CREATE INDEX ix_revlog_usn ON revlog (usn);
CREATE INDEX ix_cards_nid ON cards (nid);
CREATE INDEX ix_cards_sched ON cards (did, queue, due);
CREATE INDEX ix_revlog_cid ON revlog (cid);
CREATE INDEX ix_notes_csum ON notes (csum);
"""


def write_apkg(deck: Deck) -> bytes:
    """Return a deck as an ``.apkg`` file for Anki.

    Parameters
    ----------
    deck : Deck

    Returns
    -------
    bytes
        The same for the same deck, in every process and on every machine.
    """
    media = {FONT: _read_bangla_font(), **deck.media}
    names = sorted(media)
    listed = json.dumps({str(index): name for index, name in enumerate(names)})
    contents = {"collection.anki2": build_collection(deck), "media": listed.encode()}
    contents |= {str(index): media[name] for index, name in enumerate(names)}
    return build_zip(contents, packed=False)


def _read_bangla_font() -> bytes:
    """Return the font file of the Bangla letters on cards."""
    from quizgen.render import fonts

    return fonts.read_web_font(fonts.BANGLA["Regular"])


def build_collection(deck: Deck) -> bytes:
    """Return Anki's collection, an SQLite file with all notes and cards of a deck."""
    connection = sqlite3.connect(":memory:")
    try:
        connection.execute("PRAGMA page_size = 4096")
        connection.executescript(_SCHEMA)
        _fill_collection(connection, deck)
        connection.commit()
        data = bytearray(connection.serialize())
    finally:
        connection.close()
    data[_HEADER_VERSION] = _SQLITE
    return bytes(data)


def _fill_collection(connection: sqlite3.Connection, deck: Deck) -> None:
    """Insert settings, notes and cards of a deck into the tables of a collection."""
    latest = max((modification_time(note, deck.wish.seed) for note in deck.notes), default=BASE)
    connection.execute(
        "INSERT INTO col VALUES (1,?,?,?,11,0,0,0,?,?,?,?,'{}')",
        (BASE, latest * 1000, BASE * 1000, *map(_format_json, _build_collection_settings(deck))),
    )
    notes, cards = _number_notes_and_cards(deck)
    connection.executemany(
        "INSERT INTO notes VALUES (?,?,?,?,-1,?,?,?,?,0,'')",
        (_build_note_row(notes[note.key], note, deck.wish.seed) for note in deck.notes),
    )
    connection.executemany(
        "INSERT INTO cards VALUES (?,?,?,?,?,-1,0,0,?,0,0,0,0,0,0,0,0,'')",
        _iter_card_rows(deck, notes, cards),
    )


def _format_json(table: object) -> str:
    """Return JSON with sorted keys, so that its bytes depend on nothing else."""
    return json.dumps(table, ensure_ascii=False, sort_keys=True)


def _number_notes_and_cards(deck: Deck) -> tuple[dict[str, int], dict[tuple[str, int], int]]:
    """Return the ids of notes (by key) and cards (by key and number).

    They follow from the keys: a note has the same id in every deck, unless another one took it.
    """
    taken: set[int] = set()
    notes = {note.key: _take_free_number(f"note/{note.key}", taken) for note in _sort_notes(deck)}
    cards = {
        (note.key, number): _take_free_number(f"card/{note.key}/{number}", taken)
        for note in _sort_notes(deck)
        for number in note.cards()
    }
    return notes, cards


def _sort_notes(deck: Deck) -> list[Note]:
    """Return the notes of a deck sorted by their keys."""
    return sorted(deck.notes, key=lambda note: note.key)


def _take_free_number(name: str, taken: set[int]) -> int:
    """Return the stable id of a name, or the next number that is not taken, and take it."""
    number = stable_id(name)
    while number in taken:
        number += 1
    taken.add(number)
    return number


def _build_note_row(number: int, note: Note, seed: int) -> tuple[Any, ...]:
    """Return the row of a note in Anki's table ``notes``."""
    fields = note.fields()
    tags = f" {' '.join(note.tags)} "
    checksum = int(hashlib.sha1(fields[0].encode(), usedforsecurity=False).hexdigest()[:8], 16)
    kind = note_type(note.form, note.columns)
    sorted_by = unescape(_TAGS.sub("", fields[kind["sortf"]] or fields[2]))
    return (number, note.guid, kind["id"], modification_time(note, seed), tags, "\x1f".join(fields),
            sorted_by, checksum)  # fmt: skip


def _iter_card_rows(
    deck: Deck, notes: dict[str, int], cards: dict[tuple[str, int], int]
) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of Anki's table ``cards``, in the order of learning."""
    for place, note in enumerate(deck.notes, 1):
        for number in note.cards():
            home = stable_id(deck_name(deck.wish.bank, note.topic))
            yield (cards[note.key, number], notes[note.key], home,
                   number, modification_time(note, deck.wish.seed), place)  # fmt: skip


def deck_name(bank: Bank, topic: str) -> str:
    """Return the name of a topic's sub-deck, English in every language so that decks merge."""
    return f"{ROOT}::{bank.topic_title(topic, FIRST)}"


def _build_collection_settings(deck: Deck) -> tuple[dict[str, Any], ...]:
    """Return the JSON columns of Anki's table ``col``: settings, note types, decks, options."""
    names = [ROOT, *sorted({deck_name(deck.wish.bank, note.topic) for note in deck.notes})]
    decks = {str(stable_id(name)): _build_deck_settings(stable_id(name), name) for name in names}
    decks["1"] = _build_deck_settings(1, "Default")
    columns = dict.fromkeys([note.columns for note in deck.notes]) or [deck.wish.columns]
    types = [note_type(form, one) for one in columns for form in NAMES]
    models = {str(kind["id"]): kind for kind in types}
    current = {"curDeck": stable_id(ROOT), "activeDecks": [stable_id(ROOT)]}
    conf = {**current, "curModel": types[0]["id"], "nextPos": 1,
            "sortType": "noteFld", "newSpread": 0}  # fmt: skip
    return conf, models, decks, {"1": _build_deck_options()}


def _build_deck_settings(number: int, name: str) -> dict[str, Any]:
    """Return the JSON of one deck as Anki stores it."""
    today = {f"{kind}Today": [0, 0] for kind in ("new", "rev", "lrn", "time")}
    return {"id": number, "name": name, "mod": BASE, "usn": -1, "desc": "", "dyn": 0, "conf": 1,
            "extendNew": 0, "extendRev": 0, "collapsed": False, "browserCollapsed": True,
            **today}  # fmt: skip


def _build_deck_options() -> dict[str, Any]:
    """Return the JSON of the scheduling options that all decks share."""
    return {
        "id": 1, "name": "Default", "mod": 0, "usn": 0, "maxTaken": 60, "autoplay": True,
        "timer": 0, "replayq": True, "dyn": False,
        "new": {"bury": True, "delays": [1.0, 10.0], "initialFactor": 2500, "ints": [1, 4, 7],
                "order": 1, "perDay": 20},
        "rev": {"bury": True, "ease4": 1.3, "fuzz": 0.05, "hardFactor": 1.2,
                "ivlFct": 1.0, "maxIvl": 36500, "perDay": 200},
        "lapse": {"delays": [10.0], "leechAction": 1, "leechFails": 8, "minInt": 1,
                  "mult": 0.0},
    }  # fmt: skip
