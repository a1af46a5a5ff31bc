"""The parts of a question as systems for courses take them: what is asked, and what is said.

Such a system knows numbers with an interval, options, pairs, an order and words. Whatever is more
is written by the student and marked by a person; it is told why.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import singledispatch

from quizgen.bank.markdown import Inline, PlainText
from quizgen.export.ranges import Near, Range, ranges
from quizgen.grading.spec import AnySpec, NumericSpec, ScalarSpec
from quizgen.grading.spec import VectorSpec as SeveralNumbers
from quizgen.kinds import angle, choice, code, gap, match, number, order, point, table
from quizgen.kinds import quantity as quantities
from quizgen.kinds.asking import KeyNumbers, rounding_hint
from quizgen.locale import translate
from quizgen.maths.constants import parse_exact
from quizgen.maths.notation import pretty
from quizgen.maths.numbers import count_decimals
from quizgen.maths.values import Value
from quizgen.question.compose import QuestionPart
from quizgen.question.solution import PartSolution

Said = tuple[Inline, ...]
"""A sentence, or pieces of one."""


@dataclass(frozen=True, slots=True)
class Numeric:
    """A number: the key's interval first, then those of known mistakes; no two meet.

    ``name`` stands before its field where there are several, ``unit`` behind it; ``precision``
    says how exactly it is meant.
    """

    name: str
    unit: str
    ranges: tuple[Range, ...]
    precision: str = ""

    @property
    def key(self) -> Range:
        """What is right."""
        return self.ranges[0]


@dataclass(frozen=True, slots=True)
class Option:
    """Something to choose: its letter, its words, and what is said to whoever chooses it."""

    mark: str
    words: Said
    right: bool
    said: Said = ()


@dataclass(frozen=True, slots=True)
class Choose:
    """One of several options, or with ``many`` any number of them."""

    options: tuple[Option, ...]
    many: bool = False

    @property
    def right(self) -> tuple[Option, ...]:
        """What is to be chosen."""
        return tuple(option for option in self.options if option.right)


@dataclass(frozen=True, slots=True)
class Truth:
    """A statement that is true or false, and why."""

    true: bool
    said: Said = ()


@dataclass(frozen=True, slots=True)
class Pairs:
    """A target for each stem; ``said`` tells by stem and target why they do not belong together."""

    stems: tuple[tuple[str, Said], ...]
    targets: tuple[tuple[str, Said], ...]
    right: Mapping[str, str]
    said: Mapping[tuple[str, str], Said]


@dataclass(frozen=True, slots=True)
class Order:
    """Steps, and their marks in the one order that is right; a step may have no place in it."""

    steps: tuple[tuple[str, Said], ...]
    right: tuple[str, ...]

    @property
    def whole(self) -> bool:
        """Whether every step has its place."""
        return len(self.steps) == len(self.right)


@dataclass(frozen=True, slots=True)
class Fill:
    """Words: those that are right, the first one shown, and wrong ones with what is said.

    What a program prints is meant to the letter (``printed``).
    """

    right: tuple[str, ...]
    wrong: tuple[tuple[str, Said], ...] = ()
    printed: bool = False


@dataclass(frozen=True, slots=True)
class Write:
    """What a person marks: why, in a word of the report, and the key."""

    why: str
    key: Said
    lines: int = 1


NOWHERE = "-"
"""The place of a step that belongs to no place."""

Ask = Numeric | Choose | Truth | Pairs | Order | Fill | Write


def by_person(found: Iterable[Ask]) -> bool:
    """Whether a part that asks this is marked by a person."""
    return any(isinstance(ask, Write) for ask in found)


def as_pairs(ask: Pairs | Order, lang: str) -> Pairs:
    """An order as the place of each step, where a step may have none."""
    if isinstance(ask, Pairs):
        return ask
    places = {mark: str(place) for place, mark in enumerate(ask.right, 1)}
    right = {mark: places.get(mark, NOWHERE) for mark, _ in ask.steps}
    targets = [(place, (PlainText(place),)) for place in places.values()]
    if NOWHERE in right.values():
        targets.append((NOWHERE, (PlainText(translate(lang, "export.no_step")),)))
    return Pairs(ask.steps, tuple(targets), right, {})


@dataclass(frozen=True, slots=True)
class Asked:
    """A part with its solution, as far as its asks need them."""

    part: QuestionPart
    solved: PartSolution
    lang: str

    @property
    def mistakes(self) -> Mapping[str, Said]:
        """What is said of each known mistake."""
        return {mistake.name: mistake.sentence for mistake in self.solved.mistakes}

    @property
    def reasons(self) -> Mapping[str, Said]:
        """What is said of each wrong option, pair or word, by its mark."""
        return {reason.value: reason.sentence for reason in self.solved.reasons}

    def written(self, why: str) -> Write:
        """The part as one that a person marks."""
        lines = max(self.part.field.control.lines, 1)
        key = self.solved.shown or tuple(_sentences(self.solved.options))
        return Write(why, key, lines)


def _sentences(options: tuple[Said, ...]) -> Iterator[Inline]:
    for place, option in enumerate(options):
        yield from ((PlainText(" "),) if place else ())
        yield from option


def asks(part: QuestionPart, spec: AnySpec, solved: PartSolution, lang: str) -> tuple[Ask, ...]:
    """What a part asks, one for each field.

    Parameters
    ----------
    part : Part
    spec : Spec
        What it is marked by.
    solved : PartSolution
        Its solution in the same language.
    lang : str

    Returns
    -------
    tuple of Ask
        One ``Write`` where no system could mark it as we do.
    """
    return _asks(spec, Asked(part, solved, lang))


@singledispatch
def _asks(spec: AnySpec, asked: Asked) -> tuple[Ask, ...]:
    return (asked.written(spec.kind),)


@_asks.register
def _number(spec: number.NumberSpec, asked: Asked) -> tuple[Ask, ...]:
    if spec.form in {"fraction", "lowest"}:
        return (asked.written("fraction"),)
    unit = "%" if spec.percent else spec.unit
    return _measured(spec, asked, unit, 100 if spec.percent else 1)


@_asks.register
def _quantity(spec: quantities.QuantitySpec, asked: Asked) -> tuple[Ask, ...]:
    return _measured(spec, asked, spec.unit)


@_asks.register
def _angle(spec: angle.AngleSpec, asked: Asked) -> tuple[Ask, ...]:
    return _measured(spec, asked, "°", period=parse_exact(spec.period))


def _measured(
    spec: ScalarSpec, asked: Asked, unit: str, scale: int = 1, period: Value | None = None
) -> tuple[Ask, ...]:
    key = parse_exact(spec.value) * scale
    if spec.exact and not _finite(key):
        return (asked.written("fraction"),)
    said = asked.mistakes
    wrong = [Near(value, said.get(name, ())) for name, value in spec.trap_values(scale)]
    told = _precision(spec, spec.value, asked.lang)
    return (Numeric("", unit, ranges(spec, key, wrong, period), told),)


def _precision(spec: NumericSpec, key: KeyNumbers, lang: str) -> str:
    """How exactly a number is meant that can only be typed as a decimal."""
    rule, number = spec.stated or ("", "")
    if rule == "exact":
        return translate(lang, "export.exact")
    if rule == "abs":
        return translate(lang, "export.abs", abs=pretty.format_number(str(number)))
    return rounding_hint(spec, key, lang)


def _finite(key: Value) -> bool:
    """Whether a key can be typed as a decimal."""
    from flint import fmpq

    return isinstance(key, fmpq) and count_decimals(key) is not None


@_asks.register
def _point(spec: point.PointSpec, asked: Asked) -> tuple[Ask, ...]:
    if spec.up_to_scale:
        return (asked.written("scale"),)
    return _several(spec, asked, [box.name for box in asked.part.field.control.boxes])


def _several(spec: SeveralNumbers, asked: Asked, names: list[str]) -> tuple[Ask, ...]:
    said = asked.mistakes
    found: list[Ask] = []
    for place, key in enumerate(spec.keys()):
        if spec.exact and not _finite(key):
            return (asked.written("fraction"),)
        wrong = [
            Near(parse_exact(values[place]), said.get(name, ()))
            for name, values in spec.traps.items()
        ]
        name = names[place] if place < len(names) else ""
        told = _precision(spec, spec.values, asked.lang)
        found.append(Numeric(name, spec.unit, ranges(spec, key, wrong), told))
    return tuple(found)


@_asks.register
def _table(spec: table.TableSpec, asked: Asked) -> tuple[Ask, ...]:
    found: list[Ask] = []
    for name in spec.values:
        cell = table.cell_spec(spec, name)
        (one,) = _asks(cell, asked)
        if isinstance(one, Write):
            return (one,)
        found.append(replace(one, name=name) if isinstance(one, Numeric) else one)
    return tuple(found)


@_asks.register
def _choice(spec: choice.ChoiceSpec, asked: Asked) -> tuple[Ask, ...]:
    if spec.kind == "tf":
        told = asked.solved.options
        return (Truth(spec.correct == [1], told[0] if told else ()),)
    said = asked.reasons
    options = tuple(
        Option(mark, words, place in spec.correct, said.get(mark, ()))
        for place, (mark, words) in enumerate(asked.part.field.options, 1)
    )
    return (Choose(options, spec.kind == "multi"),)


@_asks.register
def _match(spec: match.MatchSpec, asked: Asked) -> tuple[Ask, ...]:
    field, reasons = asked.part.field, asked.reasons
    said = {
        (left, right): reasons.get(f"{left}{right}", reasons.get(left, ()))
        for left in spec.pairs
        for right, _ in field.targets
        if spec.pairs[left] != right
    }
    return (Pairs(field.options, field.targets, spec.pairs, said),)


@_asks.register
def _order(spec: order.OrderSpec, asked: Asked) -> tuple[Ask, ...]:
    if spec.before and not _one_way(spec):
        return (asked.written("orders"),)
    return (Order(asked.part.field.options, tuple(spec.steps)),)


def _one_way(spec: order.OrderSpec) -> bool:
    """Whether only one order keeps to what must come before what."""
    then = order.later_steps(spec)
    row = zip(spec.steps, spec.steps[1:], strict=False)
    return all(later in then[earlier] for earlier, later in row)


@_asks.register
def _gap(spec: gap.GapSpec, asked: Asked) -> tuple[Ask, ...]:
    wrong: dict[str, list[tuple[str, Said]]] = {}
    for mark, sentence in asked.reasons.items():
        place, _, term = mark.removeprefix("(").partition(") ")
        wrong.setdefault(place, []).append((term, sentence))
    return tuple(
        Fill(tuple(words), tuple(wrong.get(str(place), ())))
        for place, words in enumerate(spec.gaps(), 1)
    )


@_asks.register
def _code(spec: code.CodeSpec, asked: Asked) -> tuple[Ask, ...]:
    outputs = (spec.output, *spec.also)
    if any("\n" in output for output in outputs):
        return (asked.written("lines"),)
    said = asked.mistakes
    wrong = tuple((typed, said.get(name, ())) for name, typed in spec.traps.items())
    return (Fill(tuple(_set(outputs)), wrong, printed=True),)


def _set(outputs: Iterable[str]) -> Iterator[str]:
    """Outputs, and the same without blanks behind commas."""
    for output in outputs:
        yield from dict.fromkeys((output, output.replace(", ", ",")))
