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

from quizgen.bank.markdown import Block, Emphasis, ListBlock, Paragraph, PlainText
from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.core.shares import share_points
from quizgen.kinds import NUMERIC
from quizgen.locale import translate
from quizgen.question.interpolation import Interpolator
from quizgen.question.levels import exam
from quizgen.question.levels.comparison import choose_comparison
from quizgen.question.levels.consequence import choose_consequence
from quizgen.question.levels.contract import (
    LevelPart,
    LevelQuestion,
    without_bold_questions,
)
from quizgen.question.levels.error_spotting import choose_faulty_solution
from quizgen.question.levels.perturbations import Perturbations
from quizgen.question.levels.steps import level_seed, part_labels

SMALL, MIDDLE = 1, 3
"""Points up to which one part is asked, and two."""

Maker = Callable[[str], LevelPart]
"""Puts one part into words of a language."""


def is_applicable(drawn: Variant) -> bool:
    """Return whether something can be asked about changes or mistakes."""
    if "transfer" not in drawn.template.rules.levels or not drawn.template.chain.steps:
        return False
    return bool(_list_part_builders(drawn))


@lru_cache(maxsize=128)
def _list_part_builders(drawn: Variant) -> tuple[Maker, ...]:
    """Return the builders of the parts that can be asked of this variant, in order."""
    changes = Perturbations(drawn)
    asked = choose_consequence(changes)
    makers = (asked, choose_comparison(changes, asked), choose_faulty_solution(drawn))
    return tuple(maker for maker in makers if maker is not None)


def ask(drawn: Variant, lang: str) -> LevelQuestion:
    """Return the task without its questions, and what is asked about it."""
    usual = exam.ask(drawn, lang)
    total = sum((part.points for part in usual.parts), Fraction(0))
    makers = _list_part_builders(drawn)
    count = 1 if total <= SMALL else 2 if total <= MIDDLE else 3
    kept = sorted(shuffle(f"{level_seed(drawn)}/forms", range(len(makers)))[:count])
    worth = share_points(total, [Fraction(1)] * len(kept))
    parts = tuple(
        _relabel_part(makers[place](lang), label, points)
        for place, label, points in zip(kept, part_labels(drawn, len(kept)), worth, strict=True)
    )
    solution = replace(
        usual.solution, parts=tuple(part.solved for part in parts),
        check=(), note=(), why=(), precision=(),
    )  # fmt: skip
    return LevelQuestion((*_iter_task_blocks(drawn, lang, usual),), parts, solution)


def _relabel_part(part: LevelPart, label: str, points: Fraction) -> LevelPart:
    """Return a part with another label and other marks."""
    return replace(part, points=points, solved=replace(part.solved, label=label))


def _iter_task_blocks(drawn: Variant, lang: str, usual: LevelQuestion) -> Iterator[Block]:
    """Yield the task as the exam asks it, with what its calculating parts say."""
    yield Paragraph((Emphasis("em", (PlainText(translate(lang, "transfer.about")),)),))
    yield from map(
        without_bold_questions,
        Interpolator(drawn, lang, hidden=True).blocks(drawn.template.texts[lang].stem),
    )
    kinds = [part.answer["kind"] for part in drawn.template.rules.part]
    bodies = [
        tuple(map(without_bold_questions, part.body))
        for part, kind in zip(usual.parts, kinds, strict=True)
        if kind in NUMERIC and part.body
    ]
    if bodies:
        yield ListBlock(tuple(bodies))
