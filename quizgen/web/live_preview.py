"""What the checker makes of a half-typed answer: how it is read, never whether it is right."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction

from markupsafe import Markup, escape

from quizgen import typeset
from quizgen.core.errors import FormulaError
from quizgen.grading.judge import explain_verdict
from quizgen.grading.options import DECIMALS, GradingOptions
from quizgen.grading.verdict import Verdict
from quizgen.kinds.derivation import DerivationSpec
from quizgen.kinds.grade import grade_answer
from quizgen.locale import localise_numbers
from quizgen.maths.notation import FormulaReadError, parse_formula
from quizgen.maths.notation.pretty import format_number
from quizgen.maths.precision import working_precision
from quizgen.maths.units import SHOWN, SIMPLE, format_unit
from quizgen.paper.answer_key import KeyQuestion
from quizgen.practice.input_fields import join_fields
from quizgen.web.question_view import FieldView

READ = frozenset(
    {"number", "quantity", "angle", "point", "table", "set", "interval", "expression", "witness"}
)
"""Kinds of which the reading says nothing about the key: what is read is what was typed."""

_SEVERAL = re.compile(r"([({\[]?)(.*;.*?)([)}\]]?(?: [^\d;]+)?)")
_BETWEEN = re.compile(r"(; | = )")
_VALUE = re.compile(r"([^A-Za-z]+) (\D+)")
_FRACTION = re.compile(r"[-−]?(\d{1,15})/(\d{1,15})")
_HALF = re.compile(r"[-−+*/^(.,=:;·×]\s*$")


def preview_reading(
    field: FieldView,
    key: KeyQuestion,
    values: Sequence[str],
    lang: str,
    decimal: str = DECIMALS[0],
) -> Markup:
    """Return how an answer is read, typeset; empty if it is incomplete or unreadable."""
    part = next(part for part in key.parts if part.id == field.id)
    spec = part.parse_spec()
    boxes = bool(field.control.boxes)
    there = [bool(value.strip()) for value in values]
    if boxes and any(there):  # an empty box beside it must not change how a value is read
        values = [value if full else "0" for value, full in zip(values, there, strict=True)]
    typed = join_fields(field.control, values, field.marks)
    if part.spec["kind"] not in READ or not typed or any(map(_HALF.search, values)):
        return Markup()
    verdict = grade_answer(spec, typed, decimal=decimal)
    if not verdict.is_graded:
        return Markup()
    return _typeset_values(verdict.read_as, lang, boxes=boxes, filled=there)


def preview_lines(
    field: FieldView,
    key: KeyQuestion,
    values: Sequence[str],
    lang: str,
    decimal: str = DECIMALS[0],
    *,
    judged: bool,
) -> tuple[Verdict, ...]:
    """Return how the lines of a derivation are read, and if wished which hold; none for others."""
    spec = next(part for part in key.parts if part.id == field.id).parse_spec()
    if not isinstance(spec, DerivationSpec) or not values:
        return ()
    with working_precision():
        lines = spec.follow(values[0], GradingOptions(decimal), judged=judged)
    return tuple(explain_verdict(spec, line, lang, reveal=False) for line in lines)


def _typeset_values(
    text: str, lang: str, *, boxes: bool = False, filled: Sequence[bool] = ()
) -> Markup:
    """Return values typeset one by one, with the signs around and between them.

    Values from boxes have no brackets, since nobody typed them, and each has its unit; only those
    of boxes that are ``filled`` are shown.
    """
    several = _SEVERAL.fullmatch(text)
    before, inner, after = several.groups() if several else ("", text, "")
    if boxes:
        unit, read = after.lstrip(")}]"), inner.split("; ")
        if len(read) == len(filled):
            read = [value for value, full in zip(read, filled, strict=True) if full]
        before, inner, after = "", "; ".join(value + unit for value in read), ""
    pieces = [
        escape(p) if _BETWEEN.fullmatch(p) else _typeset_value(p, lang)
        for p in _BETWEEN.split(inner)
    ]
    return escape(before) + Markup().join(pieces) + escape(after)


def _typeset_value(text: str, lang: str) -> Markup:
    """Return a formula, or a value with its unit, typeset; a fraction with its decimal value."""
    value = _VALUE.fullmatch(text)
    if value and _is_unit(value[2]):
        return (
            _typeset_value(value[1], lang)
            + ("" if value[2] == "deg" else " ")
            + format_unit(value[2])
        )
    try:
        maths = Markup(typeset.to_mathml(typeset.lay_out(parse_formula(text)), lang))
    except (FormulaError, FormulaReadError):
        return escape(localise_numbers(lang, text))
    return maths + localise_numbers(lang, _format_decimal_of_fraction(text))


def _format_decimal_of_fraction(text: str) -> str:
    """Return ``= 0.25`` or ``≈ 0.333`` after a fraction; empty for other texts."""
    fraction = _FRACTION.fullmatch(text)
    if not fraction or not int(fraction[2]):
        return ""
    exact = Fraction(int(fraction[1]), int(fraction[2]))
    decimal = f"{float(exact):.4g}"
    sign = "−" if text[0] in "-−" else ""
    return f" {'=' if Fraction(decimal) == exact else '≈'} {sign}{format_number(decimal)}"


def _is_unit(text: str) -> bool:
    """Return whether a text is a product or quotient of known units."""
    return all(part in SIMPLE or part in SHOWN.values() for part in re.split("[/*·]", text))
