"""The task turned round: what a change does, which of two does more, where a solution goes wrong.

All of it comes from the chain: results after a change are computed exactly, a factor is asked only
where the formulas prove that it is the same for all numbers, and a wrong solution is what a known
mistake makes of the steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import lru_cache

from msgspec.structs import replace

from quizgen.bank.draw import Draw
from quizgen.bank.plan import shuffled
from quizgen.bank.prose import Block, Items, Paragraph, Styled, Words
from quizgen.locale import word
from quizgen.question.filling import Filler
from quizgen.question.levels import exam
from quizgen.question.levels.asking import Asked, Asking, quiet, shared_out
from quizgen.question.levels.changes import Changes
from quizgen.question.levels.comparing import compared
from quizgen.question.levels.effects import effect
from quizgen.question.levels.guided import NUMERIC
from quizgen.question.levels.mistaken import found_mistake
from quizgen.question.levels.steps import key_of, labels

SMALL, MIDDLE = 1, 3
"""Points up to which one part is asked, and two."""

Maker = Callable[[str], Asked]
"""Puts one part into words of a language."""


def fits(drawn: Draw) -> bool:
    """Whether something can be asked about changes or mistakes."""
    if "transfer" not in drawn.template.rules.levels or not drawn.template.chain.steps:
        return False
    return bool(_makers(drawn))


@lru_cache(maxsize=128)
def _makers(drawn: Draw) -> tuple[Maker, ...]:
    """What can be asked in this draw, in the order in which it is asked."""
    changes = Changes(drawn)
    asked = effect(changes)
    makers = (asked, compared(changes, asked), found_mistake(drawn))
    return tuple(maker for maker in makers if maker is not None)


def asking(drawn: Draw, lang: str) -> Asking:
    """The task, and what is asked about it."""
    usual = exam.asking(drawn, lang)
    total = sum((part.points for part in usual.parts), Fraction(0))
    makers = _makers(drawn)
    count = 1 if total <= SMALL else 2 if total <= MIDDLE else 3
    kept = sorted(shuffled(f"{key_of(drawn)}/forms", range(len(makers)))[:count])
    worth = shared_out(total, [Fraction(1)] * len(kept))
    parts = tuple(
        _placed(makers[place](lang), label, points)
        for place, label, points in zip(kept, labels(drawn, len(kept)), worth, strict=True)
    )
    solution = replace(
        usual.solution, parts=tuple(part.solved for part in parts),
        check=(), note=(), why=(), precision=(),
    )  # fmt: skip
    return Asking((*_task(drawn, lang, usual),), parts, solution)


def _placed(part: Asked, label: str, points: Fraction) -> Asked:
    return replace(part, points=points, solved=replace(part.solved, label=label))


def _task(drawn: Draw, lang: str, usual: Asking) -> Iterator[Block]:
    """The task as the exam asks it, with what its calculating parts say."""
    yield Paragraph((Styled("em", (Words(word(lang, "transfer.about")),)),))
    yield from map(quiet, Filler(drawn, lang, hidden=True).blocks(drawn.template.texts[lang].stem))
    kinds = [part.answer["kind"] for part in drawn.template.rules.part]
    bodies = [
        tuple(map(quiet, part.body)) for part, kind in zip(usual.parts, kinds, strict=True)
        if kind in NUMERIC and part.body
    ]  # fmt: skip
    if bodies:
        yield Items(tuple(bodies))
