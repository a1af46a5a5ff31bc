"""Kind ``witness``: numbers of one's own that meet a condition."""

from __future__ import annotations

from fractions import Fraction

from quizgen.bank.markdown import InlineCode
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.witness import Spec
from quizgen.grading.mark import show_key
from quizgen.maths.notation import format_tree, parse_formula, pretty
from quizgen.maths.numbers import format_exact, format_for_key
from quizgen.maths.tree import Num, substitute
from quizgen.question.contract import Box, Built, Control
from quizgen.question.inlines import TextOrInlines, assignment_inlines, translate_inlines
from quizgen.question.specs import authored_answer, specification


def build(drawn: Variant, index: int) -> Built[Spec]:
    """Conditions and an example with the drawn values in place."""
    answer = authored_answer(drawn, index)
    known = {n: Num(Fraction(format_for_key(v)), decimal=v.q != 1) for n, v in drawn.shown.items()}
    let, example = answer.get("let", {}), answer.get("example", {})
    symbols = (*answer["symbols"], *let, *known)

    def stated(text: object) -> str:
        return format_tree(substitute(parse_formula(str(text), symbols=symbols), known))

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


def _short(drawn: Variant, formula: str | int) -> str:
    """A decimal where it is short, else the exact fraction."""
    value = drawn.evaluate(str(formula))
    return format_exact(value, minus="-") or format_for_key(value)


def hints(spec: Spec, lang: str) -> tuple[TextOrInlines, ...]:
    """Which names to give, as they are typed."""
    names = "; ".join(f"{name} = ..." for name in spec.symbols)
    return (translate_inlines(lang, "ask.witness", names=(InlineCode(names),)),)


def printed(spec: Spec, lang: str) -> TextOrInlines:
    """One right example, else what an example must satisfy."""
    if not spec.example:
        return show_key(spec, lang)
    return assignment_inlines(
        (name, pretty.format_number(str(spec.example[name]))) for name in spec.names()
    )
