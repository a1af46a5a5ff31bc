"""The steps that a calculation needs, asked one by one in the order of the chain.

Before a calculating part stand the steps on which its answer rests; of one step the formula is
asked first, against those of its mistakes. What was asked before is not asked again, and a mistake
belongs to the step in which it happens. Parts without a calculation stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import msgspec
from msgspec.structs import replace

from quizgen.bank.draw import Draw
from quizgen.bank.plan import pick
from quizgen.bank.prose import Block, Inline, Paragraph, Styled
from quizgen.bank.traps import answer_names
from quizgen.maths.chain import ChainStep
from quizgen.maths.tree import Sym, names
from quizgen.question.contract import Built
from quizgen.question.filling import Filler
from quizgen.question.kinds import KINDS
from quizgen.question.levels import exam
from quizgen.question.levels.asking import Asked, Asking, quiet, shared_out
from quizgen.question.levels.options import Option, choice
from quizgen.question.levels.slips import offered
from quizgen.question.levels.steps import (
    Way,
    branch,
    defined,
    gives_away,
    has_name,
    introduced,
    key_of,
    labels,
    right_way,
    stated,
    value_spec,
    wrong_ways,
)
from quizgen.question.shown import listed, pieces, said
from quizgen.question.solution import PartSolution, line_of, mistakes_of
from quizgen.question.specs import answer_of, mistaken
from quizgen.question.worked import thing

NUMERIC = frozenset({"number", "quantity", "angle", "point", "table", "set", "interval"})


@dataclass(frozen=True, slots=True)
class Stage:
    """What takes the place of one authored part.

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
        """Whether nothing but the part itself is asked."""
        return not self.before and self.formula is None


@lru_cache(maxsize=128)
def stages(drawn: Draw) -> tuple[Stage, ...]:
    """What is asked before each authored part, whatever the language."""
    found, asked = [], set[str]()
    for index in range(len(drawn.template.rules.part)):
        stage = _stage(drawn, index, frozenset(asked))
        found.append(stage)
        asked |= {step.name for step in drawn.steps(index)}
    return tuple(found)


def _stage(drawn: Draw, index: int, asked: frozenset[str]) -> Stage:
    of, numeric = answer_names(answer_of(drawn, index)), answer_of(drawn, index)["kind"] in NUMERIC
    known = introduced(drawn) | asked | {step.name for step in drawn.steps(index)} - stated(drawn)
    steps = [
        step for step in _needed(drawn, index)
        if step.name not in asked | stated(drawn)
        and (has_name(drawn, step.name) or not gives_away(drawn, step, known))
    ]  # fmt: skip
    whole = not numeric or _together(drawn, of, steps)
    before = tuple(step for step in steps if not (whole and numeric and step.name in of))
    return Stage(index, before, _to_choose(drawn, index, steps, known), whole, known)


def _needed(drawn: Draw, index: int) -> list[ChainStep]:
    """The steps on which the answer rests in the branches that apply to this draw."""
    todo, found = list(answer_names(answer_of(drawn, index))), set[str]()
    steps = {step.name: step for step in drawn.steps(index)}
    while todo:
        name = todo.pop()
        if name in steps and name not in found:
            found.add(name)
            todo += names(branch(drawn, steps[name].expr))
    return [step for name, step in steps.items() if name in found]


def _together(drawn: Draw, of: tuple[str, ...], steps: list[ChainStep]) -> bool:
    """Whether what a part asks can be asked at once, when the steps before have been."""
    chain = drawn.template.chain
    if any(chain.needs(name) & {*of} > {name} for name in of):
        return False
    alone = all(step.name in of for step in steps)
    return len(of) == 1 or not alone or not all(has_name(drawn, name) for name in of)


def _to_choose(
    drawn: Draw, index: int, steps: list[ChainStep], known: frozenset[str]
) -> ChainStep | None:
    """The step whose formula is asked: one of those with several known mistakes."""
    told = defined(drawn)
    found = [
        step for step in steps
        if step.name not in told and not _other_unit(drawn, step)
        and has_name(drawn, step.name) and not gives_away(drawn, step, known)
        and len(wrong_ways(drawn, step, known)) > 1
    ]  # fmt: skip
    return found[pick(f"{key_of(drawn)}/{index}/formula", len(found))] if found else None


def _other_unit(drawn: Draw, step: ChainStep) -> bool:
    """Whether a step is the same quantity in another unit: bits as bytes are no formula."""
    right, units = branch(drawn, step.expr), drawn.template.units
    return isinstance(right, Sym) and units.get(right.name, "") != step.unit


def fits(drawn: Draw) -> bool:
    """Whether some part has a step before it, or a formula to choose."""
    allowed = "guided" in drawn.template.rules.levels
    return allowed and not all(stage.alone for stage in stages(drawn))


