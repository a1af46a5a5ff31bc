"""A small picture as a grid of numbers, or of black and white cells, and a kernel beside it.

Nothing in it is asked for, so that a quiz hides nothing.
"""

from __future__ import annotations

from quizgen.figures.kit import ABSENT, BOLD, SHADE, THIN, Canvas, Parameter, Pen, Values, given

DARK = "invert"

ROWS, COLUMNS, KERNEL = 5, 9, 3
CELL, MARGIN, GAP, HEAD = 30.0, 8.0, 48.0, 18.0

PARAMETERS = {
    "rows": Parameter("", "rows of the picture", 3.0, 1.0, float(ROWS), whole=True),
    "columns": Parameter("", "columns of the picture", 3.0, 1.0, float(COLUMNS), whole=True),
    "binary": Parameter("", "1 draws cells, grey for the value 1", 0.0, 0.0, 1.0, whole=True),
    **{
        f"v{y}{x}": Parameter("", f"value in row {y}, column {x}", 0.0)
        for y in range(ROWS)
        for x in range(COLUMNS)
    },
    **{
        f"k{y}{x}": Parameter("", f"kernel in row {y}, column {x}", ABSENT)
        for y in range(KERNEL)
        for x in range(KERNEL)
    },
}

WORDS = {
    "en": {
        "numbers": "A picture of {rows} rows and {columns} columns of numbers.",
        "cells": "A picture of {rows} rows and {columns} columns; grey cells are 1, white ones 0.",
        "row": " Row {y}: {values}.",
        "kernel": " Beside it the kernel w with 3 rows.",
    },
    "de": {
        "numbers": "Ein Bild aus {rows} Zeilen und {columns} Spalten von Zahlen.",
        "cells": "Ein Bild aus {rows} Zeilen und {columns} Spalten; graue Zellen sind 1, weiße 0.",
        "row": " Zeile {y}: {values}.",
        "kernel": " Daneben der Kern w mit 3 Zeilen.",
    },
}


def _rows(values: Values, letter: str, rows: int, columns: int) -> list[list[float]]:
    return [[values[f"{letter}{y}{x}"] for x in range(columns)] for y in range(rows)]


def _picture(values: Values) -> list[list[float]]:
    return _rows(values, "v", int(values["rows"]), int(values["columns"]))


def _kernel(values: Values) -> list[list[float]]:
    return _rows(values, "k", KERNEL, KERNEL) if "k00" in values else []


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; a quiz hides nothing."""
    del quiz
    picture, kernel = _picture(values), _kernel(values)
    wide = len(picture[0]) * CELL
    head = HEAD if kernel else 0.0
    beside = GAP + KERNEL * CELL if kernel else 0.0
    pen = Pen(2 * MARGIN + wide + beside, 2 * MARGIN + len(picture) * CELL + head)
    _grid(pen, picture, MARGIN, filled=bool(values["binary"]))
    if kernel:
        top = pen.height - MARGIN + 2
        _grid(pen, kernel, MARGIN + wide + GAP, filled=False)
        pen.label((MARGIN + wide / 2, top - 4), "f")
        pen.label((MARGIN + wide + GAP + KERNEL * CELL / 2, top - 4), "w")
    pen.onto(canvas)


def _grid(pen: Pen, rows: list[list[float]], left: float, *, filled: bool) -> None:
    """Cells with their numbers, the first row on top."""
    for y, row in enumerate(reversed(rows)):
        for x, value in enumerate(row):
            low, start = MARGIN + y * CELL, left + x * CELL
            corners = [(start, low), (start + CELL, low),
                       (start + CELL, low + CELL), (start, low + CELL)]  # fmt: skip
            if filled and value:
                pen.area("ones", corners, SHADE)
            pen.area("cells", corners, THIN)
            if not filled:
                pen.label((start + CELL / 2, low + CELL / 2), given(value))
    wide, high = len(rows[0]) * CELL, len(rows) * CELL
    frame = [(left, MARGIN), (left + wide, MARGIN), (left + wide, MARGIN + high),
             (left, MARGIN + high)]  # fmt: skip
    pen.area("frame", frame, BOLD)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words: every number, row by row."""
    del quiz
    words = WORDS.get(lang, WORDS["en"])
    picture = _picture(values)
    kind = "cells" if values["binary"] else "numbers"
    told = words[kind].format(rows=len(picture), columns=len(picture[0]))
    told += _told(picture, words)
    kernel = _kernel(values)
    return told + (words["kernel"] + _told(kernel, words) if kernel else "")


def _told(rows: list[list[float]], words: dict[str, str]) -> str:
    return "".join(
        words["row"].format(y=y, values=", ".join(map(given, row))) for y, row in enumerate(rows, 1)
    )
