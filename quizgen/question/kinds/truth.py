"""Kind ``tf``: a statement is true or false."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.choice import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import answer_of, holds, specification


def build(drawn: Draw, index: int) -> Built[Spec]:
    """True first, then false."""
    right = 1 if holds(drawn, answer_of(drawn, index)["true"]) else 2
    spec = specification(Spec, drawn, index, options=["true", "false"], correct=[right])
    return Built(spec, Control("truth"))


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """True or false."""
    return (word(lang, "ask.tf"),)


__all__ = ["build", "hints", "printed"]
