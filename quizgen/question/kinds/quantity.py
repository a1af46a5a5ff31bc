"""Kind ``quantity``: one value of the chain, to be typed with its unit."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.bank.traps import answer_names
from quizgen.locale import word
from quizgen.marking.kinds.quantity import Spec
from quizgen.maths.units import shown
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding
from quizgen.question.kinds.number import only
from quizgen.question.specs import answer_of, exact_first, numeric


def build(drawn: Draw, index: int) -> Built[Spec]:
    """One number in the unit asked, else in the unit it is shown in."""
    answer = answer_of(drawn, index)
    shown_in = drawn.template.units.get(answer_names(answer)[0], "")
    return numeric(Spec, drawn, index, "value", only, unit=answer.get("unit", shown_in))


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Unit and rounding."""
    unit = word(lang, "ask.unit" if spec.bare else "ask.quantity", unit=shown(spec.unit))
    return given(unit, rounding(spec, spec.value, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact value first."""
    return exact_first(spec, spec.value, lang)
