"""Answers with the percentage of the marks that each earns, as Moodle and Canvas take them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from quizgen.lms.interactions import (
    ChoiceInteraction,
    Interaction,
    NumericInteraction,
    TextEntryInteraction,
)
from quizgen.lms.markup import to_course_html

# The percentages that Moodle knows: it leaves out a question with another one and says nothing.
MOODLE_PERCENTS = (
    100, 90, 83.33333, 80, 75, 70, 66.66667, 60, 50, 40, 33.33333, 30, 25, 20, 16.66667, 14.28571,
    12.5, 11.11111, 10, 5, 0,
)  # fmt: skip

_NO_FEEDBACK = Markup("")


@dataclass(frozen=True, slots=True)
class WeightedAnswer:
    """An answer, the percentage it earns, and the feedback to it.

    ``tolerance`` is that of a number, ``letter`` that of an option.
    """

    text: str
    percent: float
    feedback: Markup = _NO_FEEDBACK
    tolerance: str = ""
    letter: str = ""


def with_letter(answer: WeightedAnswer) -> str:
    """Return an option after its letter, for systems that put none."""
    return f"{answer.letter}. {answer.text}"


def weighted_answers(interaction: Interaction, lang: str) -> Iterator[WeightedAnswer]:
    """Yield what a response is compared with, in this order."""
    match interaction:
        case NumericInteraction():
            for one in interaction.ranges:
                feedback = to_course_html(one.feedback, lang)
                percent = 100.0 if one.right else find_moodle_percent(100 * one.share)
                yield WeightedAnswer(repr(one.value), percent, feedback, repr(one.width))
        case TextEntryInteraction():
            for typed in interaction.right:
                yield WeightedAnswer(_escape_star(typed), 100)
            for typed, words in interaction.wrong:
                yield WeightedAnswer(_escape_star(typed), 0, to_course_html(words, lang))
        case ChoiceInteraction():
            percents = _option_percents(interaction)
            for option, percent in zip(interaction.options, percents, strict=True):
                text = str(to_course_html(option.words, lang))
                feedback = to_course_html(option.feedback, lang)
                yield WeightedAnswer(text, percent, feedback, letter=option.letter)
        case _:
            raise TypeError(type(interaction).__name__)


def _escape_star(typed: str) -> str:
    """Return a typed text in which a star is literal: without a backslash it matches anything."""
    return typed.replace("*", "\\*")


def _option_percents(interaction: ChoiceInteraction) -> list[float]:
    """Return the percentage of each option: a wrong one takes away what a right one gives.

    Rounded to those that Moodle knows.
    """
    if not interaction.many:
        return [100 * option.right for option in interaction.options]
    nearest = find_moodle_percent(Fraction(100, max(len(interaction.right), 1)))
    return [nearest if option.right else -nearest for option in interaction.options]


def find_moodle_percent(share: float | Fraction) -> float:
    """Return the percentage that Moodle knows which is nearest to this one."""
    return min(MOODLE_PERCENTS, key=lambda percent: abs(percent - share))
