"""The parts of a question as interactions: the one model that all formats and the manifest share.

A learning management system knows numbers within an interval, options, pairs, an order and words.
An answer that is more than these becomes an extended text, which a person grades; it says why.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import singledispatch
from typing import ClassVar

from msgspec import structs

from quizgen.core.decoding import convert
from quizgen.grading.reading import bases
from quizgen.grading.spec import AnySpec, NumericSpec, ScalarSpec, is_whole_number
from quizgen.grading.spec import VectorSpec as SeveralNumbers
from quizgen.kinds import (
    angle,
    choice,
    code,
    gap,
    match,
    matrix,
    number,
    order,
    point,
    table,
    vector,
)
from quizgen.kinds import quantity as quantities
from quizgen.kinds.asking import KeyNumbers, rounding_hint
from quizgen.kinds.forms import ROUNDED
from quizgen.lms.answer_ranges import AnswerRange, WrongValue, disjoint_ranges
from quizgen.lms.manifest import InteractionKind
from quizgen.locale import translate
from quizgen.maths.constants import parse_exact
from quizgen.maths.notation import pretty
from quizgen.maths.numbers import count_decimals
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value
from quizgen.question.compose import QuestionPart
from quizgen.question.solution import PartSolution
from quizgen.typeset.prose import Inline, PlainText

# A sentence, or pieces of one.
FeedbackText = tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class NumericInteraction:
    """A number: the key's interval first, then those of misconceptions; no two meet.

    ``name`` stands before its field if a part has several, ``unit`` after it; ``precision`` says
    how exactly the number is meant.
    """

    kind: ClassVar[InteractionKind] = "number"
    name: str
    unit: str
    ranges: tuple[AnswerRange, ...]
    precision: str = ""

    @property
    def key(self) -> AnswerRange:
        """The interval that is right."""
        return self.ranges[0]


@dataclass(frozen=True, slots=True)
class ChoiceOption:
    """An option: its letter, its words, and the feedback to those who choose it."""

    letter: str
    words: FeedbackText
    right: bool
    feedback: FeedbackText = ()


@dataclass(frozen=True, slots=True)
class ChoiceInteraction:
    """One of several options, or with ``many`` any number of them."""

    options: tuple[ChoiceOption, ...]
    many: bool = False

    @property
    def kind(self) -> InteractionKind:
        """``many`` or ``one``."""
        return "many" if self.many else "one"

    @property
    def right(self) -> tuple[ChoiceOption, ...]:
        """The options to choose."""
        return tuple(option for option in self.options if option.right)


@dataclass(frozen=True, slots=True)
class TrueFalseInteraction:
    """A statement that is true or false, and why."""

    kind: ClassVar[InteractionKind] = "truth"
    true: bool
    feedback: FeedbackText = ()


@dataclass(frozen=True, slots=True)
class MatchInteraction:
    """A target for each stem; ``feedback`` says by stem and target why they do not match."""

    kind: ClassVar[InteractionKind] = "pairs"
    stems: tuple[tuple[str, FeedbackText], ...]
    targets: tuple[tuple[str, FeedbackText], ...]
    right: Mapping[str, str]
    feedback: Mapping[tuple[str, str], FeedbackText]


@dataclass(frozen=True, slots=True)
class OrderInteraction:
    """Steps, and the letters of those that belong to the order, in the one order that is right."""

    kind: ClassVar[InteractionKind] = "order"
    steps: tuple[tuple[str, FeedbackText], ...]
    right: tuple[str, ...]

    @property
    def is_complete(self) -> bool:
        """Whether every step belongs to the order."""
        return len(self.steps) == len(self.right)


@dataclass(frozen=True, slots=True)
class TextEntryInteraction:
    """Words: those that are right, the first one shown, and wrong ones with their feedback.

    What a program prints (``printed``) must match in upper and lower case.
    """

    kind: ClassVar[InteractionKind] = "words"
    right: tuple[str, ...]
    wrong: tuple[tuple[str, FeedbackText], ...] = ()
    printed: bool = False


@dataclass(frozen=True, slots=True)
class ExtendedTextInteraction:
    """An answer that a person grades: why, in a word of the export's report, and the key."""

    kind: ClassVar[InteractionKind] = "written"
    why: str
    key: FeedbackText
    lines: int = 1


