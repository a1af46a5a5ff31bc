"""Kind ``expression``: a formula as authored."""

from __future__ import annotations

from quizgen import typeset
from quizgen.bank.markdown import InlineCode
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.expression import Spec
from quizgen.grading.reading.formulas import parse_authored
from quizgen.maths.notation import format_tree
from quizgen.question.contract import Built
from quizgen.question.inlines import TextOrInlines, TypesetMaths, translate_inlines
from quizgen.question.specs import authored_answer, misconception_notes, mistaken, specification

EXAMPLE = "(a+b)^2/2"
"""A formula as it is typed, and no answer to any question."""


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The formula as it is written."""
    traps = authored_answer(drawn, index).get("traps", {})
    spec = specification(
        Spec, drawn, index, notes=misconception_notes(drawn, traps) if traps else {}
    )
    return Built(spec, mistakes=mistaken(spec, "value"))


def hints(_spec: Spec, lang: str) -> tuple[TextOrInlines, ...]:
    """How a formula is typed."""
    return (translate_inlines(lang, "ask.expression", example=(InlineCode(EXAMPLE),)),)


def printed(spec: Spec, _lang: str) -> TextOrInlines:
    """The formula as it is written by hand."""
    formula = parse_authored(spec.value, tuple(spec.symbols))
    return (TypesetMaths(typeset.lay_out(formula, inline=True), format_tree(formula)),)
