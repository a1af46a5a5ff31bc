"""What a level makes of a variant: parts before they have a place in a paper."""

from __future__ import annotations

from fractions import Fraction
from typing import Protocol

import msgspec

from quizgen.bank.variant import Variant
from quizgen.grading.spec import AnySpec
from quizgen.kinds.contract import LINE, InputControl
from quizgen.kinds.work import Unit, sum_minutes
from quizgen.question.solution import PartSolution, Solution
from quizgen.typeset.prose import Block, Emphasis, Inline, Paragraph

ADDED_WORDS = 17
"""Words of a part that is put before an authored one, on average."""
WRITTEN = 25
"""Words that say which step is wrong, why, and what is right."""

Choice = tuple[str, tuple[Inline, ...]]
"""A mark (letter or number) and what stands beside it."""


class LevelPart(msgspec.Struct, frozen=True):
    """One part: what is said, how it is answered and marked, and its worked solution."""

    points: Fraction
    body: tuple[Block, ...]
    spec: AnySpec
    solved: PartSolution
    control: InputControl = LINE
    options: tuple[Choice, ...] = ()
    targets: tuple[Choice, ...] = ()
    near: str | None = None
    """The words around its field, if that stands inside a sentence or a cell."""
    shared: tuple[Block, ...] = ()
    """The text of the part before it that its field stands in, if it has none of its own."""

    @property
    def label(self) -> str:
        """Return its label within the question; empty where it is the only part."""
        return self.solved.label


class LevelQuestion(msgspec.Struct, frozen=True):
    """A whole question at a level; its parts and those of its solution belong together.

    ``minutes`` is None where the parts are those of the exam.
    """

    stem: tuple[Block, ...]
    parts: tuple[LevelPart, ...]
    solution: Solution
    minutes: Fraction | None = None


class Level(Protocol):
    """What a module of ``quizgen/question/levels`` offers."""

    def is_applicable(self, drawn: Variant) -> bool:
        """Return whether a variant has a form at this level."""

    def ask(self, drawn: Variant, lang: str) -> LevelQuestion:
        """Return a variant as a question in words at this level."""


def without_bold_questions(block: Block) -> Block:
    """Return a paragraph in plain type: its bold questions are not asked, but others instead."""
    if not isinstance(block, Paragraph):
        return block
    plain: list[Inline] = []
    for part in block.children:
        plain += part.children if isinstance(part, Emphasis) and part.style == "strong" else (part,)
    return Paragraph(tuple(plain))


def estimate_part_minutes(part: LevelPart, *, added: bool) -> Fraction:
    """Return the minutes of a part that a level makes: options to weigh, or a value to find.

    Parameters
    ----------
    part : LevelPart
    added : bool
        Whether it stands before an authored part, whose minutes have what both compute. Its words
        count as on average, so that a paper takes as long in every language.
    """
    work: dict[Unit, int | Fraction] = {"word read": ADDED_WORDS} if added else {"question": 1}
    if part.solved.scheme:
        work["word written"] = WRITTEN
    elif part.options:
        work["tick"] = Fraction(len(part.options), 2)
    else:
        work["cell"] = 1
    if not added:
        work["step"] = max(1, len(part.solved.lines))
    return sum_minutes(work)
