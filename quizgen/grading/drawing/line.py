"""Lines: which way they bend, where they run and in which direction, where they end."""

from __future__ import annotations

import math
from functools import lru_cache

import msgspec

from quizgen.grading.drawing.fitting import (
    LineFrame,
    StrokeFit,
    fit_parabola,
    match_strokes,
    resample,
)
from quizgen.grading.drawing.sheet import DrawingComparison, Feature, to_floats
from quizgen.grading.drawing.strokes import FieldPoint, StrokePoints
from quizgen.maths.constants import Scalar

FLAT, MOST_BENT = 0.03, 0.25
"""Rise over length below which a line is straight, and that of a bow at most."""
ROUGH = 0.03
"""How far from a smooth curve a hand may draw, as a share of the length."""
TREMBLES = 0.012
"""How far it may at any length, as a share of the width of the field."""
NEAR = 0.045
"""How far from its place a line may run or end, as a share of the width of the field."""
TURNED = math.radians(10)
"""How far its direction may be off."""
ALIKE = math.radians(2)
"""Angle below which lines are told apart by where they run, not by their directions."""
COVERED = 0.55
"""Share of a wanted line that has to be there."""
CLEARLY = 0.06
"""Share of a circle's radius by which an end has to lie inside or outside."""
SHARE = 0.3
"""How far from its place it may end, as a share of its length."""


