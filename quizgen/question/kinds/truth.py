"""Kind ``tf``: a statement is true or false."""

from __future__ import annotations

from quizgen.bank.pools import condition_holds, selected_claims
from quizgen.bank.rules import ClaimRule, get_claim
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.choice import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.specs import authored_answer, cited, reasons, specification, with_reason


def statement(drawn: Variant, index: int) -> tuple[str, ClaimRule]:
    """Name of the statement, the part's own or one of the pool of claims, and when it is true."""
    answer = authored_answer(drawn, index)
    if "from" in answer:
        name = selected_claims(drawn)[index]
        return name, get_claim(drawn.template.rules, name)
    said = answer.get("claim", "")
    return drawn.words.get(said, said), ClaimRule(answer["true"])


def build(drawn: Variant, index: int) -> Built[Spec]:
    """True first, then false; the statement's one reason says why it is as it is."""
    name, claim = statement(drawn, index)
    told = with_reason(drawn, [("A", name), ("B", name)])
    spec = specification(
        Spec,
        drawn,
        index,
        options=["true", "false"],
        correct=[1 if condition_holds(drawn, claim.true) else 2],
        why=cited(reasons(drawn, told), claim.source),
    )
    return Built(
        spec,
        Control("truth"),
        statements=(("claims", name),) if "from" in authored_answer(drawn, index) else (),
        right=(("reasons", name),) if told else (),
        source=claim.source,
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """True or false."""
    return (translate(lang, "ask.tf"),)


__all__ = ["build", "hints", "printed"]
