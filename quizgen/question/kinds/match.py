"""Kind ``match``: each left side belongs to one of the right sides."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.plan import shuffled
from quizgen.bank.pools import pairs_of, taken
from quizgen.locale import word
from quizgen.marking.kinds.match import Spec
from quizgen.marking.mark import show as printed
from quizgen.question.contract import Built, Control
from quizgen.question.specs import lettered, mixed, order_key, reasoned, specification, why


def build(drawn: Draw, index: int) -> Built[Spec]:
    """Both sides in a drawn order of their own."""
    shown, pairs = taken(drawn, index), pairs_of(drawn, index)
    left = lettered(mixed(drawn, index, shown.names, "/left"))
    targets = sorted({*(pairs[name] for name in shown.names), *shown.extra})
    right = shuffled(order_key(drawn, index) + "/right", targets)
    places = {name: str(place) for place, name in enumerate(right, 1)}
    named = [
        *left,
        *((f"{mark}{places[n]}", f"{name} = {n}") for mark, name in left for n in right),
    ]
    matched = {mark: places[pairs[name]] for mark, name in left}
    return Built(
        specification(Spec, drawn, index, pairs=matched, why=why(drawn, named)),
        Control("pairs"),
        options=left,
        targets=tuple((places[n], n) for n in right),
        reasons=reasoned(drawn, named),
    )


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """How pairs are typed."""
    return (word(lang, "ask.match"),)


__all__ = ["build", "hints", "printed"]
