"""What figures are drawn with, apart from matplotlib: one import for authors.

A figure is a module ``templates/figures/<name>.py`` of a bank, or ``figure.py`` in the folder of a
template; ``docs/figures.md`` shows both.
"""

from __future__ import annotations

from quizgen.figures.alt_text import (
    format_derived,
    format_equation,
    format_given,
    format_statement,
    load_alt_words,
    relation_sign,
    strip_mathtext,
)
from quizgen.figures.parameters import ABSENT, Parameter, Values, require

COLUMN = (250.0, 120.0)
WIDE = (312.0, 170.0)
SQUARE = (176.0, 176.0)
"""Ready sizes of axes or of a sheet in points: a text column, 11 by 6 cm, and a square."""

__all__ = [
    "ABSENT",
    "COLUMN",
    "SQUARE",
    "WIDE",
    "Parameter",
    "Values",
    "format_derived",
    "format_equation",
    "format_given",
    "format_statement",
    "load_alt_words",
    "relation_sign",
    "require",
    "strip_mathtext",
]
