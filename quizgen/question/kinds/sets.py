"""Kind ``set``: several values of the chain in any order."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.sets import Spec
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding, unit
from quizgen.question.kinds.point import each
from quizgen.question.specs import exact_first, numeric


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The elements, and those that each mistake gives."""
    return numeric(Spec, drawn, index, "values", each)


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Shape, unit and rounding."""
    return given(word(lang, "ask.set"), unit(spec.unit, lang), rounding(spec, spec.values, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact elements first."""
    return exact_first(spec, spec.values, lang)
