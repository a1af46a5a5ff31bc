"""The worked solution of a variant in one language: answers, steps, misconceptions, remarks.

The steps come from the solver's chain; the language files add one sentence of why per step.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import groupby
from typing import Any, NamedTuple

import msgspec

from quizgen.bank.variant import Variant
from quizgen.figures import FieldPicture
from quizgen.grading.spec import AnySpec, NumericSpec, ScalarSpec, VectorSpec
from quizgen.kinds import KINDS
from quizgen.kinds.asking import as_student_writes
from quizgen.kinds.contract import AskedPart, DerivedStep, SchemeRow, asked_form, asked_quantities
from quizgen.kinds.grade import show_key
from quizgen.locale import format_amount, translate
from quizgen.maths.chain import ChainStep
from quizgen.maths.constants import Scalar
from quizgen.maths.notation import format_tree
from quizgen.maths.notation.pretty import format_formula
from quizgen.maths.number_systems import NumberSystem, compile_expr, float32_system, float64_system
from quizgen.maths.numbers import format_rounded, parse_written_number, to_fraction
from quizgen.maths.tree import names_in
from quizgen.maths.units import get_unit
from quizgen.maths.values import map_numbers
from quizgen.question.interpolation import NBSP, Interpolator, inlines_to_text, join_unit
from quizgen.question.worked_steps import (
    FORMULA,
    WorkedSide,
    form_sides,
    join_sides,
    quantity_inlines,
    step_sides,
)
from quizgen.typeset import lay_out
from quizgen.typeset.prose import (
    Block,
    Inline,
    InlineCode,
    PlainText,
    TableBlock,
    TextOrInlines,
    TypesetMaths,
    to_inlines,
)


def inlines_to_plain(shown: tuple[Inline, ...]) -> str:
    """Return inlines as text with ordinary blanks before units."""
    return inlines_to_text(shown).replace(NBSP, " ")


class SolutionHint(msgspec.Struct, frozen=True):
    """A hint to a step: what kind it is, and what it shows.

    ``kind`` is ``quantity`` (which one is needed, and why), ``formula`` (with its number on the
    formula sheet), ``numbers``, ``result``, or ``why`` where nothing else is known of the step.
    """

    kind: str
    shown: tuple[Inline, ...]
    why: tuple[Inline, ...] = ()
    formula: str = ""


class SolutionStep(msgspec.Struct, frozen=True):
    """One step: the worked formula, why it is taken, and its number on the formula sheet.

    ``name``, ``thing`` and ``sides`` are its quantity, in words, and what it is equal to;
    ``points`` what an author says that it earns. ``idea`` is why without the value that results.
    """

    maths: TypesetMaths
    why: tuple[Inline, ...]
    formula: str = ""
    name: str = ""
    thing: tuple[Inline, ...] = ()
    sides: tuple[WorkedSide, ...] = ()
    points: Fraction | None = None
    idea: tuple[Inline, ...] = ()

    @property
    def hints(self) -> tuple[SolutionHint, ...]:
        """Return what a learner may be told of the step, little by little."""
        if not self.sides:
            return (SolutionHint("why", self.why),)
        found = [SolutionHint("quantity", self.thing, self.idea or self.why)]
        for role, sides in groupby(self.sides, key=lambda side: side.role):
            formula = self.formula if role == FORMULA else ""
            shown = msgspec.structs.replace(
                join_sides(self.name, tuple(sides)), lang=self.maths.lang
            )
            found.append(SolutionHint(role, (shown,), formula=formula))
        return tuple(found)


class SolvedMisconception(msgspec.Struct, frozen=True):
    """A misconception: its name, what went wrong, and the answer it would give.

    Of one that is drawn no answer is shown: its points would tell nobody what it looks like.
    ``share`` of the points is what it earns all the same. ``own`` is what the sentence says besides
    the reason of the right answer; empty if that is all of it.
    """

    name: str
    sentence: tuple[Inline, ...]
    shown: tuple[Inline, ...]
    share: Fraction = Fraction(0)
    own: tuple[Inline, ...] = ()

    @property
    def listed_sentence(self) -> tuple[Inline, ...]:
        """Return the sentence for a list below the right answer: nothing is said twice there."""
        return self.own or self.sentence

    @property
    def value(self) -> str:
        """Return the answer that it gives, as text."""
        return inlines_to_plain(self.shown)


EXAMPLES_SHOWN = 4
"""Examples of what counts that a mark scheme prints: the first ones of the list."""


class SchemeLine(NamedTuple):
    """A criterion in print: its points, the idea, examples of what counts, half, does not."""

    name: str
    points: Fraction
    idea: tuple[Inline, ...]
    accept: tuple[str, ...] = ()
    half: tuple[str, ...] = ()
    refuse: tuple[str, ...] = ()
    follows: bool = False
    halves: bool = False


class PartSolution(msgspec.Struct, frozen=True):
    """The worked solution of one part.

    ``options`` tells the right answer in words, ``reasons`` why each other choice is wrong,
    ``why`` what else explains the answer, ``drawing`` the answer if it is drawn, ``scheme`` what a
    person marks sentences by.

    For markers: ``shares`` of the points that each of the options earns, what is ``accepted``
    besides the answer, ``follows``: labels of parts whose values it works on with.
    """

    label: str
    lines: tuple[SolutionStep, ...]
    shown: tuple[Inline, ...]
    mistakes: tuple[SolvedMisconception, ...]
    options: tuple[tuple[Inline, ...], ...] = ()
    reasons: tuple[SolvedMisconception, ...] = ()
    why: tuple[Inline, ...] = ()
    drawing: FieldPicture | None = None
    shares: tuple[Fraction, ...] = ()
    accepted: str = ""
    follows: tuple[str, ...] = ()
    scheme: tuple[SchemeLine, ...] = ()
    most: Fraction | None = None
    """Points that count at most, where the criteria have more."""

    @property
    def answer(self) -> str:
        """Return the key as text that can be typed back; empty where sentences tell it."""
        return inlines_to_plain(self.shown)


class Solution(msgspec.Struct, frozen=True):
    """The worked solution of a question in one language."""

    lang: str
    title: str
    parts: tuple[PartSolution, ...]
    check: tuple[Block, ...]
    note: tuple[Block, ...]
    why: tuple[Block, ...] = ()
    precision: tuple[Block, ...] = ()


def build_solution(drawn: Variant, lang: str, parts: tuple[PartSolution, ...]) -> Solution:
    """Return the solved parts of a variant with the remarks on the whole, in one language."""
    filler = Interpolator(drawn, lang)
    return Solution(
        lang=lang,
        title=filler.text.title,
        parts=parts,
        check=filler.section("check"),
        note=filler.section("note"),
        precision=precision_table(drawn, lang),
        why=filler.section("why"),
    )


def solve_part(filler: Interpolator, index: int, built: AskedPart[Any]) -> PartSolution:
    """Return the worked solution of one authored part.

    Parameters
    ----------
    filler : Interpolator
    index : int
    built : AskedPart
        The part as its kind makes it.
    """
    drawn, spec, board = filler.drawn, built.spec, built.control.board
    label = drawn.template.labels[index]
    explained = filler.text.sentence("why", label or "a") is not None
    return PartSolution(
        label=label,
        lines=(
            *(
                _give_points(solution_step(filler, step), drawn.template.rules.part[index].scheme)
                for step in _iter_steps(filler, index)
            ),
            *(_build_derived_step(filler, step) for step in built.derived),
        ),
        shown=_build_model_answer(filler, label)
        or to_inlines(KINDS[spec.kind].explain_key(spec, filler.lang)),
        mistakes=tuple(solved_misconceptions(filler, built)),
        options=tuple(
            (*_build_right_option(filler, section, name), *_format_citation(built.source))
            for section, name in built.right
        ),
        reasons=tuple(_iter_wrong_options(filler, built)),
        why=filler.sentence("why", label or "a") if explained else (),
        drawing=FieldPicture(board, filler.lang, built.drawn) if board else None,
        shares=built.shares,
        accepted=KINDS[spec.kind].accepted(spec, filler.lang),
        follows=_list_followed(drawn, index),
        scheme=tuple(_build_scheme_line(filler, row) for row in built.scheme),
        most=_find_most_points(drawn, index, built),
    )


def _iter_steps(filler: Interpolator, index: int) -> Iterator[ChainStep]:
    """Yield the steps to a part's answer, each after the formulas that it was made from.

    A formula is a step of its own where the words have a sentence for it and no part before asks
    for it: one that stands in the question needs none.
    """
    drawn = filler.drawn
    chain, rules = drawn.template.chain, drawn.template.rules.part
    told, shown = {asked_form(part.answer) for part in rules[:index]}, rules[index].show
    for step in (*drawn.steps_of_part(index), *drawn.sampler.parts[index].form_steps):
        for name in chain.required_forms([step], told):
            told.add(name)
            if (shown is None or name in shown) and filler.text.sentence("steps", name) is not None:
                yield chain.form_by_name[name]
        yield step


def _give_points(step: SolutionStep, scheme: Mapping[str, Scalar]) -> SolutionStep:
    """Return a step with the points that an author gives it; where others have some, it has 0."""
    if not scheme:
        return step
    return msgspec.structs.replace(step, points=parse_written_number(scheme.get(step.name, 0)))


def _list_followed(drawn: Variant, index: int) -> tuple[str, ...]:
    """Return the labels of earlier parts whose answers the steps of a part use."""
    used = frozenset[str]().union(*(names_in(step.expr) for step in drawn.steps_of_part(index)))
    return tuple(
        drawn.template.labels[place]
        for place in range(index)
        if used & set(asked_quantities(drawn.template.rules.part[place].answer))
    )


def scheme_examples(row: SchemeLine) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the examples of a criterion, each list with the key of what stands before it."""
    for name, examples in (("accept", row.accept), ("half_for", row.half), ("refuse", row.refuse)):
        if examples:
            yield name, examples


