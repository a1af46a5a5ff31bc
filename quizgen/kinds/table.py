"""Kind ``table``: several named numbers, each judged as a number, quantity or angle."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

import msgspec
from msgspec.structs import replace

from quizgen.core.decoding import convert
from quizgen.grading.diagnosis.numeric_slips import find_common_slip
from quizgen.grading.judge import show_spec
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm, list_plainer_texts
from quizgen.grading.reading.labels import AskedNames, place_by_name
from quizgen.grading.reading.lists import read_list
from quizgen.grading.reading.numbers import relocate_error
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.spec import NumericSpec, decode_spec
from quizgen.grading.verdict import (
    Verdict,
    ambiguous,
    attach_values,
    correct,
    partial,
    verdict_by_share,
    wrong,
)
from quizgen.kinds import angle, number, quantity
from quizgen.kinds.asking import (
    accept_within_tolerance,
    ask_numeric,
    explain_assigned,
    nonempty,
    precision_on_paper,
    rounding_hint,
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
from quizgen.maths.constants import Scalar
from quizgen.maths.notation import FormulaReadError, pretty
from quizgen.maths.numbers import format_for_key
from quizgen.maths.tolerance import RULES
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import Inline, TextOrInlines

Cell = number.NumberSpec | quantity.QuantitySpec | angle.AngleSpec

CELLS: dict[str, type[Cell]] = {
    "number": number.NumberSpec,
    "quantity": quantity.QuantitySpec,
    "angle": angle.AngleSpec,
}


class AuthoredTable(AuthoredNumeric, tag="table", frozen=True):
    """Numbers by their labels."""

    least, most = 2, MOST_OPTIONS
    unit: str = ""
    counts: dict[str, str | tuple[str, ...]] = msgspec.field(default_factory=dict)
    cells: dict[str, dict[str, bool | Scalar]] = msgspec.field(default_factory=dict)


class TableSpec(NumericSpec, kw_only=True, frozen=True):
    """Table: ``values`` (name to value); ``units`` (name to unit); ``cells`` (name to a table).

    ``counts`` maps a name to the unit or words for what it counts.

    A cell is a number with the table's tolerance unless ``cells`` says otherwise:
    ``cells = {H = {kind = "angle", abs = "0.5"}}``. ``called`` are the words by which the question
    calls a value, which may stand before it.
    """

    written_as: ClassVar[AnswerForm] = "values"
    may_be_range: ClassVar[bool] = True

    values: dict[str, Scalar]
    units: dict[str, str] = msgspec.field(default_factory=dict)
    counts: dict[str, list[str]] = msgspec.field(default_factory=dict)
    cells: dict[str, dict[str, Any]] = msgspec.field(default_factory=dict)
    called: dict[str, list[str]] = msgspec.field(default_factory=dict)
    traps: dict[str, dict[str, Scalar]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check tolerance and every cell; errors as ``WordSpec.validate``."""
        super().validate()
        if not self.values:
            raise ValueError("values must not be empty")
        for name in (*self.units, *self.counts, *self.cells):
            if name not in self.values:
                raise ValueError(f"no value is named {name!r}")
        for name in self.values:
            decode_spec(*_build_cell_table(self, name))

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on all cells, with the verdicts of each.

        Raises
        ------
        FormulaReadError
            If a cell cannot be read, or a name is not asked for.
        """
        names = list(self.values)
        placed = _place_cells(typed, self.value_names(), options.decimal)
        asked = {name: cell_spec(self, name) for name in names}
        cells = [_judge_cell(asked[name], name, placed.get(name), options) for name in names]
        stopped = next((c for c in cells if c.verdict == "ambiguous"), None)
        shown = zip(map(pretty.format_name, names), cells, strict=True)
        read_as = "; ".join(f"{name} = {c.read_as}" for name, c in shown if c.read_as)
        if stopped is not None:
            return ambiguous(stopped.note, stopped.read_as, **stopped.fields)
        missed = any(c.credit < 1 for c in cells)
        trap = _find_misconception(self.traps, asked, placed, options) if missed else ""
        verdict = _combine_cell_verdicts(names, cells, read_as, trap)
        values = tuple(c.values[0] if c.values else None for c in cells)
        return attach_values(replace(verdict, cells=tuple(cells)), *values)

    def show(self) -> str:
        """Return the key as printed and as it can be typed back."""
        return "; ".join(
            f"{pretty.format_name(n)} = {cell_spec(self, n).show()}" for n in self.values
        )

    def value_names(self) -> AskedNames:
        """Return the labels of the cells, each with what else it may be called."""
        return {name: self.called.get(name, ()) for name in self.values}

    def value_units(self) -> list[str]:
        """Return the unit of each cell."""
        return [cell_spec(self, name).value_unit() for name in self.values]


_INHERITED = (*RULES, "within", "strict")


def cell_spec(spec: TableSpec, name: str) -> Cell:
    """Return the spec of one cell."""
    shape, table = _build_cell_table(spec, name)
    return convert(table, shape)


def _build_cell_table(spec: TableSpec, name: str) -> tuple[type[Cell], dict[str, Any]]:
    """Return the struct of one cell's kind, and its fields.

    Raises
    ------
    ValueError
        If a table cannot have cells of that kind.
    """
    own = spec.cells.get(name, {})
    table: dict[str, Any] = {"kind": "number", "value": spec.values[name], "define": spec.define}
    if not {*RULES} & own.keys():
        table |= {key: getattr(spec, key) for key in _INHERITED}
    if spec.units.get(name):
        table["unit"] = spec.units[name]
    if spec.counts.get(name):
        table["counts"] = spec.counts[name]
    table["traps"] = {trap: values[name] for trap, values in spec.traps.items() if name in values}
    if isinstance(spec.of, dict) and name in spec.of:
        table["of"] = [spec.of[name]]
    table |= own
    if table["kind"] == "angle":
        table.pop("unit", None)
    if table["kind"] not in CELLS:
        raise ValueError(f"cells.{name}: kind is one of {', '.join(CELLS)}")
    return CELLS[table["kind"]], table


def _place_cells(typed: str, names: AskedNames, decimal: str) -> dict[str, SourceText]:
    """Return what was typed for each name: by name, or all in order.

    Raises
    ------
    FormulaReadError
        If a name is not asked for, or there are not as many values without names.
    """
    count = None if any(mark in typed for mark in "=:") else len(names)
    items, _ = read_list(typed, count, decimal)
    placed = place_by_name(items, names)
    if placed is not None:
        return placed
    if len(items) != len(names):
        raise FormulaReadError("item-count", 1, str(len(items)), [str(len(names))])
    return dict(zip(names, items, strict=True))


def _judge_cell(
    asked: Cell, name: str, item: SourceText | None, options: GradingOptions
) -> Verdict:
    """Return the verdict on one cell; wrong if nothing was typed for it.

    Raises
    ------
    FormulaReadError
        If it cannot be read.
    """
    if item is None:
        return wrong("", "missing", names=(name,))
    try:
        verdict = _judge_cell_text(asked, item.text, options)
    except FormulaReadError as error:
        raise relocate_error(error, item) from None
    if verdict.verdict == "unreadable":
        raise FormulaReadError(verdict.note, item.column(0), verdict.read_as)
    return verdict


def _judge_cell_text(asked: Cell, typed: str, options: GradingOptions) -> Verdict:
    """Judge one cell as an answer of its own, with what people write around it."""
    try:
        return asked.judge(typed, options)
    except FormulaReadError:
        for text in list_plainer_texts(typed, "values"):
            with suppress(FormulaReadError):
                return asked.judge(text, options)
        raise


def _combine_cell_verdicts(
    names: list[str], cells: list[Verdict], read_as: str, trap: str
) -> Verdict:
    """Return the verdict on a table: the mean credit of its cells, and which are wrong.

    ``trap`` is the mistake that explains all of them, or empty.
    """
    credit = sum((c.credit for c in cells), Fraction(0)) / len(cells)
    missed = tuple(n for n, c in zip(names, cells, strict=True) if c.credit < 1)
    if not missed:
        notes = {c.note for c in cells if c.verdict == "partial"}
        return partial(credit, read_as, notes.pop()) if notes else correct(read_as)
    note, fields = (f"trap:{trap}", {}) if trap else find_common_slip(cells)
    return verdict_by_share(credit, read_as, note or "cells", names=missed, **fields)


def _find_misconception(
    traps: Mapping[str, Mapping[str, Scalar]],
    asked: Mapping[str, Cell],
    placed: Mapping[str, SourceText],
    options: GradingOptions,
) -> str:
    """Return the one mistake that gives every cell as it was typed; empty if not one."""
    if len(placed) < len(asked):
        return ""
    typed = {name: source.text for name, source in placed.items()}
    fitting = [
        trap
        for trap in traps
        if _is_given_by_misconception(trap, traps[trap], asked, typed, options)
    ]
    return fitting[0] if len(fitting) == 1 else ""


def _is_given_by_misconception(
    trap: str,
    values: Mapping[str, Scalar],
    asked: Mapping[str, Cell],
    typed: Mapping[str, str],
    options: GradingOptions,
) -> bool:
    """Return whether a mistake explains all cells: its values stand in every one of them."""
    return all(
        _is_cell_given_by_misconception(
            replace(one, traps={trap: values.get(name, one.value)}), typed[name], options
        )
        for name, one in asked.items()
    )


def _is_cell_given_by_misconception(cell: Cell, typed: str, options: GradingOptions) -> bool:
    """Return whether a cell's one mistake gives what was typed, which may be right all the same."""
    verdict = cell.judge(typed, options)
    ((trap, value),) = cell.traps.items()
    if not verdict.credit:
        return verdict.note == f"trap:{trap}"
    return replace(cell, value=value, traps={}).judge(typed, options).credit == 1


