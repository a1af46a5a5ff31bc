"""Heights of a curve at places along the horizontal axis."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from quizgen.grading.drawing.curve import FINE, drawn_heights
from quizgen.grading.drawing.fitting import resample
from quizgen.grading.drawing.sheet import DrawingComparison, Feature, to_floats
from quizgen.grading.drawing.strokes import FieldPoint, StrokePoints
from quizgen.maths.constants import Scalar

AROUND = 0.018
"""How far from a place along x a hand may have put what belongs there."""
LEAST = 0.05
"""How far off a height may always be, as a share of the height of the field."""


class HeightFeature(Feature, frozen=True):
    """At every place of ``at`` the curve is as high as wanted.

    ``within`` is the share of the wanted height that it may be too much or too little. It must be
    nearer than half way to where a mistake has it. Where the wanted line does not pass, nothing
    may be drawn.
    """

    at: list[Scalar]
    within: Scalar

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check the share, and that the places lie in the field.

        Raises
        ------
        ValueError
            If one of them cannot serve.
        """
        if not 0 < to_floats([self.within])[0] < 1:
            raise ValueError("within: a share above 0 and below 1")
        left, right = sheet.scale.view[:2]
        if not self.at or not all(left <= x <= right for x in to_floats(self.at)):
            raise ValueError("at: places along x, inside the field")

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether there is a line above or below any of the wanted ones."""
        return any(sheet.compute_once(drawn_heights)[name] for name in self.of)

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether there is one curve, and it passes where wanted at every place."""
        if not sheet.compute_once(drawn_heights)[name]:
            return False
        lines = [sheet.wanted[name], *(other[name] for other in sheet.others)]
        wanted, *wrong = (self._wanted_heights(sheet, line) for line in lines)
        points = sheet.compute_once(_drawn_points)
        return all(
            not any(abs(x - place) <= AROUND for x, _ in points)
            if goal is None
            else _passes(points, place, goal, self._reach(sheet, goal, others))
            for place, goal, *others in zip(self._places(sheet), wanted, *wrong, strict=True)
        )

    def _reach(
        self, sheet: DrawingComparison, goal: float, others: Sequence[float | None]
    ) -> float:
        """Return how far from a height the curve may pass, less than half way to a mistake's."""
        least = LEAST * sheet.scale.point((0.0, sheet.scale.view[3]))[1]
        apart = [abs(other - goal) / 2 for other in others if other is not None]
        most = max(to_floats([self.within])[0] * goal, least)
        return min([most, *(gap for gap in apart if gap > least / 3)])

    def _places(self, sheet: DrawingComparison) -> list[float]:
        """Return the places along x, as shares of the width."""
        low = sheet.scale.view[2]
        return [sheet.scale.point((x, low))[0] for x in to_floats(self.at)]

    def _wanted_heights(self, sheet: DrawingComparison, line: StrokePoints) -> list[float | None]:
        """Return the heights of a wanted line at the places; None where it does not pass."""
        return [_interpolate(line, place) for place in self._places(sheet)]


def _interpolate(line: StrokePoints, place: float) -> float | None:
    """Return the height of a line of straight pieces at a place along x."""
    for (x, y), (to_x, to_y) in pairwise(line):
        if min(x, to_x) - 1e-9 <= place <= max(x, to_x) + 1e-9 and x != to_x:
            return y + (to_y - y) * (place - x) / (to_x - x)
    return None


def _drawn_points(sheet: DrawingComparison) -> list[FieldPoint]:
    """Return points along all strokes."""
    return [point for stroke in sheet.strokes for point in resample(stroke, FINE)]


def _passes(points: Sequence[FieldPoint], place: float, goal: float, reach: float) -> bool:
    """Return whether some point lies at a place along x and near a height."""
    return any(abs(x - place) <= AROUND and abs(y - goal) <= reach for x, y in points)
