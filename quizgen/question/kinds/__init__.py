"""The one table of answer kinds on the asking side: a module each, see ``QuestionKind``.

In: a draw and the authored ``answer`` of a part. Out: a ``Built``: the specification, how it is
answered, what each mistake would give. Must never know: an output, a paper.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from quizgen.bank.variant import Variant
from quizgen.question.contract import Built, QuestionKind
from quizgen.question.kinds import (
    angle,
    choice,
    code,
    expression,
    gap,
    interval,
    match,
    multi,
    number,
    order,
    point,
    quantity,
    sets,
    sketch,
    table,
    text,
    truth,
    witness,
)
from quizgen.question.specs import authored_answer, part_error

KINDS: dict[str, QuestionKind[Any]] = {
    "number": number,
    "quantity": quantity,
    "angle": angle,
    "point": point,
    "table": table,
    "set": sets,
    "interval": interval,
    "expression": expression,
    "choice": choice,
    "multi": multi,
    "tf": truth,
    "match": match,
    "order": order,
    "gap": gap,
    "witness": witness,
    "code": code,
    "text": text,
    "sketch": sketch,
}
"""Kind to the module in this folder."""


@lru_cache(maxsize=128)
def build(drawn: Variant, index: int) -> Built[Any]:
    """One part of a draw as its kind makes it, the same for every language.

    Raises
    ------
    BankError
        If its kind is unknown or its answer is not complete.
    """
    name = str(authored_answer(drawn, index).get("kind", ""))
    if name not in KINDS:
        allowed = ", ".join(sorted(KINDS))
        raise part_error(drawn, index, f"unknown kind {name!r} (allowed: {allowed})")
    try:
        return KINDS[name].build(drawn, index)
    except KeyError as error:
        raise part_error(drawn, index, f"answer: {error} is missing") from error
    except (TypeError, ValueError, AttributeError, ArithmeticError, IndexError) as error:
        raise part_error(drawn, index, f"answer: not of kind {name!r}: {error}") from error
