"""How far lines have moved their ends towards a centre or away from it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import median

from quizgen.marking.features.line import fits, round_about, wishes
from quizgen.marking.features.sheet import Feature, Sheet, numbers
from quizgen.maths.constants import Scalar


class Moved(Feature, frozen=True):
    """The ends of all its lines together: from a circle they are as far as wanted.

    ``circle`` is the centre and the radius on which they were; ``within`` the factor by which the
    median of what they have moved by may be too much or too little.
    """

    circle: tuple[Scalar, Scalar, Scalar]
    within: Scalar

    def validate(self, sheet: Sheet, /) -> None:
        """Check lines, circle and factor."""
        sheet.once(wishes)
        round_about(self.circle, sheet)
        if numbers([self.within])[0] <= 1:
            raise ValueError("within: a factor above 1")

    def seen(self, sheet: Sheet, /) -> bool:
        """Whether any line lies where one is wanted."""
        return bool(sheet.once(fits))

    def has(self, name: str, sheet: Sheet, /) -> bool:
        """Whether the line is there, and the ends of all have moved as far as wanted."""
        drawn = sheet.once(fits).get(name)
        if drawn is None or not sheet.once(wishes)[name].found(drawn):
            return False
        (within,), ratios = numbers([self.within]), [*self._ratios(sheet)]
        return bool(ratios) and 1 / within <= median(ratios) <= within

    def _ratios(self, sheet: Sheet) -> Iterator[float]:
        """What each end has moved by over what was wanted of it."""
        centre, radius = round_about(self.circle, sheet)
        for name in self.of:
            drawn, line = sheet.once(fits).get(name), sheet.wanted[name]
            for end, goal in zip(drawn.ends if drawn else (), (line[0], line[-1]), strict=False):
                wanted = math.dist(goal, centre) - radius
                if wanted:
                    yield (math.dist(end, centre) - radius) / wanted
