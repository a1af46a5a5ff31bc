"""Kind ``order``: steps are to be put in order."""

from __future__ import annotations

import msgspec

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.order import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import answer_of, lettered, mixed, notes, reasoned, specification, why


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The steps and those that do not belong to them, in a drawn order."""
    answer = answer_of(drawn, index)
    steps, strangers = answer["steps"], answer.get("distractors", ())
    options = lettered(mixed(drawn, index, [*steps, *strangers]))
    marks = {name: mark for mark, name in options}
    traps = {
        name: [marks[step] for step in wrong] for name, wrong in answer.get("traps", {}).items()
    }
    spec = specification(
        Spec,
        drawn,
        index,
        traps=traps,
        notes=notes(drawn, traps) if traps else {},
        why=why(drawn, options),
        steps=[marks[name] for name in steps],
        before=[(marks[first], marks[second]) for first, second in answer.get("before", ())],
        distractors=[marks[name] for name in strangers],
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


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Whether all steps belong to the order."""
    return (word(lang, "ask.order" if spec.distractors else "ask.order_all"),)


__all__ = ["build", "hints", "printed"]
