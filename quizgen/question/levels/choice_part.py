"""A choice made by a level: options, the right one, and a reason for each in every language."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from quizgen.bank.variant import Variant
from quizgen.grading.spec import decode_spec
from quizgen.kinds.asking import LETTERS
from quizgen.kinds.choice import ChoiceSpec
from quizgen.kinds.contract import InputControl
from quizgen.question.interpolation import inlines_as_typed, inlines_to_text
from quizgen.question.levels.contract import LevelPart
from quizgen.question.solution import PartSolution, SolutionStep, SolvedMisconception
from quizgen.typeset.prose import Block, Inline, PlainText, to_inlines

Sentence = Callable[[str], tuple[Inline, ...]]
"""A sentence by language."""


@dataclass(frozen=True, slots=True)
class LevelOption:
    """One option: its wording, whether it is right, why, and what it is called."""

    said: Sentence
    right: bool
    why: Sentence
    name: str = ""


def make_choice_part(
    drawn: Variant, lang: str, body: tuple[Block, ...], options: Sequence[LevelOption],
    lines: tuple[SolutionStep, ...] = (),
) -> LevelPart:  # fmt: skip
    """Return a part with lettered options, exactly one of which is right.

    Parameters
    ----------
    drawn : Variant
    lang : str
    body : tuple of blocks
        What is asked.
    options : sequence of LevelOption
        In the order in which they are shown.
    lines : tuple of SolutionStep
        The worked lines of its solution.
    """
    marked = dict(zip(LETTERS, options, strict=False))
    right, told = next((mark, option) for mark, option in marked.items() if option.right)
    solved = PartSolution(
        label="",
        lines=lines,
        shown=to_inlines(right),
        mistakes=(),
        options=((*told.said(lang), PlainText(": "), *told.why(lang)),),
        reasons=tuple(
            SolvedMisconception(option.name or mark, option.why(lang), (PlainText(mark),))
            for mark, option in marked.items() if not option.right
        ),
    )  # fmt: skip
    shown = tuple((mark, option.said(lang)) for mark, option in marked.items())
    spec = _build_choice_spec(drawn.template.languages, marked)
    return LevelPart(Fraction(1), body, spec, solved, InputControl("one", lines=0), shown)


def _build_choice_spec(langs: Sequence[str], marked: Mapping[str, LevelOption]) -> ChoiceSpec:
    """Return what the choice is graded by; its wordings are those of the first language."""
    table = {
        "kind": "choice",
        "options": [inlines_as_typed(option.said(langs[0])) for option in marked.values()],
        "correct": [place for place, option in enumerate(marked.values(), 1) if option.right],
        "why": {
            lang: {m: inlines_to_text(o.why(lang)) for m, o in marked.items()} for lang in langs
        },
    }
    return decode_spec(ChoiceSpec, table)
