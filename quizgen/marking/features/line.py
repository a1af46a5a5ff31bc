"""Lines: which way they bend, where they run and in which direction, where they end."""

from __future__ import annotations

import math
from functools import lru_cache

import msgspec

from quizgen.marking.features.sheet import Feature, Sheet, numbers
from quizgen.marking.judging.drawing import Fit, Frame, fit, fitted, resampled
from quizgen.marking.reading.strokes import Point, Stroke
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


class Line(Feature, frozen=True):
    """All that is said here, of each line.

    ``bend``: straight, or bent to the same side as the wanted line. ``on``: it lies on the wanted
    line, whose ends it need not reach, nearer to it in place and direction than half way to where
    a mistake has it. ``ends``: it begins and ends where the wanted one does. ``circle``: centre
    and radius; both ends are inside or outside as those of the wanted line.
    """

    bend: bool = False
    on: bool = False
    ends: bool = False
    circle: tuple[Scalar, Scalar, Scalar] | None = None

    def validate(self, sheet: Sheet, /) -> None:
        """Check lines and circle."""
        sheet.once(wishes)
        if self.circle:
            round_about(self.circle, sheet)

    def seen(self, sheet: Sheet, /) -> bool:
        """Whether any line lies where one is wanted."""
        return bool(sheet.once(fits))

    def has(self, name: str, sheet: Sheet, /) -> bool:
        """Whether a line has it."""
        drawn, wish = sheet.once(fits).get(name), sheet.once(wishes)[name]
        if drawn is None or not wish.found(drawn):
            return False
        return (
            (not self.bend or wish.bends(drawn))
            and (not self.on or wish.covers(drawn))
            and (not self.ends or wish.ends(drawn))
            and (self.circle is None or _sides(self.circle, sheet, wish, drawn))
        )


class Wish(msgspec.Struct, frozen=True):
    """A wanted line with its own fit, and where mistakes have it."""

    line: Stroke
    frame: Frame
    fit: Fit
    near: float
    turned: float
    short: tuple[float, float]

    @classmethod
    def of(cls, line: Stroke, others: list[Stroke]) -> Wish:
        """A line that is told apart from others."""
        frame, own = _own(tuple(line))
        placed = [(frame(other[0]), frame(other[-1])) for other in others]
        turns = [_turn(*ends) for ends in placed]
        gaps = [abs(a[1] + b[1]) / 2
                for (a, b), turn in zip(placed, turns, strict=True) if turn < ALIKE]  # fmt: skip
        turned = max(TURNED, math.atan(2 * TREMBLES / frame.length))
        end = min(NEAR, SHARE * frame.length)
        return cls(
            line, frame, own,
            _half_way(NEAR, gaps, NEAR / 10), _half_way(turned, turns, ALIKE),
            (_half_way(end, [abs(a[0]) for a, _ in placed], NEAR / 10),
             _half_way(end, [abs(b[0] - frame.length) for _, b in placed], NEAR / 10)),
        )  # fmt: skip

    def found(self, drawn: Fit) -> bool:
        """Whether a drawn line is long and even enough to be judged."""
        length = 2 * drawn.half
        return (drawn.half >= COVERED * self.fit.half
                and drawn.rough * length <= max(ROUGH * length, TREMBLES))  # fmt: skip

    def bends(self, drawn: Fit) -> bool:
        """Whether it is straight, or bent to the same side."""
        bow, wanted = drawn.bow, self.fit.bow
        if abs(wanted) < FLAT:
            return abs(drawn.curve) < max(FLAT * 2 * drawn.half, 2 * TREMBLES)
        return FLAT <= math.copysign(bow, bow * wanted) <= MOST_BENT

    def covers(self, drawn: Fit) -> bool:
        """Whether it lies on the wanted one, as far as both run."""
        first = max(drawn.middle - drawn.half, self.fit.middle - self.fit.half)
        last = min(drawn.middle + drawn.half, self.fit.middle + self.fit.half)
        places = (first, (first + last) / 2, last)
        off = [abs(drawn.off(place) - self.fit.off(place)) for place in places]
        turned = math.atan2(drawn.slope, drawn.half) - math.atan2(self.fit.slope, self.fit.half)
        return off[1] <= self.near and max(off) <= NEAR and abs(turned) <= self.turned

    def ends(self, drawn: Fit) -> bool:
        """Whether it begins and ends where the wanted one does."""
        begins, stops = drawn.middle - drawn.half, drawn.middle + drawn.half
        return abs(begins) <= self.short[0] and abs(stops - self.frame.length) <= self.short[1]


@lru_cache(maxsize=512)
def _own(line: tuple[Point, ...]) -> tuple[Frame, Fit]:
    """A wanted line's frame and fit; a key that is read again brings the same line."""
    if len(line) < 2 or line[0] == line[-1]:
        raise ValueError("a line has two ends, apart from each other")
    frame = Frame.of(line)
    own = fit(resampled(line, frame.length / 40), frame)
    if own is None:
        raise ValueError("a line is too short for its field")
    return frame, own


def fits(sheet: Sheet) -> dict[str, Fit]:
    """The drawn lines by the names of those that they are taken for."""
    return fitted(sheet.strokes, sheet.wanted)


def wishes(sheet: Sheet) -> dict[str, Wish]:
    """The wanted lines, to compare drawn ones with."""
    return {
        name: Wish.of(line, [other[name] for other in sheet.others])
        for name, line in sheet.wanted.items()
    }


def _turn(first: Point, last: Point) -> float:
    """Angle of a line to the axis of a frame, whichever way it runs."""
    return math.atan2(abs(last[1] - first[1]), abs(last[0] - first[0]))


def _half_way(most: float, distances: list[float], least: float) -> float:
    """Half way to the nearest of others, as far as they are apart from what is wanted at all."""
    return min([most, *(distance / 2 for distance in distances if distance > least)])


def _sides(circle: tuple[Scalar, ...], sheet: Sheet, wish: Wish, drawn: Fit) -> bool:
    centre, limit = round_about(circle, sheet)
    return all(
        (math.dist(end, centre) / limit - 1) * (1 if math.dist(goal, centre) > limit else -1)
        >= CLEARLY
        for end, goal in zip(drawn.ends, (wish.line[0], wish.line[-1]), strict=True)
    )


def round_about(circle: tuple[Scalar, ...], sheet: Sheet) -> tuple[Point, float]:
    """Centre and radius of a circle on a sheet."""
    x, y, radius = numbers(circle)
    if radius <= 0:
        raise ValueError("circle: its radius must be above 0")
    centre, rim = sheet.scale.line([(x, y), (x + radius, y)])
    return centre, math.dist(centre, rim)
