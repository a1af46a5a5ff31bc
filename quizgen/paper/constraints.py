"""What a paper asks for as a whole, met exactly: points, minutes, figures, photographs.

The places of a paper are filled one after the other. What the places left can still add up to is
known beforehand: for each number of figures and photographs one large integer, whose bits are the
sums of points and minutes. So no choice is made that cannot come out; only kinds of figures and
what must stand apart are found by trying.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from msgspec import structs

from quizgen.bank.candidate import Candidate
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import Blueprint

STEPS = 20_000
"""Places that are tried to be filled before a choice is given up."""
READING = Fraction(11, 10)
"""Working time of a paper to that of its questions: a tenth for reading through and checking."""


def paper_minutes(minutes: Fraction | int) -> int:
    """Return the minutes for a paper whose questions take so many, rounded up."""
    return math.ceil(minutes * READING)


MOST_SUMS = 4_000_000
"""Sums of points and minutes, in units, that are looked at: four times those of a mock exam."""


class RunningTotals(NamedTuple):
    """What the places filled so far add up to, points and minutes in units."""

    points: int = 0
    minutes: int = 0
    figures: int = 0
    photographs: int = 0


NONE = RunningTotals()


class ConstraintSolver:
    """Search for templates that meet all demands of a blueprint on the paper as a whole.

    Parameters
    ----------
    blueprint : Blueprint
    places : sequence of sequences of Candidate
        Who may fill each place, in the order in which they are tried.
    order : sequence of int
        The order in which places are filled.
    """

    def __init__(
        self, blueprint: Blueprint, places: Sequence[Sequence[Candidate]], order: Sequence[int]
    ) -> None:
        """Work out which sums of points and minutes can be reached from each place on.

        Both are counted in integer units, the least common denominators of all candidates.

        Raises
        ------
        BlueprintError
            If the sums are too many to be looked at.
        """
        self.blueprint, self.places, self.order = blueprint, places, order
        everyone = [one for place in places for one in place]
        self.point = math.lcm(1, *(one.points.denominator for one in everyone))
        self.minute = math.lcm(1, *(one.minutes.denominator for one in everyone))
        self.total = math.floor(Fraction(str(blueprint.total or 0)) * self.point)
        self.first, self.last = self._compute_time_span()
        self.width = self.last + 1
        self.limits = (blueprint.figures, blueprint.photographs)
        if (self.total + 1) * self.width > MOST_SUMS:
            raise BlueprintError("total and minutes are too large to be met together")
        self.steps = STEPS
        self._reach = self._compute_reachable_sums()

    def _compute_time_span(self) -> tuple[int, int]:
        """Return the fewest and most units of time that the questions may take together."""
        if not isinstance(self.blueprint.minutes, tuple):
            return 0, 0
        first, last = self.blueprint.minutes
        unit = self.minute / READING
        return math.floor((first - 1) * unit) + 1, math.floor(last * unit)

    def _count_candidate(self, one: Candidate) -> RunningTotals:
        """Return what a candidate adds to the totals; 0 for what the blueprint does not limit."""
        points = _convert_to_units(one.points, self.point) if self.blueprint.total else 0
        minutes = _convert_to_units(one.minutes, self.minute) if self.last else 0
        return RunningTotals(points, minutes, bool(one.figure), one.photograph)

    def _compute_reachable_sums(self) -> list[dict[tuple[int, int], int]]:
        """Return, from each place on, which sums can be reached, as the bits of an integer.

        The key says how many figures and photographs there are at least. The bit ``points * width +
        minutes`` is set where that sum can be reached, so that one shift and one OR add a candidate
        to all sums at once.
        """
        figures, photographs = self.limits
        every = [(f, p) for f in range(figures + 1) for p in range(photographs + 1)]
        whole = (1 << ((self.total + 1) * self.width)) - 1
        reach = [dict.fromkeys(every, 0) | {(0, 0): 1}]
        for place in reversed(self.order):
            now = dict.fromkeys(every, 0)
            different = {self._count_candidate(one) for one in self.places[place]}
            for (f, p), sums in reach[-1].items():
                for add in different if sums else ():
                    key = min(figures, f + add.figures), min(photographs, p + add.photographs)
                    now[key] |= (sums << (add.points * self.width + add.minutes)) & whole
            reach.append(now)
        return [_accumulate_sums(sums) for sums in reversed(reach)]

    def is_reachable(self, step: int = 0, sums: RunningTotals = NONE) -> bool:
        """Return whether the places from a step on can still bring what is missing."""
        if sums.points > self.total or sums.minutes > self.last:
            return False
        figures, photographs = self.limits
        key = max(0, figures - sums.figures), max(0, photographs - sums.photographs)
        first, last = max(0, self.first - sums.minutes), self.last - sums.minutes
        row = self._reach[step][key] >> ((self.total - sums.points) * self.width + first)
        return bool(row & ((1 << (last - first + 1)) - 1))

    def solve(self) -> list[str]:
        """Return the names in order of the paper; empty if no way was found in ``STEPS`` steps."""
        self.steps = STEPS
        chosen = self._fill_from(0, NONE, {}) if self.is_reachable() else None
        return [chosen[place].name for place in sorted(chosen)] if chosen else []

    def _fill_from(
        self, step: int, sums: RunningTotals, chosen: dict[int, Candidate]
    ) -> dict[int, Candidate] | None:
        """Return all places filled, by index, with those of ``chosen``; None if there is no way.

        It tries candidates depth first, and goes back where the rest cannot be reached or the steps
        are used up.
        """
        if step == len(self.order):
            kinds = {one.figure for one in chosen.values()} - {""}
            return chosen if len(kinds) >= self.blueprint.figure_kinds else None
        place = self.order[step]
        for one in self._list_open_candidates(place, list(chosen.values())):
            self.steps -= 1
            after = RunningTotals(*map(sum, zip(sums, self._count_candidate(one), strict=True)))
            if self.steps > 0 and self.is_reachable(step + 1, after):
                found = self._fill_from(step + 1, after, {**chosen, place: one})
                if found:
                    return found
        return None

    def _list_open_candidates(self, place: int, chosen: Sequence[Candidate]) -> list[Candidate]:
        """Return the candidates that may stand here beside those chosen.

        Of those with numbers left, the least used: each is used once before any is used again.
        """
        uses = Counter(one.name for one in chosen)
        left = [o for o in self.places[place] if o.pool is None or uses[o.name] < o.pool]
        least = min((uses[one.name] for one in left), default=0)
        return [
            one for one in left
            if uses[one.name] == least
            and not any(map(one.excludes, chosen))
        ]  # fmt: skip


def explain_infeasible(blueprint: Blueprint, places: Sequence[Sequence[Candidate]]) -> str:
    """Return which demand no choice can meet, or that no choice was found that meets all."""
    for name, none in NOTHING.items():
        others = {other: value for other, value in NOTHING.items() if other != name}
        alone = structs.replace(blueprint, **others)
        wanted = getattr(alone, name)
        if (
            wanted != none
            and not ConstraintSolver(alone, places, range(len(places))).is_reachable()
        ):
            return (
                f"{name} = {_format_toml_value(wanted)} cannot be "
                f"met: {_describe_attainable_range(name, places)}"
            )
    kinds = {one.figure for place in places for one in place} - {""}
    if blueprint.figure_kinds > len(kinds):
        return f"figure_kinds = {blueprint.figure_kinds} cannot be met: there are {len(kinds)}"
    asked = ", ".join(name for name, none in NOTHING.items() if getattr(blueprint, name) != none)
    return f"no choice of templates that may stand together was found that meets {asked}"


NOTHING = {"total": None, "minutes": None, "figures": 0, "photographs": 0, "figure_kinds": 0}
"""Each demand and its value that asks for nothing."""
MEASURES: Mapping[str, Callable[[Candidate], Fraction | int]] = {
    "total": lambda one: one.points,
    "minutes": lambda one: one.minutes * READING,
    "figures": lambda one: bool(one.figure),
    "photographs": lambda one: one.photograph,
}


def _format_toml_value(value: float | tuple[int, int]) -> str:
    """Return a demand as its blueprint writes it."""
    return f"{list(value)}" if isinstance(value, tuple) else f"{value:g}"


def _describe_attainable_range(name: str, places: Sequence[Sequence[Candidate]]) -> str:
    """Return what the slots can add up to, for an error."""
    measure = MEASURES[name]
    least, most = (sum(pick(map(measure, place)) for place in places) for pick in (min, max))
    return f"the slots together can make {float(least):g} to {float(most):g}"


def _convert_to_units(value: Fraction, unit: int) -> int:
    """Return a value as an integer number of units, which its denominator divides."""
    return value.numerator * (unit // value.denominator)


def _accumulate_sums(sums: Mapping[tuple[int, int], int]) -> dict[tuple[int, int], int]:
    """Return the sums reached with so many figures and photographs or more."""
    found: dict[tuple[int, int], int] = {}
    for f, p in sorted(sums, reverse=True):
        found[f, p] = sums[f, p] | found.get((f + 1, p), 0) | found.get((f, p + 1), 0)
    return found
