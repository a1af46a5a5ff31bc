"""What figures are drawn with.

A figure is a module ``templates/figures/<name>.py`` of a bank with ``PARAMETERS``, ``DARK``,
``draw`` and ``alt``, as ``_module.FigureModule`` says; ``docs/banks.md`` shows one.
"""

from __future__ import annotations

from quizgen.figures._canvas import Canvas, Style
from quizgen.figures._numbers import (
    derived,
    equation,
    given,
    numbered,
    relation,
    spoken,
    statement,
)
from quizgen.figures._parameters import ABSENT, Parameter, Values, require
from quizgen.figures._pen import (
    BOLD,
    DASHED,
    DEEP,
    DOTTED,
    GREY,
    HEIGHT,
    INK,
    LINE,
    RAY,
    RED,
    SHADE,
    THIN,
    WIDTH,
    Pen,
    Point,
    text_width,
)
from quizgen.figures._words import words_of

__all__ = [
    "ABSENT",
    "BOLD",
    "DASHED",
    "DEEP",
    "DOTTED",
    "GREY",
    "HEIGHT",
    "INK",
    "LINE",
    "RAY",
    "RED",
    "SHADE",
    "THIN",
    "WIDTH",
    "Canvas",
    "Parameter",
    "Pen",
    "Point",
    "Style",
    "Values",
    "derived",
    "equation",
    "given",
    "numbered",
    "relation",
    "require",
    "spoken",
    "statement",
    "text_width",
    "words_of",
]
