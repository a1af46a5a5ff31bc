"""The answer kinds: one module each, with a ``Spec`` that keeps to ``contract.Kind``.

In: the fields of a key, and a typed text. Out: a verdict, and the key as it is printed. Must never
know: the template and the draw that the key comes from, how a learner is asked.
"""

from __future__ import annotations

from quizgen.grading.kinds import (
    angle,
    choice,
    code,
    expression,
    gap,
    interval,
    match,
    number,
    order,
    point,
    quantity,
    sets,
    sketch,
    table,
    text,
    witness,
)
from quizgen.grading.spec import NumericSpec, WordSpec

KINDS: dict[str, type[WordSpec | NumericSpec]] = {
    "number": number.Spec,
    "quantity": quantity.Spec,
    "angle": angle.Spec,
    "point": point.Spec,
    "table": table.Spec,
    "set": sets.Spec,
    "interval": interval.Spec,
    "expression": expression.Spec,
    "choice": choice.Spec,
    "multi": choice.Spec,
    "tf": choice.Spec,
    "match": match.Spec,
    "order": order.Spec,
    "gap": gap.Spec,
    "witness": witness.Spec,
    "code": code.Spec,
    "text": text.Spec,
    "sketch": sketch.Spec,
}
"""Every kind and the shape of its specification."""
