"""Text in columns of a terminal: how many it takes, lines of it, tables.

rich and wcwidth are not asked for widths: they give the vowel signs of Bangla that stand to the
right or left of their letter no column of their own (``বাংলা`` takes 2 and 4 columns by them),
where libc and terminals give them one (5), so that every line they break would be too wide.
"""

from __future__ import annotations

import re
import sys
import unicodedata
from collections.abc import Iterator, Sequence

# Where a line may break; not at a no-break space.
_BLANKS = re.compile(r"[ \t\n]+")
_GAP = "  "
# Columns below which the last cell of a row does not stand to the right of the others.
_NARROWEST_CELL = 20


def text_width(text: str) -> int:
    """Return how many columns of a terminal a text takes, as libc's ``wcwidth`` counts them."""
    marks = {"Mn", "Me", "Cf"}
    return sum(0 if unicodedata.category(c) in marks else 1 + _is_wide(c) for c in text)


def _is_wide(character: str) -> bool:
    """Return whether a character takes two columns, as most of Chinese and Japanese do."""
    return unicodedata.east_asian_width(character) in {"W", "F"}


def wrap_lines(text: str, room: int, first: str = "", rest: str = "") -> Iterator[str]:
    """Yield the lines of a text, broken between words.

    Parameters
    ----------
    text : str
        A word that is longer than a line stays whole; characters of double width may part.
    room : int
        Columns of a line.
    first, rest : str
        What the first line and the others begin with.
    """
    line, used, empty = first, text_width(first), True
    for glue, piece in _split_pieces(text):
        more = text_width(piece)
        if not empty and used + len(glue) + more > room:
            yield line.rstrip(" ")
            line, used, empty = rest, text_width(rest), True
        if not empty:
            line, used = line + glue, used + len(glue)
        line, used, empty = line + piece, used + more, False
    yield line.rstrip(" ")


def _split_pieces(text: str) -> Iterator[tuple[str, str]]:
    """Yield what may stand on a line of its own, each with the blank in front of it."""
    for word in filter(None, _BLANKS.split(text)):
        glue, piece = " ", ""
        for character in word:
            if piece and _is_wide(character):
                yield glue, piece
                glue, piece = "", ""
            piece += character
        yield glue, piece


def lay_out_table(rows: Sequence[Sequence[str]], room: int = sys.maxsize) -> Iterator[list[str]]:
    """Yield the lines of each row, in aligned columns.

    Parameters
    ----------
    rows : sequence of sequence of str
        Cells of one line each, as many in every row.
    room : int
        Columns of a line: the last cell is wrapped, or stands below the others.
    """
    sizes = [max(map(text_width, column)) for column in zip(*rows, strict=True)][:-1]
    for row in rows:
        cells = zip(row, sizes, strict=False)
        start = "".join(cell + " " * (size - text_width(cell)) + _GAP for cell, size in cells)
        indent = text_width(start)
        if room - indent >= _NARROWEST_CELL:
            yield list(wrap_lines(row[-1], room, start, " " * indent))
            continue
        line = start.rstrip()
        whole = [line] if text_width(line) <= room else wrap_lines(line, room, "", _GAP)
        yield [*whole, *(wrap_lines(row[-1], room, _GAP * 2, _GAP * 2) if row[-1] else ())]