def _build_model_answer(filler: Interpolator, label: str) -> tuple[Inline, ...]:
    """Return the model answer of a part, filled; empty if the words have none."""
    name = label or "a"
    known = filler.text.sentence("model", name) is not None
    return filler.sentence("model", name) if known else ()


def _find_most_points(drawn: Variant, index: int, built: AskedPart[Any]) -> Fraction | None:
    """Return the points of a part whose criteria have more than that; else None."""
    full = parse_written_number(drawn.template.rules.part[index].points)
    return full if sum(row.points for row in built.scheme) > full else None


def scheme_title(part: PartSolution, lang: str) -> str:
    """Return what stands over a mark scheme: its name, and that the best criteria count."""
    title = translate(lang, "solution.scheme")
    if part.most is None:
        return title
    best = translate(lang, "solution.best", points=format_amount(part.most, lang))
    return f"{title}. {best}"


def _list_examples(filler: Interpolator, section: str, name: str) -> tuple[str, ...]:
    """Return the examples of a list in the language's own words; none if it has no such list."""
    if filler.text.sentence(section, name) is None:
        return ()
    words = inlines_to_text(map(_write_typed_formula, filler.sentence(section, name))).split("|")
    return tuple(word.strip() for word in words if word.strip())


def _write_typed_formula(part: Inline) -> Inline:
    """Return a formula that an example gives as it is typed as people write it: N², 1/√N."""
    if isinstance(part, InlineCode) and re.search(r"sqrt\(|\^", part.text):
        return PlainText(re.sub(r"√\((\w)\)", r"√\1", format_formula(part.text)))
    return part


