"""The minutes that a question takes: one model for papers, plans and lists.

Words are read, steps of the chain are computed, and each kind of answer says what is written,
drawn or ticked (``quizgen.kinds.work``, which has the table).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from quizgen.bank.rules import PART_LABELS, Rules
from quizgen.kinds import KINDS
from quizgen.kinds.choice import has_value_options
from quizgen.kinds.contract import asked_quantities
from quizgen.kinds.work import sum_minutes
from quizgen.maths.chain import Chain
from quizgen.maths.numbers import parse_written_number
from quizgen.maths.tree import Call

PLACES = 10
"""Minutes are told in tenths."""
_SECTION = re.compile(r"^## +(\S+)", re.MULTILINE)
_MODEL = re.compile(r"^- ([a-j])(?: \[[^\]\n]*\])?:(.*)$", re.MULTILINE)
_WORD = re.compile(r"\w+(?:['.,/^_-]\w+)*")


def working_minutes(rules: Rules, chain: Chain, page: str) -> Fraction:
    """Return the minutes that a template takes, in tenths: what its rules say, else the estimate.

    Parameters
    ----------
    rules : Rules
    chain : Chain
        Of its solver; an empty one where it has none.
    page : str
        Text of its first language file.
    """
    if rules.minutes:
        return Fraction(rules.minutes)
    title, *pieces = _SECTION.split(page)
    sections = dict(zip(pieces[::2], pieces[1::2], strict=True))
    labels = PART_LABELS[: len(rules.part)]
    read = [title, *(sections.get(label, "") for label in labels)]
    written = _count_model_words(sections.get("model", ""))
    minutes = sum_minutes({"question": 1, "word read": sum(map(_count_words, read))})
    done: set[str] = set()
    for label, part in zip(labels, rules.part, strict=True):
        kind = KINDS[part.answer["kind"]]
        points = parse_written_number(part.points)
        minutes += sum_minutes(kind.work(part.answer, points, written.get(label, 0)))
        if kind.verb == "compute" or has_value_options(part.answer):
            minutes += sum_minutes({"step": _count_new_steps(part.answer, chain, done)})
    return Fraction(round(minutes * PLACES), PLACES)


def _count_words(text: str) -> int:
    """Return the words of a text; a formula has as many as names and numbers."""
    return len(_WORD.findall(text))


def _count_model_words(section: str) -> dict[str, int]:
    """Return the words of the model answer of each part; of several the longest.

    What stands in brackets is a remark on it.
    """
    found: dict[str, int] = {}
    for label, text in _MODEL.findall(section):
        words = _count_words(re.sub(r"\([^)]*\)", "", text))
        found[label] = max(words, found.get(label, 0))
    return found


def _count_new_steps(answer: Mapping[str, Any], chain: Chain, done: set[str]) -> int:
    """Return the steps that compute something and that no earlier part needed; add them."""
    needed = {
        step
        for name in asked_quantities(answer)
        if name in chain.by_name
        for step in chain.required_steps(name)
    } - done
    done |= needed
    computed = (chain.by_name[name].expr for name in needed)
    return sum(isinstance(expr, Call) and bool(expr.args) for expr in computed)
