"""A curve over the horizontal axis: its peaks, where the highest is, whether it falls to zero."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean, median

from quizgen.grading.drawing.fitting import resample
from quizgen.grading.drawing.sheet import DrawingComparison, Feature
from quizgen.grading.drawing.strokes import FieldPoint, StrokePoints

PLACES = 61
"""Places along the wanted curve at which heights are read."""
FINE = 0.004
"""Distance of samples: a few for every place."""
COVERED = 0.85
"""Share of the places at which there has to be something."""
THICK = 0.1
"""How far apart lines may be at one place, as a share of the height of the wanted curve."""
MOSTLY = 0.8
"""Share of the places at which there is one height."""
RISE = 0.1
"""Height from which on a hill is one, as a share of the highest."""
BESIDE = 0.06
"""How far beside its place the highest point may be, as a share of the width of the field."""
HIGH = 0.2
"""How much higher or lower the highest point may be than the wanted one, as a share of that."""
LOW = 0.12
"""Height at an end that is as good as none, as a share of the highest."""
AROUND = 2
"""Places on each side that a height is averaged over: a hand trembles."""


class CurveFeature(Feature, frozen=True):
    """What makes a curve right; every one that is set must hold.

    ``peaks``: as many as the wanted one has. ``top``: the highest point is where its own is,
    nearer than half way to where a mistake has it, and about as high. ``ends``: it is as good as
    zero at either end where the wanted one is.
    """

    peaks: bool = False
    top: bool = False
    ends: bool = False

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check that something is asked of the curve, and that it has heights above 0.

        Raises
        ------
        ValueError
            If not, or if the field does not begin at 0.
        """
        if not (self.peaks or self.top or self.ends):
            raise ValueError("peaks, top or ends must be asked of a curve")
        if sheet.scale.view[2]:
            raise ValueError("the field of a curve begins at 0, from where its heights count")
        if not all(sheet.compute_once(wanted_heights)[name] for name in self.of):
            raise ValueError("a curve runs along x and has one height at each place, above 0")

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether there is a line above or below any of the wanted ones."""
        return any(sheet.compute_once(drawn_heights)[name] for name in self.of)

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether a curve covers its width and has all that is asked of it."""
        drawn, wanted = (
            sheet.compute_once(drawn_heights)[name],
            sheet.compute_once(wanted_heights)[name],
        )
        if len(drawn) < COVERED * PLACES:
            return False
        return (
            (not self.peaks or _count_peaks(drawn) == _count_peaks(wanted))
            and (not self.top or self._is_peak_nearest_wanted(sheet, name, drawn))
            and (not self.ends or _has_falling_ends(drawn, wanted))
        )

    def _is_peak_nearest_wanted(
        self, sheet: DrawingComparison, name: str, drawn: Sequence[FieldPoint]
    ) -> bool:
        """Return whether the highest point is about as high as wanted, and nearer its own place.

        Nearer than to the place where any known mistake has it, that is.
        """
        own, *others = (_find_highest_point(one[name]) for one in (sheet.wanted, *sheet.others))
        apart = [abs(other - own) / 2 for other in others if other != own]
        tall, most = (max(y for _, y in line) for line in (sheet.wanted[name], drawn))
        return (
            abs(_find_summit(drawn) - own) <= min([BESIDE, *apart]) and abs(most / tall - 1) <= HIGH
        )


def drawn_heights(sheet: DrawingComparison) -> dict[str, list[FieldPoint]]:
    """Return what was drawn over the width of each wanted line, as smoothed heights by its name."""
    return {name: _build_height_profile(sheet.strokes, line) for name, line in sheet.wanted.items()}


def wanted_heights(sheet: DrawingComparison) -> dict[str, list[FieldPoint]]:
    """Return the heights of each wanted line, measured as those of a drawing are."""
    return {name: _build_height_profile([line], line) for name, line in sheet.wanted.items()}


def _build_height_profile(strokes: Sequence[StrokePoints], line: StrokePoints) -> list[FieldPoint]:
    """Return smoothed heights at ``PLACES`` points along a line's width, where something was drawn.

    The list is empty if the line has no width or height, or the drawing several heights at many
    points: then it is no curve.
    """
    left, right = min(x for x, _ in line), max(x for x, _ in line)
    step, tall = (right - left) / (PLACES - 1), max(y for _, y in line)
    if step <= 0 or tall <= 0:
        return []
    found: list[list[float]] = [[] for _ in range(PLACES)]
    for stroke in strokes:
        for x, y in resample(stroke, FINE):
            place = round((x - left) / step)
            if 0 <= place < PLACES:
                found[place].append(y)
    heights = [(left + step * place, median(ys)) for place, ys in enumerate(found) if ys]
    even = sum(_has_one_height(ys, tall) for ys in found if ys)
    return _smooth_heights(heights) if even >= MOSTLY * len(heights) else []


def _has_one_height(heights: Sequence[float], tall: float) -> bool:
    """Return whether heights read at one x are of one line; ``tall`` is the wanted height."""
    middle = median(heights)
    return fmean(abs(height - middle) for height in heights) <= THICK * tall


def _smooth_heights(heights: Sequence[FieldPoint]) -> list[FieldPoint]:
    """Return the heights, each averaged with ``AROUND`` neighbours on either side."""
    return [
        (x, fmean(y for _, y in heights[max(0, place - AROUND) : place + AROUND + 1]))
        for place, (x, _) in enumerate(heights)
    ]


def _count_peaks(heights: Sequence[FieldPoint]) -> int:
    """Return how many hills there are, each higher by ``RISE`` than the valleys next to it."""
    rise = RISE * max(y for _, y in heights)
    count, climbing, turn = 0, False, heights[0][1]
    for _, y in heights:
        turn = max(turn, y) if climbing else min(turn, y)
        if abs(y - turn) >= rise:
            count += climbing
            climbing, turn = not climbing, y
    return count


def _find_summit(heights: Sequence[FieldPoint]) -> float:
    """Return the x of the middle of all that is nearly as high as the highest point.

    A hand draws a plateau rather than a point.
    """
    most = max(y for _, y in heights)
    near = [x for x, y in heights if y >= most * 0.97]
    return (near[0] + near[-1]) / 2


def _find_highest_point(line: StrokePoints) -> float:
    """Return the x of the highest point of a wanted line."""
    return max(line, key=lambda point: point[1])[0]


def _has_falling_ends(drawn: Sequence[FieldPoint], wanted: Sequence[FieldPoint]) -> bool:
    """Return whether the drawn curve is as good as 0 at every end where the wanted one is."""
    limit = LOW * max(y for _, y in wanted)
    return all(drawn[end][1] <= limit for end in (0, -1) if wanted[end][1] <= limit / 2)
