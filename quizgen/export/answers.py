"""What Moodle compares an answer with: the share of the marks it earns, and what is said to it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import singledispatch
from typing import NamedTuple

from markupsafe import Markup

from quizgen.export.asks import Ask, Choose, Fill, Numeric
from quizgen.export.wording import inline

SHARES = (100, 90, 83.33333, 80, 75, 70, 66.66667, 60, 50, 40, 33.33333, 30, 25, 20, 16.66667,
          14.28571, 12.5, 11.11111, 10, 5, 0)  # fmt: skip
"""The percentages that Moodle knows; a question with another one is left out without a word."""


class Answer(NamedTuple):
    """An answer, its percentage, what is said to it; ``mark`` is the letter of an option."""

    typed: str
    percent: float
    said: Markup = Markup("")
    tolerance: str = ""
    mark: str = ""


def lettered(one: Answer) -> str:
    """An option behind its letter, where the system itself puts none."""
    return f"{one.mark}. {one.typed}"


def answers(ask: Ask, lang: str) -> list[Answer]:
    """What an answer is compared with, in this order."""
    return list(_answers(ask, lang))


@singledispatch
def _answers(ask: Ask, _lang: str) -> Iterator[Answer]:
    raise TypeError(type(ask).__name__)


@_answers.register
def _numbers(ask: Numeric, lang: str) -> Iterator[Answer]:
    for one in ask.ranges:
        said = inline(one.said, lang)
        yield Answer(repr(one.value), 100 * one.right, said, repr(one.width))


@_answers.register
def _words(ask: Fill, lang: str) -> Iterator[Answer]:
    for typed in ask.right:
        yield Answer(_literal(typed), 100)
    for typed, said in ask.wrong:
        yield Answer(_literal(typed), 0, inline(said, lang))


def _literal(typed: str) -> str:
    """A star stands for anything, unless a backslash is before it."""
    return typed.replace("*", "\\*")


@_answers.register
def _options(ask: Choose, lang: str) -> Iterator[Answer]:
    for option, share in zip(ask.options, _shares(ask), strict=True):
        words = str(inline(option.words, lang))
        yield Answer(words, share, inline(option.said, lang), mark=option.mark)


def _shares(ask: Choose) -> list[float]:
    """The percentage of each option: one that is too much takes away what a right one gives."""
    if not ask.many:
        return [100 * option.right for option in ask.options]
    share = _known(Fraction(100, max(len(ask.right), 1)))
    return [share if option.right else -share for option in ask.options]


def _known(share: Fraction) -> float:
    """The nearest percentage that Moodle knows."""
    return min(SHARES, key=lambda known: abs(known - share))
