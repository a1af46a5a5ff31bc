"""A worked solution that somebody else made, with one of the misconceptions in it or with none."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant, leading_digits
from quizgen.core.errors import MathError
from quizgen.grading.spec import decode_spec
from quizgen.kinds import NUMERIC
from quizgen.kinds.contract import InputControl, asked_quantities
from quizgen.kinds.rubric import RubricSpec
from quizgen.locale import translate
from quizgen.maths.chain import ChainStep
from quizgen.maths.numbers import format_rounded
from quizgen.question.interpolation import Interpolator, inlines_to_text
from quizgen.question.levels.choice_part import LevelOption, make_choice_part
from quizgen.question.levels.contract import LevelPart
from quizgen.question.levels.perturbations import required_steps
from quizgen.question.levels.steps import (
    differs_in_unit_only,
    flatten_sums,
    has_name,
    has_sentence,
    is_same_value,
    leaks_answer,
    level_seed,
)
from quizgen.question.solution import PartSolution, SchemeLine, solution_step
from quizgen.question.worked_steps import quantity_inlines, typeset_step
from quizgen.typeset.prose import (
    Block,
    Emphasis,
    Inline,
    ListBlock,
    Paragraph,
    PlainText,
    translate_inlines,
)

FEWEST, MOST = 2, 8
"""Steps of a solution in which a mistake is looked for."""
_SENTENCES = re.compile(r"(?<=[.;:।]) +")
WRITTEN_LINES = 4
"""Lines to write on why a step is wrong."""


@dataclass(frozen=True)
class FaultySolution:
    """A solution: its steps, the misconception in it (or none), its first wrong step."""

    drawn: Variant
    steps: tuple[ChainStep, ...]
    trap: str = ""
    place: int = -1
    written: bool = False

    def __call__(self, lang: str) -> LevelPart:
        """Return the part in a language."""
        shown = self._apply_misconception()
        rows = tuple(
            self._build_step_paragraph(shown, step, lang) for step in self._iter_shown_steps()
        )
        intro = Paragraph(translate_inlines(lang, "transfer.mistake_said"))
        if self.written:
            return self._ask_for_reason((intro, ListBlock(rows, ordered=True)), lang)
        asked = Paragraph((Emphasis("strong", translate_inlines(lang, "transfer.mistake")),))
        options = [self._build_step_option(place) for place in range(len(self.steps))]
        none = LevelOption(
            lambda each: translate_inlines(each, "transfer.none"),
            not self.trap,
            self._explain_no_error,
            "none",
        )
        right = Interpolator(self.drawn, lang)
        lines = (solution_step(right, self.steps[self.place]),) if self.trap else ()
        body = (intro, ListBlock(rows, ordered=True), asked)
        return make_choice_part(self.drawn, lang, body, [*options, none], lines)

    def _ask_for_reason(self, body: tuple[Block, ...], lang: str) -> LevelPart:
        """Return the part in which the wrong step is named and mended in words."""
        asked = Paragraph((Emphasis("strong", translate_inlines(lang, "transfer.mend")),))
        langs, number = self.drawn.template.languages, str(self.place + 1)
        ideas, names = {}, []
        for each in langs:
            filler = Interpolator(self.drawn, each)
            shown = (PlainText(number),)
            step = translate_inlines(each, "transfer.wrong_is", n=shown)
            reason = (
                *filler.sentence("traps", self.trap), PlainText(" "),
                *filler.sentence("steps", self.steps[self.place].name),
            )  # fmt: skip
            ideas[each] = {"step": step, "reason": reason}
            names += translate(each, "transfer.step_names").format(n=number).split("; ")
        said = {
            each: {name: inlines_to_text(idea) for name, idea in of.items()}
            for each, of in ideas.items()
        }
        reasons = [one for of in said.values() for one in _SENTENCES.split(of["reason"])]
        accept = {"step": [*names, *(of["step"] for of in said.values())], "reason": reasons}
        spec = decode_spec(RubricSpec, {
            "kind": "rubric",
            "full": len(accept),
            "criteria": {name: {"points": 1, "accept": of} for name, of in accept.items()},
            "ideas": said,
        })  # fmt: skip
        solved = PartSolution(
            label="",
            lines=(),
            shown=(),
            mistakes=(),
            scheme=tuple(SchemeLine(name, Fraction(1), idea) for name, idea in ideas[lang].items()),
        )
        return LevelPart(
            Fraction(1), (*body, asked), spec, solved, InputControl("lines", lines=WRITTEN_LINES)
        )

    def _apply_misconception(self) -> Variant:
        """Return the variant with the values that the misconception leads to."""
        return _solve_with_misconception(self.drawn, self.trap) if self.trap else self.drawn

    @property
    def leaks_answer(self) -> bool:
        """Return whether a line shows a formula or a result that another question asks."""
        values, numbers = self._apply_misconception().shown_values, self.drawn.elsewhere.numbers
        return any(
            leading_digits(values[step.name]) in numbers
            or leaks_answer(self.drawn, step.name, step.expr)
            for step in self._iter_shown_steps()
        )

    def _get_misconception_steps(self) -> tuple[ChainStep, ...]:
        """Return the wrong steps of the misconception; none if the solution is right."""
        return self.drawn.template.chain.traps.get(self.trap, ())

    def _has_different_value(self, place: int) -> bool:
        """Return whether a step has another value than in the right solution."""
        name = self.steps[place].name
        return not is_same_value(self._apply_misconception().values[name], self.drawn.values[name])

    def _iter_shown_steps(self) -> Iterator[ChainStep]:
        """Yield the steps as this solution takes them."""
        wrong = {step.name: step.expr for step in self._get_misconception_steps()}
        for step in self.steps:
            yield ChainStep(step.name, flatten_sums(wrong.get(step.name, step.expr)), step.unit)

    def _build_step_paragraph(
        self, shown: Variant, step: ChainStep, lang: str
    ) -> tuple[Block, ...]:
        """Return one line of the solution: its quantity and the typeset step."""
        name = quantity_inlines(self.drawn, step.name, lang)
        return (Paragraph((*name, PlainText(": "), typeset_step(shown, step))),)

    def _build_step_option(self, place: int) -> LevelOption:
        """Return the option that names a step, counted from 0, as the first wrong one."""
        number = (PlainText(str(place + 1)),)
        return LevelOption(
            lambda each: translate_inlines(each, "transfer.step", n=number),
            bool(self.trap) and place == self.place,
            lambda each: self._explain_step(place, each),
            f"step-{place + 1}",
        )

    def _explain_step(self, place: int, lang: str) -> tuple[Inline, ...]:
        """Return why a step is the first wrong one, or why it is not."""
        filler = Interpolator(self.drawn, lang)
        if self.trap and place == self.place:
            return filler.sentence("traps", self.trap)
        number = (PlainText(str(place + 1)),)
        if self.trap and place > self.place:
            if any(one.name == self.steps[place].name for one in self._get_misconception_steps()):
                return translate_inlines(lang, "transfer.again", n=number)
            if self._has_different_value(place):
                return translate_inlines(lang, "transfer.carried", n=number)
        why = filler.sentence("steps", self.steps[place].name)
        return translate_inlines(lang, "transfer.right_step", n=number, why=why)

    def _explain_no_error(self, lang: str) -> tuple[Inline, ...]:
        """Return whether one step is wrong or all are right: the reason for the last option."""
        return translate_inlines(lang, "transfer.one_wrong" if self.trap else "transfer.all_right")


def choose_faulty_solution(drawn: Variant, *, written: bool = False) -> FaultySolution | None:
    """Return a solution of one part with a drawn misconception, or with none.

    None if no part has steps for it.

    Which step is wrong is drawn first, then the mistake in it, so that no step is a safe guess.
    Where the reason is to be ``written``, one is wrong.
    """
    for index in shuffle(f"{level_seed(drawn)}/mistake", range(len(drawn.template.rules.part))):
        steps = _list_steps_to_answer(drawn, index)
        if not FEWEST <= len(steps) <= MOST:
            continue
        by_place: dict[int, list[FaultySolution]] = {}
        for trap, place in _iter_usable_misconceptions(drawn, index, steps):
            one = FaultySolution(drawn, steps, trap, place, written)
            by_place.setdefault(place, []).append(one)
        if not by_place:
            continue
        if not written:
            by_place[-1] = [FaultySolution(drawn, steps)]
        key = f"{level_seed(drawn)}/mistake/{index}"
        for place in shuffle(key, sorted(by_place)):
            for wrong in shuffle(f"{key}/trap", by_place[place]):
                if not wrong.leaks_answer:
                    return wrong
    return None


def _solve_with_misconception(drawn: Variant, trap: str) -> Variant:
    """Return the variant with the values that a misconception leads to."""
    return replace(drawn, values=drawn.template.chain.solve_with_misconception(trap, drawn.values))


def _list_steps_to_answer(drawn: Variant, index: int) -> tuple[ChainStep, ...]:
    """Return all steps to a part's answer, from the task on; none where one has no name."""
    answer = drawn.template.rules.part[index].answer
    if answer["kind"] not in NUMERIC:
        return ()
    names = {step.name for of in asked_quantities(answer) for step in required_steps(drawn, of)}
    steps = tuple(step for step in drawn.template.chain.steps if step.name in names)
    named = all(
        has_name(drawn, step.name) and has_sentence(drawn, "steps", step.name) for step in steps
    )
    return steps if named else ()


