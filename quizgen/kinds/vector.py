"""Kind ``vector``: the components in order; ``up_to = "scale"`` takes any multiple but 0."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, ClassVar, Literal

import msgspec
from flint import fmpq

from quizgen.grading.judging.sampled_equality import values_agree
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm, casts_doubt
from quizgen.grading.reading.lists import read_list
from quizgen.grading.verdict import Verdict, correct, verdict_by_share, wrong
from quizgen.kinds.asking import hint, make_spec, misconception_specs
from quizgen.kinds.contract import (
    AnswerKind,
    AskedPart,
    FieldProblem,
    InputControl,
    PartContext,
)
from quizgen.kinds.forms import (
    AuthoredEntries,
    EntriesSpec,
    EntryText,
    TypedEntry,
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
from quizgen.locale import translate
from quizgen.maths.complex_values import ComplexValue, evaluate_complex, multiply
from quizgen.maths.tree import Call, Expr
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

_HINT = hint("ask.vector")


class AuthoredVector(AuthoredEntries, kw_only=True, tag="vector", frozen=True):
    """A vector of the solver."""

    of: str
    up_to: Literal["", "scale"] = ""

    def find_problems(self) -> Iterator[FieldProblem]:
        """Yield a problem if a rule of rounding stands beside ``up_to``: any multiple is right."""
        if self.up_to and (self.decimals, self.sigfigs, self.rel, self.abs) != (None,) * 4:
            yield ("up_to",), "QG112", "any multiple counts, so no rounding can be asked"


class ColumnSpec(EntriesSpec, kw_only=True, frozen=True):
    """Vector: ``components``, how near each must be; ``up_to`` = scale for any multiple."""

    written_as: ClassVar[AnswerForm] = "formula"

    components: list[EntryText]
    up_to: Literal["", "scale"] = ""
    traps: dict[str, list[EntryText]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check the components."""
        super().validate()
        for components in (self.components, *self.traps.values()):
            for text in components:
                check_entry(text)

    def judge_entries(self, typed: str, scale: Value, options: GradingOptions, /) -> Verdict:
        """Judge a typed vector; errors as ``judge``."""
        numbers = self._read(typed, options)
        values = [scale_entry(number.value, scale) for number in numbers]
        read_as = f"({'; '.join(number.read_as for number in numbers)})"
        if self._is_right(values, self.components):
            return correct(read_as)
        for name, components in self.traps.items():
            if self._is_right(values, components):
                return wrong(read_as, f"trap:{name}")
        if self.up_to or not values:
            return wrong(read_as)
        if all(self._match_components(list(map(_negate, values)), self.components)):
            return wrong(read_as, "sign")
        right = sum(self._match_components(values, self.components))
        credit, count = Fraction(right, len(values)), len(values)
        return verdict_by_share(credit, read_as, "matrix-entries", right=right, of=count)

    def _read(self, typed: str, options: GradingOptions) -> list[TypedEntry]:
        """Return the typed components; errors as ``judge``."""
        typed = _HEADING.sub(lambda m: m[0] if casts_doubt(m[0]) else "", typed)
        if self.up_to == "scale":
            typed = _PARAMETER.sub("", _NOT_ZERO.sub("", typed))
        plain = _write_by_axes(typed).replace("\\\\", ";").replace("&", ";")
        pieces, _ = read_list(plain, len(self.components), options.decimal)
        known = (self.components, *self.traps.values())
        as_complex = any(isinstance(entry, list) for row in known for entry in row)
        return [read_any_entry(piece, options.decimal, as_complex=as_complex) for piece in pieces]

    def read_form(self, typed: str, options: GradingOptions, /) -> Expr:
        """Return a typed vector; errors as ``judge``."""
        plain, unit = self.split_unit(typed)
        factor = self.base_factor(unit)
        values = [scale_entry(number.value, factor) for number in self._read(plain, options)]
        return Call("vector", tuple(map(write_constant, values)))

    def replace_key(self, form: Expr, /) -> ColumnSpec:
        """Return the specification with another vector as its key, and without mistakes."""
        return msgspec.structs.replace(
            self, components=_write_components(form, self.base_factor(None)), traps={}
        )

    def _is_right(self, values: list[Value | ComplexValue], components: list[EntryText]) -> bool:
        """Return whether a vector is the key, or a multiple of it if ``up_to`` is "scale"."""
        if self.up_to == "scale":
            return _are_parallel(values, components)
        return all(self._match_components(values, components))

    def _match_components(
        self, values: list[Value | ComplexValue], components: list[EntryText]
    ) -> list[bool]:
        """Return for each value whether it is its component."""
        pairs = zip(values, components, strict=True)
        return [entry_matches(value, text, self.tolerance) for value, text in pairs]

    def show(self) -> str:
        """Return the key as it is printed, and as it can be typed back."""
        return self.add_unit(self.show_plain())

    def show_plain(self) -> str:
        """Return the key without its unit."""
        return f"({'; '.join(map(show_entry, self.rounded_components()))})"

    def rounded_components(self) -> list[EntryText]:
        """Return the components as far as they are asked."""
        return [round_entry(text, self.tolerance) for text in self.components]


