"""What a bank's own figures are drawn with.

A figure is a module ``figures/<name>.py`` of the bank with ``PARAMETERS``, ``DARK``, ``draw`` and
``alt``, as ``_table.FigureModule`` says; ``docs/banks.md`` shows one.
"""

from __future__ import annotations

from quizgen.figures._canvas import Canvas, Style
from quizgen.figures._numbers import derived, equation, given
from quizgen.figures._parameters import ABSENT, Parameter, Values, require
from quizgen.figures._pen import (
    BOLD,
    DASHED,
    DEEP,
    DOTTED,
    GREY,
    INK,
    LINE,
    RAY,
    RED,
    SHADE,
    THIN,
    Pen,
    Point,
)

__all__ = [
    "ABSENT",
    "BOLD",
    "DASHED",
    "DEEP",
    "DOTTED",
    "GREY",
    "INK",
    "LINE",
    "RAY",
    "RED",
    "SHADE",
    "THIN",
    "Canvas",
    "Parameter",
    "Pen",
    "Point",
    "Style",
    "Values",
    "derived",
    "equation",
    "given",
    "require",
]
