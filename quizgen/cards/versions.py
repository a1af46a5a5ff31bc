"""Content versions: why a corrected card replaces the old one on re-import.

Anki updates a note only if the incoming one was modified later. A deck that depends on nothing but
its input cannot use the clock, so every note has a version: ``cards/versions.toml`` of the bank
lists, per note, its version and a digest of what stands on it. A test compares the digests; after a
change, ``python -m quizgen.cards.update_versions`` raises the versions of the notes that changed.

A worked question counts its template's files instead: a template that is listed with another digest
counts as one version newer until the list is written again.
"""

from __future__ import annotations

import hashlib
from functools import cache

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.template import Template
from quizgen.cards.note import Note
from quizgen.core.complaints import complaint_of
from quizgen.core.decoding import convert
from quizgen.core.errors import BankError
from quizgen.core.untrusted import error_context, parse_toml, read_text
from quizgen.locale import FIRST

BASE = 1_577_836_800
"""Modification time of version 0, 1 January 2020: earlier than any change a learner makes."""
STEP = 100_000
"""Seconds between two versions; room for seed and languages within one version."""
LARGEST_SEED = STEP // 3 - 1
DRAWN = frozenset({"question", "mistake"})
"""Kinds whose numbers depend on a seed; their version is that of their template."""
FILE = "versions"


Registry = dict[str, tuple[int, str]]
"""Key to version and digest."""


@cache
def read_versions(bank: Bank) -> Registry:
    """Return version and digest by note key, as the bank lists them; nothing if it has no list."""
    if FILE not in bank.cards:
        return {}
    path = bank.cards[FILE]
    table = parse_toml(read_text(path, BankError), path, BankError)
    try:
        return convert(table, Registry)
    except msgspec.ValidationError as error:
        with error_context(path, BankError):
            raise complaint_of(error, Registry, table) from error


def note_version(note: Note, bank: Bank) -> int:
    """Return the version of a note: the listed one, else its own."""
    if note.kind in DRAWN:
        return note.version
    return read_versions(bank).get(note.key, (note.version, ""))[0]


def template_version(template: Template, bank: Bank) -> int:
    """Return the version of a worked question, from the files of its template."""
    version, digest = read_versions(bank).get(
        f"question/{template.origin}", (template.rules.version, "")
    )
    return version + (bool(digest) and digest != template.digest[: len(digest)])


def modification_time(note: Note, seed: int) -> int:
    """Return the modification time of a note in Anki, seconds since 1970.

    It rises with the version; within a version with the seed (only for kinds whose
    numbers depend on it) and from one language to both.
    """
    drawn = min(seed, LARGEST_SEED) if note.kind in DRAWN else 0
    return BASE + note.version * STEP + 3 * drawn + _count_language_versions(note.langs)


def _count_language_versions(langs: tuple[str, ...]) -> int:
    """Return 0 for English alone, 1 for another language, 2 for several: the part of a version."""
    return 2 if len(langs) > 1 else int(langs != (FIRST,))


def note_digest(note: Note) -> str:
    """Return a digest of everything that stands on a note."""
    return hashlib.sha256("\x1f".join((*note.fields(), note.topic)).encode()).hexdigest()[:12]