def asking(drawn: Draw, lang: str) -> Asking:
    """Each authored part with the steps before it."""
    usual = exam.asking(drawn, lang)
    guide = _Guide(drawn, lang)
    groups = [guide.group(stage, usual.parts[stage.index]) for stage in stages(drawn)]
    weights = [part.points for group in groups for part in group]
    points = shared_out(sum(weights, Fraction(0)), weights)
    parts = tuple(
        replace(part, points=worth)
        for part, worth in zip((p for group in groups for p in group), points, strict=True)
    )
    solution = replace(usual.solution, parts=tuple(part.solved for part in parts))
    stem = usual.stem if len(groups) > 1 else tuple(map(quiet, usual.stem))
    return Asking(stem, parts, solution)


class _Guide:
    """Puts the stages of a draw into words."""

    def __init__(self, drawn: Draw, lang: str) -> None:
        self.drawn, self.lang = drawn, lang
        self.filler = Filler(drawn, lang)

    def group(self, stage: Stage, usual: Asked) -> list[Asked]:
        """The parts that take the place of an authored one."""
        if stage.alone:
            return [usual]
        found: list[Asked] = []
        for step in stage.before:
            if step == stage.formula:
                found.append(self._formula(stage, step, len(found)))
            found.append(self._value(stage, step, len(found)))
        if stage.whole:
            if stage.formula is not None and stage.formula not in stage.before:
                found.append(self._formula(stage, stage.formula, len(found)))
            found.append(self._rest(stage, usual))
        goal = map(quiet, usual.body) if len(found) > 1 else ()
        found[0] = replace(found[0], body=(*goal, *found[0].body))
        worth = usual.points / len(found)
        return [
            replace(part, points=worth, solved=replace(part.solved, label=label))
            for part, label in zip(found, self._labels(usual.label, len(found)), strict=True)
        ]

    def _labels(self, label: str, count: int) -> list[str]:
        """Labels of the parts that take the place of one."""
        if label and count > 1:
            return [f"{label}{n}" for n in range(1, count + 1)]
        return [label] if label else labels(self.drawn, count)

    def _strong(self, key: str, **blanks: tuple[Inline, ...]) -> tuple[Block, ...]:
        return (Paragraph((Styled("strong", said(self.lang, key, **blanks)),)),)

    def _value(self, stage: Stage, step: ChainStep, place: int) -> Asked:
        key = "guided.value" if place else "guided.value_first"
        spec = value_spec(self.drawn, stage.index, step)
        if has_name(self.drawn, step.name):
            body = self._strong(key, thing=thing(self.drawn, step.name, self.lang))
        else:
            way = right_way(self.drawn, step, stage.known)
            body = self._strong(key, thing=(way.shown,))
        solved = PartSolution(
            label="",
            lines=(line_of(self.filler, step),),
            shown=pieces(KINDS[spec.kind].printed(spec, self.lang)),
            mistakes=tuple(mistakes_of(self.filler, Built(spec, mistakes=mistaken(spec, "value")))),
        )
        return Asked(Fraction(1), body, spec, solved)

    def _rest(self, stage: Stage, usual: Asked) -> Asked:
        """The authored part, with the mistakes that can still happen in it."""
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
        of = answer_names(answer_of(self.drawn, stage.index))
        numeric = spec.kind in NUMERIC
        solved = replace(
            usual.solved,
            lines=tuple(
                line_of(self.filler, step)
                for step in self.drawn.steps(stage.index) if step.name in of and numeric
            ),
            mistakes=tuple(m for m in usual.solved.mistakes if m.name not in gone),
        )  # fmt: skip
        body = usual.body
        if numeric:
            body = self._strong("guided.result", things=self._things(of))
        elif stage.before:
            body = self._strong("guided.now")
        return replace(usual, body=body, spec=spec, solved=solved)

    def _things(self, of: tuple[str, ...]) -> tuple[Inline, ...]:
        return listed((thing(self.drawn, name, self.lang) for name in of), ", ")

    def _formula(self, stage: Stage, step: ChainStep, place: int) -> Asked:
        """Which formula? The right one among those of the step's mistakes."""
        key = "guided.formula" if place else "guided.formula_first"
        body = self._strong(key, thing=thing(self.drawn, step.name, self.lang))
        ways = offered(self.drawn, step, stage.known)
        return choice(self.drawn, self.lang, body, [self._way(step, way) for way in ways])

    def _way(self, step: ChainStep, way: Way) -> Option:
        def because(lang: str) -> tuple[Inline, ...]:
            if way.slip:
                return said(lang, f"guided.slip_{way.slip}")
            section, name = ("traps", way.trap) if way.trap else ("steps", step.name)
            return Filler(self.drawn, lang).sentence(section, name)

        return Option(lambda _lang: (way.shown,), way.right, because, way.trap or way.slip)
