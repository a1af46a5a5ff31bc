"""Kind ``table``: several named values of the chain."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec.structs import replace

from quizgen.bank.markdown import Inline, PlainText
from quizgen.bank.misconceptions import answer_names
from quizgen.bank.variant import Variant
from quizgen.grading.kinds.table import Spec, cell
from quizgen.grading.mark import show_key
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import format_for_key
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value
from quizgen.question.contract import Box, Built, Control
from quizgen.question.hints import given, rounding
from quizgen.question.inlines import (
    TextOrInlines,
    assignment_inlines,
    join_inlines,
    name_inline,
    translate_inlines,
)
from quizgen.question.specs import authored_answer, numeric


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The cells by their labels, and those that each mistake gives."""
    answer = authored_answer(drawn, index)
    of, names = answer["of"], answer_names(answer)
    labels = list(of) if isinstance(of, Mapping) else list(names)

    def write(values: tuple[Value, ...]) -> dict[str, Scalar]:
        return {label: format_for_key(v) for label, v in zip(labels, values, strict=True)}

    units = [str(answer.get("unit", drawn.template.units.get(name, ""))) for name in names]
    stated = {label: unit for label, unit in zip(labels, units, strict=True) if unit}
    named = dict(zip(labels, names, strict=True))
    built = numeric(Spec, drawn, index, "values", write, of=named, units=stated)
    boxes = tuple(map(Box, labels, units))
    return replace(built, control=Control("line", boxes=boxes, named=True))


def hints(spec: Spec, lang: str) -> tuple[TextOrInlines, ...]:
    """Names with their units, and rounding."""
    names = join_inlines((_with_unit(name, spec.units.get(name, "")) for name in spec.values), ", ")
    return given(
        translate_inlines(lang, "ask.table", names=names), rounding(spec, spec.values, lang)
    )


def _with_unit(name: str, unit: str) -> tuple[Inline, ...]:
    return (
        (name_inline(name), PlainText(f" ({format_unit(unit)})")) if unit else (name_inline(name),)
    )


def printed(spec: Spec, lang: str) -> TextOrInlines:
    """The cells by their names."""
    return assignment_inlines((name, show_key(cell(spec, name), lang)) for name in spec.values)
