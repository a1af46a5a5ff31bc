"""Points: a dot, a tick or a cross in the right place, and no other mark."""

from __future__ import annotations

import math
from collections.abc import Sequence

from quizgen.grading.drawing.line import NEAR
from quizgen.grading.drawing.sheet import DrawingComparison, Feature
from quizgen.grading.drawing.strokes import FieldPoint, StrokePoints

LARGEST = 0.15
"""Share of the width of the field that a stroke of a mark may be wide or tall at most."""


class PointFeature(Feature, frozen=True):
    """A small mark lies at the middle of the wanted line, and no mark elsewhere.

    It must be nearer than half way to where a mistake has it.
    """

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether any mark was made."""
        return bool(_find_marks(sheet))

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether the mark is there, and every mark at some wanted point."""
        marks = _find_marks(sheet)
        places = [_find_middle(sheet.wanted[one]) for one in self.of]
        goal = _find_middle(sheet.wanted[name])
        return any(_is_near(mark, goal, name, sheet) for mark in marks) and all(
            any(math.dist(mark, place) <= NEAR for place in places) for mark in marks
        )


def _is_near(mark: FieldPoint, goal: FieldPoint, name: str, sheet: DrawingComparison) -> bool:
    """Return whether a mark is at a point, as far as known mistakes allow."""
    wrong = (_find_middle(other[name]) for other in sheet.others if name in other)
    rivals = [far / 2 for place in wrong if (far := math.dist(place, goal)) > 0]
    return math.dist(mark, goal) <= min([NEAR, *rivals])


def _find_marks(sheet: DrawingComparison) -> list[FieldPoint]:
    """Return the middles of the strokes that are small enough for a mark."""
    return [_find_middle(stroke) for stroke in sheet.strokes if _measure(stroke) <= LARGEST]


def _find_middle(stroke: StrokePoints | Sequence[FieldPoint]) -> FieldPoint:
    """Return the middle of the box around a stroke."""
    across, up = zip(*stroke, strict=True)
    return (min(across) + max(across)) / 2, (min(up) + max(up)) / 2


def _measure(stroke: StrokePoints) -> float:
    """Return how wide or tall a stroke is, whichever is more."""
    across, up = zip(*stroke, strict=True)
    return max(max(across) - min(across), max(up) - min(up))
