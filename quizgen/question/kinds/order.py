"""Kind ``order``: steps are to be put in order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from quizgen.bank.draw import Draw
from quizgen.bank.pools import taken
from quizgen.locale import word
from quizgen.marking.kinds.order import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import (
    answer_of,
    complaint,
    lettered,
    mixed,
    notes,
    reasoned,
    specification,
    why,
)


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The steps and those that do not belong to them, in a drawn order."""
    answer = answer_of(drawn, index)
    shown = taken(drawn, index)
    options = lettered(mixed(drawn, index, [*shown.names, *shown.extra]))
    marks = {name: mark for mark, name in options}
    _check_traps(drawn, index)
    traps = _wrong_orders(answer.get("traps", {}), shown.names, marks)
    spec = specification(
        Spec,
        drawn,
        index,
        traps=traps,
        notes=notes(drawn, traps) if traps else {},
        why=why(drawn, options),
        steps=[marks[name] for name in shown.names],
        before=[(marks[first], marks[second]) for first, second in answer.get("before", ())],
        distractors=[marks[name] for name in shown.extra],
    )
    return Built(
        spec,
        Control("order"),
        options=options,
        reasons=reasoned(drawn, options),
        mistakes={
            trap: msgspec.structs.replace(
                spec, steps=wrong, before=None, distractors=[], traps={}, notes={}
            )
            for trap, wrong in traps.items()
        },
    )


def _check_traps(drawn: Draw, index: int) -> None:
    """Refuse a wrong order of other steps, or of one step twice."""
    answer = answer_of(drawn, index)
    known = {*answer["steps"], *answer.get("distractors", ())}
    for trap, order in answer.get("traps", {}).items():
        for step in order:
            if step not in known or order.count(step) > 1:
                wrong = "twice" if step in known else "unknown"
                raise complaint(drawn, index, f"answer: traps.{trap}: step {step!r} is {wrong}")


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
    return (word(lang, "ask.order" if spec.distractors else "ask.order_all"),)


__all__ = ["build", "hints", "printed"]
