"""Kind ``point``: two or more coordinates, possibly homogeneous (up to scale)."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, ClassVar

import msgspec
from flint import fmpq

from quizgen.grading.diagnosis.carry_forward import CARRIED, diagnosis_for
from quizgen.grading.diagnosis.numeric_slips import agrees_within_half_percent, find_common_slip
from quizgen.grading.judging.numeric import (
    NumberTarget,
    are_groups_meant,
    choose_reading,
    judge_value,
)
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.count_nouns import check_count_nouns, count_noun_unit, drop_count_noun
from quizgen.grading.reading.equalities import read_items
from quizgen.grading.reading.labels import AskedNames, are_counted_off, reorder_by_name
from quizgen.grading.reading.lists import read_list
from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.reading.quantities import split_quantity
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import TypedUnit
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import (
    COUNTED,
    VectorSpec,
    all_match_misconception,
    all_match_target,
    is_large_count,
)
from quizgen.grading.verdict import (
    Verdict,
    attach_values,
    correct,
    partial,
    verdict_by_share,
    wrong,
)
from quizgen.kinds.asking import (
    accept_within_tolerance,
    ask_numeric,
    numeric_hints,
    precision_on_paper,
    show_exact_first,
    unit_hint,
)
from quizgen.kinds.contract import (
    MOST_OPTIONS,
    AnswerKind,
    AskedPart,
    AuthoredNumeric,
    InputBox,
    InputControl,
    PartContext,
    asked_quantities,
)
from quizgen.locale import translate
from quizgen.maths.constants import parse_exact
from quizgen.maths.notation import pretty
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value


class AuthoredPoint(AuthoredNumeric, tag="point", frozen=True):
    """Coordinates."""

    least, most = 2, MOST_OPTIONS
    names: tuple[str, ...] = ()
    unit: str = ""
    counts: str | tuple[str, ...] = ()
    up_to_scale: bool = False


class PointSpec(VectorSpec, kw_only=True, frozen=True):
    """Point: ``values``; ``names`` of the coordinates; ``unit`` of all; ``up_to_scale``.

    ``counts`` are a unit or words for what each coordinate counts, which may be typed.
    """

    written_as: ClassVar[AnswerForm] = "values"

    names: list[str] = msgspec.field(default_factory=list)
    counts: list[str] = msgspec.field(default_factory=list)
    up_to_scale: bool = False
    called: dict[str, list[str]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check tolerance, coordinates, unit and traps."""
        super().validate()
        check_count_nouns(self.counts)
        if not self.values or (self.names and len(self.names) != len(self.values)):
            raise ValueError("values must not be empty, names as many as values")
        if any(len(trap) != len(self.values) for trap in self.traps.values()):
            raise ValueError("a trap needs as many values as the point")

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on typed coordinates, with the verdicts of each.

        Raises
        ------
        FormulaReadError
            If one cannot be read, or there are too many, too few or other names than asked for.
        """
        items, tail = read_list(typed, len(self.values), options.decimal)
        counted = not self.names and are_counted_off(items)
        items = reorder_by_name(items, () if counted else self.value_names())
        items = [drop_count_noun(item, self.counts) for item in items]
        unit, asked = _unit(tail), self.unit or count_noun_unit(self.counts)
        first, second, doubt = read_items(items, asked, unit, options.decimal)
        verdict = _judge(self, first, options)
        if second is None or doubt is None:
            return verdict
        other = _judge(self, second, options)
        twofold = [i for i, (a, b) in enumerate(zip(first, second, strict=True)) if a != b]
        if doubt.native and all(_right(verdict, place) for place in twofold):
            return verdict
        whole = (self.counts or self.unit in COUNTED) and all(map(is_large_count, self.keys()))
        if whole and are_groups_meant(verdict, other):
            return other
        if not (doubt.group_wins or any(_right(other, place) for place in twofold)):
            return verdict
        return choose_reading(verdict, other, doubt, (_echo(self, first), _echo(self, second)))

    def value_names(self) -> AskedNames:
        """Return the authored names, else those that the chain has for the coordinates."""
        return {n: self.called.get(n, ()) for n in self.names or self.quantities()}

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        inside = "; ".join(pretty.format_number(format_key(self, key)) for key in self.keys())
        return f"({inside}) {format_unit(self.unit)}".rstrip()


def _right(verdict: Verdict, place: int) -> bool:
    """Return whether a coordinate is right."""
    cells = verdict.cells
    return bool(cells[place].credit) if cells else bool(verdict.credit)


def _unit(tail: SourceText) -> TypedUnit | None:
    """Return the unit behind the closing bracket; None if there is none."""
    if not tail.text:
        return None
    quantity = split_quantity(SourceText(f"1 {tail.text}", (1, 1, *tail.columns)))
    return quantity.unit


def _echo(spec: PointSpec, numbers: list[ReadNumber]) -> str:
    """Return the coordinates as read, with the unit behind them."""
    inside = "; ".join(number.read_as for number in numbers)
    return f"({inside}) {format_unit(spec.unit)}".rstrip()


def _judge(spec: PointSpec, numbers: list[ReadNumber], options: GradingOptions) -> Verdict:
    """Return the verdict on one reading of all coordinates."""
    values = [number.value for number in numbers]
    read_as = _echo(spec, numbers)
    keys = spec.keys()
    if spec.up_to_scale:
        return _up_to_scale(spec, values, keys, read_as)
    return attach_values(_coordinates(spec, numbers, keys, read_as, options), *values)


def _up_to_scale(spec: PointSpec, values: list[Value], keys: list[Value], read_as: str) -> Verdict:
    """Return the verdict on homogeneous coordinates, scaled to the key's largest.

    All zero is no point.
    """
    if all(value == 0 for value in values):
        return wrong(read_as, "all-zero")
    largest = max(range(len(keys)), key=lambda i: abs(float(keys[i])))
    if values[largest] == 0:
        return wrong(read_as)
    scale = keys[largest] / values[largest]
    right = all(spec.accepts(v * scale, k) for v, k in zip(values, keys, strict=True))
    return correct(read_as) if right else wrong(read_as)


def _coordinates(
    spec: PointSpec,
    numbers: list[ReadNumber],
    keys: list[Value],
    read_as: str,
    options: GradingOptions,
) -> Verdict:
    """Return the verdict on coordinates, each judged as a number; a known mistake gives all."""
    cells = tuple(_cell(spec, i, numbers[i], keys[i], options) for i in range(len(keys)))
    if all(cell.credit == 1 for cell in cells):
        carried = any(cell.note == CARRIED for cell in cells)
        if carried:
            return partial(Fraction(1), read_as, CARRIED)
        return correct(read_as)
    trap = _trap(spec, numbers)
    if trap:
        told = verdict_by_share(_credit(keys, cells), read_as, f"trap:{trap}")
        return msgspec.structs.replace(told, cells=cells)
    return msgspec.structs.replace(_hint(spec, numbers, keys, cells, read_as), cells=cells)


def _cell(
    spec: PointSpec, index: int, number: ReadNumber, key: Value, options: GradingOptions
) -> Verdict:
    """Return the verdict on one coordinate, with errors carried forward in its quantity."""
    target = spec.quantities()[index] if len(spec.of) == len(spec.values) else ""
    hints = diagnosis_for(spec, number, fmpq(1), options, target) if target else None
    return judge_value(NumberTarget(spec, key, hints=hints), number, number.value)


def _trap(spec: PointSpec, numbers: list[ReadNumber]) -> str:
    """Return the mistake that gives the numbers, the nearest of several; empty if none."""
    wanted = {name: list(map(parse_exact, values)) for name, values in spec.traps.items()}
    found = [
        name for name, values in wanted.items() if all_match_misconception(spec, numbers, values)
    ]
    return min(found, key=lambda name: _distance(numbers, wanted[name]), default="")


def _distance(numbers: list[ReadNumber], values: list[Value]) -> float:
    """Return the sum of the distances of the coordinates from a mistake's."""
    return sum(
        abs(float(number.value) - float(value))
        for number, value in zip(numbers, values, strict=True)
    )


