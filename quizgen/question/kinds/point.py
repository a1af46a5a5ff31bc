"""Kind ``point``: two or more coordinates of the chain."""

from __future__ import annotations

from msgspec.structs import replace

from quizgen.bank.variant import Variant
from quizgen.grading.kinds.point import Spec
from quizgen.locale import translate
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import format_for_key
from quizgen.maths.values import Value
from quizgen.question.contract import Box, Built, Control
from quizgen.question.hints import given, rounding, unit
from quizgen.question.specs import exact_first, numeric


def each(values: tuple[Value, ...]) -> list[Scalar]:
    """The components of an answer in order, as a key holds them."""
    return [format_for_key(value) for value in values]


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The coordinates, and those that each mistake gives."""
    built = numeric(Spec, drawn, index, "values", each)
    boxes = tuple(Box("", built.spec.unit) for _ in built.spec.values)
    return replace(built, control=Control("line", boxes=boxes))


def hints(spec: Spec, lang: str) -> tuple[str, ...]:
    """Shape, unit and rounding."""
    name = "ask.point3" if len(spec.values) > len(("x", "y")) else "ask.point"
    return given(translate(lang, name), unit(spec.unit, lang), rounding(spec, spec.values, lang))


def printed(spec: Spec, lang: str) -> str:
    """The exact coordinates first."""
    return exact_first(spec, spec.values, lang)
