"""Intervals of numbers for systems that compare floats: the key's first, then those of mistakes.

Players disagree on the very edge of an interval, so no number that somebody would type lies there;
and some take the first interval that fits while others take all, so no two of them meet.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from math import inf, isfinite

from quizgen.bank.markdown import Inline
from quizgen.grading.diagnosis.numeric_slips import CLOSE
from quizgen.grading.spec import WIDEST
from quizgen.maths.constants import parse_exact
from quizgen.maths.numbers import to_float
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value

BEYOND = 1.01
"""Factor by which an interval is wider than our closed one, so that its ends are inside."""
NARROWER, WIDER = 0.97, 1.003
SAME = 1e-9
"""What counts as exact, and as on the edge, relative to the number."""
ROUNDED = 2
"""Places that a number is written with where the exact one was asked for and is longer."""
DECIMALS = range(-7, 13)
"""Places that somebody may round to, or go up or down by half a step of."""


@dataclass(frozen=True, slots=True)
class Near:
    """A wrong value, and what is said of it."""

    value: Value
    said: tuple[Inline, ...] = ()


@dataclass(frozen=True, slots=True)
class Range:
    """Numbers around a value: whether they are right, and what is said of them."""

    value: float
    width: float
    right: bool
    said: tuple[Inline, ...] = ()

    @property
    def low(self) -> float:
        """The lower end."""
        return self.value - self.width

    @property
    def high(self) -> float:
        """The upper end."""
        return self.value + self.width


def ranges(
    rule: Tolerance, key: Value, wrong: Iterable[Near], period: Value | None = None
) -> tuple[Range, ...]:
    """The intervals of a key and of known mistakes, none of which meet.

    Parameters
    ----------
    rule : Tolerance
        In the unit of the values.
    key : Value
    wrong : iterable of Near
        Values that mistakes give; one too near to what came before it is left out.
    period : Value, optional
        A turn: the key may be one less or more.
    """
    right = _right(rule, key, period)
    mistakes = (_wrong(rule, one) for one in wrong if isfinite(to_float(one.value)))
    return tuple(_apart(chain(right, mistakes)))


def _right(rule: Tolerance, key: Value, period: Value | None) -> Iterator[Range]:
    value, width = to_float(key), to_float(rule.half_width(key)) * BEYOND
    width = max(width, SAME * max(abs(value), 1))
    turn = to_float(period) if period is not None else 0
    for shift in (0, -turn, turn) if turn else (0,):
        yield Range(value + shift, _off_edge(value + shift, width, WIDER), right=True)
    if rule.accept is not None:
        low, high = (to_float(parse_exact(bound)) for bound in rule.accept)
        for start, end in ((low, min(value - width, high)), (max(value + width, low), high)):
            if start < end:
                yield Range((start + end) / 2, (end - start) / 2 * BEYOND, right=True)


def _wrong(rule: Tolerance, one: Near) -> Range:
    """As near as marking calls a number by the name of a mistake."""
    value = to_float(one.value)
    close = to_float(CLOSE) * abs(value)
    width = min(to_float(rule.half_width(one.value)), to_float(WIDEST) * abs(value))
    wide = min(close, _rounding(value)) if rule.exact else max(close, width)
    widest = max(wide, SAME * max(abs(value), 1))
    return Range(value, _off_edge(value, widest, NARROWER), right=False, said=one.said)


def _rounding(value: float) -> float:
    """How far a number is from what somebody writes who has to round it."""
    return 0 if round(value, ROUNDED) == value else 0.51 * 10**-ROUNDED


def _apart(wanted: Iterable[Range]) -> Iterator[Range]:
    """Narrow each interval to the room that is left beside those before it."""
    kept: list[Range] = []
    for one in wanted:
        room = min((abs(one.value - other.value) - other.width for other in kept), default=inf)
        if room <= SAME * max(abs(one.value), 1) * 2:
            continue
        width = one.width
        if width >= room:
            width = _off_edge(one.value, room * NARROWER, NARROWER)
        kept.append(Range(one.value, width, one.right, one.said))
        yield kept[-1]


def _off_edge(value: float, width: float, factor: float) -> float:
    """A width near this one on whose edge no rounding of the value lies."""
    near = SAME * max(abs(value), 1)
    gaps = [gap for count in DECIMALS for gap in _gaps(value, 10.0**-count)]
    while width > near and any(abs(gap - width) <= near for gap in gaps):
        width *= factor
    return width


def _gaps(value: float, step: float) -> Iterator[float]:
    """How far a value is from what it is rounded to, up or down, and from halves of a step."""
    above = value % step
    for halves in range(-1, 6):
        yield abs(halves * step / 2 - above)
