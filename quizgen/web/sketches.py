"""Lines that were drawn, as they are shown over the field: with scripts and without."""

from __future__ import annotations

from collections.abc import Sequence

from markupsafe import Markup

from quizgen.grading.drawing.strokes import read_strokes
from quizgen.kinds.contract import DrawingField
from quizgen.maths.notation import FormulaReadError

_LINE = Markup('<polyline points="{}"/>')


def strokes_to_svg(board: DrawingField, values: Sequence[str]) -> Markup:
    """The lines of an answer in the picture of its field; nothing if they cannot be read."""
    try:
        lines = read_strokes(" ".join(values), board.view)
    except FormulaReadError:
        return Markup()
    _, tall = board.picture_size
    return Markup().join(
        _LINE.format(" ".join(f"{x:.1f},{tall - y:.1f}" for x, y in map(board.to_picture, line)))
        for line in lines
    )
