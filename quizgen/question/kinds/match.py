"""Kind ``match``: each left side belongs to one of the right sides."""

from __future__ import annotations

from quizgen.bank.pools import matching_pairs, select_from_pool
from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.match import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Built, Control
from quizgen.question.specs import (
    lettered,
    order_seed,
    reasons,
    shuffle_names,
    specification,
    with_reason,
)


def build(drawn: Variant, index: int) -> Built[Spec]:
    """Both sides in a drawn order of their own."""
    shown, pairs = select_from_pool(drawn, index), matching_pairs(drawn, index)
    left = lettered(shuffle_names(drawn, index, shown.names, "/left"))
    targets = sorted({*(pairs[name] for name in shown.names), *shown.extra})
    right = shuffle(order_seed(drawn, index) + "/right", targets)
    places = {name: str(place) for place, name in enumerate(right, 1)}
    named = [
        *left,
        *((f"{mark}{places[n]}", f"{name} = {n}") for mark, name in left for n in right),
    ]
    matched = {mark: places[pairs[name]] for mark, name in left}
    return Built(
        specification(Spec, drawn, index, pairs=matched, why=reasons(drawn, named)),
        Control("pairs"),
        options=left,
        targets=tuple((places[n], n) for n in right),
        reasons=with_reason(drawn, named),
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """How pairs are typed."""
    return (translate(lang, "ask.match"),)


__all__ = ["build", "hints", "printed"]
