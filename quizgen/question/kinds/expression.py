"""Kind ``expression``: a formula as authored."""

from __future__ import annotations

from quizgen import typeset
from quizgen.bank.draw import Draw
from quizgen.bank.prose import Code
from quizgen.marking.kinds.expression import Spec
from quizgen.marking.reading.formulas import author
from quizgen.maths.notation import to_text
from quizgen.question.contract import Built
from quizgen.question.shown import Maths, Shown, said
from quizgen.question.specs import answer_of, mistaken, notes, specification

EXAMPLE = "(a+b)^2/2"
"""A formula as it is typed, and no answer to any question."""


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The formula as it is written."""
    traps = answer_of(drawn, index).get("traps", {})
    spec = specification(Spec, drawn, index, notes=notes(drawn, traps) if traps else {})
    return Built(spec, mistakes=mistaken(spec, "value"))


def hints(_spec: Spec, lang: str) -> tuple[Shown, ...]:
    """How a formula is typed."""
    return (said(lang, "ask.expression", example=(Code(EXAMPLE),)),)


def printed(spec: Spec, _lang: str) -> Shown:
    """The formula as it is written by hand."""
    formula = author(spec.value, tuple(spec.symbols))
    return (Maths(typeset.layout(formula, inline=True), to_text(formula)),)
