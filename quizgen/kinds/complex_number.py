"""Kind ``complex``: ``3 + 4i``, ``5*exp(i*pi/4)``, ``5(cos(1) + i sin(1))``, ``(5; 53.1°)``."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Literal

import msgspec
from flint import fmpq

from quizgen.grading.judging.sampled_equality import values_agree
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.answer_reader import AnswerForm
from quizgen.grading.reading.formulas import read_formula
from quizgen.grading.rounding import USUAL_FIGURES, format_figures, format_rounded_key
from quizgen.grading.verdict import HALF, Verdict, correct, partial, wrong
from quizgen.kinds.asking import hint, make_spec, misconception_specs
from quizgen.kinds.contract import AnswerKind, AskedPart, PartContext
from quizgen.kinds.forms import (
    IMAGINARY,
    ROUNDED,
    AuthoredEntries,
    EntriesSpec,
    drop_name,
    entry_matches,
    find_factor,
    find_unit,
    format_entry,
    parse_entry,
    round_number,
    scale_entry,
    separate_unit,
    split_sides,
    typeset_key,
    write_constant,
)
from quizgen.locale import translate
from quizgen.maths.complex_values import ComplexValue, evaluate_complex
from quizgen.maths.constants import parse_exact
from quizgen.maths.notation import FormulaReadError, format_tree, parse_formula, pretty
from quizgen.maths.numbers import to_float
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Sym, make_number, names_in, operators_in, walk_tree
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

_HINT = hint("ask.complex")


class AuthoredComplex(AuthoredEntries, kw_only=True, tag="complex", frozen=True):
    """A complex number of the solver."""

    of: str
    form: Literal["cartesian", "polar", "any"] = "any"


class ComplexSpec(EntriesSpec, kw_only=True, frozen=True):
    """Complex: ``parts`` = real and imaginary, how near; ``form`` = cartesian, polar or any.

    ``rel`` and ``abs`` are distances in the plane, decimals and figures those of both parts.
    """

    written_as: ClassVar[AnswerForm] = "formula"

    parts: list[str]
    form: Literal["cartesian", "polar", "any"] = "any"
    traps: dict[str, list[str]] = msgspec.field(default_factory=dict)

    def validate(self) -> None:
        """Check both parts."""
        super().validate()
        for parts in (self.parts, *self.traps.values()):
            if len(parts) != len(("real", "imaginary")):
                raise ValueError("parts: the real and the imaginary part are needed")
            for text in parts:
                parse_exact(text)

    def judge_entries(self, typed: str, scale: Value, options: GradingOptions, /) -> Verdict:
        """Judge a typed complex number, the last of a chain.

        Raises
        ------
        FormulaReadError
            If it cannot be read, or the sides of a chain differ.
        """
        tree, (real, imaginary) = self._read(typed, options)
        value = real * scale, imaginary * scale
        read_as = pretty.format_formula(format_tree(tree))
        rounded = find_written_form(tree) == "polar"
        if self._is_near(value, self.parts, rounded=rounded):
            return self._judge_form(tree, correct(read_as))
        for name, parts in self.traps.items():
            if self._is_near(value, parts, rounded=rounded):
                return wrong(read_as, f"trap:{name}")
        return wrong(read_as, self._find_slip(value))

    def _read(self, typed: str, options: GradingOptions) -> tuple[Expr, ComplexValue]:
        """Return the last side of a typed number and its value; errors as ``judge``."""
        *before, tree = (
            read_formula(_spell_out(drop_name(side)), IMAGINARY, options.decimal).tree
            for side in split_sides(typed)
        )
        value = evaluate_complex(tree, frozenset(IMAGINARY))
        for side in before:
            if not _are_near(evaluate_complex(side, frozenset(IMAGINARY)), value):
                raise FormulaReadError("sides-differ", 1, typed.strip()[:60])
        return tree, value

    def read_form(self, typed: str, options: GradingOptions, /) -> Expr:
        """Return a typed number as its two parts; errors as ``judge``."""
        plain, unit = self.split_unit(typed)
        value = self._read(plain, options)[1]
        return write_constant(scale_entry(value, self.base_factor(unit)))

    def replace_key(self, form: Expr, /) -> ComplexSpec:
        """Return the specification with another number as its key, and without mistakes."""
        parts = _list_parts(form, self.base_factor(None))
        return msgspec.structs.replace(self, parts=parts, traps={})

    def _is_near(self, value: ComplexValue, parts: list[str], *, rounded: bool) -> bool:
        """Return whether a number is a key; size and angle written out may always be rounded."""
        rule = self.tolerance
        if rule is not None and self.rel is None and self.abs is None:
            return all(entry_matches(v, text, rule) for v, text in zip(value, parts, strict=True))
        if rule is None and (_is_same(value, parts) or not rounded):
            return _is_same(value, parts)
        key = [parse_exact(text) for text in parts]
        size = parse_exact(self.rel) if self.rel is not None else ROUNDED
        reach = parse_exact(self.abs) ** 2 if self.abs is not None else size**2 * _square(key)
        return not _square([v - k for v, k in zip(value, key, strict=True)]) > reach

    def _find_slip(self, value: ComplexValue) -> str:
        """Return the note on a wrong number that misses the key by one slip; "" for none."""
        real, imaginary = value
        if _is_same((real, -imaginary), self.parts):
            return "conjugate"
        if _is_same((imaginary, real), self.parts):
            return "parts-swapped"
        return "sign" if _is_same((-real, -imaginary), self.parts) else ""

    def _judge_form(self, tree: Expr, right: Verdict) -> Verdict:
        """Return the verdict on a right number: half if it is not in the form asked."""
        if self.form == "any" or self.form == find_written_form(tree):
            return right
        return partial(HALF, right.read_as, f"form-{self.form}")

    def show(self) -> str:
        """Return the key as it is printed, and as it can be typed back."""
        number = self.show_plain()
        bare = not self.unit or (self.form == "polar" and self.tolerance)
        return self.add_unit(number if bare else f"({number})")

    def show_plain(self) -> str:
        """Return the number of the key alone."""
        if self.form == "polar" and self.tolerance:
            return "{}\N{ANGLE}{}°".format(*map(pretty.format_number, self.rounded_polar()))
        if self.tolerance:
            return pretty.format_constant(self.rounded_sum())
        return pretty.format_constant(format_tree(build_complex(self.parts, self.form)))

    def rounded_sum(self) -> str:
        """Return real and imaginary part as far as they are asked, as they are typed."""
        real, imaginary = (round_number(text, self.tolerance) for text in self.parts)
        sign = "-" if imaginary.startswith("-") else "+"
        return f"{real} {sign} {imaginary.removeprefix('-')}*i"

    def rounded_polar(self) -> tuple[str, str]:
        """Return size and angle in degrees as far as they are asked, at least to three figures."""
        x, y = (to_float(parse_exact(text)) for text in self.parts)
        turned = (math.hypot(x, y), math.degrees(math.atan2(y, x)))
        places = self.decimals
        figures = max(self.sigfigs or 0, USUAL_FIGURES) + 1
        size, angle = (fmpq(*part.as_integer_ratio()) for part in turned)
        shown = format_figures(size, figures) if places is None else f"{turned[0]:.{places}f}"
        return shown, format_rounded_key(angle, max(places or 0, figures - 2))


def _square(parts: Sequence[Value]) -> Value:
    """Return the square of a number's size."""
    real, imaginary = parts
    return real * real + imaginary * imaginary


