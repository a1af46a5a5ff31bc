"""Mistakes of authors: one change to a sound bank each, and what lint says of it.

``mistakes.toml`` is tested, and is the page ``docs/mistakes.md``: ``uv run python
tests/lint/author_mistakes.py`` renews the page.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "bank")]

from mechanics import FILES, write  # noqa: E402

from quizgen.bank.scaffold import scaffold_template  # noqa: E402

ROWS = tomllib.loads((HERE / "mistakes.toml").read_text("utf-8"))["mistake"]
PAGE = HERE.parents[1] / "docs" / "mistakes.md"
HEAD = """# Mistakes of authors

*For authors of questions. To look things up.*

What `quizgen lint` says, by mistake. It writes `FILE:LINE:COLUMN: CODE MESSAGE; HINT`; the codes are those of
[diagnostics.md](diagnostics.md). This page is made from `tests/lint/mistakes.toml`, where each mistake is made and its message compared.

| mistake | in | code | lint says |
|---|---|---|---|
"""


CARDS = "templates/cards/vocabulary.toml"
CARD = """
[[entry]]
id = "newton"
number = 1
topic = "forces"
tier = "A"
section = "1"
group = "units"
term.en = "Newton"
meaning.en = "The force that accelerates 1 kg by 1 m/s²."
"""


def sound() -> dict[str, str]:
    """The files of the bank before any mistake: a computation, and one question of each other kind."""
    found = dict(FILES)
    for kind in ("choice", "claims", "match", "order", "gap"):
        made = scaffold_template("forces", f"a-{kind}", kind, ("en",))
        found |= {name: data.decode() for name, data in made.items()}
    return found


def spoilt(root: Path, row: dict[str, Any]) -> Path:
    """The bank with one mistake; cards, which have topics too, where it is about them."""
    files = sound() | ({CARDS: CARD} if row["file"] == CARDS else {})
    if "text" in row:  # another file, or several
        return write(root, {**files, row["file"]: row["text"], **row.get("also", {})})
    if "rename" in row:
        write(root, files)
        (root / row["file"]).rename(root / row["rename"])
        return root
    assert row["find"] in files[row["file"]], row["what"]
    text = files[row["file"]].replace(row["find"], row["write"])
    return write(root, {**files, row["file"]: text})


def page() -> str:
    """The documentation."""
    lines = []
    for row in ROWS:
        place, said = row["says"].split(": ", 1)
        code, message = said.split(" ", 1)
        text = message.replace("|", "\\|")
        lines.append(f"| {row['what']} | `{place}` | {code} | `` {text} `` |")
    return HEAD + "\n".join(lines) + "\n\nNext: [Questions for other systems](export.md)\n"


def code_of(row: dict[str, Any]) -> str:
    """The code that lint says of a mistake."""
    return str(row["says"].split(": ", 1)[1].split(" ", 1)[0])


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
