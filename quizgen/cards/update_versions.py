"""Write the lists of versions again: ``python -m quizgen.cards.update_versions [BANK]``.

Without a bank, the built-in one and the note types are renewed.
"""

from __future__ import annotations

import sys
from pathlib import Path

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.cards import note_types
from quizgen.cards.deck import build_deck
from quizgen.cards.kinds import KINDS
from quizgen.cards.versions import DRAWN, FILE, Registry, note_digest, read_versions

HEAD = "`python -m quizgen.cards.update_versions` keeps it.\n"


def current_digests(bank: Bank) -> dict[str, str]:
    """Return the digest of every note as the content stands now, in every language of the bank."""
    authored = tuple(kind for kind in KINDS if kind not in DRAWN)
    notes = build_deck("both", kinds=authored, bank=bank).notes
    digests = {note.key: note_digest(note) for note in notes}
    return digests | {f"question/{t.origin}": t.digest[:12] for t in bank}


def raise_versions(old: Registry, new: dict[str, str]) -> Registry:
    """Return the versions after a change: a new digest raises one, a new note starts at 1.

    A note that is gone stays listed, so that its version never falls should it return.
    """
    merged = dict(old)
    for key, digest in new.items():
        version, known = old.get(key, (0, ""))
        merged[key] = (version if known == digest else version + 1, digest)
    return merged


def format_versions(table: Registry) -> str:
    """Return the rows of a list of versions as TOML."""
    return "".join(f'"{key}" = [{v}, "{digest}"]\n' for key, (v, digest) in sorted(table.items()))


def update_note_types() -> None:
    """Write the versions of the note types to ``looks.toml``."""
    old = note_types.read_note_type_versions()
    new = raise_versions(
        old.looks, {form: note_types.note_type_digest(form) for form in note_types.NAMES}
    )
    langs = ", ".join(f'"{lang}"' for lang in old.languages)
    head = f"# Note types: the languages of the plain ones, version and digest of each;\n# {HEAD}"
    path = Path(note_types.__file__).parent / "looks.toml"
    path.write_text(
        f"{head}languages = [{langs}]\n\n[looks]\n{format_versions(new)}", encoding="utf-8"
    )


def update_versions(bank: Bank) -> None:
    """Write a bank's list of versions, and print how many cards changed."""
    old = read_versions(bank)
    new = raise_versions(old, current_digests(bank))
    path = bank.folder / "cards" / f"{FILE}.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(
        f"# Version and digest of every card; {HEAD}{format_versions(new)}", encoding="utf-8"
    )
    changed = sum(new[key] != old.get(key) for key in new)
    sys.stdout.write(f"{path.name}: {len(new)} cards, {changed} changed\n")


def main(arguments: list[str]) -> None:
    """Update the versions of the named bank, else of the built-in one and of the note types."""
    if arguments:
        update_versions(Bank(Path(arguments[0]), trusted=True))
        return
    update_note_types()
    update_versions(builtin_bank())


if __name__ == "__main__":
    main(sys.argv[1:])
