"""Whether ``check.py`` judges its own examples as they say, and survives what makes no sense."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from quizgen.bank.variant import Variant
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.kinds.grade import grade_answer
from quizgen.question.part_context import VariantPart, ask_part

DRAWS = 20
"""Draws in which each example is judged."""
NONSENSE = ("?", "((((", "0/0", "qwertz uiop", "9" * 200, "x" * 5000)
"""Answers that earn nothing, whatever is asked, and that no check may fail at."""


def find_misjudged_examples(draws: Iterable[Variant]) -> Iterator[Diagnostic]:
    """Yield each example that is not judged as it says, once, and each failure of a check."""
    said = set[tuple[int, int]]()
    for one in list(draws)[:DRAWS]:
        for index, part in enumerate(one.template.rules.part):
            if not part.example:
                continue
            spec = ask_part(one, index).spec
            examples = [
                *VariantPart(one, index).examples(),
                *((text, Fraction(0)) for text in NONSENSE),
            ]
            for place, (typed, share) in enumerate(examples):
                verdict = grade_answer(spec, typed, lang=one.template.languages[0])
                fault = str(verdict.fields.get("fault", ""))
                if (index, place) in said or (not fault and verdict.credit == share):
                    continue
                said.add((index, place))
                earned = f"earns {verdict.credit} of the points, not {share}"
                found = f"cannot be judged: {fault}" if fault else earned
                what = f"seed {one.seed}: {typed[:60]!r} {found}"
                own = place < len(part.example)
                at = ("part", index, "example", place) if own else ("part", index, "answer")
                yield diagnose("QG221", one.template.file, what, at)
                if fault:
                    return  # one that takes too long does so for each answer of each draw
