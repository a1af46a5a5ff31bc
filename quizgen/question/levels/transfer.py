"""The task turned round: what a change does, what brings it about, where a solution goes wrong.

All of it comes from the chain: results after a change are computed exactly, a factor is asked only
where the formulas prove that it is the same for all numbers, and a wrong solution is what a known
mistake makes of the steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import lru_cache

from msgspec.structs import replace

from quizgen.bank.sampler import pick_index, shuffle
from quizgen.bank.variant import Variant
from quizgen.core.shares import share_points
from quizgen.kinds import NUMERIC
from quizgen.kinds.rubric import RubricSpec
from quizgen.locale import translate
from quizgen.question.interpolation import Interpolator
from quizgen.question.levels import exam
from quizgen.question.levels.comparison import choose_comparison
from quizgen.question.levels.consequence import choose_consequence, choose_way_back
from quizgen.question.levels.contract import (
    LevelPart,
    LevelQuestion,
    estimate_part_minutes,
    without_bold_questions,
)
from quizgen.question.levels.error_spotting import choose_faulty_solution
from quizgen.question.levels.limit import choose_limit
from quizgen.question.levels.perturbations import Perturbations
from quizgen.question.levels.steps import level_seed, part_labels
from quizgen.typeset.prose import Block, Emphasis, ListBlock, Paragraph, PlainText

READ_TASK = Fraction(1)
"""Minutes for reading the task, in which nothing is asked."""
COMPUTED = 3
"""Points of what is computed to those of what is ticked, of which there is one beside it."""
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
    written = bool(pick_index(f"{level_seed(drawn)}/written", 2))
    makers = (
        asked,
        choose_way_back(changes, asked),
        choose_limit(changes, asked),
        choose_comparison(changes, asked),
        choose_faulty_solution(drawn, written=written),
    )
    return tuple(maker for maker in makers if maker is not None)


def ask(drawn: Variant, lang: str) -> LevelQuestion:
    """Return the task without its questions, and what is asked about it."""
    usual = exam.ask(drawn, lang)
    total = sum((part.points for part in usual.parts), Fraction(0))
    makers = _list_part_builders(drawn)
    count = 1 if total <= SMALL else 2 if total <= MIDDLE else 3
    made = [maker(lang) for maker in makers]
    order = shuffle(f"{level_seed(drawn)}/forms", range(len(made)))
    computed = [place for place in order if not made[place].options]
    ticked = [place for place in order if made[place].options]
    kept = [*computed, *(ticked[:1] if computed else ticked)][:count]
    while len(kept) > min(count, 2) and _count_minutes(made, kept) > drawn.template.minutes:
        kept.pop()  # no longer than the task itself, or a paper would not fit its time
    kept.sort()
    weights = [Fraction(1 if made[place].options else COMPUTED) for place in kept]
    parts = tuple(
        _relabel_part(made[place], label, points)
        for place, label, points in zip(
            kept, part_labels(drawn, len(kept)), share_points(total, weights), strict=True
        )
    )
    solution = replace(
        usual.solution, parts=tuple(part.solved for part in parts),
        check=(), note=(), why=(), precision=(),
    )  # fmt: skip
    stem = (*_iter_task_blocks(drawn, lang, usual),)
    return LevelQuestion(stem, parts, solution, _count_minutes(made, kept))


def _count_minutes(made: list[LevelPart], kept: Iterable[int]) -> Fraction:
    """Return the minutes for reading the task and answering the parts at some places."""
    return sum((estimate_part_minutes(made[place], added=False) for place in kept), READ_TASK)


def _relabel_part(part: LevelPart, label: str, points: Fraction) -> LevelPart:
    """Return a part with another label and other marks."""
    spec, solved = part.spec, replace(part.solved, label=label)
    if isinstance(spec, RubricSpec):
        worth = dict(
            zip(
                spec.criteria, share_points(points, [Fraction(1)] * len(spec.criteria)), strict=True
            )
        )
        criteria = {
            name: replace(one, points=str(worth[name])) for name, one in spec.criteria.items()
        }
        spec = replace(spec, full=str(points), criteria=criteria)
        lines = (line._replace(points=worth[line.name]) for line in solved.scheme)
        solved = replace(solved, scheme=tuple(lines))
    return replace(part, points=points, spec=spec, solved=solved)


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
