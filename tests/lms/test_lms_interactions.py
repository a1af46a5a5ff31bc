"""What other systems are told is what our own marking says: it judges what they would accept."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from quizgen.kinds.grade import grade_answer
from quizgen.lms.interactions import (
    ChoiceInteraction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    TrueFalseInteraction,
)

INSIDE = 0.98
"""Share of an interval that our closed one holds, too: it was widened by a hundredth."""


def parts(items):
    """Item, part, specification, solution and asks of all parts."""
    for item in items:
        solved = item.key.solution.parts
        for (part, found), spec, told in zip(item.parts, item.key.specs, solved, strict=True):
            yield item, part, spec, told, found


def disagreements(items):
    for item, part, spec, told, found in parts(items):
        if len(found) == 1:
            yield from ((item.id, part.label, *one) for one in judged(found[0], spec, told))
        elif isinstance(found[0], NumericInteraction):
            names = [f"{ask.name} = " if spec.kind == "table" else "" for ask in found]
            values = [repr(ask.key.value) for ask in found]
            typed = "; ".join(map("".join, zip(names, values, strict=True)))
            if grade_answer(spec, typed).credit != 1:
                yield item.id, part.label, typed


def judged(ask, spec, told):
    """Each answer that the ask has a mark for and that we mark otherwise."""
    sentences = {f"trap:{mistake.name}": mistake.sentence for mistake in told.mistakes}
    for typed, credit, said in declared(ask, spec):
        verdict = grade_answer(spec, typed)
        if verdict.credit != credit or (said and sentences.get(verdict.note, said) != said):
            yield typed, credit, verdict.credit, verdict.note


def declared(ask, spec):
    match ask:
        case NumericInteraction():
            unit = f" {ask.unit}" if spec.kind == "quantity" else ""
            for one in ask.ranges:
                wide = one.width > 1e-6 * max(abs(one.value), 1)
                for place in (-INSIDE, 0, INSIDE) if wide else (0,):
                    typed = f"{one.value + place * one.width!r}{unit}"
                    yield typed, int(one.right), one.feedback if place == 0 else ()
        case ChoiceInteraction(many=True):
            yield " ".join(option.letter for option in ask.right), 1, ()
        case ChoiceInteraction():
            yield from ((option.letter, int(option.right), ()) for option in ask.options)
        case TrueFalseInteraction():
            yield from (("true", int(ask.true), ()), ("false", int(not ask.true), ()))
        case MatchInteraction():
            yield " ".join(f"{left}{right}" for left, right in ask.right.items()), 1, ()
        case OrderInteraction():
            yield " ".join(ask.right), 1, ()
        case TextEntryInteraction():
            yield from ((typed, 1, ()) for typed in ask.right)
            yield from ((typed, 0, said) for typed, said in ask.wrong)


def numbers(items):
    for item in items:
        for _, found in item.parts:
            yield from (ask for ask in found if isinstance(ask, NumericInteraction))


def on_an_edge(ask):
    """Intervals on whose edge the value lies when it is rounded, up or down, or to half a step."""
    for one in ask.ranges:
        for step in (10.0**-count for count in range(-6, 13)):
            below = math.floor(one.value / step) * step
            for typed in (below, below + step / 2, below + step, below + 1.5 * step):
                away = abs(typed - one.value)
                if abs(away - one.width) <= 1e-9 * max(abs(one.value), 1) < one.width:
                    yield one


def overlaps(ask):
    rows = sorted(ask.ranges, key=lambda one: one.low)
    return [(a, b) for a, b in pairwise(rows) if a.high >= b.low and not (a.right and b.right)]


def test_our_marking_agrees(items):
    assert list(disagreements(items)) == []


def test_no_rounding_of_a_number_lies_on_an_edge_and_no_intervals_meet(items):
    asked = list(numbers(items))
    assert len(asked) > 40
    assert [ask for ask in asked if [*on_an_edge(ask)] or overlaps(ask)] == []


@pytest.mark.slow
def test_our_marking_agrees_on_the_whole_bank(everything):
    strict = {"figures-asked"}
    found = [one for one in disagreements(everything) if not strict & {*one}]
    assert found == []


@pytest.mark.slow
def test_no_rounding_on_an_edge_in_the_whole_bank(everything):
    assert [ask for ask in numbers(everything) if [*on_an_edge(ask)] or overlaps(ask)] == []


def test_the_image_of_a_point_in_the_notes(reference):
    """x' = 2 * 10 / 3 and y' = 2 * 5 / 3 to two decimals; forgetting to divide gives 20 and 10."""
    ((_, (x, y)),) = reference("point-to-image-plane-fractions").parts
    assert (round(x.key.value, 3), round(y.key.value, 3)) == (6.667, 3.333)
    assert 0.005 < x.key.width < 0.0051
    assert {20.0, 15.0, 5.0} < {one.value for one in x.ranges if not one.right}
    assert {10.0, 7.5, 2.5} < {one.value for one in y.ranges if not one.right}
