"""Kind ``tf``: a statement is true or false."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.pools import claims, holds
from quizgen.bank.rules import ClaimRule, claim_of
from quizgen.locale import word
from quizgen.marking.kinds.choice import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control, Named
from quizgen.question.specs import answer_of, cited, reasoned, specification, why


def build(drawn: Draw, index: int) -> Built[Spec]:
    """True first, then false; the statement is the part's own, or one of the pool of claims."""
    answer = answer_of(drawn, index)
    if "from" in answer:
        name = claims(drawn)[index]
        claim = claim_of(drawn.template.rules, name)
        return _judged(drawn, index, name, claim, (("claims", name),))
    said = answer.get("claim", "")
    return _judged(drawn, index, drawn.words.get(said, said), ClaimRule(answer["true"]))


def _judged(
    drawn: Draw, index: int, name: str, claim: ClaimRule, asked: tuple[Named, ...] = ()
) -> Built[Spec]:
    """A statement whose one reason says why it is true, or why it is false."""
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
        statements=asked,
        right=(("reasons", name),) if told else (),
        source=claim.source,
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """True or false."""
    return (word(lang, "ask.tf"),)


__all__ = ["build", "hints", "printed"]
