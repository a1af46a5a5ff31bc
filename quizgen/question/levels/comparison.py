"""Which of two changes moves a result further? Both results are computed exactly."""

from __future__ import annotations

from dataclasses import dataclass

from quizgen.bank.sampler import pick_index, shuffle
from quizgen.maths.precision import working_precision
from quizgen.question.levels.choice_part import LevelOption, make_choice_part
from quizgen.question.levels.consequence import Consequence, value_inlines
from quizgen.question.levels.contract import LevelPart
from quizgen.question.levels.perturbations import (
    SCALES,
    Perturbation,
    Perturbations,
    askable_results,
    change_size,
    is_clearly_more,
)
from quizgen.question.levels.steps import level_seed
from quizgen.question.worked_steps import quantity_inlines
from quizgen.typeset.prose import Emphasis, Inline, ListBlock, Paragraph, translate_inlines

ANSWERS = ("first", "second", "equal")


@dataclass(frozen=True)
class PerturbationPair:
    """Two changes that one result depends on, and the answer."""

    first: Perturbation
    second: Perturbation
    answer: str

    def __call__(self, lang: str) -> LevelPart:
        """Return the part in a language."""
        drawn, target = self.first.drawn, self.first.target

        def because(each: str) -> tuple[Inline, ...]:
            """Return the results of both changes, in a language."""
            return translate_inlines(
                each, "transfer.two_results",
                target=quantity_inlines(drawn, target, each),
                before=value_inlines(drawn, target),
                first=value_inlines(self.first.changed, target),
                second=value_inlines(self.second.changed, target),
            )  # fmt: skip

        def option(name: str) -> LevelOption:
            """Return the option of this name, and whether it is right."""
            wording = f"transfer.{name}"
            return LevelOption(
                lambda each: translate_inlines(each, wording), name == self.answer, because, name
            )

        intro = Paragraph(translate_inlines(lang, "transfer.compare_said"))
        changes = ListBlock(
            tuple((Paragraph(change.describe(lang)),) for change in (self.first, self.second)),
            ordered=True,
        )
        asked = translate_inlines(
            lang, "transfer.compare", target=quantity_inlines(drawn, target, lang)
        )
        body = (intro, changes, Paragraph((Emphasis("strong", asked),)))
        return make_choice_part(drawn, lang, body, [option(name) for name in ANSWERS])


def choose_comparison(changes: Perturbations, asked: Consequence | None) -> PerturbationPair | None:
    """Return two changes of one result with a clear answer; None if there are none.

    A change whose effect has been asked is not used again.
    """
    drawn = changes.drawn
    wanted = ANSWERS[pick_index(f"{level_seed(drawn)}/compare", len(ANSWERS))]
    spare: PerturbationPair | None = None
    for index, target in shuffle(f"{level_seed(drawn)}/compare", list(askable_results(drawn))):
        usable = [
            change
            for change in changes.of(index, target)
            if change.scale in SCALES and not _is_same_perturbation(change, asked)
        ]
        for place, first in enumerate(usable):
            for second in usable[place + 1 :]:
                pair = _build_decidable_pair(first, second)
                if pair is not None and pair.answer == wanted:
                    return pair
                spare = spare or pair
    return spare


def _is_same_perturbation(change: Perturbation, asked: Consequence | None) -> bool:
    """Return whether another part asks about this change; nothing is asked twice."""
    return asked is not None and (change.target, change.given, change.scale) == (
        asked.change.target, asked.change.given, asked.change.scale
    )  # fmt: skip


def _build_decidable_pair(first: Perturbation, second: Perturbation) -> PerturbationPair | None:
    """Return the pair with its answer; None where only precise numbers could tell.

    Two factors of one quantity are no comparison.
    """
    if first.given == second.given:
        return None
    one, two = change_size(first), change_size(second)
    with working_precision():
        if one == two and one != 0:
            return PerturbationPair(first, second, "equal")
    if is_clearly_more(one, two):
        return PerturbationPair(first, second, "first")
    return PerturbationPair(first, second, "second") if is_clearly_more(two, one) else None
