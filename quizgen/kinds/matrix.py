"""Kind ``matrix``: ``[1, 2; 3, 4]``, a row on each line, or LaTeX; judged by entry."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING, ClassVar

import msgspec

from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.matrices import split_matrix
from quizgen.grading.verdict import Verdict, correct, verdict_by_share, wrong
from quizgen.kinds.asking import hint, make_spec, misconception_specs
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    InputControl,
    PartContext,
)
from quizgen.kinds.forms import (
    AuthoredEntries,
    EntriesSpec,
    EntryText,
    check_entry,
    drop_name,
    entry_matches,
    find_factor,
    find_unit,
    format_entry,
    parse_entry,
    read_any_entry,
    require_form,
    round_entry,
    scale_entry,
    show_entry,
    typeset_key,
    write_constant,
)
from quizgen.maths.complex_values import ComplexValue
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.tree import Call, Expr
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

_HINT = hint("ask.matrix")
Entries = list[list[EntryText]]
"""Rows of numbers."""


Rows = list[list[Value | ComplexValue]]
"""Typed rows."""


class AuthoredMatrix(AuthoredEntries, kw_only=True, tag="matrix", frozen=True):
    """A matrix of the solver."""

    of: str


class MatrixSpec(EntriesSpec, kw_only=True, frozen=True):
    """Matrix: ``entries``, row by row; how near each must be."""

    written_as: ClassVar[AnswerForm] = "formula"

    entries: Entries
    traps: dict[str, Entries] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check entries, and that all rows are of one length."""
        super().validate()
        for rows in (self.entries, *self.traps.values()):
            if not rows or len({len(row) for row in rows}) != 1:
                raise ValueError("entries: rows of one length are needed")
            for row in rows:
                for entry in row:
                    check_entry(entry)

    def judge_entries(self, typed: str, scale: Value, options: GradingOptions, /) -> Verdict:
        """Judge a typed matrix; errors as ``judge``."""
        rows, read_as = self._read(typed, scale, options)
        if _is_same(rows, self.entries, self.tolerance):
            return correct(read_as)
        for name, entries in self.traps.items():
            if _is_same(rows, entries, self.tolerance):
                return wrong(read_as, f"trap:{name}")
        return _diagnose(self, rows, read_as)

    def _read(self, typed: str, scale: Value, options: GradingOptions) -> tuple[Rows, str]:
        """Return typed rows of values, and the echo; errors as ``judge``."""
        known = (self.entries, *self.traps.values())
        as_complex = any(isinstance(entry, list) for rows in known for row in rows for entry in row)
        row = _find_row_of_decimals(typed) if len(self.entries) == 1 else ""
        row = row or _part_digits(typed, len(self.entries[0]))
        row = row or _multiply_out(typed) or _part_into_rows(typed, len(self.entries))
        rows, read_as = _read_matrix(row or typed, options.decimal, as_complex=as_complex)
        if row and len(rows[0]) != len(self.entries[0]):
            rows, read_as = _read_matrix(typed, options.decimal, as_complex=as_complex)
        return [[scale_entry(value, scale) for value in row] for row in rows], read_as

    def read_form(self, typed: str, options: GradingOptions, /) -> Expr | None:
        """Return a typed matrix; None if its size is not that of the key; errors as ``judge``."""
        plain, unit = self.split_unit(typed)
        rows, _ = self._read(plain, self.base_factor(unit), options)
        if list(map(len, rows)) != list(map(len, self.entries)):
            return None
        return Call("matrix", tuple(Call("row", tuple(map(write_constant, row))) for row in rows))

    def replace_key(self, form: Expr, /) -> MatrixSpec:
        """Return the specification with another matrix as its key, and without mistakes."""
        return msgspec.structs.replace(
            self, entries=_write_entries(form, self.base_factor(None)), traps={}
        )

    def show(self) -> str:
        """Return the key as it is printed, and as it can be typed back."""
        return self.add_unit(self.show_plain())

    def show_plain(self) -> str:
        """Return the key without its unit."""
        rows = self.rounded_entries()
        return f"[{'; '.join(', '.join(map(show_entry, row)) for row in rows)}]"

    def rounded_entries(self) -> Entries:
        """Return the entries as far as they are asked."""
        return [[round_entry(text, self.tolerance) for text in row] for row in self.entries]


def build_matrix(entries: Entries) -> Expr:
    """Return rows of a key as a tree."""
    return Call("matrix", tuple(Call("row", tuple(map(parse_entry, row))) for row in entries))


_ROW_OF_DECIMALS = re.compile(r"[-+−]?\d+(?:,\d+)?(?: ?; ?[-+−]?\d+(?:,\d+)?)+")


def _find_row_of_decimals(typed: str) -> str:
    """Return ``(-4,65; -10,5)`` with ``&`` between its entries; empty for anything else."""
    text = drop_name(typed).strip(" ()[]")
    return text.replace(";", "&") if _ROW_OF_DECIMALS.fullmatch(text) else ""


def _part_into_rows(typed: str, height: int) -> str:
    """Return ``[0,5; 0,866; -0,866; 0,5]`` in rows, if a row cannot be one value wide."""
    values = [piece.strip() for piece in drop_name(typed).strip(" []()").split(";")]
    width, rest = divmod(len(values), max(height, 1))
    plain = all(_VALUE.fullmatch(value) for value in values)
    if height < len(("first", "second")) or width <= 1 or rest or not plain:
        return ""
    rows = (values[at : at + width] for at in range(0, len(values), width))
    return "; ".join(" & ".join(row) for row in rows)