def _build_scheme_line(filler: Interpolator, row: SchemeRow) -> SchemeLine:
    """Return a criterion as the mark scheme prints it, with the first of its examples."""
    found = {
        section: _list_examples(filler, section, row.name)[:EXAMPLES_SHOWN]
        for section in ("accept", "half", "refuse")
    }
    idea = filler.sentence("points", row.name)
    return SchemeLine(
        row.name, row.points, idea, **found, follows=bool(row.follows), halves=row.halves
    )


def solution_step(filler: Interpolator, step: ChainStep) -> SolutionStep:
    """Return a step of the chain as the solution shows it."""
    formula = filler.drawn.template.chain.formulas.get(step.name, "")
    is_form = step.name in filler.drawn.template.chain.form_by_name
    sides = (form_sides if is_form else step_sides)(filler.drawn, step)
    return SolutionStep(
        join_sides(step.name, sides),
        filler.sentence("steps", step.name),
        formula,
        step.name,
        quantity_inlines(filler.drawn, step.name, filler.lang),
        sides,
        idea=filler.step_idea(step.name),
    )


def _build_derived_step(filler: Interpolator, step: DerivedStep) -> SolutionStep:
    """Return a line of a derivation as the solution shows it, with its points."""
    maths = TypesetMaths(lay_out(step.tree), format_tree(step.tree), filler.lang)
    return SolutionStep(maths, filler.sentence("steps", step.name), points=step.points)


def solved_misconceptions(
    filler: Interpolator, built: AskedPart[Any]
) -> Iterator[SolvedMisconception]:
    """Yield the misconceptions of a part with the answers that they give."""
    for trap, wrong in built.mistakes.items():
        spec = as_student_writes(wrong, built.spec.traps[trap])
        named = built.drawn or built.is_long
        shown = () if named else to_inlines(_show_wrong_answer(spec, filler.lang))
        worth = built.spec.worth if isinstance(built.spec, NumericSpec) else {}
        share = parse_written_number(worth.get(trap, 0))
        yield SolvedMisconception(trap, filler.sentence("traps", trap), shown, share)


