"""Kind ``table``: several named values of the chain."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec.structs import replace

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Inline, Words
from quizgen.bank.traps import answer_names
from quizgen.marking.kinds.table import Spec, cell
from quizgen.marking.mark import show
from quizgen.maths.constants import Scalar
from quizgen.maths.numbers import key_text
from quizgen.maths.units import shown
from quizgen.maths.values import Value
from quizgen.question.contract import Box, Built, Control
from quizgen.question.hints import given, rounding
from quizgen.question.shown import Shown, assigned, listed, named, said
from quizgen.question.specs import answer_of, numeric


def build(drawn: Draw, index: int) -> Built[Spec]:
    """The cells by their labels, and those that each mistake gives."""
    answer = answer_of(drawn, index)
    of, names = answer["of"], answer_names(answer)
    labels = list(of) if isinstance(of, Mapping) else list(names)

    def write(values: tuple[Value, ...]) -> dict[str, Scalar]:
        return {label: key_text(v) for label, v in zip(labels, values, strict=True)}

    units = [str(answer.get("unit", drawn.template.units.get(name, ""))) for name in names]
    stated = {label: unit for label, unit in zip(labels, units, strict=True) if unit}
    named = dict(zip(labels, names, strict=True))
    built = numeric(Spec, drawn, index, "values", write, of=named, units=stated)
    boxes = tuple(map(Box, labels, units))
    return replace(built, control=Control("line", boxes=boxes, named=True))


def hints(spec: Spec, lang: str) -> tuple[Shown, ...]:
    """Names with their units, and rounding."""
    names = listed((_with_unit(name, spec.units.get(name, "")) for name in spec.values), ", ")
    return given(said(lang, "ask.table", names=names), rounding(spec, spec.values, lang))


def _with_unit(name: str, unit: str) -> tuple[Inline, ...]:
    return (named(name), Words(f" ({shown(unit)})")) if unit else (named(name),)


def printed(spec: Spec, lang: str) -> Shown:
    """The cells by their names."""
    return assigned((name, show(cell(spec, name), lang)) for name in spec.values)
