"""Write the lists of versions anew: ``python -m quizgen.cards.renew [BANK]``.

Without a bank, the built-in one and the note types are renewed.
"""

from __future__ import annotations

import sys
from pathlib import Path

from quizgen.bank.folder import Bank, builtin
from quizgen.cards import looks
from quizgen.cards.deck import build
from quizgen.cards.kinds import KINDS
from quizgen.cards.versions import DRAWN, FILE, Registry, digest_of, registry

HEAD = "`python -m quizgen.cards.renew` keeps it.\n"


def current(bank: Bank) -> dict[str, str]:
    """Digest of every note as the content stands now, in every language of the bank."""
    authored = tuple(kind for kind in KINDS if kind not in DRAWN)
    notes = build("both", kinds=authored, bank=bank).notes
    digests = {note.key: digest_of(note) for note in notes}
    return digests | {f"question/{t.origin}": t.digest[:12] for t in bank}


def raised(old: Registry, new: dict[str, str]) -> Registry:
    """The list after a change: a new digest raises the version, a new note starts at 1.

    A note that is gone stays listed, so that its version never falls should it return.
    """
    merged = dict(old)
    for key, digest in new.items():
        version, known = old.get(key, (0, ""))
        merged[key] = (version if known == digest else version + 1, digest)
    return merged


def written(table: Registry) -> str:
    """The rows of a list as TOML."""
    return "".join(f'"{key}" = [{v}, "{digest}"]\n' for key, (v, digest) in sorted(table.items()))


def renew_looks() -> None:
    """Write the versions of the note types."""
    old = looks.listed()
    new = raised(old.looks, {form: looks.digest_of(form) for form in looks.NAMES})
    langs = ", ".join(f'"{lang}"' for lang in old.languages)
    head = f"# Note types: the languages of the plain ones, version and digest of each;\n# {HEAD}"
    path = Path(looks.__file__).parent / "looks.toml"
    path.write_text(f"{head}languages = [{langs}]\n\n[looks]\n{written(new)}", encoding="utf-8")


def renew(bank: Bank) -> None:
    """Write a bank's list, and say how many cards changed."""
    old = registry(bank)
    new = raised(old, current(bank))
    path = bank.folder / "cards" / f"{FILE}.toml"
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"# Version and digest of every card; {HEAD}{written(new)}", encoding="utf-8")
    changed = sum(new[key] != old.get(key) for key in new)
    sys.stdout.write(f"{path.name}: {len(new)} cards, {changed} changed\n")


def main(arguments: list[str]) -> None:
    """Renew the bank that is named, else the built-in one and the note types."""
    if arguments:
        renew(Bank(Path(arguments[0]), trusted=True))
        return
    renew_looks()
    renew(builtin())


if __name__ == "__main__":
    main(sys.argv[1:])
