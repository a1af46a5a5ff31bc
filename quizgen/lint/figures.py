"""Figures: whether they can be drawn from what a template gives, read, and give nothing away.

A figure gives an answer away if its number stands in the labels or the words of the figure in every
draw in which the question does not state that number itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from quizgen.bank.variant import Variant, leading_digits
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import QuizgenError
from quizgen.figures import Figure
from quizgen.kinds.contract import asked_quantities
from quizgen.lint.figure_looks import look_problems
from quizgen.question.figure import describe_question_figure, draw_question_figure

DRAWN = 6
"""Draws whose figure is drawn, in the quiz and in the solution."""
FEWEST = 3
"""Different answers that are needed to tell a secret from a coincidence."""

_NUMBER = re.compile(r"\d[\d\u2009\u202f\u00a0]*(?:[.,]\d+)?")
_SPACES = re.compile(r"[\u2009\u202f\u00a0]")


def check_figures(draws: Sequence[Variant]) -> Iterator[Diagnostic]:
    """What is wrong with the figure of a template, by some of its draws."""
    template = draws[0].template
    rule = template.rules.figure
    if rule is None:
        return
    shown = [(one, set[str]()) for one in draws[:DRAWN]]
    for one, numbers in shown:
        for lang in template.languages:
            for quiz in (True, False):
                try:
                    said = figure_text(one, lang, quiz=quiz, drawn=lang == template.languages[0])
                except QuizgenError as error:
                    yield error.diagnostic(template.file)
                    return
                numbers.update(_iter_numbers(said) if quiz else ())
    if rule.quiz:
        yield from _given_away(shown)
        yield from _find_unreadable(shown, rule.reads)
    for code, what in look_problems(_iter_figures(draws[:DRAWN])):
        yield diagnose(code, template.file, what, ("figure",))


def _iter_figures(draws: Sequence[Variant]) -> Iterator[Figure]:
    """The figures of questions and solutions, which were drawn before and so cost nothing."""
    for one in draws:
        for quiz in (True, False):
            figure = draw_question_figure(one, one.template.languages[0], quiz=quiz)
            if figure is not None:
                yield figure


def figure_text(one: Variant, lang: str, *, quiz: bool, drawn: bool = True) -> str:
    """All that a figure says: its words and, if it is one of the bank's own, its labels.

    Parameters
    ----------
    one : Draw
    lang : str
    quiz : bool
        As the question shows it, not the solution.
    drawn : bool
        Whether to draw it, for its labels.
    """
    figure = draw_question_figure(one, lang, quiz=quiz) if drawn and one.template.figure else None
    if figure is None:
        return describe_question_figure(one, lang, quiz=quiz) or ""
    return " ; ".join([figure.alt, *(label.text for label in figure.labels)])


def _iter_numbers(text: str) -> Iterator[str]:
    for found in _NUMBER.findall(text):
        yield f"{float(_SPACES.sub('', found).replace(',', '.')):.4g}"


def _given_away(shown: Sequence[tuple[Variant, set[str]]]) -> Iterator[Diagnostic]:
    template = shown[0][0].template
    for place, part in enumerate(template.rules.part, 1):
        for name in asked_quantities(part.answer):
            secret = [
                (leading_digits(one.shown_values[name]), numbers)
                for one, numbers in shown
                if leading_digits(one.shown_values[name]) not in _collect_stated_numbers(one)
            ]
            different = {answer for answer, _ in secret}
            if len(different) >= FEWEST and all(answer in seen for answer, seen in secret):
                example = secret[0][0]
                what = f"shows {name} = {example} in the question, where part {place} asks it"
                yield diagnose("QG401", template.file, f"figure: {what}", ("figure",))


def _find_unreadable(
    shown: Sequence[tuple[Variant, set[str]]], reads: Sequence[str]
) -> Iterator[Diagnostic]:
    """Quantities that are said to be read in a figure that does not have their numbers."""
    file = shown[0][0].template.file
    for index, name in enumerate(reads):
        lacking = [one for one, numbers in shown if leading_digits(one.shown[name]) not in numbers]
        if lacking:
            number = leading_digits(lacking[0].shown[name])
            what = f"figure: has no {name} = {number}, which reads says is read in it"
            yield diagnose("QG402", file, what, ("figure", "reads", index))


def _collect_stated_numbers(one: Variant) -> set[str]:
    """Numbers that the question states."""
    return {leading_digits(value) for value in one.shown.values()}
