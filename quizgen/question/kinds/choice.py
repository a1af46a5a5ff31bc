"""Kind ``choice``: one of several options is right."""

from __future__ import annotations

from quizgen.bank.pools import condition_holds, select_from_pool
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.choice import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.interpolation import Interpolator, inlines_as_typed
from quizgen.question.specs import (
    authored_answer,
    lettered,
    part_error,
    reasons,
    shuffle_names,
    specification,
    with_reason,
)


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The options in a drawn order; exactly one is right."""
    built = offered(drawn, index, Control("one", lines=0))
    if len(built.right) != 1:
        raise part_error(drawn, index, f"{len(built.right)} options are right")
    return built


def ordered(drawn: Variant, index: int) -> tuple[list[str], list[str]]:
    """Names of the options in a drawn order, and of those that are right in this draw."""
    conditions = authored_answer(drawn, index)["options"]
    order = shuffle_names(drawn, index, select_from_pool(drawn, index).names)
    return order, [name for name in order if condition_holds(drawn, conditions[name])]


def offered(drawn: Variant, index: int, control: Control) -> Built[Spec]:
    """The options in a drawn order, with those that are right in this draw."""
    order, right = ordered(drawn, index)
    filler = Interpolator(drawn, drawn.template.languages[0])
    wordings = [inlines_as_typed(filler.sentence("options", name)) for name in order]
    options = lettered(order)
    correct = [order.index(name) + 1 for name in right]
    given = {"options": wordings, "correct": correct, "why": reasons(drawn, options)}
    return Built(
        specification(Spec, drawn, index, **given),
        control,
        options=options,
        reasons=with_reason(drawn, options),
        right=tuple(("options", name) for name in right),
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """One option is to be chosen."""
    return (translate(lang, "ask.choice"),)


__all__ = ["build", "hints", "printed"]
