"""How long a question takes, by what is to be done: the scale that points and minutes stand on.

A point is about a minute. The estimate is coarse; it is there to notice a question that is worth
twice or half of what its like is worth.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from quizgen.bank.rules import suggested_minutes, total_points
from quizgen.bank.sampler import sampler_for
from quizgen.bank.template import Template
from quizgen.maths.tree import Call, Expr

READING = 0.5
"""Minutes for the stem and the figure."""
PART, OPERATION = 0.5, 0.3
"""Minutes for writing down a calculation, and for each operation of a step not done before."""
ENTRY = {"choice": 0.15, "multi": 0.4, "match": 0.3, "order": 0.5, "gap": 0.4, "text": 0.75,
         "sketch": 1.0}  # fmt: skip
"""Minutes for each option, pair, step, gap, key point or feature that is shown or asked."""
LISTED = {"choice": "options", "multi": "options", "match": "pairs", "order": "steps",
          "gap": "gaps", "text": "points", "sketch": "features"}  # fmt: skip
WHOLE = {"tf": 0.5, "code": 1.5, "witness": 3.0, "expression": 2.0}
"""Minutes for a part that has no entries."""
FAR = 2.0
"""Factor by which points or minutes are far from the estimate."""


def estimate_minutes(template: Template) -> float:
    """Minutes that a template takes by its operations, options and key points."""
    done: set[str] = set()
    parts = (
        _estimate_part_minutes(template, index, done) for index in range(len(template.rules.part))
    )
    return READING + sum(parts)


def _estimate_part_minutes(template: Template, index: int, done: set[str]) -> float:
    answer: dict[str, Any] = template.rules.part[index].answer
    kind = answer["kind"]
    if kind in WHOLE:
        return WHOLE[kind]
    if kind in ENTRY:
        return PART + ENTRY[kind] * answer.get("take", len(answer[LISTED[kind]]))
    steps = [step for step in sampler_for(template).parts[index].steps if step.name not in done]
    done.update(step.name for step in steps)
    return PART + OPERATION * sum(_count_operations(step.expr) for step in steps)


def _count_operations(expr: Expr) -> int:
    """Operations of a formula; of several cases only the longest is computed."""
    if not isinstance(expr, Call) or not expr.args:
        return 0
    if expr.op == "piecewise":
        return 1 + max(map(_count_operations, expr.args[::2]))
    return max(1, len(expr.args) - 1) + sum(map(_count_operations, expr.args))


def check_workload(template: Template) -> Iterator[str]:
    """What of a template's points and minutes is far from the estimate."""
    minutes = estimate_minutes(template)
    given = (
        ("points", float(total_points(template.rules))),
        ("minutes", suggested_minutes(template.rules)),
    )
    for name, value in given:
        if not minutes / FAR <= value <= minutes * FAR:
            yield f"{value:g} {name}, where its operations take about {minutes:.1f} minutes"
