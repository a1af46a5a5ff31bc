"""Kind ``tf``: a statement is true or false."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.choice import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import answer_of, holds, reasoned, specification, why


def build(drawn: Draw, index: int) -> Built[Spec]:
    """True first, then false; whichever was chosen, the claim has one reason."""
    answer = answer_of(drawn, index)
    right = 1 if holds(drawn, answer["true"]) else 2
    claim = drawn.words.get(answer.get("claim", ""), "")
    told = reasoned(drawn, [("A", claim), ("B", claim)])
    spec = specification(
        Spec, drawn, index, options=["true", "false"], correct=[right], why=why(drawn, told)
    )
    return Built(spec, Control("truth"), right=(("reasons", claim),) if told else ())


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """True or false."""
    return (word(lang, "ask.tf"),)


__all__ = ["build", "hints", "printed"]
