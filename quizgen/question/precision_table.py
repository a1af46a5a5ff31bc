"""What chosen steps come to in float32, in float64 and exactly: a table below the solution."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.bank.markdown import Block, PlainText, TableBlock
from quizgen.bank.variant import Variant
from quizgen.locale import translate
from quizgen.maths.number_systems import NumberSystem, compile_expr, float32_system, float64_system
from quizgen.maths.numbers import format_rounded, to_fraction
from quizgen.maths.units import get_unit
from quizgen.question.inlines import to_inlines
from quizgen.question.interpolation import join_unit

FIGURES = 9
"""Significant figures that tell float32 from float64."""


def precision_table(drawn: Variant, lang: str) -> tuple[Block, ...]:
    """What the template's chosen steps come to in float32, in float64 and exactly."""
    chosen = drawn.template.rules.precision
    if not chosen:
        return ()
    head = tuple((PlainText(translate(lang, f"precision.{name}")),) for name in ("way", "value"))
    rows = []
    for name in chosen:
        of = f"{name}: " if len(chosen) > 1 else ""
        for way, text in _iter_number_systems(drawn, name):
            rows.append(
                ((PlainText(f"{of}{translate(lang, f'precision.{way}')}"),), to_inlines(text))
            )
    return (TableBlock(head, tuple(rows)),)


def _iter_number_systems(drawn: Variant, name: str) -> Iterator[tuple[str, str]]:
    shown = drawn.template.units.get(name, "")
    yield "float32", _rounded_at_each_step(drawn, name, shown, float32_system())
    yield "float64", _rounded_at_each_step(drawn, name, shown, float64_system())
    yield "exact", join_unit(format_rounded(drawn.shown_values[name], figures=FIGURES), shown)


def _rounded_at_each_step(drawn: Variant, name: str, shown: str, numbers: NumberSystem) -> str:
    """A quantity as floats give it, or a dash where they give nothing."""
    chain = drawn.template.chain
    env = {n: numbers.constant(to_fraction(drawn.values[n])) for n in chain.given}
    try:
        for step in chain.steps:
            env[step.name] = compile_expr(step.expr, numbers)(env)
        text = f"{env[name] / float(get_unit(shown).factor):.{FIGURES}g}"
    except (ZeroDivisionError, ValueError, OverflowError):
        return "-"
    return join_unit(text, shown)
