"""Kind ``quantity``: one value of the chain, to be typed with its unit."""

from __future__ import annotations

from quizgen.bank.misconceptions import answer_names
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.quantity import Spec
from quizgen.locale import translate
from quizgen.maths.units import format_unit
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding
from quizgen.question.kinds.number import only
from quizgen.question.specs import authored_answer, exact_first, numeric


def build(drawn: Variant, index: int) -> Built[Spec]:
    """One number in the unit asked, else in the unit it is shown in."""
    answer = authored_answer(drawn, index)
    shown_in = drawn.template.units.get(answer_names(answer)[0], "")
    return numeric(Spec, drawn, index, "value", only, unit=answer.get("unit", shown_in))


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Unit and rounding."""
    unit = translate(lang, "ask.unit" if spec.bare else "ask.quantity", unit=format_unit(spec.unit))
    return given(unit, rounding(spec, spec.value, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact value first."""
    return exact_first(spec, spec.value, lang)
