"""The answer kinds: one module each, and the one list of them.

In: an authored answer with a ``PartContext``; a spec and a typed text. Out: an ``AskedPart``; a
``Verdict``, the key as it is printed. Must never know: a paper, an output, a seed.

What authors may write, what a key may hold, how it is asked and how it is graded: every table of
kinds is made from ``KINDS``.
"""

from __future__ import annotations

from typing import Any

from quizgen.grading.spec import NumericSpec
from quizgen.kinds import (
    angle,
    checked,
    choice,
    code,
    complex_number,
    derivation,
    equation,
    expression,
    gap,
    interval,
    match,
    matrix,
    multi,
    number,
    order,
    point,
    program,
    quantity,
    rubric,
    sets,
    sketch,
    table,
    true_false,
    vector,
    witness,
)
from quizgen.kinds.contract import AnswerKind

KINDS: dict[str, AnswerKind[Any]] = {
    module.KIND.name: module.KIND
    for module in (
        number, quantity, angle, point, sets, table, interval, expression, equation, complex_number,
        matrix, vector, choice, multi,
        true_false, match, order, gap, witness, derivation, code, program, rubric, sketch, checked,
    )
}  # fmt: skip
"""Name to kind, in the order of the manual."""

NUMERIC = frozenset(name for name, kind in KINDS.items() if issubclass(kind.spec, NumericSpec))
"""Kinds whose key is made of numbers."""
