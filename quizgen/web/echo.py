"""What the checker makes of a half-typed answer: how it is read, never whether it is right."""

from __future__ import annotations

import re
from collections.abc import Sequence

from markupsafe import Markup, escape

from quizgen import typeset
from quizgen.errors import FormulaError
from quizgen.marking.mark import mark
from quizgen.maths.notation import ReadError, parse
from quizgen.paper.key import KeyQuestion
from quizgen.practice.boxes import joined
from quizgen.web.made import MadeField

READ = frozenset(
    {"number", "quantity", "angle", "point", "table", "set", "interval", "expression", "witness"}
)
"""Kinds of which the reading says nothing about the key: what is read is what was typed."""

_HALF = re.compile(r"[-−+*/^(.,=:;·×]\s*$")


def read_back(field: MadeField, key: KeyQuestion, values: Sequence[str]) -> Markup:
    """How an answer is read, typeset; empty if it is not complete yet, or of another kind."""
    part = next(part for part in key.parts if part.id == field.id)
    typed = joined(field.control, values, field.marks)
    if part.spec["kind"] not in READ or not typed or any(map(_HALF.search, values)):
        return Markup()
    verdict = mark(part.in_order(), typed)
    return _typeset(verdict.read_as) if verdict.graded else Markup()


def _typeset(text: str) -> Markup:
    try:
        return Markup(typeset.mathml(typeset.layout(parse(text)), "en"))
    except (FormulaError, ReadError):
        return escape(text)
