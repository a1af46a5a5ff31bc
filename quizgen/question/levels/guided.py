"""The steps that a calculation needs, asked one by one in the order of the chain.

Before a calculating part stand the steps on which its answer rests; of one step the formula is
asked first, against those of its mistakes. What was asked before is not asked again, and a mistake
belongs to the step in which it happens. Parts without a calculation stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import msgspec
from msgspec.structs import replace

from quizgen.bank.sampler import pick_index
from quizgen.bank.variant import Variant
from quizgen.core.shares import share_points
from quizgen.kinds import KINDS, NUMERIC
from quizgen.kinds.asking import misconception_specs
from quizgen.kinds.contract import AskedPart, asked_quantities
from quizgen.maths.chain import ChainStep
from quizgen.maths.tree import Sym, names_in
from quizgen.question.interpolation import Interpolator
from quizgen.question.levels import exam
from quizgen.question.levels.choice_part import LevelOption, make_choice_part
from quizgen.question.levels.contract import (
    LevelPart,
    LevelQuestion,
    estimate_part_minutes,
    without_bold_questions,
)
from quizgen.question.levels.distractors import draw_formula_options
from quizgen.question.levels.steps import (
    FormulaOption,
    applicable_branch,
    defined_quantities,
    given_equation,
    gives_away,
    has_name,
    introduced_names,
    level_seed,
    list_untold_letters,
    part_labels,
    right_option,
    stated_quantities,
    step_value_spec,
    wrong_options,
)
from quizgen.question.part_context import authored_answer
from quizgen.question.solution import PartSolution, solution_step, solved_misconceptions
from quizgen.question.worked_steps import quantity_inlines
from quizgen.typeset.prose import (
    Block,
    Emphasis,
    Inline,
    Paragraph,
    begin_sentence,
    join_inlines,
    to_inlines,
    translate_inlines,
)


@dataclass(frozen=True, slots=True)
class GuidedStage:
    """The questions that take the place of one authored part.

    Parameters
    ----------
    index : int
        The authored part.
    before : tuple of ChainStep
        Steps that are asked one by one.
    formula : ChainStep, optional
        The step whose formula is asked first.
    whole : bool
        Whether the authored part is asked at the end; else the steps have asked all of it.
    known : frozenset of str
        Letters that formulas may use.
    """

    index: int
    before: tuple[ChainStep, ...]
    formula: ChainStep | None
    whole: bool
    known: frozenset[str]

    @property
    def alone(self) -> bool:
        """Return whether nothing but the part itself is asked."""
        return not self.before and self.formula is None


@lru_cache(maxsize=128)
def guided_stages(drawn: Variant) -> tuple[GuidedStage, ...]:
    """Return what is asked before each authored part, whatever the language."""
    found, asked = [], set[str]()
    for index in range(len(drawn.template.rules.part)):
        stage = _build_stage(drawn, index, frozenset(asked))
        found.append(stage)
        asked |= {step.name for step in drawn.steps_of_part(index)}
    return tuple(found)


def _build_stage(drawn: Variant, index: int, asked: frozenset[str]) -> GuidedStage:
    """Return what is asked before one authored part; ``asked`` are the quantities asked so far."""
    of, numeric = (
        asked_quantities(authored_answer(drawn, index)),
        authored_answer(drawn, index)["kind"] in NUMERIC,
    )
    known = (
        introduced_names(drawn)
        | asked
        | {step.name for step in drawn.steps_of_part(index)} - stated_quantities(drawn)
    )
    steps = [
        step for step in _list_required_steps(drawn, index)
        if step.name not in asked | stated_quantities(drawn)
        and (has_name(drawn, step.name) or not gives_away(drawn, step, known))
    ]  # fmt: skip
    whole = not numeric or _is_askable_at_once(drawn, of, steps)
    before = tuple(step for step in steps if not (whole and numeric and step.name in of))
    return GuidedStage(index, before, _find_formula_step(drawn, index, steps, known), whole, known)


def _list_required_steps(drawn: Variant, index: int) -> list[ChainStep]:
    """Return the steps that the answer rests on, in the branches that apply to this variant."""
    todo, found = list(asked_quantities(authored_answer(drawn, index))), set[str]()
    steps = {step.name: step for step in drawn.steps_of_part(index)}
    while todo:
        name = todo.pop()
        if name in steps and name not in found:
            found.add(name)
            todo += names_in(applicable_branch(drawn, steps[name].expr))
    return [step for name, step in steps.items() if name in found]


def _is_askable_at_once(drawn: Variant, of: tuple[str, ...], steps: list[ChainStep]) -> bool:
    """Return whether a part can be asked at once after the steps before it."""
    chain = drawn.template.chain
    if any(chain.required_steps(name) & {*of} > {name} for name in of):
        return False
    alone = all(step.name in of for step in steps)
    return len(of) == 1 or not alone or not all(has_name(drawn, name) for name in of)


def _find_formula_step(
    drawn: Variant, index: int, steps: list[ChainStep], known: frozenset[str]
) -> ChainStep | None:
    """Return the step whose formula is asked: one of those with several misconceptions, or None."""
    told = defined_quantities(drawn)
    found = [
        step for step in steps
        if step.name not in told and not _is_unit_conversion(drawn, step)
        and has_name(drawn, step.name) and not gives_away(drawn, step, known)
        and len(wrong_options(drawn, step, known)) > 1
    ]  # fmt: skip
    return found[pick_index(f"{level_seed(drawn)}/{index}/formula", len(found))] if found else None


def _is_unit_conversion(drawn: Variant, step: ChainStep) -> bool:
    """Return whether a step is the same quantity in another unit.

    Nobody has to choose a formula for bits as bytes.
    """
    right, units = applicable_branch(drawn, step.expr), drawn.template.units
    return isinstance(right, Sym) and units.get(right.name, "") != step.unit


def is_applicable(drawn: Variant) -> bool:
    """Return whether some part has a step before it, or a formula to choose."""
    template = drawn.template
    allowed = "guided" in template.rules.levels and not template.places_fields
    return allowed and not all(stage.alone for stage in guided_stages(drawn))


def ask(drawn: Variant, lang: str) -> LevelQuestion:
    """Return the question with steps before each authored part."""
    usual = exam.ask(drawn, lang)
    guide = _Guide(drawn, lang)
    groups = [guide.group(stage, usual.parts[stage.index]) for stage in guided_stages(drawn)]
    weights = [part.points for group in groups for part in group]
    points = share_points(sum(weights, Fraction(0)), weights)
    parts = tuple(
        replace(part, points=worth)
        for part, worth in zip((p for group in groups for p in group), points, strict=True)
    )
    solution = replace(usual.solution, parts=tuple(part.solved for part in parts))
    stem = usual.stem if len(groups) > 1 else tuple(map(without_bold_questions, usual.stem))
    added = len(parts) - len(usual.parts)
    before = (part for group in groups for part in group[:-1])
    minutes = sum(
        (estimate_part_minutes(part, added=True) for part in before), drawn.template.minutes
    )
    return LevelQuestion(stem, parts, solution, minutes if added else None)


class _Guide:
    """Writer of the parts of guided stages, for one variant in one language."""

    def __init__(self, drawn: Variant, lang: str) -> None:
        """Take the variant's sentences in one language."""
        self.drawn, self.lang = drawn, lang
        self.filler = Interpolator(drawn, lang)

    def group(self, stage: GuidedStage, usual: LevelPart) -> list[LevelPart]:
        """Return the parts that take the place of an authored one."""
        if stage.alone:
            return [usual]
        found: list[LevelPart] = []
        for step in stage.before:
            if step == stage.formula:
                found.append(self._ask_step_formula(stage, step, len(found)))
            found.append(self._ask_step_value(stage, step, len(found)))
        if stage.whole:
            if stage.formula is not None and stage.formula not in stage.before:
                found.append(self._ask_step_formula(stage, stage.formula, len(found)))
            found.append(self._ask_authored_part(stage, usual))
        goal = map(without_bold_questions, usual.body) if len(found) > 1 else ()
        found[0] = replace(found[0], body=(*goal, *found[0].body))
        worth = usual.points / len(found)
        return [
            replace(part, points=worth, solved=replace(part.solved, label=label))
            for part, label in zip(
                found, self._make_substep_labels(usual.label, len(found)), strict=True
            )
        ]

    def _make_substep_labels(self, label: str, count: int) -> list[str]:
        """Return the labels of the parts that take the place of one."""
        if label and count > 1:
            return [f"{label}{n}" for n in range(1, count + 1)]
        return [label] if label else part_labels(self.drawn, count)

    def _build_strong_paragraph(self, key: str, **blanks: tuple[Inline, ...]) -> tuple[Block, ...]:
        """Return a sentence of the interface as a bold paragraph: it is what is asked."""
        said = begin_sentence(translate_inlines(self.lang, key, **blanks))
        return (Paragraph((Emphasis("strong", said),)),)

    def _ask_step_value(self, stage: GuidedStage, step: ChainStep, place: int) -> LevelPart:
        """Return a part that asks for the value of one step.

        A quantity without a name in the bank is asked for by its formula.
        """
        key = "guided.value" if place else "guided.value_first"
        spec = step_value_spec(self.drawn, stage.index, step)
        if has_name(self.drawn, step.name):
            body = self._build_strong_paragraph(
                key, thing=quantity_inlines(self.drawn, step.name, self.lang)
            )
        else:
            way = right_option(self.drawn, step, stage.known)
            body = self._build_strong_paragraph(key, thing=(way.shown,))
        solved = PartSolution(
            label="",
            lines=(solution_step(self.filler, step),),
            shown=to_inlines(KINDS[spec.kind].explain_key(spec, self.lang)),
            mistakes=tuple(
                solved_misconceptions(
                    self.filler, AskedPart(spec, mistakes=misconception_specs(spec, "value"))
                )
            ),
        )
        return LevelPart(Fraction(1), body, spec, solved)

    def _ask_authored_part(self, stage: GuidedStage, usual: LevelPart) -> LevelPart:
        """Return the authored part, with the misconceptions that can still happen in it."""
        before = {step.name for step in stage.before}
        traps = self.drawn.template.chain.traps
        gone = {
            name for name in usual.spec.traps
            if name in traps and before & {wrong.name for wrong in traps[name]}
        }  # fmt: skip
        kept = {name: wrong for name, wrong in usual.spec.traps.items() if name not in gone}
        told = {
            lang: {name: text for name, text in texts.items() if name not in gone}
            for lang, texts in usual.spec.notes.items()
        }
        spec = msgspec.structs.replace(usual.spec, traps=kept, notes=told if kept else {})
        of = asked_quantities(authored_answer(self.drawn, stage.index))
        numeric = spec.kind in NUMERIC
        solved = replace(
            usual.solved,
            lines=tuple(
                solution_step(self.filler, step)
                for step in self.drawn.steps_of_part(stage.index) if step.name in of and numeric
            ),
            mistakes=tuple(m for m in usual.solved.mistakes if m.name not in gone),
        )  # fmt: skip
        body = usual.body
        if numeric:
            body = self._build_strong_paragraph("guided.result", things=self._list_quantities(of))
        elif stage.before:
            body = self._build_strong_paragraph("guided.now")
        return replace(usual, body=body, spec=spec, solved=solved)

    def _list_quantities(self, of: tuple[str, ...]) -> tuple[Inline, ...]:
        """Return the names of quantities, with commas between them."""
        return join_inlines((quantity_inlines(self.drawn, name, self.lang) for name in of), ", ")

    def _ask_step_formula(self, stage: GuidedStage, step: ChainStep, place: int) -> LevelPart:
        """Return a part that asks for a formula: the right one among those of misconceptions."""
        key = "guided.formula" if place else "guided.formula_first"
        body = self._build_strong_paragraph(
            key, thing=quantity_inlines(self.drawn, step.name, self.lang)
        )
        told = list_untold_letters(self.drawn, step, stage.known)
        body += tuple(self._build_legend(told))
        ways = draw_formula_options(self.drawn, step, stage.known | {*told})
        return make_choice_part(
            self.drawn, self.lang, body, [self._build_formula_option(step, way) for way in ways]
        )

    def _build_legend(self, names: Sequence[str]) -> Iterator[Block]:
        """Yield the line that says which numbers of the text letters of the options stand for."""
        equations = ((given_equation(self.drawn, name),) for name in names)
        if names:
            yield Paragraph(join_inlines(equations, ", "))

    def _build_formula_option(self, step: ChainStep, way: FormulaOption) -> LevelOption:
        """Return an option that shows a formula, with the reason why it is right or wrong."""

        def because(lang: str) -> tuple[Inline, ...]:
            """Return the sentence on the slip, the misconception, or the right step."""
            if way.slip:
                return translate_inlines(lang, f"guided.slip_{way.slip}")
            section, name = ("traps", way.trap) if way.trap else ("steps", step.name)
            return Interpolator(self.drawn, lang).sentence(section, name)

        return LevelOption(lambda _lang: (way.shown,), way.is_right, because, way.trap or way.slip)
