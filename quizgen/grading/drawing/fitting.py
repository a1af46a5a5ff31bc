"""What a drawn line is like: which wanted line it is, how far it bends, where it leads.

All lengths are shares of the width of the field. Lines are told apart by where they lie and which
way they run, piece by piece, so that it does not matter in how many strokes they were drawn,
from which end, or how often.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from operator import mul

import msgspec

from quizgen.grading.drawing.strokes import FieldPoint, StrokePoints

STEP, MOST_SAMPLES, COARSE = 0.02, 1000, 3
"""Distance of samples, how many there are at most, every which is held against each line."""
STRAIGHT = 0.03
"""How far a piece of a stroke may be from straight."""
SHORT = 0.05
"""Length below which a piece has no direction: a hand trembles."""
REACH = 0.25
"""How far from its place a line is still known."""
BEYOND = 0.5
"""How much less it counts to lie beyond the end of a line than to lie beside it."""
TURNED = 0.77
"""Sine of the angle beyond which a line is another one."""
TURN_COSTS = 0.2
FEWEST = 4
"""Points that a curve of second degree does not pass through anyway."""
STRAY, LEAST_STRAY = 3.0, 0.01
"""How much farther off than the others a point is that belongs elsewhere, and how far at least."""
TINY = 1e-9
"""What is left of a number but rounding."""


class StrokeFit(msgspec.Struct, frozen=True):
    """A drawn line in the frame of the wanted one, as a curve of second degree.

    Parameters
    ----------
    middle, half : float
        Where along the wanted line it lies, and half its length.
    level, slope, curve : float
        Its distance from the chord of the wanted line: ``level + slope t + curve t²`` for ``t``
        from -1 to 1.
    rough : float
        How far it is from that curve, as a share of its length.
    ends : (Point, Point)
        In the field.
    """

    middle: float
    half: float
    level: float
    slope: float
    curve: float
    rough: float
    ends: tuple[FieldPoint, FieldPoint]

    @property
    def curvature(self) -> float:
        """Its rise over its length; positive to the left of the wanted line's direction."""
        return -self.curve / (2 * self.half)

    def offset_at(self, along: float) -> float:
        """Return the distance from the chord at a point along it."""
        t = (along - self.middle) / self.half
        return self.level + self.slope * t + self.curve * t * t

    def relative_offset(self, placed: FieldPoint) -> float:
        """Return how far from it a point of the frame is, as a share of its length."""
        along, off = placed
        return abs(off - self.offset_at(along)) / (2 * self.half)


class LineFrame(msgspec.Struct, frozen=True):
    """Coordinates along a wanted line's chord and across it, from its first point."""

    origin: FieldPoint
    way: FieldPoint
    length: float

    @classmethod
    def of(cls, line: StrokePoints) -> LineFrame:
        """Return the frame of a line that does not end where it begins."""
        (x, y), (to_x, to_y) = line[0], line[-1]
        length = math.hypot(to_x - x, to_y - y)
        return cls((x, y), ((to_x - x) / length, (to_y - y) / length), length)

    def __call__(self, point: FieldPoint) -> FieldPoint:
        """Return a point of the field as its distance along the chord, and to the left of it."""
        x, y = point[0] - self.origin[0], point[1] - self.origin[1]
        return x * self.way[0] + y * self.way[1], y * self.way[0] - x * self.way[1]


def match_strokes(
    strokes: Sequence[StrokePoints], wanted: Mapping[str, StrokePoints]
) -> dict[str, StrokeFit]:
    """Return the drawn lines by the names of the wanted ones that they are taken for.

    Wanted lines that nothing was drawn for are left out.
    """
    lines = {name: _LineMatcher(line) for name, line in wanted.items()}
    found: dict[str, list[FieldPoint]] = {}
    length = sum(math.dist(a, b) for stroke in strokes for a, b in pairwise(stroke))
    for stroke in strokes:
        for piece in split_at_corners(stroke):
            points = resample(piece, max(STEP, length / MOST_SAMPLES))
            name = _find_closest_line([*points[::COARSE], points[-1]], lines)
            if name is not None:
                found.setdefault(name, []).extend(points)
    fits = {
        name: fit_parabola(points, LineFrame.of(wanted[name])) for name, points in found.items()
    }
    return {name: one for name, one in fits.items() if one is not None}


def _find_closest_line(
    points: Sequence[FieldPoint], lines: Mapping[str, _LineMatcher]
) -> str | None:
    """Return the line that a piece of a stroke is taken for; None if it is none of them."""
    least, found = math.inf, None
    for name, line in lines.items():
        cost = line.cost(points, least)
        if cost < least:
            least, found = cost, name
    return found


def split_at_corners(stroke: StrokePoints) -> Iterator[StrokePoints]:
    """Yield the pieces of a stroke between its corners.

    A hand need not lift the pen between lines.
    """
    (x, y), (to_x, to_y) = stroke[0], stroke[-1]
    run = math.hypot(to_x - x, to_y - y)
    off = [abs((to_x - x) * (y - b) - (x - a) * (to_y - y)) / run if run
           else math.hypot(a - x, b - y) for a, b in stroke]  # fmt: skip
    far = max(range(len(off)), key=off.__getitem__)
    if off[far] <= STRAIGHT:
        yield stroke
    else:
        yield from split_at_corners(stroke[: far + 1])
        yield from split_at_corners(stroke[far:])


