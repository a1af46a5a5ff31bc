"""Kind ``interval``: bounds as authored."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.interval import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding
from quizgen.question.specs import mistaken, specification


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The interval as it is written."""
    spec = specification(Spec, drawn, index)
    return Built(spec, mistakes=mistaken(spec, "value"))


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """How an interval is typed, and rounding."""
    return given(word(lang, "ask.interval"), rounding(spec, spec.value, lang))


__all__ = ["build", "hints", "printed"]
