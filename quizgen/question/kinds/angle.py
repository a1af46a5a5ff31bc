"""Kind ``angle``: one value of the chain in degrees."""

from __future__ import annotations

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.angle import Spec
from quizgen.locale import translate
from quizgen.question.contract import Built
from quizgen.question.hints import given, rounding
from quizgen.question.kinds.number import only
from quizgen.question.specs import exact_first, numeric


def build(drawn: Variant, index: int) -> Built[Spec]:
    """One angle, and the angle that each mistake gives."""
    return numeric(Spec, drawn, index, "value", only)


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Degrees and rounding."""
    return given(translate(lang, "ask.degrees"), rounding(spec, spec.value, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact value first."""
    return exact_first(spec, spec.value, lang)