_SIZE_AND_ANGLE = re.compile(
    r"\(?\s*(?P<size>[^;∠()]+?)\s*(?:∠|;|/_)\s*(?P<angle>[^;∠()]*?)\s*"
    r"(?P<unit>°|deg(?:rees?)?\b|\^?\\circ|rad\b|(?<=π)|(?<=pi))\s*\)?"
)


def _spell_out(typed: str) -> str:
    """Return ``50∠53°`` and ``(50; 53°)`` as a formula, and ``j40`` as a product."""
    polar = _SIZE_AND_ANGLE.fullmatch(" ".join(typed.split()))
    if polar is None:
        return separate_unit(typed)
    unit = "" if polar["unit"] in {"rad", ""} else "°"
    return f"({polar['size']})*exp(i*({polar['angle']}{unit}))"


def _are_near(first: ComplexValue, second: ComplexValue) -> bool:
    """Return whether two sides of a chain may be one number, one of them rounded."""
    return all(
        values_agree(a, b) is not False or abs(a - b) <= abs(b) * ROUNDED
        for a, b in zip(first, second, strict=True)
    )


def find_written_form(tree: Expr) -> str:
    """Whether a number is written ``a + b i`` or by its size and angle; empty if as neither."""
    if operators_in(tree) & {"exp", "sin", "cos"}:
        return "polar"
    return "" if any(map(_works_on_sum, walk_tree(tree))) else "cartesian"


def _works_on_sum(node: Expr) -> bool:
    """Whether a sum with the imaginary unit is still multiplied, raised or divided by."""
    if not isinstance(node, Call) or node.op not in {"mul", "div", "pow"}:
        return False
    looked_at = node.args[1:] if node.op == "div" else node.args
    return any(
        isinstance(arg, Call) and arg.op in {"add", "sub"} and bool(names_in(arg) & {*IMAGINARY})
        for arg in looked_at
    )