_HEADING = re.compile(r"^[^()\[\];]*\d ?[:,] ?(?=[(\[][^()\[\]]+[)\]]\s*$)")
"""What a vector is for, ``z = 1: (2; -6; 1)``."""
_PARAMETER = re.compile(r"^\s*(?:[^\W\d_]\w? ?= ?)?[^\W\d_] ?[*·⋅×] ?(?=[(\[])")
"""The letter before a vector that stands for all its multiples: ``t·(1; 2)``."""
_NOT_ZERO = re.compile(r"(?<=[)\]]),? ?\(?[^\W\d_] ?(?:≠|!=|<>) ?0\)?\s*$")
_TERM = re.compile(r"([-+−]?) ?(\d+(?:[.,]\d+)?)? ?[*·]? ?([ijk])\b ?")
_AXES = "ijk"
LONGEST_SUM = 200
"""Signs of a sum along the axes; no longer text is searched for one."""


def _write_by_axes(typed: str) -> str:
    """Return ``2i - 3k``, a sum along the axes, as its three components."""
    text = re.sub(r"\\(?:hat|vec|mathbf) ?\{?([ijk])\}?", r"\1", drop_name(typed)).strip()
    if "k" not in text or len(text) > LONGEST_SUM:
        return typed
    terms = [match.groups("") for match in _TERM.finditer(text)]
    if _TERM.sub("", text) or len({term[2] for term in terms}) < len(terms):
        return typed
    parts = {axis: f"{sign.replace('+', '')}{size or 1}" for sign, size, axis in terms}
    return "; ".join(parts.get(axis, "0") for axis in _AXES)


def build_vector(components: list[EntryText]) -> Expr:
    """Return components of a key as a tree."""
    return Call("vector", tuple(map(parse_entry, components)))


def _negate(value: Value | ComplexValue) -> Value | ComplexValue:
    """Return a number with the other sign."""
    return (-value[0], -value[1]) if isinstance(value, tuple) else -value


def _are_parallel(typed: list[Value | ComplexValue], components: list[EntryText]) -> bool:
    """Return whether two vectors are multiples of each other; the zero vector is of none."""
    a = [value if isinstance(value, tuple) else (value, fmpq(0)) for value in typed]
    b = [evaluate_complex(parse_entry(entry), frozenset("i")) for entry in components]
    if all(part == 0 for value in a for part in value):
        return False
    return all(
        values_agree(x, y) is not False
        for i in range(len(a))
        for j in range(i)
        for x, y in zip(multiply(a[i], b[j]), multiply(a[j], b[i]), strict=True)
    )


def ask(part: PartContext) -> AskedPart[ColumnSpec]:
    """Return the vector of the solver, and what each mistake makes of it."""
    traps = {name: _list_components(part, f) for name, f in part.misconception_forms().items()}
    notes = part.misconception_notes(traps) if traps else {}
    components = _list_components(part, part.answer_form())
    spec = make_spec(
        ColumnSpec,
        part,
        **{"components": components, "traps": traps, "notes": notes} | find_unit(part),
    )
    return AskedPart(spec, InputControl("line"), mistakes=misconception_specs(spec, "components"))


def _list_components(part: PartContext, form: Expr) -> list[EntryText]:
    """Return the components of a form as text; a matrix of one row is a vector, too."""
    return _write_components(require_form(part, form, "vector", "matrix"), find_factor(part))


def _write_components(form: Expr, factor: Value) -> list[EntryText]:
    """Return the components of a vector, or of a matrix of one row, as a key has them."""
    args = form.args if isinstance(form, Call) else ()
    if isinstance(form, Call) and form.op == "matrix":
        (row,) = args
        args = row.args if isinstance(row, Call) else ()
    return [format_entry(arg, factor) for arg in args]


def input_hints(spec: ColumnSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return how a vector is typed, and whether any multiple counts."""
    return (
        *_HINT(spec, lang),
        *spec.hint_unit(lang),
        *_hint_multiples(spec, lang),
        *spec.hint_rounding(lang),
    )


def paper_hints(spec: ColumnSpec, lang: str) -> tuple[str, ...]:
    """Return whether any multiple counts, and how exactly the components must be given."""
    return (*_hint_multiples(spec, lang), *spec.hint_rounding_on_paper(lang))


def _hint_multiples(spec: ColumnSpec, lang: str) -> tuple[str, ...]:
    """Return that any multiple counts, if it does."""
    return (translate(lang, "ask.up_to_scale"),) if spec.up_to else ()


def explain_key(spec: ColumnSpec, _lang: str) -> TextOrInlines:
    """The vector as it is written by hand."""
    key = typeset_key(build_vector(spec.rounded_components()), spec.show_plain())
    return spec.typeset_with_unit(key)


KIND = AnswerKind(AuthoredVector, ColumnSpec, ask, input_hints, explain_key, paper_hints)
