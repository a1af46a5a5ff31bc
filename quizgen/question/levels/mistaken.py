"""A worked solution that somebody else made, with one of the known mistakes in it or with none."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from quizgen.bank.draw import Draw, digits
from quizgen.bank.plan import shuffled
from quizgen.bank.prose import Block, Inline, Items, Paragraph, Styled, Words
from quizgen.bank.traps import answer_names
from quizgen.errors import MathError
from quizgen.maths.chain import ChainStep
from quizgen.maths.numbers import rounded_text
from quizgen.question.filling import Filler
from quizgen.question.levels.asking import Asked
from quizgen.question.levels.changes import needed
from quizgen.question.levels.guided import NUMERIC
from quizgen.question.levels.options import Option, choice
from quizgen.question.levels.steps import (
    flat,
    has_name,
    key_of,
    only_units,
    same_value,
    tells,
    told,
)
from quizgen.question.shown import said
from quizgen.question.solution import line_of
from quizgen.question.worked import thing, worked

FEWEST, MOST = 2, 8
"""Steps of a solution in which a mistake is looked for."""


@dataclass(frozen=True)
class Wrong:
    """A solution: its steps, the mistake in it (or none) and the place of its first wrong step."""

    drawn: Draw
    steps: tuple[ChainStep, ...]
    trap: str = ""
    place: int = -1

    def __call__(self, lang: str) -> Asked:
        """The part in a language."""
        shown = self._shown()
        rows = tuple(self._row(shown, step, lang) for step in self._written())
        intro = Paragraph(said(lang, "transfer.mistake_said"))
        asked = Paragraph((Styled("strong", said(lang, "transfer.mistake")),))
        options = [self._option(place) for place in range(len(self.steps))]
        none = Option(
            lambda each: said(each, "transfer.none"), not self.trap, self._about_none, "none"
        )
        right = Filler(self.drawn, lang)
        lines = (line_of(right, self.steps[self.place]),) if self.trap else ()
        body = (intro, Items(rows, ordered=True), asked)
        return choice(self.drawn, lang, body, [*options, none], lines)

    def _shown(self) -> Draw:
        """The draw with the values that the mistake leads to."""
        return _mistaken(self.drawn, self.trap) if self.trap else self.drawn

    @property
    def tells(self) -> bool:
        """Whether a line holds a formula or a result that another question of the paper asks."""
        values, numbers = self._shown().shown_values, self.drawn.elsewhere.numbers
        return any(
            digits(values[step.name]) in numbers or tells(self.drawn, step.name, step.expr)
            for step in self._written()
        )

    def _wrong(self) -> tuple[ChainStep, ...]:
        return self.drawn.template.chain.traps.get(self.trap, ())

    def _differs(self, place: int) -> bool:
        """Whether a step has another value than the right solution."""
        name = self.steps[place].name
        return not same_value(self._shown().values[name], self.drawn.values[name])

    def _written(self) -> Iterator[ChainStep]:
        """The steps as that solution takes them."""
        wrong = {step.name: step.expr for step in self._wrong()}
        for step in self.steps:
            yield ChainStep(step.name, flat(wrong.get(step.name, step.expr)), step.unit)

    def _row(self, shown: Draw, step: ChainStep, lang: str) -> tuple[Block, ...]:
        name = thing(self.drawn, step.name, lang)
        return (Paragraph((*name, Words(": "), worked(shown, step))),)

    def _option(self, place: int) -> Option:
        number = (Words(str(place + 1)),)
        return Option(
            lambda each: said(each, "transfer.step", n=number),
            bool(self.trap) and place == self.place,
            lambda each: self._about(place, each),
            f"step-{place + 1}",
        )

    def _about(self, place: int, lang: str) -> tuple[Inline, ...]:
        """Why a step is the wrong one, or why it is not."""
        filler = Filler(self.drawn, lang)
        if self.trap and place == self.place:
            return filler.sentence("traps", self.trap)
        number = (Words(str(place + 1)),)
        if self.trap and place > self.place:
            if any(one.name == self.steps[place].name for one in self._wrong()):
                return said(lang, "transfer.again", n=number)
            if self._differs(place):
                return said(lang, "transfer.carried", n=number)
        why = filler.sentence("steps", self.steps[place].name)
        return said(lang, "transfer.right_step", n=number, why=why)

    def _about_none(self, lang: str) -> tuple[Inline, ...]:
        return said(lang, "transfer.one_wrong" if self.trap else "transfer.all_right")


def found_mistake(drawn: Draw) -> Wrong | None:
    """A solution of one part with a drawn mistake, or with none; None if no part has steps for it.

    Which step is wrong is drawn first, then the mistake in it, so that no step is a safe guess.
    """
    for index in shuffled(f"{key_of(drawn)}/mistake", range(len(drawn.template.rules.part))):
        steps = _steps(drawn, index)
        if not FEWEST <= len(steps) <= MOST:
            continue
        by_place: dict[int, list[Wrong]] = {-1: [Wrong(drawn, steps)]}
        for trap, place in _usable(drawn, index, steps):
            by_place.setdefault(place, []).append(Wrong(drawn, steps, trap, place))
        if len(by_place) == 1:
            continue
        key = f"{key_of(drawn)}/mistake/{index}"
        for place in shuffled(key, sorted(by_place)):
            for wrong in shuffled(f"{key}/trap", by_place[place]):
                if not wrong.tells:
                    return wrong
    return None


def _mistaken(drawn: Draw, trap: str) -> Draw:
    """The draw with the values that a mistake leads to."""
    return replace(drawn, values=drawn.template.chain.trapped(trap, drawn.values))


def _steps(drawn: Draw, index: int) -> tuple[ChainStep, ...]:
    """All steps to the answer of a part, from the task on; none where one has no name."""
    answer = drawn.template.rules.part[index].answer
    if answer["kind"] not in NUMERIC:
        return ()
    names = {step.name for of in answer_names(answer) for step in needed(drawn, of)}
    steps = tuple(step for step in drawn.template.chain.steps if step.name in names)
    named = all(has_name(drawn, step.name) and told(drawn, "steps", step.name) for step in steps)
    return steps if named else ()


def _usable(drawn: Draw, index: int, steps: tuple[ChainStep, ...]) -> Iterator[tuple[str, int]]:
    """Mistakes that change the answer, and the place of their first wrong step."""
    places = {step.name: place for place, step in enumerate(steps)}
    answer = answer_names(drawn.template.rules.part[index].answer)
    for trap, wrong in drawn.template.chain.traps.items():
        inside = [step for step in wrong if step.name in places]
        if not inside or trap in drawn.template.rules.drop or not told(drawn, "traps", trap):
            continue
        if any(only_units(one.expr, steps[places[one.name]].expr) for one in inside):
            continue
        try:
            shown = _mistaken(drawn, trap)
        except MathError:
            continue
        if not _writable(shown, steps):
            continue
        values = shown.values
        changed = [
            one.name for one in inside if not same_value(values[one.name], drawn.values[one.name])
        ]
        first = min(places[one.name] for one in inside)
        if steps[first].name not in changed:  # a wrong formula that gives the right number
            continue
        if not all(same_value(values[name], drawn.values[name]) for name in answer):
            yield trap, first


def _writable(shown: Draw, steps: tuple[ChainStep, ...]) -> bool:
    """Whether the digits of each step can be told: not where roots cancel to nothing."""
    try:
        for step in steps:
            rounded_text(shown.shown_values[step.name])
    except MathError:
        return False
    return True
