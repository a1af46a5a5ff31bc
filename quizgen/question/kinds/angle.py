"""Kind ``angle``: one value of the chain in degrees."""

from __future__ import annotations

from quizgen.bank.draw import Draw
from quizgen.locale import word
from quizgen.marking.kinds.angle import Spec
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding
from quizgen.question.kinds.number import only
from quizgen.question.specs import exact_first, numeric


def build(drawn: Draw, index: int) -> Built[Spec]:
    """One angle, and the angle that each mistake gives."""
    return numeric(Spec, drawn, index, "value", only)


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Degrees and rounding."""
    return given(word(lang, "ask.degrees"), rounding(spec, spec.value, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact value first."""
    return exact_first(spec, spec.value, lang)
