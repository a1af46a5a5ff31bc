"""The figure of a question, drawn or in words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from quizgen.bank.draw import Draw
from quizgen.bank.rules import Source
from quizgen.bank.solvers import authored
from quizgen.errors import BankError
from quizgen.figures import Figure, complete_parameters, describe_figure, draw_figure, needs_colour
from quizgen.maths.numbers import to_float
from quizgen.outside import located

Shown = TypeVar("Shown")


def pictured(drawn: Draw, lang: str, *, quiz: bool) -> Figure | None:
    """The figure of a question; None if it has none."""
    return _shown(draw_figure, drawn, lang, quiz=quiz)


def described(drawn: Draw, lang: str, *, quiz: bool) -> str | None:
    """The figure of a question in words, without drawing it; None if it has none."""
    return _shown(describe_figure, drawn, lang, quiz=quiz)


def coloured(drawn: Draw) -> bool:
    """Whether a question has a figure that cannot be read on grey paper, without drawing it."""

    def judge(figure: ModuleType, values: Mapping[str, Any], **_how: object) -> bool:
        return needs_colour(figure, values)

    return bool(_shown(judge, drawn, "", quiz=True))


def _shown(show: Callable[..., Shown], drawn: Draw, lang: str, *, quiz: bool) -> Shown | None:
    rule = drawn.template.rules.figure
    if rule is None or (quiz and not rule.quiz):
        return None
    figure = drawn.template.figure
    if figure is None:
        return None
    given: Mapping[str, Any] = {name: _parameter(drawn, s) for name, s in rule.values.items()}
    with located(drawn.template.file, BankError):
        values = complete_parameters(figure, given)
        with authored(Path(str(figure.__file__))):
            return show(figure, values, quiz=quiz, lang=lang)


def _parameter(drawn: Draw, source: Source) -> Any:
    """A number as written, a drawn phrase by its name, a formula's value, or lists of these."""
    if isinstance(source, tuple):
        return [_parameter(drawn, one) for one in source]
    if not isinstance(source, str):
        return source
    return drawn.words.get(source) or to_float(drawn.computed(source))
