"""What an engine of QTI is to say: responses, their marks and the sentences that are shown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from xml.etree import ElementTree as ET

from quizgen.kinds.grade import grade_answer
from quizgen.lms.interactions import (
    ChoiceInteraction,
    ExtendedTextInteraction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    TrueFalseInteraction,
    order_as_match,
)
from quizgen.question.html import inlines_to_html

INSIDE, OUTSIDE = 0.98, 1.02
"""Shares of the width of an interval that are surely in it and surely beyond it."""


@dataclass(frozen=True)
class Case:
    """Responses by their variables; marks; sentences."""

    given: dict[str, str | list[str]]
    marks: float
    said: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Asked:
    """An ask of an item: the end of its names, its marks and how we mark it."""

    suffix: str
    worth: float
    ask: object
    spec: object
    lang: str

    def words(self, said) -> frozenset[str]:
        """A sentence as it is read."""
        markup = inlines_to_html(said, self.lang)
        return frozenset({text_of(ET.fromstring(f"<p>{markup}</p>"))}) if said else frozenset()

    def choice(self, mark: str) -> str:
        return f"C{self.suffix}_{mark}"


def text_of(element) -> str:
    return " ".join("".join(element.itertext()).split())


def asked(item) -> list[Asked]:
    found = []
    for (part, asks), spec in zip(item.parts, item.key.specs, strict=True):
        label = f"_{part.label}" if part.label else ""
        for place, ask in enumerate(asks, 1):
            suffix = f"{label}_{place}" if len(asks) > 1 else label
            found.append(Asked(suffix, float(part.points) / len(asks), ask, spec, item.lang))
    return found


def cases(item) -> Iterator[Case]:
    """Everything right, nothing given, and each other answer to one ask with all else right."""
    rows = [one for one in asked(item) if not isinstance(one.ask, ExtendedTextInteraction)]
    answers = {one.suffix: list(answers_to(one)) for one in rows}
    keys = {f"RESPONSE{suffix}": found[0][0] for suffix, found in answers.items()}
    full = sum(one.worth for one in rows)
    yield Case({}, 0)
    yield Case(keys, full)
    for one in rows:
        for given, credit, said in answers[one.suffix]:
            marks = full - one.worth * (1 - credit)
            told = frozenset().union(*map(one.words, said))
            yield Case({**keys, f"RESPONSE{one.suffix}": given}, marks, told)


def answers_to(one: Asked):
    """Answers, the right one first, with their share of the marks and the sentences said."""
    match one.ask:
        case NumericInteraction():
            return numbers(one.ask)
        case TrueFalseInteraction(true=true, feedback=said):
            right, wrong = ("true", "false") if true else ("false", "true")
            return [(one.choice(right), 1, []), (one.choice(wrong), 0, [said])]
        case ChoiceInteraction(options=options, many=many):
            rows = sorted(options, key=lambda option: not option.right)
            each = [(one.choice(o.letter), int(o.right), [o.feedback]) for o in rows]
            return several(one) if many else each
        case OrderInteraction() | MatchInteraction():
            return orders(one) if getattr(one.ask, "is_complete", False) else pairs(one)
        case TextEntryInteraction(right=right, wrong=wrong):
            rows = [(typed, 1, []) for typed in right], [(t, 0, [said]) for t, said in wrong]
            return chain(*rows, [("qwerty", 0, [])])
    raise TypeError(one.ask)


def numbers(ask: NumericInteraction):
    """In the middle of each interval, inside its ends, and beyond them."""
    for one in ask.ranges:
        wide = one.width > 1e-6 * max(abs(one.value), 1)
        for place in (0, -INSIDE, INSIDE) if wide else (0,):
            yield repr(one.value + place * one.width), int(one.right), [one.feedback]
    for one in ask.ranges:
        for place in (-OUTSIDE, OUTSIDE):
            number = one.value + place * one.width
            if not any(other.low <= number <= other.high for other in ask.ranges):
                yield repr(number), 0, []


def several(one: Asked):
    """The right options, all but one of them, and one too many, as we mark them."""
    right = [option.letter for option in one.ask.right]
    said = {option.letter: option.feedback for option in one.ask.options}
    wrong = [option.letter for option in one.ask.options if not option.right]
    tried = [right, right[1:], *([*right, mark] for mark in wrong)]
    for marks in tried:
        if marks:
            credit = float(grade_answer(one.spec, " ".join(marks)).credit)
            yield [one.choice(mark) for mark in marks], credit, [said[mark] for mark in marks]


def orders(one: Asked):
    """The right order, and the first two steps exchanged: two steps are not in their place."""
    right = [one.choice(mark) for mark in one.ask.right]
    yield right, 1, []
    yield [right[1], right[0], *right[2:]], 1 - 2 / len(right), []


def pairs(one: Asked):
    """The right pairs, and each wrong one among right ones."""
    ask = order_as_match(one.ask, one.lang)
    yield [one.choice(stem) + " " + one.choice(ask.right[stem]) for stem, _ in ask.stems], 1, []
    for stem, _ in ask.stems:
        for target, _ in ask.targets:
            if target != ask.right[stem]:
                chosen = {**ask.right, stem: target}
                given = [f"{one.choice(left)} {one.choice(chosen[left])}" for left in chosen]
                yield given, 1 - 1 / len(ask.stems), [ask.feedback.get((stem, target), ())]
