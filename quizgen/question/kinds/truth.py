"""Kind ``tf``: a statement is true or false."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.pools import claims, holds
from quizgen.bank.rules import ClaimRule, claim_of
from quizgen.locale import word
from quizgen.marking.kinds.choice import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import answer_of, cited, reasoned, specification, why


def statement(drawn: Draw, index: int) -> tuple[str, ClaimRule]:
    """Name of the statement, the part's own or one of the pool of claims, and when it is true."""
    answer = answer_of(drawn, index)
    if "from" in answer:
        name = claims(drawn)[index]
        return name, claim_of(drawn.template.rules, name)
    said = answer.get("claim", "")
    return drawn.words.get(said, said), ClaimRule(answer["true"])


def build(drawn: Draw, index: int) -> Built[Spec]:
    """True first, then false; the statement's one reason says why it is as it is."""
    name, claim = statement(drawn, index)
    told = reasoned(drawn, [("A", name), ("B", name)])
    spec = specification(
        Spec,
        drawn,
        index,
        options=["true", "false"],
        correct=[1 if holds(drawn, claim.true) else 2],
        why=cited(why(drawn, told), claim.source),
    )
    return Built(
        spec,
        Control("truth"),
        statements=(("claims", name),) if "from" in answer_of(drawn, index) else (),
        right=(("reasons", name),) if told else (),
        source=claim.source,
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """True or false."""
    return (word(lang, "ask.tf"),)


__all__ = ["build", "hints", "printed"]
