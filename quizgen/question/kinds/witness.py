"""Kind ``witness``: numbers of one's own that meet a condition."""

from __future__ import annotations

from fractions import Fraction

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Code
from quizgen.marking.kinds.witness import Spec
from quizgen.marking.mark import show
from quizgen.maths.notation import parse, people, to_text
from quizgen.maths.numbers import exact_text, key_text
from quizgen.maths.tree import Num, substitute
from quizgen.question.contract import Box, Built, Control
from quizgen.question.shown import Shown, assigned, said
from quizgen.question.specs import answer_of, specification


def build(drawn: Draw, index: int) -> Built[Spec]:
    """Conditions and an example with the drawn values in place."""
    answer = answer_of(drawn, index)
    known = {n: Num(Fraction(key_text(v)), decimal=v.q != 1) for n, v in drawn.shown.items()}
    let, example = answer.get("let", {}), answer.get("example", {})
    symbols = (*answer["symbols"], *let, *known)

    def stated(text: object) -> str:
        return to_text(substitute(parse(str(text), symbols=symbols), known))

    spec = specification(
        Spec,
        drawn,
        index,
        example={name: _short(drawn, formula) for name, formula in example.items()},
        let={name: stated(text) for name, text in let.items()},
        predicate=stated(answer["predicate"]),
        where=[stated(text) for text in answer.get("where", ())],
    )
    return Built(spec, Control("lines", lines=2, boxes=tuple(map(Box, spec.symbols)), named=True))


def _short(drawn: Draw, formula: str | int) -> str:
    """A decimal where it is short, else the exact fraction."""
    value = drawn.computed(str(formula))
    return exact_text(value, minus="-") or key_text(value)


def hints(spec: Spec, lang: str) -> tuple[Shown, ...]:
    """Which names to give, as they are typed."""
    names = "; ".join(f"{name} = ..." for name in spec.symbols)
    return (said(lang, "ask.witness", names=(Code(names),)),)


def printed(spec: Spec, lang: str) -> Shown:
    """One right example, else what an example must satisfy."""
    if not spec.example:
        return show(spec, lang)
    return assigned((name, people.number(str(spec.example[name]))) for name in spec.names())
