"""Kind ``number``: one value of the chain, in the unit it is asked in."""

from __future__ import annotations

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.number import Spec
from quizgen.grading.mark import show_key
from quizgen.locale import translate
from quizgen.maths.numbers import format_for_key
from quizgen.maths.values import Value
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding, unit
from quizgen.question.specs import exact_first, numeric


def only(values: tuple[Value, ...]) -> str:
    """The one component of an answer, as a key holds it."""
    (value,) = values
    return format_for_key(value)


def build(drawn: Variant, index: int) -> Built[Spec]:
    """One number, and the number that each mistake gives."""
    return numeric(Spec, drawn, index, "value", only)


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Percent, unit and rounding."""
    percent = translate(lang, "ask.percent") if spec.percent else ""
    return given(percent, unit(spec.unit, lang), rounding(spec, spec.value, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact value first, unless a percentage is asked."""
    return show_key(spec, lang) if spec.percent else exact_first(spec, spec.value, lang)
