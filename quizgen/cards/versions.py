"""Content versions: why a corrected card replaces the old one on re-import.

Anki updates a note only if the incoming one was modified later. A deck that depends on nothing but
its input cannot use the clock, so every note has a version: ``content/versions.toml`` lists, per
note, its version and a digest of what stands on it. A test compares the digests; after a change,
``python -m quizgen.cards.versions`` raises the versions of the notes that changed.

A worked question counts its template's files instead: a template that is listed with another digest
counts as one version newer until the list is written again.
"""

from __future__ import annotations

import hashlib
import sys
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from quizgen.bank.template import Template
from quizgen.cards.content import read
from quizgen.cards.note import Note

BASE = 1_577_836_800
"""Modification time of version 0, 1 January 2020: earlier than any change a learner makes."""
STEP = 100_000
"""Seconds between two versions; room for seed and languages within one version."""
LARGEST_SEED = STEP // 3 - 1
DRAWN = frozenset({"question", "mistake"})
"""Kinds whose numbers depend on a seed; their version is that of their template."""
FILE = "versions"


@cache
def registry() -> dict[str, tuple[int, str]]:
    """Note key to its version and digest, as committed."""
    table = tomllib.loads(read(FILE))
    return {key: (int(version), str(digest)) for key, (version, digest) in table.items()}


def version_of(note: Note) -> int:
    """Version of a note: as listed, or the one it came with."""
    if note.kind in DRAWN:
        return note.version
    return registry().get(note.key, (note.version, ""))[0]


def template_version(template: Template) -> int:
    """Version of a worked question, from the files of its template."""
    version, digest = registry().get(f"question/{template.origin}", (template.rules.version, ""))
    return version + (bool(digest) and digest != template.digest[: len(digest)])


def modified(note: Note, seed: int) -> int:
    """Modification time of a note in Anki, seconds since 1970.

    It rises with the version; within a version with the seed (only for kinds whose
    numbers depend on it) and from one language to both.
    """
    drawn = min(seed, LARGEST_SEED) if note.kind in DRAWN else 0
    return BASE + note.version * STEP + 3 * drawn + _breadth(note.langs)


def _breadth(langs: tuple[str, ...]) -> int:
    return 2 if len(langs) > 1 else int(langs != ("en",))


def digest_of(note: Note) -> str:
    """Digest of everything that stands on a note."""
    return hashlib.sha256("\x1f".join((*note.fields(), note.topic)).encode()).hexdigest()[:12]


def current() -> dict[str, str]:
    """Digest of every note and note type as the content stands now, in both languages."""
    from quizgen.bank.folder import builtin
    from quizgen.cards import looks
    from quizgen.cards.deck import build

    digests = {note.key: digest_of(note) for note in build("both", kinds=_authored()).notes}
    digests |= {f"looks/{form}": looks.digest_of(form) for form in looks.NAMES}
    return digests | {f"question/{t.origin}": t.digest[:12] for t in builtin()}


def _authored() -> tuple[str, ...]:
    from quizgen.cards.kinds import KINDS

    return tuple(kind for kind in KINDS if kind != "question")


def raised(old: dict[str, tuple[int, str]], new: dict[str, str]) -> dict[str, tuple[int, str]]:
    """The list after a change: a new digest raises the version, a new note starts at 1.

    A note that is gone stays listed, so that its version never falls should it return.
    """
    merged = dict(old)
    for key, digest in new.items():
        version, known = old.get(key, (0, ""))
        merged[key] = (version if known == digest else version + 1, digest)
    return merged


def written(table: dict[str, tuple[int, str]]) -> str:
    """The list as TOML."""
    head = "# Version and digest of every card; `python -m quizgen.cards.versions` keeps it.\n"
    rows: Any = (f'"{key}" = [{v}, "{digest}"]\n' for key, (v, digest) in sorted(table.items()))
    return head + "".join(rows)


def main() -> None:
    """Write the list anew."""
    old = registry()
    new = raised(old, current())
    path = Path(__file__).parent / "content" / f"{FILE}.toml"
    path.write_text(written(new), encoding="utf-8")
    changed = sum(new[key] != old.get(key) for key in new)
    sys.stdout.write(f"{path.name}: {len(new)} cards, {changed} changed\n")


if __name__ == "__main__":
    main()
