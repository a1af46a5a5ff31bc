"""A whole paper that comes back from a scanner: marks, a code a page, and where each field stands.

Only the places are known here: what is asked and how it looks is that of any paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from quizgen.core.errors import RenderError
from quizgen.paper.paper import Paper
from quizgen.render.answer_sheet import (
    MARKS,
    PAPER_VERSION,
    POWER,
    SIZE,
    SheetField,
    SheetPlaces,
    draw_page_code,
    iter_mark_places,
)
from quizgen.render.pdf import fit_to_pages, typst_sources
from quizgen.render.typst_document import compile_pdf, query_metadata, typst_literal

MARK, INSET = 7.0, 7.0
"""Side of a corner mark, and its distance from the edges: 3 mm from all that is printed."""
CODE = (165.0, 4.8, 12.5)
"""Place and side of the code: left of the column of points, above the text."""
MOST_PAGES = 60
STROKE = 0.8 / 72 * 25.4
"""Millimetres that the frame of a box is thick; half of it is outside."""
KINDS = {"box": "box", "line": "line", "frame": "line", "number": "line", "power": "line",
         "room": "room", "points": "points"}  # fmt: skip
"""What a field is to a reader, by what the layout calls it."""
LEAST = 1.0
"""Millimetres that room to work in is high at least."""


def render_scanned_paper(paper: Paper, code_of: Callable[[int], str]) -> tuple[bytes, SheetPlaces]:
    """Return a student's paper with marks and codes as a PDF file, and the places of its fields.

    Parameters
    ----------
    paper : Paper
        Of a holder.
    code_of : callable
        What the code of a page says, by its number from 1.

    Raises
    ------
    RenderError
        If Typst refuses the document, or it has too many pages.
    """
    marks = tuple(iter_mark_places(INSET, MARK))
    sources = typst_sources(paper, "exam", scanned=True)
    sources["common.typ"] = sources["common.typ"].replace(
        b"#let scanned = false", _describe_marks(marks).encode(), 1
    )
    blank = b'<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"/>'
    empty = {f"code-{page}.svg": blank for page in range(1, MOST_PAGES + 1)}
    sources, rows = fit_to_pages(
        paper,
        sources,
        lambda files: (files, query_metadata({**files, **empty}, "spot")),
        lambda made: _count_pages(made[1]),
    )
    pages = _count_pages(rows)
    if pages > MOST_PAGES:
        raise RenderError(f"PDF: a paper of {pages} pages (at most {MOST_PAGES} can be scanned)")
    codes = {f"code-{page}.svg": draw_page_code(code_of(page)) for page in range(1, pages + 1)}
    places = SheetPlaces(PAPER_VERSION, pages, SIZE, marks, CODE, tuple(_iter_fields(rows)))
    return compile_pdf({**sources, **codes}), places


def _count_pages(rows: Iterable[Sequence[Any]]) -> int:
    """Return the pages of a document by what it says of its fields."""
    return max(row[2] for row in rows)


def _describe_marks(marks: Sequence[tuple[float, float, float]]) -> str:
    """Return what the layout is told of marks and codes, as Typst source."""
    placed = [
        f"({x}, {y}, {side}, ({', '.join(map(typst_literal, rows))}))"
        for (x, y, side), rows in zip(marks, MARKS, strict=True)
    ]
    return f"#let scanned = true\n#let marks = ({', '.join(placed)})\n#let code = {CODE}"


def _iter_fields(rows: Sequence[Sequence[Any]]) -> Iterator[SheetField]:
    """Yield the fields from what the layout says of itself, in the order of the paper.

    A field belongs to the part that began last, unless it stands in a text and names its part.
    """
    number = part = ""
    for kind, what, page, *place in rows:
        if kind == "question":
            number = part = what
        elif kind == "part":
            part = number + what
        if kind not in KINDS:
            continue
        x, y, w, h = place
        whose, option = part, what
        if (kind in {"line", "box"} and what != what.strip(" ")) or (kind == "box" and " " in what):
            label, _, option = what.partition(" ")
            whose = number + label
        elif kind == "line":
            whose, option = (number + what if what else part), ""
        if kind == "room" and h < LEAST:
            continue
        option = POWER if kind == "power" else option
        more = STROKE / 2 if kind in {"box", "frame", "number", "power"} else 0.0
        yield SheetField(
            page, whose, KINDS[kind],
            round(x - more, 2), round(y - more, 2), round(w + 2 * more, 2), round(h + 2 * more, 2),
            option, kind in {"number", "power"},
        )  # fmt: skip