Interaction = (
    NumericInteraction
    | ChoiceInteraction
    | TrueFalseInteraction
    | MatchInteraction
    | OrderInteraction
    | TextEntryInteraction
    | ExtendedTextInteraction
)

# A part of a question with what it asks.
PartInteractions = tuple[QuestionPart, tuple[Interaction, ...]]

# The place of a step that does not belong to the order.
NO_PLACE = "-"


def needs_manual_grading(interactions: Iterable[Interaction]) -> bool:
    """Whether a part that asks this is graded by a person."""
    return any(isinstance(one, ExtendedTextInteraction) for one in interactions)


def order_as_match(interaction: MatchInteraction | OrderInteraction, lang: str) -> MatchInteraction:
    """Return an order as the place of each step, or a match as it is."""
    if isinstance(interaction, MatchInteraction):
        return interaction
    places = {letter: str(place) for place, letter in enumerate(interaction.right, 1)}
    right = {letter: places.get(letter, NO_PLACE) for letter, _ in interaction.steps}
    targets = [(place, (PlainText(place),)) for place in places.values()]
    if NO_PLACE in right.values():
        targets.append((NO_PLACE, (PlainText(translate(lang, "export.no_step")),)))
    return MatchInteraction(interaction.steps, tuple(targets), right, {})


@dataclass(frozen=True, slots=True)
class SolvedPart:
    """A part with its solution in a language."""

    part: QuestionPart
    solution: PartSolution
    lang: str

    @property
    def mistakes(self) -> Mapping[str, FeedbackText]:
        """Feedback on each misconception, by its name."""
        return {mistake.name: mistake.sentence for mistake in self.solution.mistakes}

    @property
    def reasons(self) -> Mapping[str, FeedbackText]:
        """Feedback on each wrong option, pair or word, by its letter."""
        return {reason.value: reason.sentence for reason in self.solution.reasons}

    def as_manual(self, why: str) -> ExtendedTextInteraction:
        """Return the part as one that a person grades."""
        lines = max(self.part.field.control.lines, 1)
        key = self.solution.shown or tuple(_join_sentences(self.solution.options))
        return ExtendedTextInteraction(why, key, lines)


def _join_sentences(options: tuple[FeedbackText, ...]) -> Iterator[Inline]:
    """Yield sentences one after another, with a blank between two."""
    for place, option in enumerate(options):
        yield from ((PlainText(" "),) if place else ())
        yield from option


def part_interactions(
    part: QuestionPart, spec: AnySpec, solution: PartSolution, lang: str
) -> tuple[Interaction, ...]:
    """Return what a part asks, one interaction for each field.

    Parameters
    ----------
    part : QuestionPart
    spec : AnySpec
        What it is graded by.
    solution : PartSolution
        In the same language.
    lang : str

    Returns
    -------
    tuple of Interaction
        One ``ExtendedTextInteraction`` if no system could grade it as we do.
    """
    return _interactions_of(spec, SolvedPart(part, solution, lang))


