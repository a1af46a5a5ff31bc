"""Which of two changes moves a result further? Both results are computed exactly."""

from __future__ import annotations

from dataclasses import dataclass

from quizgen.bank.plan import pick, shuffled
from quizgen.bank.prose import Inline, Items, Paragraph, Styled
from quizgen.maths.precision import working_precision
from quizgen.question.levels.asking import Asked
from quizgen.question.levels.changes import SCALES, Change, Changes, clearly_more, distance, targets
from quizgen.question.levels.effects import Effect, shown_value
from quizgen.question.levels.options import Option, choice
from quizgen.question.levels.steps import key_of
from quizgen.question.shown import said
from quizgen.question.worked import thing

ANSWERS = ("first", "second", "equal")


@dataclass(frozen=True)
class Pair:
    """Two changes of which one result depends, and the answer."""

    first: Change
    second: Change
    answer: str

    def __call__(self, lang: str) -> Asked:
        """The part in a language."""
        drawn, target = self.first.drawn, self.first.target

        def because(each: str) -> tuple[Inline, ...]:
            return said(
                each, "transfer.two_results",
                target=thing(drawn, target, each),
                before=shown_value(drawn, target),
                first=shown_value(self.first.changed, target),
                second=shown_value(self.second.changed, target),
            )  # fmt: skip

        def option(name: str) -> Option:
            wording = f"transfer.{name}"
            return Option(lambda each: said(each, wording), name == self.answer, because, name)

        intro = Paragraph(said(lang, "transfer.compare_said"))
        changes = Items(
            tuple((Paragraph(change.said(lang)),) for change in (self.first, self.second)),
            ordered=True,
        )
        asked = said(lang, "transfer.compare", target=thing(drawn, target, lang))
        body = (intro, changes, Paragraph((Styled("strong", asked),)))
        return choice(drawn, lang, body, [option(name) for name in ANSWERS])


def compared(changes: Changes, asked: Effect | None) -> Pair | None:
    """Two changes of one result with a clear answer; None if there are none.

    A change whose effect has been asked is not used again.
    """
    drawn = changes.drawn
    wanted = ANSWERS[pick(f"{key_of(drawn)}/compare", len(ANSWERS))]
    spare: Pair | None = None
    for index, target in shuffled(f"{key_of(drawn)}/compare", list(targets(drawn))):
        usable = [
            change
            for change in changes.of(index, target)
            if change.scale in SCALES and not _same(change, asked)
        ]
        for place, first in enumerate(usable):
            for second in usable[place + 1 :]:
                pair = _judged(first, second)
                if pair is not None and pair.answer == wanted:
                    return pair
                spare = spare or pair
    return spare


def _same(change: Change, asked: Effect | None) -> bool:
    return asked is not None and (change.target, change.given, change.scale) == (
        asked.change.target, asked.change.given, asked.change.scale
    )  # fmt: skip


def _judged(first: Change, second: Change) -> Pair | None:
    """The pair with its answer; None where nobody could tell without precise numbers.

    Two factors of one quantity are no comparison, but for one that grows and one that shrinks.
    """
    if first.given == second.given and (first.scale > 1) == (second.scale > 1):
        return None
    one, two = distance(first), distance(second)
    with working_precision():
        if one == two and one != 0:
            return Pair(first, second, "equal")
    if clearly_more(one, two):
        return Pair(first, second, "first")
    return Pair(first, second, "second") if clearly_more(two, one) else None