def _iter_usable_misconceptions(
    drawn: Variant, index: int, steps: tuple[ChainStep, ...]
) -> Iterator[tuple[str, int]]:
    """Yield misconceptions that change the answer, and the place of their first wrong step."""
    places = {step.name: place for place, step in enumerate(steps)}
    answer = asked_quantities(drawn.template.rules.part[index].answer)
    for trap, wrong in drawn.template.chain.traps.items():
        inside = [step for step in wrong if step.name in places]
        if (
            not inside
            or trap in drawn.template.rules.drop
            or not has_sentence(drawn, "traps", trap)
        ):
            continue
        if any(differs_in_unit_only(one.expr, steps[places[one.name]].expr) for one in inside):
            continue
        try:
            shown = _solve_with_misconception(drawn, trap)
        except MathError:
            continue
        if not _has_certain_digits(shown, steps):
            continue
        values = shown.values
        changed = [
            one.name
            for one in inside
            if not is_same_value(values[one.name], drawn.values[one.name])
        ]
        first = min(places[one.name] for one in inside)
        if steps[first].name not in changed:  # a wrong formula that gives the right number
            continue
        if not all(is_same_value(values[name], drawn.values[name]) for name in answer):
            yield trap, first


def _has_certain_digits(shown: Variant, steps: tuple[ChainStep, ...]) -> bool:
    """Return whether the digits of each step are certain: not where roots cancel to nothing."""
    try:
        for step in steps:
            format_rounded(shown.shown_values[step.name])
    except MathError:
        return False
    return True