@singledispatch
def _interactions_of(spec: AnySpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return the interactions of a part; of a kind without its own rule one graded manually."""
    return (solved.as_manual(spec.kind),)


@_interactions_of.register
def _number_interactions(spec: number.NumberSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a numeric interaction; a fraction is graded manually."""
    if spec.form in {"fraction", "lowest"}:
        return (solved.as_manual("fraction"),)
    if spec.base != bases.TEN:
        wrong = tuple(
            (bases.format_in_base(int(value.p), spec.base), solved.mistakes.get(name, ()))
            for name, value in spec.trap_values(1)
            if is_whole_number(value)
        )
        return (TextEntryInteraction((spec.show(),), wrong),)
    unit = "%" if spec.percent else spec.unit
    return _numeric_interaction(spec, solved, unit, 100 if spec.percent else 1)


@_interactions_of.register
def _quantity_interactions(
    spec: quantities.QuantitySpec, solved: SolvedPart
) -> tuple[Interaction, ...]:
    """Return a numeric interaction in the unit of the key."""
    return _numeric_interaction(spec, solved, spec.unit)


@_interactions_of.register
def _angle_interactions(spec: angle.AngleSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a numeric interaction in degrees that also accepts the key a period away."""
    return _numeric_interaction(spec, solved, "°", period=parse_exact(spec.period))


def _numeric_interaction(
    spec: ScalarSpec, solved: SolvedPart, unit: str, scale: int = 1, period: Value | None = None
) -> tuple[Interaction, ...]:
    """Return one numeric interaction with intervals of the key and misconceptions.

    ``scale`` multiplies all values (100 for percent). An exact key without a finite decimal is
    graded manually: it could not be typed.
    """
    key = parse_exact(spec.value) * scale
    if spec.exact and not _has_finite_decimal(key):
        return (solved.as_manual("fraction"),)
    feedback = solved.mistakes
    wrong = [
        WrongValue(value, feedback.get(name, ()), _find_share(spec, name))
        for name, value in spec.trap_values(scale)
    ]
    precision = _precision_text(spec, spec.value, solved.lang)
    return (NumericInteraction("", unit, disjoint_ranges(spec, key, wrong, period), precision),)


def _find_share(spec: NumericSpec, mistake: str) -> float:
    """Return the share of the points that a known mistake still earns."""
    return float(parse_exact(spec.worth.get(mistake, 0)))


def _precision_text(spec: NumericSpec, key: KeyNumbers, lang: str) -> str:
    """Return how exactly a number is meant, since systems take it only as a decimal."""
    rule, number = spec.stated_rule or ("", "")
    if rule == "exact":
        return translate(lang, "export.exact")
    if rule == "abs":
        return translate(lang, "export.abs", abs=pretty.format_number(str(number)))
    return rounding_hint(spec, key, lang)


def _has_finite_decimal(key: Value) -> bool:
    """Return whether an exact value can be typed as a decimal."""
    from flint import fmpq

    return isinstance(key, fmpq) and count_decimals(key) is not None


@_interactions_of.register
def _point_interactions(spec: point.PointSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a numeric interaction for each coordinate.

    A point up to scale is graded manually: no interval tells whether its coordinates agree.
    """
    if spec.up_to_scale:
        return (solved.as_manual("scale"),)
    return _numeric_interactions(
        spec, solved, [box.name for box in solved.part.field.control.boxes]
    )


def _numeric_interactions(
    spec: SeveralNumbers, solved: SolvedPart, names: list[str]
) -> tuple[Interaction, ...]:
    """Return a numeric interaction for each value of a key, named by ``names``."""
    feedback = solved.mistakes
    found: list[Interaction] = []
    for place, key in enumerate(spec.keys()):
        if spec.exact and not _has_finite_decimal(key):
            return (solved.as_manual("fraction"),)
        wrong = [
            WrongValue(parse_exact(values[place]), feedback.get(name, ()), _find_share(spec, name))
            for name, values in spec.traps.items()
        ]
        name = names[place] if place < len(names) else ""
        precision = _precision_text(spec, spec.values, solved.lang)
        found.append(
            NumericInteraction(name, spec.unit, disjoint_ranges(spec, key, wrong), precision)
        )
    return tuple(found)


@_interactions_of.register
def _vector_interactions(spec: vector.ColumnSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a numeric interaction for each component; any multiple is graded manually."""
    if spec.up_to:
        return (solved.as_manual("scale"),)
    return _entry_interactions(spec, solved, [spec.components], [[""] * len(spec.components)])


@_interactions_of.register
def _matrix_interactions(spec: matrix.MatrixSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a numeric interaction for each entry, row by row, named by its row and column."""
    rows = range(1, len(spec.entries) + 1)
    columns = range(1, len(spec.entries[0]) + 1)
    names = [[f"a_{row}{column}" for column in columns] for row in rows]
    return _entry_interactions(spec, solved, spec.entries, names)


def _entry_interactions(
    spec: matrix.MatrixSpec | vector.ColumnSpec,
    solved: SolvedPart,
    entries: matrix.Entries,
    names: list[list[str]],
) -> tuple[Interaction, ...]:
    """Return a numeric interaction for each entry; complex ones are graded manually.

    Without a rule an entry may be rounded where it has no finite decimal, as in grading.
    """
    found: list[Interaction] = []
    for r, row in enumerate(entries):
        for c, entry in enumerate(row):
            wrong = _list_wrong_entries(spec, solved, (r, c))
            if isinstance(entry, list):
                return (solved.as_manual(spec.kind),)
            key = parse_exact(entry)
            default = {"exact": True} if _has_finite_decimal(key) else {"rel": str(ROUNDED)}
            rule = convert(spec.stated_rule() or default, Tolerance)
            precision = rounding_hint(rule, [entry], solved.lang) if spec.stated_rule() else ""
            ranges = disjoint_ranges(rule, key, wrong)
            found.append(NumericInteraction(names[r][c], spec.unit, ranges, precision))
    return tuple(found)


def _list_wrong_entries(
    spec: matrix.MatrixSpec | vector.ColumnSpec, solved: SolvedPart, place: tuple[int, int]
) -> list[WrongValue]:
    """Return what each mistake makes of the entry at a row and column, if it has one there."""
    found = []
    for name, trap in spec.traps.items():
        rows = [trap] if isinstance(spec, vector.ColumnSpec) else trap
        with suppress(IndexError):
            entry = rows[place[0]][place[1]]
            if isinstance(entry, str):
                found.append(WrongValue(parse_exact(entry), solved.mistakes.get(name, ()), 0.0))
    return found


@_interactions_of.register
def _table_interactions(spec: table.TableSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return an interaction for each cell; all is graded manually if one cell must be."""
    found: list[Interaction] = []
    for name in spec.values:
        cell = table.cell_spec(spec, name)
        worth = {mistake: spec.worth[mistake] for mistake in spec.worth if mistake in cell.traps}
        (one,) = _interactions_of(structs.replace(cell, worth=worth), solved)
        if isinstance(one, ExtendedTextInteraction):
            return (one,)
        found.append(replace(one, name=name) if isinstance(one, NumericInteraction) else one)
    return tuple(found)


@_interactions_of.register
def _choice_interactions(spec: choice.ChoiceSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a choice, or for ``tf`` a statement that is true or false."""
    if spec.kind == "tf":
        why = solved.solution.options
        return (TrueFalseInteraction(spec.correct == [1], why[0] if why else ()),)
    feedback = solved.reasons
    options = tuple(
        ChoiceOption(mark, words, place in spec.correct, feedback.get(mark, ()))
        for place, (mark, words) in enumerate(solved.part.field.options, 1)
    )
    return (ChoiceInteraction(options, spec.kind == "multi"),)


@_interactions_of.register
def _match_interactions(spec: match.MatchSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a match with its feedback on each wrong pair."""
    field, reasons = solved.part.field, solved.reasons
    feedback = {
        (left, right): reasons.get(f"{left}{right}", reasons.get(left, ()))
        for left in spec.pairs
        for right, _ in field.targets
        if spec.pairs[left] != right
    }
    return (MatchInteraction(field.options, field.targets, spec.pairs, feedback),)


@_interactions_of.register
def _order_interactions(spec: order.OrderSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return an order; one with several right orders is graded manually."""
    if spec.before and not _has_one_order(spec):
        return (solved.as_manual("orders"),)
    return (OrderInteraction(solved.part.field.options, tuple(spec.steps)),)


def _has_one_order(spec: order.OrderSpec) -> bool:
    """Return whether the constraints between steps leave only one order."""
    then = order.later_steps(spec)
    row = zip(spec.steps, spec.steps[1:], strict=False)
    return all(later in then[earlier] for earlier, later in row)


@_interactions_of.register
def _gap_interactions(spec: gap.GapSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a text entry for each gap, with feedback on the wrong words that have some."""
    wrong: dict[str, list[tuple[str, FeedbackText]]] = {}
    for mark, sentence in solved.reasons.items():
        place, _, term = mark.removeprefix("(").partition(") ")
        wrong.setdefault(place, []).append((term, sentence))
    return tuple(
        TextEntryInteraction(tuple(words), tuple(wrong.get(str(place), ())))
        for place, words in enumerate(spec.gaps(), 1)
    )


@_interactions_of.register
def _code_interactions(spec: code.CodeSpec, solved: SolvedPart) -> tuple[Interaction, ...]:
    """Return a text entry for a program's output; several lines are graded manually."""
    outputs = (spec.output, *spec.also)
    if any("\n" in output for output in outputs):
        return (solved.as_manual("lines"),)
    feedback = solved.mistakes
    wrong = tuple((typed, feedback.get(name, ())) for name, typed in spec.traps.items())
    return (TextEntryInteraction(tuple(_output_spellings(outputs)), wrong, printed=True),)


def _output_spellings(outputs: Iterable[str]) -> Iterator[str]:
    """Yield each output, and the same without blanks after commas."""
    for output in outputs:
        yield from dict.fromkeys((output, output.replace(", ", ",")))
