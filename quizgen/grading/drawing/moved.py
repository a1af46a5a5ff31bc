"""How far lines have moved their ends towards a centre or away from it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import median

from quizgen.grading.drawing.line import circle_on_sheet, fit_lines, wanted_lines
from quizgen.grading.drawing.sheet import DrawingComparison, Feature, to_floats
from quizgen.maths.constants import Scalar


class MovedFeature(Feature, frozen=True):
    """The ends of all lines together have moved from a circle as far as wanted.

    ``circle`` is the centre and the radius on which they were; ``within`` the factor by which the
    median of what they have moved by may be too much or too little.
    """

    circle: tuple[Scalar, Scalar, Scalar]
    within: Scalar

    def validate(self, sheet: DrawingComparison, /) -> None:
        """Check lines, circle and factor.

        Raises
        ------
        ValueError
            If one of them cannot serve.
        """
        sheet.compute_once(wanted_lines)
        circle_on_sheet(self.circle, sheet)
        if to_floats([self.within])[0] <= 1:
            raise ValueError("within: a factor above 1")

    def is_judgeable(self, sheet: DrawingComparison, /) -> bool:
        """Return whether any line lies where one is wanted."""
        return bool(sheet.compute_once(fit_lines))

    def holds_for(self, name: str, sheet: DrawingComparison, /) -> bool:
        """Return whether the line is there, and the ends of all have moved as far as wanted."""
        drawn = sheet.compute_once(fit_lines).get(name)
        if drawn is None or not sheet.compute_once(wanted_lines)[name].is_comparable(drawn):
            return False
        (within,), ratios = to_floats([self.within]), [*self._iter_shift_ratios(sheet)]
        return bool(ratios) and 1 / within <= median(ratios) <= within

    def _iter_shift_ratios(self, sheet: DrawingComparison) -> Iterator[float]:
        """Yield how far each drawn end has moved, over how far it was to move."""
        centre, radius = circle_on_sheet(self.circle, sheet)
        for name in self.of:
            drawn, line = sheet.compute_once(fit_lines).get(name), sheet.wanted[name]
            for end, goal in zip(drawn.ends if drawn else (), (line[0], line[-1]), strict=False):
                wanted = math.dist(goal, centre) - radius
                if wanted:
                    yield (math.dist(end, centre) - radius) / wanted
