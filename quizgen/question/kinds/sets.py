"""Kind ``set``: several values of the chain in any order."""

from __future__ import annotations

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.sets import Spec
from quizgen.locale import translate
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding, unit
from quizgen.question.kinds.point import each
from quizgen.question.specs import exact_first, numeric


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The elements, and those that each mistake gives."""
    return numeric(Spec, drawn, index, "values", each)


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Shape, unit and rounding."""
    return given(
        translate(lang, "ask.set"), unit(spec.unit, lang), rounding(spec, spec.values, lang)
    )


def printed(spec: Spec, lang: str) -> str:
    """The exact elements first."""
    return exact_first(spec, spec.values, lang)
