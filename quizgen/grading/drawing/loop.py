"""Closed lines: ellipses and circles around their centres."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import fmean

from quizgen.grading.drawing.curve import FINE
from quizgen.grading.drawing.fitting import resample
from quizgen.grading.drawing.line import NEAR
from quizgen.grading.drawing.sheet import DrawingComparison, Feature, to_floats
from quizgen.grading.drawing.strokes import FieldPoint, StrokePoints
from quizgen.maths.constants import Scalar

DIRECTIONS = 16
"""Directions from the centre in which the line is looked for."""
COVERED = 0.85
"""Share of the directions in which there has to be something."""
TREMBLES = 0.014
"""How far a half axis may always be off, as a share of the width of the field."""
ROUND = 0.075
"""How far from its shape a loop may be in the mean, as a share of its longest half axis."""


class LoopFeature(Feature, frozen=True):
    """What makes a closed line right; every one that is set must hold.

    ``centre``: its middle is where the wanted one's is. ``within``: its width and its height are
    those of the wanted one, too much or too little by that share at most, and less than half way
    to those of a mistake. ``form``: it has the wanted shape, whatever its size.
    """

    centre: bool = False
    within: Scalar = 0
    form: bool = False

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check that something is asked, and that the wanted lines are closed.

        Raises
        ------
        ValueError
            If not.
        """
        share = to_floats([self.within])[0]
        if not (self.centre or self.form or share) or not 0 <= share < 1:
            raise ValueError("centre, form or within (a share below 1) must be asked of a loop")
        for name in self.of:
            line = sheet.wanted[name]
            if math.dist(line[0], line[-1]) > FINE or not all(_half_axes(line)):
                raise ValueError("a loop ends where it begins, and is as wide as it is high or so")

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether any closed line was drawn."""
        return any(sheet.compute_once(drawn_loops).values())

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether a line goes all around and has all that is asked of it."""
        drawn, wanted = sheet.compute_once(drawn_loops)[name], sheet.wanted[name]
        if not drawn:
            return False
        return (
            (not self.centre or math.dist(_centre(drawn), _centre(wanted)) <= NEAR)
            and (not to_floats([self.within])[0] or self._is_as_large(name, sheet, drawn))
            and (not self.form or _differ(drawn, wanted) <= ROUND)
        )

    def _is_as_large(
        self, name: str, sheet: DrawingComparison, drawn: Sequence[FieldPoint]
    ) -> bool:
        """Return whether both half axes are as long as wanted, and nearer than a mistake's."""
        found, within = _steady_axes(drawn), to_floats([self.within])[0]
        others = [_steady_axes(other[name]) for other in sheet.others]
        for place, goal in enumerate(_steady_axes(sheet.wanted[name])):
            apart = [abs(other[place] / goal - 1) / 2 for other in others]
            near = min([max(within, TREMBLES / goal), *(gap for gap in apart if gap > within / 4)])
            if abs(found[place] / goal - 1) > near:
                return False
        return True


def drawn_loops(sheet: DrawingComparison) -> dict[str, list[FieldPoint]]:
    """Return the points drawn around each wanted loop, by its name; none if it is not closed.

    A stroke belongs to the loop whose middle is nearest to its own.
    """
    centres = {name: _centre(line) for name, line in sheet.wanted.items()}
    found: dict[str, list[FieldPoint]] = {name: [] for name in centres}
    for stroke in sheet.strokes:
        points = resample(stroke, FINE)
        middle = _centre(points)
        nearest = min(centres, key=lambda name: math.dist(centres[name], middle))
        found[nearest] += points
    return {name: points if _is_closed(points) else [] for name, points in found.items()}


def _is_closed(points: Sequence[FieldPoint]) -> bool:
    """Return whether points lie around their middle in nearly all directions."""
    if not points or not all(_half_axes(points)):
        return False
    return len(_smooth(points)) >= COVERED * DIRECTIONS


def _centre(points: StrokePoints) -> FieldPoint:
    """Return the middle of the box around points."""
    across, up = zip(*points, strict=True)
    return (min(across) + max(across)) / 2, (min(up) + max(up)) / 2


def _half_axes(points: StrokePoints) -> FieldPoint:
    """Return half the width and half the height of points."""
    across, up = zip(*points, strict=True)
    return (max(across) - min(across)) / 2, (max(up) - min(up)) / 2


def _steady_axes(line: StrokePoints) -> FieldPoint:
    """Return half the width and half the height of a loop without the trembling of a hand."""
    return _half_axes([*_smooth(resample(line, FINE)).values()])


def _smooth(points: StrokePoints) -> dict[int, FieldPoint]:
    """Return the mean point in each direction from the middle: a hand trembles."""
    (x_0, y_0), (a, b) = _centre(points), _half_axes(points)
    found: dict[int, list[FieldPoint]] = {}
    for x, y in points:
        turn = math.atan2((y - y_0) / b, (x - x_0) / a) / (2 * math.pi)
        found.setdefault(round(turn * DIRECTIONS) % DIRECTIONS, []).append((x, y))
    return {turn: (fmean(x for x, _ in near), fmean(y for _, y in near))
            for turn, near in found.items()}  # fmt: skip


def _radii(points: StrokePoints) -> dict[int, float]:
    """Return the distance from the middle by direction, in units of the half axes.

    An ellipse along the axes has 1 everywhere, so that only the shape counts.
    """
    outline = _smooth(points)
    (x_0, y_0), (a, b) = _centre([*outline.values()]), _half_axes([*outline.values()])
    return {turn: math.hypot((x - x_0) / a, (y - y_0) / b) for turn, (x, y) in outline.items()}


def _differ(drawn: StrokePoints, wanted: StrokePoints) -> float:
    """Return by how much the shapes differ in the mean over all directions."""
    one, other = _radii(drawn), _radii(resample(wanted, FINE))
    shared = one.keys() & other.keys()
    return sum(abs(one[turn] - other[turn]) for turn in shared) / len(shared)
