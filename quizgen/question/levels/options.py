"""A choice made by a level: options, the right one, and a reason for each in every language."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Block, Inline, Words
from quizgen.marking.kinds.choice import LETTERS, Spec
from quizgen.marking.specs import decode
from quizgen.question.contract import Control
from quizgen.question.filling import as_typed, plain
from quizgen.question.levels.asking import Asked
from quizgen.question.shown import pieces
from quizgen.question.solution import Line, Mistake, PartSolution

Sentence = Callable[[str], tuple[Inline, ...]]
"""A sentence by language."""


@dataclass(frozen=True, slots=True)
class Option:
    """One option: its wording, whether it is right, why, and what it is called."""

    said: Sentence
    right: bool
    why: Sentence
    name: str = ""


def choice(
    drawn: Draw, lang: str, body: tuple[Block, ...], options: Sequence[Option],
    lines: tuple[Line, ...] = (),
) -> Asked:  # fmt: skip
    """One part with lettered options, exactly one of which is right.

    Parameters
    ----------
    drawn : Draw
    lang : str
    body : tuple of blocks
        What is asked.
    options : sequence of Option
        In the order in which they are shown.
    lines : tuple of Line
        The worked lines of its solution.
    """
    marked = dict(zip(LETTERS, options, strict=False))
    right, told = next((mark, option) for mark, option in marked.items() if option.right)
    solved = PartSolution(
        label="",
        lines=lines,
        shown=pieces(right),
        mistakes=(),
        options=((*told.said(lang), Words(": "), *told.why(lang)),),
        reasons=tuple(
            Mistake(option.name or mark, option.why(lang), (Words(mark),))
            for mark, option in marked.items() if not option.right
        ),
    )  # fmt: skip
    shown = tuple((mark, option.said(lang)) for mark, option in marked.items())
    spec = _spec(drawn.template.languages, marked)
    return Asked(Fraction(1), body, spec, solved, Control("one", lines=0), shown)


def _spec(langs: Sequence[str], marked: Mapping[str, Option]) -> Spec:
    """What the choice is marked by; its wordings are those of the first language."""
    table = {
        "kind": "choice",
        "options": [as_typed(option.said(langs[0])) for option in marked.values()],
        "correct": [place for place, option in enumerate(marked.values(), 1) if option.right],
        "why": {lang: {m: plain(o.why(lang)) for m, o in marked.items()} for lang in langs},
    }
    return decode(Spec, table)