def _is_same(value: ComplexValue, parts: list[str]) -> bool:
    """Return whether real and imaginary part are those of a key."""
    return all(map(entry_matches, value, parts))


def build_complex(parts: list[str], form: str) -> Expr:
    """Return a number of a key as a formula of ``i``, in the form asked."""
    if form != "polar":
        return parse_entry(parts)
    real, imaginary = map(parse_entry, parts)
    unit, square = Sym("i"), make_number(2)
    size = Call(
        "sqrt", (Call("add", (Call("pow", (real, square)), Call("pow", (imaginary, square)))),)
    )
    angle = _write_angle(parts, real, imaginary)
    return tidy_formula(Call("mul", (size, Call("exp", (Call("mul", (unit, angle)),)))))


def _write_angle(parts: list[str], real: Expr, imaginary: Expr) -> Expr:
    """Return the angle: a multiple of pi where it is an eighth of a turn, else by ``atan2``."""
    x, y = map(parse_exact, parts)
    for eighth, right in enumerate(
        ((x > 0 and y == 0), (x > 0 and _agree(x, y)), (x == 0 and y > 0),
         (y > 0 and _agree(-x, y)), (x < 0 and y == 0))
    ):  # fmt: skip
        if right:
            return tidy_formula(
                Call("div", (Call("mul", (make_number(eighth), Call("pi", ()))), make_number(4)))
            )
    return Call("atan2", (imaginary, real))


def _agree(a: Value, b: Value) -> bool:
    """Return whether two values agree, or cannot be shown to differ."""
    return values_agree(a, b) is not False


def ask(part: PartContext) -> AskedPart[ComplexSpec]:
    """Return the number of the solver, and what each mistake makes of it."""
    factor = find_factor(part)
    traps = {name: _list_parts(f, factor) for name, f in part.misconception_forms().items()}
    notes = part.misconception_notes(traps) if traps else {}
    parts = _list_parts(part.answer_form(), factor)
    given = {"parts": parts, "traps": traps, "notes": notes, **find_unit(part)}
    spec = make_spec(ComplexSpec, part, **given)
    return AskedPart(spec, mistakes=misconception_specs(spec, "parts"))


def _list_parts(form: Expr, factor: Value) -> list[str]:
    """Return real and imaginary part of a form in a unit; a real form has the imaginary part 0."""
    entry = format_entry(form, factor)
    return [entry, "0"] if isinstance(entry, str) else entry


def input_hints(spec: ComplexSpec, lang: str) -> tuple[TextOrInlines, ...]:
    """Return how a complex number is typed, and the form that is asked."""
    more = (translate(lang, f"ask.form_{spec.form}"),) if spec.form != "any" else ()
    return (*_HINT(spec, lang), *more, *spec.hint_unit(lang), *spec.hint_rounding(lang))


def explain_key(spec: ComplexSpec, _lang: str) -> TextOrInlines:
    """The number as it is written by hand, with its unit."""
    number = _typeset_number(spec)
    if not spec.unit or (spec.form == "polar" and spec.tolerance):
        return spec.typeset_with_unit(number)
    from quizgen.typeset.prose import PlainText, to_inlines

    return spec.typeset_with_unit((PlainText("("), *to_inlines(number), PlainText(")")))


def _typeset_number(spec: ComplexSpec) -> TextOrInlines:
    """Return the number alone as it is written by hand."""
    if spec.form == "polar" and spec.tolerance:
        from quizgen.typeset import quantity
        from quizgen.typeset.nodes import Ident, MathRow
        from quizgen.typeset.prose import TypesetMaths

        size, angle = spec.rounded_polar()
        row = MathRow((quantity(size, ""), Ident("\N{ANGLE}"), quantity(angle, "deg")))
        return (TypesetMaths(row, spec.show_plain()),)
    if spec.tolerance:
        return typeset_key(parse_formula(spec.rounded_sum(), symbols=("i",)), spec.show_plain())
    return typeset_key(build_complex(spec.parts, spec.form))


def paper_hints(spec: ComplexSpec, lang: str) -> tuple[str, ...]:
    """Return the form that is asked, if one is."""
    form = (translate(lang, f"on_paper.form_{spec.form}"),) if spec.form != "any" else ()
    return (*form, *spec.hint_rounding_on_paper(lang))


KIND = AnswerKind(AuthoredComplex, ComplexSpec, ask, input_hints, explain_key, paper_hints)