def ask(part: PartContext) -> AskedPart[TableSpec]:
    """Return the cells by their labels, and those that each mistake gives."""
    of, names = part.answer["of"], asked_quantities(part.answer)
    labels = list(of) if isinstance(of, Mapping) else list(names)

    def write(values: tuple[Value, ...]) -> dict[str, Scalar]:
        """Return the components of an answer under the labels of the cells."""
        return {label: format_for_key(v) for label, v in zip(labels, values, strict=True)}

    units = [str(part.answer.get("unit", part.units.get(name, ""))) for name in names]
    stated = {label: unit for label, unit in zip(labels, units, strict=True) if unit}
    by_label = dict(zip(labels, names, strict=True))
    called = part.value_words(by_label)
    said = {"called": called} if called else {}
    asked = ask_numeric(TableSpec, part, write, of=by_label, units=stated, **said)
    boxes = tuple(map(InputBox, labels, units))
    return replace(asked, control=InputControl("line", boxes=boxes, named=True))


def input_hints(spec: TableSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return the sentences on names with their units, and on rounding."""
    from quizgen.typeset.prose import join_inlines, translate_inlines

    names = join_inlines(
        (_format_name_with_unit(name, spec.units.get(name, "")) for name in spec.values), ", "
    )
    rounding = rounding_hint(spec, spec.values, lang)
    return nonempty(translate_inlines(lang, "ask.table", names=names), rounding)


def _format_name_with_unit(name: str, unit: str) -> tuple[Inline, ...]:
    """Return a name with its unit in brackets, if it has one."""
    from quizgen.typeset.prose import PlainText, name_inline

    return (
        (name_inline(name), PlainText(f" ({format_unit(unit)})")) if unit else (name_inline(name),)
    )


def explain_key(spec: TableSpec, lang: str) -> TextOrInlines:
    """Return the cells by their names."""
    return explain_assigned((name, show_spec(cell_spec(spec, name), lang)) for name in spec.values)


KIND = AnswerKind(
    AuthoredTable,
    TableSpec,
    ask,
    input_hints,
    explain_key,
    precision_on_paper,
    accept_within_tolerance,
)
