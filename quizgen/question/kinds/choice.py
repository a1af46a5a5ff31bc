"""Kind ``choice``: one of several options is right."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.pools import holds, taken
from quizgen.locale import word
from quizgen.marking.kinds.choice import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.filling import Filler, as_typed
from quizgen.question.specs import (
    answer_of,
    complaint,
    lettered,
    mixed,
    reasoned,
    specification,
    why,
)


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The options in a drawn order; exactly one is right."""
    built = offered(drawn, index, Control("one", lines=0))
    if len(built.right) != 1:
        raise complaint(drawn, index, f"{len(built.right)} options are right")
    return built


def ordered(drawn: Draw, index: int) -> tuple[list[str], list[str]]:
    """Names of the options in a drawn order, and of those that are right in this draw."""
    conditions = answer_of(drawn, index)["options"]
    order = mixed(drawn, index, taken(drawn, index).names)
    return order, [name for name in order if holds(drawn, conditions[name])]


def offered(drawn: Draw, index: int, control: Control) -> Built[Spec]:
    """The options in a drawn order, with those that are right in this draw."""
    order, right = ordered(drawn, index)
    filler = Filler(drawn, drawn.template.languages[0])
    wordings = [as_typed(filler.sentence("options", name)) for name in order]
    options = lettered(order)
    correct = [order.index(name) + 1 for name in right]
    given = {"options": wordings, "correct": correct, "why": why(drawn, options)}
    return Built(
        specification(Spec, drawn, index, **given),
        control,
        options=options,
        reasons=reasoned(drawn, options),
        right=tuple(("options", name) for name in right),
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """One option is to be chosen."""
    return (word(lang, "ask.choice"),)


__all__ = ["build", "hints", "printed"]