def _show_wrong_answer(wrong: AnySpec, lang: str) -> TextOrInlines:
    """Return a wrong answer for print; nobody wants to see the exact value of a number."""
    if isinstance(wrong, ScalarSpec | VectorSpec):
        return show_key(wrong, lang)
    return KINDS[wrong.kind].explain_key(wrong, lang)


def _iter_wrong_options(
    filler: Interpolator, built: AskedPart[Any]
) -> Iterator[SolvedMisconception]:
    """Yield wrong options, pairs and steps with the reason."""
    right = {name for _, name in built.right}
    reasons = {name: filler.sentence("reasons", name) for _, name in built.reasons}
    known = [one for name in reasons if name in right for one in _split_sentences(reasons[name])]
    for mark, name in built.reasons:
        if name not in right:
            shown = next(iter(_list_examples(filler, "refuse", name)), mark)
            own = _drop_known_end(reasons[name], known)
            yield SolvedMisconception(name, reasons[name], (PlainText(shown),), own=own)


_SENTENCE_END = re.compile(r"(?<=[.!?।]) ")


def _split_sentences(told: tuple[Inline, ...]) -> list[list[Inline]]:
    """Return the sentences of a passage, without the blanks between them."""
    found: list[list[Inline]] = [[]]
    for is_text, run in groupby(told, key=lambda one: isinstance(one, PlainText)):
        if not is_text:
            found[-1] += run
            continue
        first, *others = _SENTENCE_END.split(inlines_to_text(tuple(run)))
        found[-1] += [PlainText(first)] if first else []
        found += [[PlainText(other)] if other else [] for other in others]
    return found


def _drop_known_end(told: tuple[Inline, ...], known: list[list[Inline]]) -> tuple[Inline, ...]:
    """Return a passage without the sentences at its end that are known; empty if all are."""
    sentences = _split_sentences(told)
    while sentences and sentences[-1] in known:
        sentences.pop()
    return tuple(
        one
        for number, sentence in enumerate(sentences)
        for one in ([PlainText(" "), *sentence] if number else sentence)
    )


def _format_citation(source: str) -> tuple[Inline, ...]:
    """Return a source in brackets, to end a sentence; nothing if there is none."""
    return (PlainText(f" [{source}]"),) if source else ()


def _build_right_option(filler: Interpolator, section: str, name: str) -> tuple[Inline, ...]:
    """Return a right option, and why it is right if that is written."""
    told = filler.sentence(section, name)
    if section == "options" and filler.text.sentence("reasons", name) is not None:
        return (*_drop_full_stop(told), PlainText(": "), *filler.sentence("reasons", name))
    return told


def _drop_full_stop(told: tuple[Inline, ...]) -> tuple[Inline, ...]:
    """Return a sentence without its full stop, to go on after a colon."""
    *most, last = told
    return (*most, PlainText(last.text.rstrip(".।"))) if isinstance(last, PlainText) else told


FIGURES = 9
"""Significant figures that tell float32 from float64."""


def precision_table(drawn: Variant, lang: str) -> tuple[Block, ...]:
    """Return what the template's chosen steps come to in float32, in float64 and exactly."""
    chosen = drawn.template.rules.precision
    if not chosen:
        return ()
    head = tuple((PlainText(translate(lang, f"precision.{name}")),) for name in ("way", "value"))
    rows = []
    for name in chosen:
        of = f"{name}: " if len(chosen) > 1 else ""
        for way, text in _iter_number_systems(drawn, name):
            rows.append(
                ((PlainText(f"{of}{translate(lang, f'precision.{way}')}"),), to_inlines(text))
            )
    return (TableBlock(head, tuple(rows)),)


def _iter_number_systems(drawn: Variant, name: str) -> Iterator[tuple[str, str]]:
    """Yield the name of each number system and the value that it gives, with its unit."""
    shown = drawn.template.units.get(name, "")
    yield "float32", _compute_with_rounding(drawn, name, shown, float32_system())
    yield "float64", _compute_with_rounding(drawn, name, shown, float64_system())
    yield "exact", join_unit(format_rounded(drawn.shown_values[name], figures=FIGURES), shown)


def _compute_with_rounding(drawn: Variant, name: str, shown: str, numbers: NumberSystem) -> str:
    """Return a quantity as floats give it, or a dash where they give nothing."""
    chain = drawn.template.chain
    env: dict[str, Any] = {
        n: map_numbers(lambda value: numbers.constant(to_fraction(value)), drawn.values[n])
        for n in chain.given
    }
    try:
        for step in chain.steps:
            env[step.name] = compile_expr(step.expr, numbers)(env)
        text = f"{env[name] / float(get_unit(shown).factor):.{FIGURES}g}"
    except (ZeroDivisionError, ValueError, OverflowError):
        return "-"
    return join_unit(text, shown)
