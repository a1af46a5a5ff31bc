"""Kind ``order``: steps are to be put in order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from quizgen.bank.pools import select_from_pool
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.order import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.specs import (
    authored_answer,
    lettered,
    misconception_notes,
    part_error,
    reasons,
    shuffle_names,
    specification,
    with_reason,
)


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The steps and those that do not belong to them, in a drawn order."""
    answer = authored_answer(drawn, index)
    shown = select_from_pool(drawn, index)
    options = lettered(shuffle_names(drawn, index, [*shown.names, *shown.extra]))
    marks = {name: mark for mark, name in options}
    _check_traps(drawn, index)
    traps = _wrong_orders(answer.get("traps", {}), shown.names, marks)
    spec = specification(
        Spec,
        drawn,
        index,
        traps=traps,
        notes=misconception_notes(drawn, traps) if traps else {},
        why=reasons(drawn, options),
        steps=[marks[name] for name in shown.names],
        before=[(marks[first], marks[second]) for first, second in answer.get("before", ())],
        distractors=[marks[name] for name in shown.extra],
    )
    return Built(
        spec,
        Control("order"),
        options=options,
        reasons=with_reason(drawn, options),
        mistakes={
            trap: msgspec.structs.replace(
                spec, steps=wrong, before=None, distractors=[], traps={}, notes={}
            )
            for trap, wrong in traps.items()
        },
    )


def _check_traps(drawn: Variant, index: int) -> None:
    """Refuse a wrong order of other steps, or of one step twice."""
    answer = authored_answer(drawn, index)
    known = {*answer["steps"], *answer.get("distractors", ())}
    for trap, order in answer.get("traps", {}).items():
        for step in order:
            if step not in known or order.count(step) > 1:
                wrong = "twice" if step in known else "unknown"
                raise part_error(drawn, index, f"answer: traps.{trap}: step {step!r} is {wrong}")


def _wrong_orders(
    traps: Mapping[str, Sequence[str]], steps: Sequence[str], marks: Mapping[str, str]
) -> dict[str, list[str]]:
    """The known wrong orders of what is shown; one that is right or known already is left out."""
    found: dict[str, list[str]] = {}
    for name, wrong in traps.items():
        order = [marks[step] for step in wrong if step in marks]
        if order != [marks[step] for step in steps] and order not in found.values():
            found[name] = order
    return found


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Whether all steps belong to the order."""
    return (translate(lang, "ask.order" if spec.distractors else "ask.order_all"),)


__all__ = ["build", "hints", "printed"]