def _hint(
    spec: PointSpec,
    numbers: list[ReadNumber],
    keys: list[Value],
    cells: tuple[Verdict, ...],
    read_as: str,
) -> Verdict:
    """Return a verdict that names swapped axes, signs, or which coordinate is wrong."""
    values = [number.value for number in numbers]
    if _are_swapped(spec, numbers, keys, cells):
        return wrong(read_as, "swapped")
    missed = [i for i, cell in enumerate(cells) if cell.credit < 1]
    note, fields = "coordinate", dict[str, object]()
    if all(keys[i] != 0 and agrees_within_half_percent(-values[i], keys[i]) for i in missed):
        note = "coordinate-sign"
    elif len(missed) == len(cells):
        note, fields = find_common_slip(cells)
    return verdict_by_share(
        _credit(keys, cells), read_as, note, names=_names(spec, missed), **fields
    )


def _are_swapped(
    spec: PointSpec, numbers: list[ReadNumber], keys: list[Value], cells: tuple[Verdict, ...]
) -> bool:
    """Return whether the coordinates stand the other way round, and none that moved is right."""
    moved = [
        cell
        for cell, here, there in zip(cells, spec.values, spec.values[::-1], strict=True)
        if str(here) != str(there)
    ]
    right = any(cell.credit for cell in moved)
    return bool(moved) and not right and all_match_target(spec, numbers, keys[::-1])


def _credit(keys: list[Value], cells: tuple[Verdict, ...]) -> Fraction:
    """Return the share of right coordinates; a zero in the key earns nothing by itself."""
    counted = [cell.credit for key, cell in zip(keys, cells, strict=True) if key != 0]
    if counted and all(credit == 1 for credit in counted):
        return Fraction(len(counted), len(cells))
    return sum(counted, Fraction(0)) / len(counted) if counted else Fraction(0)


def _names(spec: PointSpec, missed: list[int]) -> tuple[str, ...]:
    """Return the names of coordinates, or their numbers from 1."""
    names = spec.names or [str(i + 1) for i in range(len(spec.values))]
    return tuple(names[i] for i in missed)


def ask(part: PartContext) -> AskedPart[PointSpec]:
    """Return the coordinates, and those that each mistake gives."""
    of = asked_quantities(part.answer)
    called = part.value_words(dict(zip(part.answer.get("names") or of, of, strict=True)))
    said: dict[str, Any] = {"called": called} if called else {}
    asked = ask_numeric(PointSpec, part, **said)
    boxes = tuple(InputBox("", asked.spec.unit) for _ in asked.spec.values)
    return msgspec.structs.replace(asked, control=InputControl("line", boxes=boxes))


def input_hints(spec: PointSpec, lang: str) -> tuple[str, ...]:
    """Return the sentences on shape, unit and rounding."""
    shape = translate(lang, "ask.point3" if len(spec.values) > len(("x", "y")) else "ask.point")
    return numeric_hints(spec, lang, shape, unit_hint(spec.unit, lang))


KIND = AnswerKind(
    AuthoredPoint,
    PointSpec,
    ask,
    input_hints,
    show_exact_first,
    precision_on_paper,
    accept_within_tolerance,
)
