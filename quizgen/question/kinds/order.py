"""Kind ``order``: steps are to be put in order."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.order import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import answer_of, lettered, mixed, specification


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The steps and those that do not belong to them, in a drawn order."""
    answer = answer_of(drawn, index)
    steps, strangers = answer["steps"], answer.get("distractors", ())
    options = lettered(mixed(drawn, index, [*steps, *strangers]))
    marks = {name: mark for mark, name in options}
    spec = specification(
        Spec,
        drawn,
        index,
        steps=[marks[name] for name in steps],
        before=[(marks[first], marks[second]) for first, second in answer.get("before", ())],
        distractors=[marks[name] for name in strangers],
    )
    return Built(spec, Control("order"), options=options)


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Whether all steps belong to the order."""
    return (word(lang, "ask.order" if spec.distractors else "ask.order_all"),)


__all__ = ["build", "hints", "printed"]
