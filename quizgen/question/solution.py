"""The worked solution of a draw in one language: answers, steps with their why, mistakes, remarks.

The steps come from the solver's chain; the language files add one sentence of why per step.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any

import msgspec

from quizgen.bank.draw import Draw
from quizgen.bank.prose import Block, Inline, Words
from quizgen.figures import FieldPicture
from quizgen.marking.mark import show
from quizgen.marking.specs import AnySpec, Numbers, OneNumber
from quizgen.maths.chain import ChainStep
from quizgen.question.contract import Built
from quizgen.question.filling import NBSP, Filler, plain
from quizgen.question.kinds import KINDS
from quizgen.question.precision import precision_table
from quizgen.question.shown import Maths, Shown, pieces
from quizgen.question.specs import written_down
from quizgen.question.worked import FORMULA, Side, in_line, sides_of, thing


def as_text(shown: tuple[Inline, ...]) -> str:
    """Pieces as text with ordinary blanks before units."""
    return plain(shown).replace(NBSP, " ")


class Rung(msgspec.Struct, frozen=True):
    """A hint: what it is, and what it shows.

    ``kind`` is ``quantity`` (which one is needed, and why), ``formula`` (with its number on the
    formula sheet), ``numbers``, ``result``, or ``why`` where nothing else is known of the step.
    """

    kind: str
    shown: tuple[Inline, ...]
    why: tuple[Inline, ...] = ()
    formula: str = ""


class Line(msgspec.Struct, frozen=True):
    """One step: the worked formula, why it is taken, and its number on the formula sheet.

    ``name``, ``thing`` and ``sides`` are its quantity, in words, and what it is equal to.
    """

    maths: Maths
    why: tuple[Inline, ...]
    formula: str = ""
    name: str = ""
    thing: tuple[Inline, ...] = ()
    sides: tuple[Side, ...] = ()

    @property
    def rungs(self) -> tuple[Rung, ...]:
        """What a learner may be told of it, little by little."""
        if not self.sides:
            return (Rung("why", self.why),)
        found = [Rung("quantity", self.thing, self.why)]
        for role, sides in groupby(self.sides, key=lambda side: side.role):
            formula = self.formula if role == FORMULA else ""
            shown = msgspec.structs.replace(in_line(self.name, tuple(sides)), lang=self.maths.lang)
            found.append(Rung(role, (shown,), formula=formula))
        return tuple(found)


class Mistake(msgspec.Struct, frozen=True):
    """A known mistake: its name, what went wrong, and the answer it would give.

    Of one that is drawn no answer is shown: its points would tell nobody what it looks like.
    """

    name: str
    sentence: tuple[Inline, ...]
    shown: tuple[Inline, ...]

    @property
    def value(self) -> str:
        """The answer that it gives, as text."""
        return as_text(self.shown)


class PartSolution(msgspec.Struct, frozen=True):
    """The worked solution of one part.

    ``options`` tells the right answer in words, ``reasons`` why each other choice is wrong,
    ``why`` what else explains the answer, ``drawing`` the answer if it is drawn.
    """

    label: str
    lines: tuple[Line, ...]
    shown: tuple[Inline, ...]
    mistakes: tuple[Mistake, ...]
    options: tuple[tuple[Inline, ...], ...] = ()
    reasons: tuple[Mistake, ...] = ()
    why: tuple[Inline, ...] = ()
    drawing: FieldPicture | None = None

    @property
    def answer(self) -> str:
        """The key as text, as it can be typed back; empty where sentences tell it."""
        return as_text(self.shown)


class Solution(msgspec.Struct, frozen=True):
    """The worked solution of a question in one language."""

    lang: str
    title: str
    parts: tuple[PartSolution, ...]
    check: tuple[Block, ...]
    note: tuple[Block, ...]
    why: tuple[Block, ...] = ()
    precision: tuple[Block, ...] = ()


def solve(drawn: Draw, lang: str, parts: tuple[PartSolution, ...]) -> Solution:
    """The solved parts of an instance with the remarks on the whole, in one language."""
    filler = Filler(drawn, lang)
    return Solution(
        lang=lang,
        title=filler.text.title,
        parts=parts,
        check=filler.section("check"),
        note=filler.section("note"),
        precision=precision_table(drawn, lang),
        why=filler.section("why"),
    )


def solved_part(filler: Filler, index: int, built: Built[Any]) -> PartSolution:
    """Work one authored part out.

    Parameters
    ----------
    filler : Filler
    index : int
    built : Built
        The part as its kind makes it.
    """
    drawn, spec, board = filler.drawn, built.spec, built.control.board
    label = drawn.template.labels[index]
    explained = filler.text.sentence("why", label or "a") is not None
    return PartSolution(
        label=label,
        lines=tuple(line_of(filler, step) for step in drawn.steps(index)),
        shown=pieces(KINDS[spec.kind].printed(spec, filler.lang)),
        mistakes=tuple(mistakes_of(filler, built)),
        options=tuple(
            (*_right(filler, section, name), *_cited(built.source)) for section, name in built.right
        ),
        reasons=tuple(_reasons(filler, built)),
        why=filler.sentence("why", label or "a") if explained else (),
        drawing=FieldPicture(board, filler.lang, built.drawn) if board else None,
    )


def line_of(filler: Filler, step: ChainStep) -> Line:
    """A step of the chain as the solution shows it."""
    formula = filler.drawn.template.chain.formulas.get(step.name, "")
    sides = sides_of(filler.drawn, step)
    return Line(
        in_line(step.name, sides),
        filler.sentence("steps", step.name),
        formula,
        step.name,
        thing(filler.drawn, step.name, filler.lang),
        sides,
    )


def mistakes_of(filler: Filler, built: Built[Any]) -> Iterator[Mistake]:
    """The known mistakes of a part with the answers that they give."""
    for trap, wrong in built.mistakes.items():
        spec = written_down(wrong, built.spec.traps[trap])
        shown = () if built.drawn else pieces(_rounded(spec, filler.lang))
        yield Mistake(trap, filler.sentence("traps", trap), shown)


def _rounded(wrong: AnySpec, lang: str) -> Shown:
    """A wrong answer; of numbers nobody wants to see the exact value."""
    if isinstance(wrong, OneNumber | Numbers):
        return show(wrong, lang)
    return KINDS[wrong.kind].printed(wrong, lang)


def _reasons(filler: Filler, built: Built[Any]) -> Iterator[Mistake]:
    """Wrong options, pairs and steps with the reason."""
    right = {name for _, name in built.right}
    for mark, name in built.reasons:
        if name not in right:
            yield Mistake(name, filler.sentence("reasons", name), (Words(mark),))


def _cited(source: str) -> tuple[Inline, ...]:
    return (Words(f" [{source}]"),) if source else ()


def _right(filler: Filler, section: str, name: str) -> tuple[Inline, ...]:
    """A right option, and why it is right if that is written."""
    told = filler.sentence(section, name)
    if section == "options" and filler.text.sentence("reasons", name) is not None:
        return (*_unstopped(told), Words(": "), *filler.sentence("reasons", name))
    return told


def _unstopped(told: tuple[Inline, ...]) -> tuple[Inline, ...]:
    """A sentence that goes on after a colon has no full stop before it."""
    *most, last = told
    return (*most, Words(last.text.rstrip(".।"))) if isinstance(last, Words) else told
