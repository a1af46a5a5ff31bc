"""Kind ``expression``: a formula as authored."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.expression import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built
from quizgen.question.specs import answer_of, mistaken, notes, specification


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The formula as it is written."""
    traps = answer_of(drawn, index).get("traps", {})
    spec = specification(Spec, drawn, index, notes=notes(drawn, traps) if traps else {})
    return Built(spec, mistakes=mistaken(spec, "value"))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """How a formula is typed."""
    return (word(lang, "ask.expression"),)


__all__ = ["build", "hints", "printed"]
