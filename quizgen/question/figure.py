"""The figure of a question, drawn or in words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from quizgen.bank.rules import Source
from quizgen.bank.solvers import author_error_context
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.core.untrusted import error_context
from quizgen.figures import Figure, complete_parameters, describe_figure, draw_figure, needs_colour
from quizgen.maths.numbers import to_float
from quizgen.maths.units import build_unit_registry

Shown = TypeVar("Shown")


def draw_question_figure(drawn: Variant, lang: str, *, quiz: bool) -> Figure | None:
    """Return the figure of a question; None if it has none."""
    return _draw_question_figure(draw_figure, drawn, lang, quiz=quiz)


def draw_marked_figure(
    drawn: Variant, lang: str, values: Mapping[str, tuple[float, float]], *, quiz: bool
) -> Figure | None:
    """Return the figure of a question with values of a learner drawn into it.

    Parameters
    ----------
    drawn : Variant
    lang : str
    values : mapping of str to (float, float)
        Name of a quantity to what the learner gave, and how many base units its unit has; those
        that the figure cannot show are left out.
    quiz : bool
        Whether what the question asks for is hidden.

    Returns
    -------
    Figure or None
        None if the figure shows none of them.
    """

    def draw(figure: ModuleType, given: Mapping[str, Any], **how: Any) -> Figure | None:
        """Draw with the marks that the figure knows."""
        known: Mapping[str, str] = getattr(figure, "MARKS", {})
        marks = {
            name: _convert_mark(*values[name], unit)
            for name, unit in known.items()
            if name in values
        }
        return draw_figure(figure, given, marks=marks, **how) if marks else None

    return _draw_question_figure(draw, drawn, lang, quiz=quiz)


def describe_question_figure(drawn: Variant, lang: str, *, quiz: bool) -> str | None:
    """Return the figure of a question in words, without drawing it; None if it has none."""
    return _draw_question_figure(describe_figure, drawn, lang, quiz=quiz)


def has_coloured_figure(drawn: Variant) -> bool:
    """Return whether a question's figure cannot be read on grey paper, without drawing it."""

    def judge(figure: ModuleType, values: Mapping[str, Any], **_how: object) -> bool:
        """Return whether the figure needs colour with these values."""
        return needs_colour(figure, values)

    return bool(_draw_question_figure(judge, drawn, "", quiz=True))


def _draw_question_figure(
    show: Callable[..., Shown], drawn: Variant, lang: str, *, quiz: bool
) -> Shown | None:
    """Return what ``show`` makes of a question's figure; None if it shows none.

    Raises ``BankError`` at the template or at the line of the figure's module that failed.
    """
    rule = drawn.template.rules.figure
    if rule is None or (quiz and not rule.quiz):
        return None
    figure = drawn.template.figure
    if figure is None:
        return None
    given: Mapping[str, Any] = {
        name: _evaluate_parameter(drawn, s) for name, s in rule.values.items()
    }
    with error_context(drawn.template.file, BankError):
        values = complete_parameters(figure, given)
        with author_error_context(Path(str(figure.__file__))):
            return show(figure, values, quiz=quiz, lang=lang)


def _convert_mark(value: float, factor: float, unit: str) -> float:
    """Return a value in the unit that a figure draws it in; as it is if that is left open."""
    return value * factor / to_float(build_unit_registry().factor(unit)) if unit else value


def _evaluate_parameter(drawn: Variant, source: Source) -> Any:
    """Return a parameter: a number, drawn phrases, a formula's value, or lists of these."""
    if isinstance(source, tuple):
        return [_evaluate_parameter(drawn, one) for one in source]
    if not isinstance(source, str):
        return source
    if source in drawn.words:
        return drawn.words[source]
    if texts := drawn.text_list(source):
        return texts
    value: Any = drawn.evaluate(source)
    return [*map(to_float, value)] if isinstance(value, tuple) else to_float(value)
