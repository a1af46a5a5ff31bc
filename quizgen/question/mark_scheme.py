"""The mark scheme of a worked solution: what each side of each step earns.

An author may give points to steps (``scheme`` in ``template.toml``). Within a step, and where
nobody has given any, formula, numbers put in, value and unit count alike. Points are dealt out in
quarters: the result first, then formulas, values, units and numbers, each as its turn comes.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from msgspec.structs import replace

from quizgen.core.shares import rescale_points
from quizgen.question.solution import PartSolution, SolutionStep
from quizgen.question.worked_steps import FORMULA, NUMBERS, RESULT

QUARTER = Fraction(1, 4)
UNIT, STEP = "unit", "step"
ROLES = {FORMULA: "formula", NUMBERS: "numbers", RESULT: "value"}
FIRST_RESULT = -1
RANKS = {"formula": 0, "step": 0, "value": 1, UNIT: 2, "numbers": 3}
"""Which comes first where there are fewer quarters than things to earn them."""


class SideMark(NamedTuple):
    """What one side of a step earns: points, and names (in section ``scheme``) of what for."""

    points: Fraction
    earned: tuple[str, ...]


class _Thing(NamedTuple):
    """A thing that earns points: the place of its step and side, its name, and its rank."""

    line: int
    side: int
    name: str
    rank: int


def mark_steps(
    part: PartSolution, points: Fraction, *, has_unit: bool
) -> tuple[tuple[SideMark, ...], ...]:
    """Return what each side of each step of a part earns; together the points of the part.

    Parameters
    ----------
    part : PartSolution
    points : Fraction
        What the part is worth.
    has_unit : bool
        Whether the answer has a unit, which earns something with the last value.
    """
    things = [*_iter_things(part.lines, has_unit=has_unit)]
    shares = dict.fromkeys(things, Fraction(0))
    given = [line.points or Fraction(0) for line in part.lines]
    if any(given):
        for place, share in enumerate(_split(points, given)):
            shares |= _deal([thing for thing in things if thing.line == place], share)
    else:
        shares |= _deal(things, points)
    return tuple(
        tuple(_gather(shares, place, side) for side in range(max(len(line.sides), 1)))
        for place, line in enumerate(part.lines)
    )


def _iter_things(lines: Sequence[SolutionStep], *, has_unit: bool) -> list[_Thing]:
    """Return all that earns points, in the order of the solution: each role once a step."""
    found = list[_Thing]()
    for place, line in enumerate(lines):
        last = {ROLES[side.role]: index for index, side in enumerate(line.sides)} or {STEP: 0}
        is_result = place == len(lines) - 1
        ends = max(last.values())
        found += [
            _Thing(place, index, name, FIRST_RESULT if is_result and index == ends else RANKS[name])
            for name, index in last.items()
        ]
        if is_result and has_unit:
            found.append(_Thing(place, ends, UNIT, RANKS[UNIT]))
    return found


def _deal(things: Sequence[_Thing], points: Fraction) -> dict[_Thing, Fraction]:
    """Return points dealt out in quarters, as evenly as there are; what is left to the first."""
    if not things:
        return {}
    turns = sorted(things, key=lambda thing: thing.rank)
    each, more = divmod(int(points / QUARTER), len(turns))
    shares = {thing: QUARTER * (each + (place < more)) for place, thing in enumerate(turns)}
    shares[turns[0]] += points - sum(shares.values(), Fraction(0))
    return shares


def mark_lines(part: PartSolution, points: Fraction, *, has_unit: bool) -> tuple[Fraction, ...]:
    """Return what each step of a part earns; arguments as for ``mark_steps``."""
    marked = mark_steps(part, points, has_unit=has_unit)
    return tuple(sum((side.points for side in line), Fraction(0)) for line in marked)


def rescale_criteria(part: PartSolution, points: Fraction) -> PartSolution:
    """Return a part whose criteria have the points that a paper gives it.

    Where the best criteria count, they keep their exact shares: quarters might not reach the whole.
    """
    if not part.scheme:
        return part
    worth = tuple(row.points for row in part.scheme)
    if part.most is None:
        worth = rescale_points(worth, points)
    else:
        worth = tuple(one * points / part.most for one in worth)
    rows = zip(part.scheme, worth, strict=True)
    return replace(
        part,
        scheme=tuple(row._replace(points=one) for row, one in rows),
        most=None if part.most is None else points,
    )


def _split(points: Fraction, weights: Sequence[Fraction]) -> list[Fraction]:
    """Return points split by weight in quarters: a paper may give a part more than its author."""
    whole = sum(weights, Fraction(0))
    exact = [points * weight / whole for weight in weights]
    found = [QUARTER * int(share / QUARTER) for share in exact]
    left = points - sum(found, Fraction(0))
    for place in sorted(range(len(found)), key=lambda place: found[place] - exact[place]):
        more = min(QUARTER, left)
        found[place] += more
        left -= more
    return found


def _gather(shares: dict[_Thing, Fraction], line: int, side: int) -> SideMark:
    """Return what one side of a step earns in sum."""
    own = {t: got for t, got in shares.items() if (t.line, t.side) == (line, side) and got}
    return SideMark(sum(own.values(), Fraction(0)), tuple(thing.name for thing in own))