_VALUE = re.compile(r"[-+−]?\d+(?:[.,]\d+)?(?:/\d+)?")


def _multiply_out(typed: str) -> str:
    """Return ``1/sqrt(2) * [-1, -1; 1, -1]`` with the factor in each entry; empty without one."""
    match = _FACTOR.fullmatch(drop_name(typed).strip())
    if match is None:
        return ""
    rows = split_matrix(match["matrix"])
    scaled = (", ".join(f"1*({match['factor']})*({one})*1" for one in row) for row in rows)
    return f"[[{'], ['.join(scaled)}]]"


_FACTOR = re.compile(r"(?P<factor>-?[^\[\]{};,=+-]*[\d)]) ?[*·×]? ?(?P<matrix>\[.*\])", re.DOTALL)
"""A matrix with a factor before it."""


def _part_digits(typed: str, width: int) -> str:
    """Return ``0010; 1000`` with a blank between its digits, if each row has the width asked."""
    rows = [row.strip(" []()") for row in re.split(r"[;\n]", typed) if row.strip(" []()")]
    together = width > 1 and len(rows) > 1 and all(re.fullmatch(r"[0-9]+", row) for row in rows)
    if not together or {*map(len, rows)} != {width}:
        return ""
    return "; ".join(" ".join(row) for row in rows)


def _read_matrix(typed: str, decimal: str, *, as_complex: bool) -> tuple[Rows, str]:
    """Return rows of values, and the echo.

    Raises
    ------
    FormulaReadError
        If rows differ in length, or an entry is no number.
    """
    pieces = split_matrix(drop_name(typed), decimal)
    rows = [
        [read_any_entry(piece, decimal, as_complex=as_complex) for piece in row] for row in pieces
    ]
    echo = "; ".join(", ".join(number.read_as for number in row) for row in rows)
    return [[number.value for number in row] for row in rows], f"[{echo}]"


def _is_same(rows: Rows, entries: Entries, rule: Tolerance | None) -> bool:
    """Return whether a matrix has the shape and the entries of a key."""
    return len(rows) == len(entries) and all(
        len(row) == len(key) and all(_match_entries(row, key, rule))
        for row, key in zip(rows, entries, strict=True)
    )


def _match_entries(
    row: list[Value | ComplexValue], key: list[EntryText], rule: Tolerance | None
) -> list[bool]:
    """Return for each entry of a row whether it is that of a key's row."""
    return [entry_matches(value, text, rule) for value, text in zip(row, key, strict=True)]


def _diagnose(spec: MatrixSpec, rows: Rows, read_as: str) -> Verdict:
    """Return what is wrong: the size, rows and columns exchanged, one row, or single entries."""
    turned = [list(column) for column in zip(*rows, strict=True)]
    if _is_same(turned, spec.entries, spec.tolerance):
        return wrong(read_as, "transposed")
    height, width = len(spec.entries), len(spec.entries[0])
    if (len(rows), len(rows[0])) != (height, width):
        return wrong(read_as, "matrix-size", rows=len(rows), columns=len(rows[0]))
    right = [
        _match_entries(row, key, spec.tolerance)
        for row, key in zip(rows, spec.entries, strict=True)
    ]
    count = sum(map(sum, right))
    off = [index + 1 for index, row in enumerate(right) if not all(row)]
    if not count:
        return wrong(read_as)
    note = "matrix-row" if len(off) == 1 and height > 1 else "matrix-entries"
    credit = Fraction(count, height * width)
    return verdict_by_share(credit, read_as, note, line=off[0], right=count, of=height * width)


def ask(part: PartContext) -> AskedPart[MatrixSpec]:
    """Return the matrix of the solver, and what each mistake makes of it."""
    wrong_forms = part.misconception_forms()
    traps = {name: _list_entries(part, form) for name, form in wrong_forms.items()}
    notes = part.misconception_notes(traps) if traps else {}
    entries = _list_entries(part, part.answer_form())
    spec = make_spec(
        MatrixSpec, part, **{"entries": entries, "traps": traps, "notes": notes} | find_unit(part)
    )
    control = InputControl("lines", lines=len(entries))
    return AskedPart(spec, control, mistakes=misconception_specs(spec, "entries"))


def _list_entries(part: PartContext, form: Expr) -> Entries:
    """Return the entries of a form by row, as text; a vector is one column."""
    return _write_entries(require_form(part, form, "matrix", "vector"), find_factor(part))


def _write_entries(form: Expr, factor: Value) -> Entries:
    """Return the entries of a matrix or vector as a key has them."""
    rows = form.args if isinstance(form, Call) else ()
    return [
        [format_entry(x, factor) for x in row.args]
        if isinstance(row, Call) and row.op == "row"
        else [format_entry(row, factor)]
        for row in rows
    ]


def explain_key(spec: MatrixSpec, _lang: str) -> TextOrInlines:
    """The matrix as it is written by hand."""
    key = typeset_key(build_matrix(spec.rounded_entries()), spec.show_plain())
    return spec.typeset_with_unit(key)


def input_hints(spec: MatrixSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return how a matrix is typed, and how exactly."""
    return (*_HINT(spec, lang), *spec.hint_unit(lang), *spec.hint_rounding(lang))


def paper_hints(spec: MatrixSpec, lang: str) -> tuple[str, ...]:
    """Return how exactly the entries must be given."""
    return spec.hint_rounding_on_paper(lang)


KIND = AnswerKind(AuthoredMatrix, MatrixSpec, ask, input_hints, explain_key, paper_hints)
