"""Kind ``interval``: bounds as authored."""

from __future__ import annotations

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.interval import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding
from quizgen.question.specs import mistaken, specification


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The interval as it is written."""
    spec = specification(Spec, drawn, index)
    return Built(spec, mistakes=mistaken(spec, "value"))


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """How an interval is typed, and rounding."""
    return given(translate(lang, "ask.interval"), rounding(spec, spec.value, lang))


__all__ = ["build", "hints", "printed"]