def resample(stroke: StrokePoints, step: float) -> list[FieldPoint]:
    """Return points along a stroke, no farther apart than a step."""
    points = [stroke[0]]
    for (x, y), (to_x, to_y) in pairwise(stroke):
        count = max(1, math.ceil(math.dist((x, y), (to_x, to_y)) / step))
        points += [(x + (to_x - x) * i / count, y + (to_y - y) * i / count)
                   for i in range(1, count + 1)]  # fmt: skip
    return points


class _LineMatcher:
    """A wanted line as what drawn points are compared with."""

    def __init__(self, line: StrokePoints) -> None:
        """Store where each piece of a line begins, its direction (length 1) and its length."""
        self.pieces = [
            (a[0], a[1], (b[0] - a[0]) / run, (b[1] - a[1]) / run, run)
            for a, b in pairwise(line)
            if (run := math.dist(a, b))
        ]

    def cost(self, points: Sequence[FieldPoint], most: float) -> float:
        """Return how unlike the line a piece of a stroke is; infinite if it is another.

        ``most`` is the cost of the best line so far: no distance needs to be measured beyond it.
        Distances only add up, so a line that lies elsewhere is refused after its first points.
        """
        far, ways, limit, count = 0.0, [], min(REACH, most), len(points)
        for point in points:
            distance, way = self._measure_nearest(point)
            far += distance
            if far / count >= limit:
                return math.inf
            ways.append(way)
        turned = self._measure_angle_sine(points, ways)
        return far / count + TURN_COSTS * turned if turned < TURNED else math.inf

    def _measure_nearest(self, point: FieldPoint) -> tuple[float, FieldPoint]:
        """Return the distance of a point to the line, and the line's direction there."""
        x, y = point
        least, way = math.inf, (1.0, 0.0)
        for from_x, from_y, w_x, w_y, run in self.pieces:
            d_x, d_y = x - from_x, y - from_y
            along, across = d_x * w_x + d_y * w_y, d_y * w_x - d_x * w_y
            over = BEYOND * (along if along < 0 else max(0.0, along - run))
            square = across * across + over * over
            if square < least:
                least, way = square, (w_x, w_y)
        return math.sqrt(least), way

    def _measure_angle_sine(
        self, points: Sequence[FieldPoint], ways: Sequence[FieldPoint]
    ) -> float:
        """Return the mean sine of the angle between a piece of a stroke and the line next to it."""
        (x, y), (to_x, to_y) = points[0], points[-1]
        run = math.hypot(to_x - x, to_y - y)
        if run < SHORT:
            return 0.0
        return sum(abs((to_x - x) * b - (to_y - y) * a) for a, b in ways) / run / len(ways)


def fit_parabola(points: Sequence[FieldPoint], frame: LineFrame) -> StrokeFit | None:
    """Return the curve of second degree that is nearest to points; None where they make no line.

    Single points far from it belong to another line that begins or ends there, and are left out.
    """
    own = _fit_points_in_frame(points, frame)
    if own is None:
        return None
    stray = max(STRAY * own.rough, LEAST_STRAY)
    kept = [point for point in points if own.relative_offset(frame(point)) <= stray]
    return own if len(kept) == len(points) else _fit_points_in_frame(kept, frame)


def _fit_points_in_frame(points: Sequence[FieldPoint], frame: LineFrame) -> StrokeFit | None:
    """Return the curve of second degree nearest to all points.

    None if there are fewer than ``FEWEST``, or they spread over less than ``STEP`` each way.
    """
    placed = [frame(point) for point in points]
    first, last = min(s for s, _ in placed), max(s for s, _ in placed)
    middle, half = (first + last) / 2, (last - first) / 2
    if len(placed) < FEWEST or half < STEP:
        return None
    pairs = [((s - middle) / half, off) for s, off in placed]
    level, slope, curve = _solve_least_squares(pairs)
    squares = sum((off - level - slope * t - curve * t * t) ** 2 for t, off in pairs)
    ends = min(zip(placed, points, strict=True))[1], max(zip(placed, points, strict=True))[1]
    rough = math.sqrt(squares / len(pairs)) / (2 * half)
    return StrokeFit(middle, half, level, slope, curve, rough, ends)


def _solve_least_squares(pairs: Sequence[FieldPoint]) -> tuple[float, float, float]:
    """Return the coefficients of 1, t and t² that fit best.

    Computed from the normal equations in the first three Legendre polynomials, which are nearly
    independent on [-1, 1].
    """
    along, off = zip(*pairs, strict=True)
    basis = ([1.0] * len(along), along, [(3 * t * t - 1) / 2 for t in along])
    rows = [[sum(map(mul, one, other)) for other in (*basis, off)] for one in basis]
    low, slope, bent = _solve_three_equations(rows)
    return low - bent / 2, slope, 1.5 * bent


def _solve_three_equations(rows: list[list[float]]) -> list[float]:
    """Return the solution of three equations; what they do not decide is 0."""
    for place in range(3):
        largest = max(range(place, 3), key=[abs(row[place]) for row in rows].__getitem__)
        pivot = rows[largest]
        rest = [row for row in rows[place:] if row is not pivot]
        rows = [*rows[:place], pivot, *rest]
        if abs(pivot[place]) >= TINY:
            rows = [row if row is pivot else _eliminate_entry(row, pivot, place) for row in rows]
    return [row[3] / row[i] if abs(row[i]) >= TINY else 0.0 for i, row in enumerate(rows)]


def _eliminate_entry(row: list[float], pivot: list[float], place: int) -> list[float]:
    """Return a row less as much of another as makes its number in one column 0."""
    share = row[place] / pivot[place]
    return [a - share * b for a, b in zip(row, pivot, strict=True)]
