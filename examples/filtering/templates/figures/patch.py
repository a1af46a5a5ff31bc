"""A small picture as a grid of numbers, or of black and white cells, and a kernel beside it.

Nothing in it is asked for, so that a quiz hides nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import ABSENT, Parameter, Values, format_given

if TYPE_CHECKING:
    from quizgen.figures.sketch import Sketch

CELL, GAP = 30.0, 48.0
SIZE = (9 * CELL, 5 * CELL)

PARAMETERS = {
    "picture": Parameter("", "rows of grey values", kind="table"),
    "kernel": Parameter("", "rows of a kernel beside it", ABSENT, kind="table"),
    "binary": Parameter("", "1 draws cells, grey for the value 1", 0.0, 0.0, 1.0, whole=True),
}

WORDS = {
    "en": {
        "numbers": "A picture of {rows} rows and {columns} columns of numbers.",
        "cells": "A picture of {rows} rows and {columns} columns; grey cells are 1, white ones 0.",
        "row": " Row {y}: {values}.",
        "kernel": " Beside it the kernel w with {rows} rows.",
    },
    "de": {
        "numbers": "Ein Bild aus {rows} Zeilen und {columns} Spalten von Zahlen.",
        "cells": "Ein Bild aus {rows} Zeilen und {columns} Spalten; graue Zellen sind 1, weiße 0.",
        "row": " Zeile {y}: {values}.",
        "kernel": " Daneben der Kern w mit {rows} Zeilen.",
    },
}

Rows = Sequence[Sequence[float]]


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; a quiz hides nothing."""
    del quiz
    sketch, picture = fig.sketch(), values["picture"]
    _draw_grid(sketch, picture, 0.0, "$f$" if "kernel" in values else "", values["binary"])
    if "kernel" in values:
        _draw_grid(sketch, values["kernel"], len(picture[0]) * CELL + GAP, "$w$")


def _draw_grid(sketch: Sketch, rows: Rows, left: float, name: str, filled: float = 0) -> None:
    """Cells with their numbers, the first row on top."""
    wide, high = len(rows[0]) * CELL, len(rows) * CELL
    for y, row in enumerate(rows):
        for x, value in enumerate(row):
            start, top = left + x * CELL, high - y * CELL
            corners = [(start, top), (start + CELL, top), (start + CELL, top - CELL),
                       (start, top - CELL)]  # fmt: skip
            sketch.area(corners, "rule" if filled and value else None, "ink", 0.7, part="cells")
            if not filled:
                sketch.label((start + CELL / 2, top - CELL / 2), format_given(value))
    frame = [(left, 0), (left + wide, 0), (left + wide, high), (left, high)]
    sketch.area(frame, None, "ink", 1.6, part="frame")
    sketch.label((left + wide / 2, high + 10), name)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words: every number, row by row."""
    del quiz
    words, picture = WORDS.get(lang, WORDS["en"]), values["picture"]
    kind = "cells" if values["binary"] else "numbers"
    text = words[kind].format(rows=len(picture), columns=len(picture[0]))
    text += _describe_rows(picture, words)
    if "kernel" in values:
        kernel = values["kernel"]
        text += words["kernel"].format(rows=len(kernel)) + _describe_rows(kernel, words)
    return text


def _describe_rows(rows: Rows, words: dict[str, str]) -> str:
    return "".join(
        words["row"].format(y=y, values=", ".join(map(format_given, row)))
        for y, row in enumerate(rows, 1)
    )
