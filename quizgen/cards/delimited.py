"""Decks for other programs: two sides per card, as TSV with HTML or as CSV with plain text.

TSV begins with Anki's ``#`` header lines (other programs skip them or are told to skip six lines);
CSV follows RFC 4180 with one line of column names. Columns of both: ``id`` (the same for ever, also
over languages), ``deck``, ``kind``, ``front``, ``back``, ``tags`` (separated by blanks).
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator

from quizgen.cards.apkg import deck_name
from quizgen.cards.deck import Deck
from quizgen.cards.markup import to_card_html
from quizgen.cards.note import side_to_text
from quizgen.core.untrusted import escape_csv_formula

COLUMNS = ("id", "deck", "kind", "front", "back", "tags")
HEADER = (
    "#separator:tab", "#html:true", "#guid column:1", "#deck column:2", "#tags column:6",
    "#columns:" + "\t".join(COLUMNS),
)  # fmt: skip


def card_rows(deck: Deck, *, rich: bool) -> Iterator[tuple[str, ...]]:
    """Yield one row of cells for each card.

    Parameters
    ----------
    deck : Deck
    rich : bool
        HTML with MathJax instead of plain text.
    """
    for note in deck.notes:
        home = deck_name(deck.wish.bank, note.topic)
        for name, front, back in note.sides():
            if rich:
                main = note.langs[0]
                sides = (to_card_html(front, main, ask=True), to_card_html(back, main, ask=False))
            else:
                sides = (side_to_text(front, ask=True), side_to_text(back, ask=False))
            number = f"{note.guid}-{name.lower()}"
            yield (
                number,
                home,
                note.kind,
                *sides,
                " ".join(note.tags),
            )


def write_tsv(deck: Deck) -> bytes:
    """Return a deck as tab-separated values with HTML."""
    lines = [*HEADER, *("\t".join(map(_quote_cell, row)) for row in card_rows(deck, rich=True))]
    return ("\n".join(lines) + "\n").encode()


def _quote_cell(text: str) -> str:
    """Return a cell in quotes where it needs them; HTML can do without tabs and line breaks."""
    flat = escape_csv_formula(text).replace("\t", " ").replace("\r", "").replace("\n", "<br>")
    return '"' + flat.replace('"', '""') + '"' if '"' in flat or flat.startswith("#") else flat


def write_csv(deck: Deck) -> bytes:
    """Return a deck as comma-separated values in plain text (UTF-8 with a byte order mark)."""
    out = io.StringIO(newline="")
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(COLUMNS)
    writer.writerows(map(escape_csv_formula, row) for row in card_rows(deck, rich=False))
    return "\ufeff".encode() + out.getvalue().encode()