class LineFeature(Feature, frozen=True):
    """What makes a line right; every one that is set must hold.

    ``bend``: straight, or bent to the same side as the wanted line. ``on``: it lies on the wanted
    line, whose ends it need not reach, nearer to it in place and direction than half way to where
    a mistake has it. ``ends``: it begins and ends where the wanted one does. ``circle``: centre
    and radius; both ends are inside or outside as those of the wanted line.
    """

    bend: bool = False
    on: bool = False
    ends: bool = False
    circle: tuple[Scalar, Scalar, Scalar] | None = None

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check lines and circle.

        Raises
        ------
        ValueError
            If a line is too short or closed, or the circle has no radius.
        """
        sheet.compute_once(wanted_lines)
        if self.circle:
            circle_on_sheet(self.circle, sheet)

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether any line lies where one is wanted."""
        return bool(sheet.compute_once(fit_lines))

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether a line is long and even enough, and has all that is asked of it."""
        drawn, wish = (
            sheet.compute_once(fit_lines).get(name),
            sheet.compute_once(wanted_lines)[name],
        )
        if drawn is None or not wish.is_comparable(drawn):
            return False
        return (
            (not self.bend or wish.bends_alike(drawn))
            and (not self.on or wish.runs_along(drawn))
            and (not self.ends or wish.ends_alike(drawn))
            and (self.circle is None or _is_on_wanted_sides(self.circle, sheet, wish, drawn))
        )


class WantedLine(msgspec.Struct, frozen=True):
    """A wanted line with its own fit, and how near a drawn one must come.

    Parameters
    ----------
    line, frame, fit
        The line, its coordinates, and the curve of second degree that it is.
    near : float
        How far off a drawn line may run, as a share of the width of the field.
    turned : float
        How far its direction may be off, in radians.
    short : (float, float)
        How far from the first and the last point it may begin and end, as ``near``.
    """

    line: StrokePoints
    frame: LineFrame
    fit: StrokeFit
    near: float
    turned: float
    short: tuple[float, float]

    @classmethod
    def from_stroke(cls, line: StrokePoints, others: list[StrokePoints]) -> WantedLine:
        """Return a wanted line that is told apart from where mistakes have it.

        Raises
        ------
        ValueError
            If it has no two ends apart from each other.
        """
        frame, own = _fit_wanted_line(tuple(line))
        placed = [(frame(other[0]), frame(other[-1])) for other in others]
        turns = [_measure_angle_to_axis(*ends) for ends in placed]
        gaps = [abs(a[1] + b[1]) / 2
                for (a, b), turn in zip(placed, turns, strict=True) if turn < ALIKE]  # fmt: skip
        turned = max(TURNED, math.atan(2 * TREMBLES / frame.length))
        end = min(NEAR, SHARE * frame.length)
        return cls(
            line, frame, own,
            _halve_distance(NEAR, gaps, NEAR / 10), _halve_distance(turned, turns, ALIKE),
            (_halve_distance(end, [abs(a[0]) for a, _ in placed], NEAR / 10),
             _halve_distance(end, [abs(b[0] - frame.length) for _, b in placed], NEAR / 10)),
        )  # fmt: skip

    def is_comparable(self, drawn: StrokeFit) -> bool:
        """Return whether a drawn line is long and even enough to be judged."""
        length = 2 * drawn.half
        return (drawn.half >= COVERED * self.fit.half
                and drawn.rough * length <= max(ROUGH * length, TREMBLES))  # fmt: skip

    def bends_alike(self, drawn: StrokeFit) -> bool:
        """Return whether it is straight as wanted, or bent to the same side."""
        bow, wanted = drawn.curvature, self.fit.curvature
        if abs(wanted) < FLAT:
            return abs(drawn.curve) < max(FLAT * 2 * drawn.half, 2 * TREMBLES)
        return FLAT <= math.copysign(bow, bow * wanted) <= MOST_BENT

    def runs_along(self, drawn: StrokeFit) -> bool:
        """Return whether it lies on the wanted one, as far as both run."""
        first = max(drawn.middle - drawn.half, self.fit.middle - self.fit.half)
        last = min(drawn.middle + drawn.half, self.fit.middle + self.fit.half)
        places = (first, (first + last) / 2, last)
        off = [abs(drawn.offset_at(place) - self.fit.offset_at(place)) for place in places]
        turned = math.atan2(drawn.slope, drawn.half) - math.atan2(self.fit.slope, self.fit.half)
        return off[1] <= self.near and max(off) <= NEAR and abs(turned) <= self.turned

    def ends_alike(self, drawn: StrokeFit) -> bool:
        """Return whether it begins and ends where the wanted one does."""
        begins, stops = drawn.middle - drawn.half, drawn.middle + drawn.half
        return abs(begins) <= self.short[0] and abs(stops - self.frame.length) <= self.short[1]


@lru_cache(maxsize=512)
def _fit_wanted_line(line: tuple[FieldPoint, ...]) -> tuple[LineFrame, StrokeFit]:
    """Return a wanted line's frame and fit, cached since a key brings the same line again.

    Raises
    ------
    ValueError
        If it is closed or too short.
    """
    if len(line) < 2 or line[0] == line[-1]:
        raise ValueError("a line has two ends, apart from each other")
    frame = LineFrame.of(line)
    own = fit_parabola(resample(line, frame.length / 40), frame)
    if own is None:
        raise ValueError("a line is too short for its field")
    return frame, own


def fit_lines(sheet: DrawingComparison) -> dict[str, StrokeFit]:
    """Return the drawn lines by the names of those that they are taken for."""
    return match_strokes(sheet.strokes, sheet.wanted)


def wanted_lines(sheet: DrawingComparison) -> dict[str, WantedLine]:
    """Return the wanted lines by their names, to compare drawn ones with."""
    return {
        name: WantedLine.from_stroke(line, [other[name] for other in sheet.others])
        for name, line in sheet.wanted.items()
    }


def _measure_angle_to_axis(first: FieldPoint, last: FieldPoint) -> float:
    """Return the angle of a line to the axis of a frame in radians, whichever way it runs."""
    return math.atan2(abs(last[1] - first[1]), abs(last[0] - first[0]))


def _halve_distance(most: float, distances: list[float], least: float) -> float:
    """Return half the distance to the nearest of others, at most ``most``.

    Others nearer than ``least`` are as good as in the same place and do not count.
    """
    return min([most, *(distance / 2 for distance in distances if distance > least)])


def _is_on_wanted_sides(
    circle: tuple[Scalar, ...], sheet: DrawingComparison, wish: WantedLine, drawn: StrokeFit
) -> bool:
    """Return whether both ends lie clearly inside or outside the circle, as the wanted ones do."""
    centre, limit = circle_on_sheet(circle, sheet)
    return all(
        (math.dist(end, centre) / limit - 1) * (1 if math.dist(goal, centre) > limit else -1)
        >= CLEARLY
        for end, goal in zip(drawn.ends, (wish.line[0], wish.line[-1]), strict=True)
    )


def circle_on_sheet(
    circle: tuple[Scalar, ...], sheet: DrawingComparison
) -> tuple[FieldPoint, float]:
    """Return centre and radius of a circle, as shares of the width of the field.

    Raises
    ------
    ValueError
        If the radius is not above 0.
    """
    x, y, radius = to_floats(circle)
    if radius <= 0:
        raise ValueError("circle: its radius must be above 0")
    centre, rim = sheet.scale.line([(x, y), (x + radius, y)])
    return centre, math.dist(centre, rim)
