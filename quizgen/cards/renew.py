"""The command that writes the list of versions anew: ``python -m quizgen.cards.renew``."""

from __future__ import annotations

import sys
from pathlib import Path

from quizgen.bank.folder import builtin
from quizgen.cards import looks
from quizgen.cards.deck import build
from quizgen.cards.kinds import KINDS
from quizgen.cards.versions import DRAWN, FILE, Registry, digest_of, registry


def current() -> dict[str, str]:
    """Digest of every note and note type as the content stands now, in both languages."""
    authored = tuple(kind for kind in KINDS if kind not in DRAWN)
    digests = {note.key: digest_of(note) for note in build("both", kinds=authored).notes}
    digests |= {f"looks/{form}": looks.digest_of(form) for form in looks.NAMES}
    return digests | {f"question/{t.origin}": t.digest[:12] for t in builtin()}


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
    """The list as TOML."""
    head = "# Version and digest of every card; `python -m quizgen.cards.renew` keeps it.\n"
    rows = (f'"{key}" = [{v}, "{digest}"]\n' for key, (v, digest) in sorted(table.items()))
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
