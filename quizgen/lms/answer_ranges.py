"""Intervals for systems that compare floats: the key's first, then those of misconceptions.

Systems disagree on the very edge of an interval, so no number that somebody would type lies there;
and some take the first interval that fits while others take all, so no two of them meet.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from math import inf, isfinite

from quizgen.grading.diagnosis.numeric_slips import CLOSE
from quizgen.grading.spec import WIDEST
from quizgen.maths.constants import parse_exact
from quizgen.maths.numbers import to_float
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value
from quizgen.typeset.prose import Inline

# An interval is wider than our closed one by this factor, so that its ends are inside.
BEYOND = 1.01
NARROWER, WIDER = 0.97, 1.003
# What counts as exact, and as on the edge, relative to the number.
SAME = 1e-9
# Decimals that people write where the exact number was asked for and has more.
ROUNDED = 2
# Decimals that somebody may round to, or go up or down by half a step of.
DECIMALS = range(-7, 13)


@dataclass(frozen=True, slots=True)
class WrongValue:
    """A wrong value, the feedback to it, and the share of the points that it still earns."""

    value: Value
    feedback: tuple[Inline, ...] = ()
    share: float = 0


@dataclass(frozen=True, slots=True)
class AnswerRange:
    """Numbers around a value: whether they are right, the feedback, and what a mistake earns."""

    value: float
    width: float
    right: bool
    feedback: tuple[Inline, ...] = ()
    share: float = 0

    @property
    def low(self) -> float:
        """The lower end."""
        return self.value - self.width

    @property
    def high(self) -> float:
        """The upper end."""
        return self.value + self.width


def disjoint_ranges(
    rule: Tolerance, key: Value, wrong: Iterable[WrongValue], period: Value | None = None
) -> tuple[AnswerRange, ...]:
    """Return the intervals of a key and of misconceptions, no two of which meet.

    Parameters
    ----------
    rule : Tolerance
        In the unit of the values.
    key : Value
    wrong : iterable of WrongValue
        One too near to what came before it is left out.
    period : Value, optional
        The key may be one period less or more.
    """
    right = _right_ranges(rule, key, period)
    mistakes = (_wrong_range(rule, one) for one in wrong if isfinite(to_float(one.value)))
    return tuple(_separate(chain(right, mistakes)))


def _right_ranges(rule: Tolerance, key: Value, period: Value | None) -> Iterator[AnswerRange]:
    """Yield the right intervals: of the key, one period apart, and what ``accept`` adds."""
    value, width = to_float(key), to_float(rule.half_width(key)) * BEYOND
    width = max(width, SAME * max(abs(value), 1))
    cycle = to_float(period) if period is not None else 0
    for shift in (0, -cycle, cycle) if cycle else (0,):
        yield AnswerRange(value + shift, _move_off_edge(value + shift, width, WIDER), right=True)
    if rule.accept is not None:
        low, high = (to_float(parse_exact(bound)) for bound in rule.accept)
        for start, end in ((low, min(value - width, high)), (max(value + width, low), high)):
            if start < end:
                yield AnswerRange((start + end) / 2, (end - start) / 2 * BEYOND, right=True)


def _wrong_range(rule: Tolerance, one: WrongValue) -> AnswerRange:
    """Return the interval of a misconception, as wide as grading would name it."""
    value = to_float(one.value)
    close = to_float(CLOSE) * abs(value)
    width = min(to_float(rule.half_width(one.value)), to_float(WIDEST) * abs(value))
    wide = min(close, _rounding_error(value)) if rule.exact else max(close, width)
    widest = max(wide, SAME * max(abs(value), 1))
    width = _move_off_edge(value, widest, NARROWER)
    return AnswerRange(value, width, right=False, feedback=one.feedback, share=one.share)


def _rounding_error(value: float) -> float:
    """Return how far a number is from what people write who round it; 0 if they need not."""
    return 0 if round(value, ROUNDED) == value else 0.51 * 10**-ROUNDED


def _separate(wanted: Iterable[AnswerRange]) -> Iterator[AnswerRange]:
    """Yield each interval narrowed to the room that those before it leave; drop one without room.

    Systems differ in which of several intervals they apply, so none may meet another.
    """
    separate: list[AnswerRange] = []
    for one in wanted:
        room = min((abs(one.value - other.value) - other.width for other in separate), default=inf)
        if room <= SAME * max(abs(one.value), 1) * 2:
            continue
        width = one.width
        if width >= room:
            width = _move_off_edge(one.value, room * NARROWER, NARROWER)
        separate.append(replace(one, width=width))
        yield separate[-1]


def _move_off_edge(value: float, width: float, factor: float) -> float:
    """Return a width near this one with no rounding of the value on its edge."""
    near = SAME * max(abs(value), 1)
    gaps = [gap for count in DECIMALS for gap in _edge_distances(value, 10.0**-count)]
    while width > near and any(abs(gap - width) <= near for gap in gaps):
        width *= factor
    return width


def _edge_distances(value: float, step: float) -> Iterator[float]:
    """Yield how far a value is from what it is rounded to, up or down, and from half steps."""
    above = value % step
    for halves in range(-1, 6):
        yield abs(halves * step / 2 - above)
