"""What chosen steps come to in float32, in float64 and exactly: a table below the solution."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Block, Table, Words
from quizgen.locale import word
from quizgen.maths.numbers import fraction, rounded_text
from quizgen.maths.systems import NumberSystem, compile_expr, floats, singles
from quizgen.maths.units import unit
from quizgen.question.filling import with_unit
from quizgen.question.shown import pieces

FIGURES = 9
"""Significant figures that tell float32 from float64."""


def precision_table(drawn: Draw, lang: str) -> tuple[Block, ...]:
    """What the template's chosen steps come to in float32, in float64 and exactly."""
    chosen = drawn.template.rules.precision
    if not chosen:
        return ()
    head = tuple((Words(word(lang, f"precision.{name}")),) for name in ("way", "value"))
    rows = []
    for name in chosen:
        of = f"{name}: " if len(chosen) > 1 else ""
        for way, text in _ways(drawn, name):
            rows.append(((Words(f"{of}{word(lang, f'precision.{way}')}"),), pieces(text)))
    return (Table(head, tuple(rows)),)


def _ways(drawn: Draw, name: str) -> Iterator[tuple[str, str]]:
    shown = drawn.template.units.get(name, "")
    yield "float32", _rounded_at_each_step(drawn, name, shown, singles())
    yield "float64", _rounded_at_each_step(drawn, name, shown, floats())
    yield "exact", with_unit(rounded_text(drawn.shown_values[name], figures=FIGURES), shown)


def _rounded_at_each_step(drawn: Draw, name: str, shown: str, numbers: NumberSystem) -> str:
    """A quantity as floats give it, or a dash where they give nothing."""
    chain = drawn.template.chain
    env = {n: numbers.constant(fraction(drawn.values[n])) for n in chain.given}
    try:
        for step in chain.steps:
            env[step.name] = compile_expr(step.expr, numbers)(env)
        text = f"{env[name] / float(unit(shown).factor):.{FIGURES}g}"
    except (ZeroDivisionError, ValueError, OverflowError):
        return "-"
    return with_unit(text, shown)
