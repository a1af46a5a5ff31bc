"""What kinds share whose key is a form of the solver: its numbers, read and compared one by one."""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Collection
from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import msgspec
from flint import fmpq

from quizgen.core.decoding import convert
from quizgen.core.errors import FormulaError
from quizgen.grading.diagnosis.carry_forward import to_constant
from quizgen.grading.judging.sampled_equality import values_agree
from quizgen.grading.options import GradingOptions
from quizgen.grading.reading.formulas import read_formula
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import ReadNumber, read_number
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import TypedUnit, listed_unit, part_joined_units, read_unit
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import WordSpec
from quizgen.grading.verdict import HALF, Verdict, partial, wrong
from quizgen.kinds.asking import precision_on_paper, rounding_hint, unit_hint
from quizgen.kinds.contract import AuthoredAnswer, PartContext
from quizgen.maths.complex_values import ComplexValue, evaluate_complex
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import format_tree, parse_formula, pretty
from quizgen.maths.numbers import is_short_decimal
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tolerance import RULES, Tolerance
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.maths.units import UnitRegistry, build_unit_registry, format_unit
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

EntryText: TypeAlias = str | list[str]
"""An entry of a key: a constant formula, or those of a real and an imaginary part."""
IMAGINARY = ("i", "j")
_UNIT_AFTER = re.compile(r"(?<=\d)([ij])(?=[^\W\d_])")
_UNIT_WORD = re.compile(
    r"(?<![^\W\d_])[^\W\d_]+(?:\^-?\d)?(?:(?:[/*·]| (?=[^\W\d_]))[^\W\d_]+(?:\^-?\d)?)*"
)
_NO_UNITS = frozenset({"i", "j", "e", "exp", "sqrt", "cos", "sin", "pi", "π", "deg", "rad"})
_NUMBER = re.compile(r"-?\d+(?:/\d+|\.\d+)?")
_FORM_WORDS = {"eq": "equation", "lt": "<", "le": "<=", "gt": ">", "ge": ">="}
"""Operator to its name, where that is not the word for it."""
_CALLED = re.compile(
    r"^\s*(?:[^\W\d_]\w{0,9}'*\s*[·*⋅×]?\s*){1,2}(?::=|[=:≈]|(?<=\s)is\b)\s*(?=\S)"
)
"""A name or a product of two in front of a value: ``A = ``, ``z·w is ``."""
_BOXED = re.compile(r"\s*\\boxed ?\{(.*)\}\s*", re.DOTALL)
ROUNDED = fmpq(1, 200)
"""Share of a number that has no short decimal form within which it may be rounded."""


def require_form(part: PartContext, form: Expr, *ops: str) -> Call:
    """Return what a solver gives, if it is one of the operators that a kind asks for.

    Raises
    ------
    BankError
        If it is another, or none.
    """
    if not isinstance(form, Call) or form.op not in ops:
        wanted = " or ".join(_FORM_WORDS.get(op, op) for op in ops)
        raise part.error(f"{part.answer.get('of')!r} is no {wanted} of the solver")
    return form


def typeset_key(tree: Expr, typed_text: str = "") -> TextOrInlines:
    """Return a formula of a key as it is written by hand.

    ``typed_text`` is how it would be typed, where that is not the formula itself.
    """
    from quizgen import typeset
    from quizgen.typeset.prose import TypesetMaths

    return (TypesetMaths(typeset.lay_out(tree, inline=True), typed_text or format_tree(tree)),)


def format_plain(expr: Expr) -> str:
    """Return a number of a form as a person types it: ``-1/3``, ``2*sqrt(3)``, ``inf``."""
    if not isinstance(expr, Num):
        return format_tree(expr)
    return format_tree(expr).strip("{}") if expr.decimal else str(expr.value)


class AuthoredEntries(AuthoredAnswer, kw_only=True, frozen=True):
    """Numbers of a form of the solver, and how near each must be: one rule at most."""

    decimals: int | None = None
    sigfigs: int | None = None
    rel: Scalar | None = None
    abs: Scalar | None = None
    unit: str = ""


class EntriesSpec(WordSpec, kw_only=True, frozen=True):
    """Fields of a key of several numbers, and how near each must be.

    Without a rule numbers with a short decimal form are exact, and others may be rounded.
    ``unit`` is that of all numbers, ``define`` are units of the question's bank.
    """

    decimals: int | None = None
    sigfigs: int | None = None
    rel: Scalar | None = None
    abs: Scalar | None = None
    unit: str = ""
    define: tuple[str, ...] = ()

    @abstractmethod
    def judge_entries(self, typed: str, scale: Value, options: GradingOptions, /) -> Verdict:
        """Return the verdict on what was typed without a unit; its numbers count times ``scale``.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """

    def judge(self, typed: str, options: GradingOptions, /) -> Verdict:
        """Return the verdict on what was typed, with its unit if one is asked.

        Raises
        ------
        FormulaReadError
            If it cannot be read.
        """
        plain, unit = self.split_unit(typed)
        wanted = listed_unit(self.unit)
        if unit is not None and unit.dimension != wanted.dimension:
            said = {"given": format_unit(unit.text), "asked": format_unit(self.unit)}
            return wrong(typed, "unit-clash", **said)
        scale = fmpq(1) if unit is None else unit.factor / wanted.factor
        verdict = self.judge_entries(plain, scale, options)
        if not self.unit or unit is not None or verdict.credit < 1:
            return verdict
        credit = max(HALF, 1 - HALF / (options.points or Fraction(1)))
        return partial(credit, verdict.read_as, "unit-missing", unit=format_unit(self.unit))

    def known_units(self) -> UnitRegistry:
        """Return the units that may be typed: those listed, and those of the question's bank."""
        return build_unit_registry(self.define)

    def split_unit(self, typed: str) -> tuple[str, TypedUnit | None]:
        """Return an answer without its unit, which may stand after each number, and the unit.

        It is None if there is none, or none is asked.
        """
        if not self.unit:
            return typed, None
        powers = (
            part_joined_units(typed.replace(r"\Omega", " Ω"), self.unit)
            .replace("²", "^2")
            .replace("³", "^3")
        )
        spaced = _UNIT_AFTER.sub(r"\1 ", drop_name(powers))
        found = _UNIT_WORD.findall(spaced)
        words = dict.fromkeys(one for word in found for one in _list_ends(word))
        units = {word: unit for word in words if (unit := _find_unit(word))}
        wanted = listed_unit(self.unit).dimension
        ends = found and spaced.rstrip(" )]}$").endswith(found[-1])
        last = _list_ends(found[-1]) if ends else []
        for word in [*(w for w in units if units[w].dimension == wanted), *last]:
            if word in units:
                inside = rf"(?<![^\W\d_]){re.escape(word)}(?![^\W_])"
                return re.sub(inside, " ", spaced).strip(), units[word]
        return typed, None

    def base_factor(self, unit: TypedUnit | None) -> Value:
        """Return how many base units a typed number counts."""
        return (unit or listed_unit(self.unit)).factor

    def add_unit(self, shown: str) -> str:
        """Return a printed key with its unit, if it has one."""
        return f"{shown} {format_unit(self.unit)}" if self.unit else shown

    def typeset_with_unit(self, key: TextOrInlines) -> TextOrInlines:
        """Return a typeset key with its unit, if it has one."""
        from quizgen.typeset.prose import PlainText, to_inlines

        unit = f"\N{NO-BREAK SPACE}{format_unit(self.unit)}"
        return (*to_inlines(key), PlainText(unit)) if self.unit else key

    def hint_unit(self, lang: str) -> tuple[str, ...]:
        """Return the sentence on the unit, if there is one."""
        return (unit_hint(self.unit, lang),) if self.unit else ()

    def validate(self) -> None:
        """Check the rule and the unit; errors as ``WordSpec.validate``."""
        listed_unit(self.unit)
        if self.tolerance:
            self.tolerance.validate()

    def stated_rule(self) -> dict[str, Scalar]:
        """Return the rule that is stated, by its name; empty if none is."""
        names = AuthoredEntries.__struct_fields__
        found = {name: getattr(self, name) for name in names if name in RULES}
        return {name: number for name, number in found.items() if number is not None}

    @property
    def tolerance(self) -> Tolerance | None:
        """The rule as kinds of numbers have it; None if none is stated."""
        stated = self.stated_rule()
        return convert(stated, Tolerance) if stated else None

    def hint_rounding(self, lang: str) -> tuple[str, ...]:
        """Return the sentence on rounding for pages; empty if no rule is stated."""
        rule = self.tolerance
        return (rounding_hint(rule, [], lang),) if rule else ()

    def hint_rounding_on_paper(self, lang: str) -> tuple[str, ...]:
        """Return the same in few words."""
        rule = self.tolerance
        return precision_on_paper(rule, lang) if rule else ()


def _list_ends(words: str) -> list[str]:
    """Return words, the same without the first, and so on: of ``k N m`` only two are the unit."""
    parts = words.split(" ")
    return [" ".join(parts[first:]) for first in range(len(parts))]


def _find_unit(word: str) -> TypedUnit | None:
    """Return the unit that a word is; None for a function, an imaginary unit or an angle."""
    with suppress(FormulaError):
        return None if word in _NO_UNITS else read_unit(word)
    return None


def find_unit(part: PartContext) -> dict[str, Any]:
    """Return the fields of a specification for the unit that a part asks; empty if it asks none."""
    if not part.answer.get("unit"):
        return {}
    return {"unit": part.answer["unit"], "define": list(part.defined_units)}


def find_factor(part: PartContext) -> Value:
    """Return how many base units the unit has that a part asks."""
    with build_unit_registry(tuple(part.defined_units)).activate():
        return listed_unit(part.answer.get("unit", "")).factor


def format_entry(expr: Expr, factor: Value = fmpq(1)) -> EntryText:  # noqa: B008 - a constant
    """Return an entry of a form as a key has it, in a unit of so many base units."""
    if factor != 1 and not (isinstance(expr, Call) and expr.op == "complex"):
        expr = tidy_formula(Call("div", (expr, to_constant(factor))))
    if isinstance(expr, Call) and expr.op == "complex":
        return [str(format_entry(part, factor)) for part in expr.args]
    return format_plain(expr)


def scale_entry(value: Value | ComplexValue, scale: Value) -> Value | ComplexValue:
    """Return a typed number in another unit."""
    if scale == 1:
        return value
    return (value[0] * scale, value[1] * scale) if isinstance(value, tuple) else value * scale


def check_entry(entry: EntryText) -> None:
    """Raise ``FormulaError`` if an entry of a key cannot be read, ``ValueError`` if it is none."""
    parts = _split_parts(entry)
    if len(parts) != len(("real", "imaginary")):
        raise ValueError("an entry is a number, or a real and an imaginary part")
    for text in parts:
        parse_exact(text)


def _split_parts(entry: EntryText) -> list[str]:
    """Return the real and the imaginary part of an entry."""
    return [entry, "0"] if isinstance(entry, str) else entry


def round_entry(entry: EntryText, rule: Tolerance | None) -> EntryText:
    """Return an entry as far as a rule asks, each part of a complex one."""
    if isinstance(entry, list):
        return [round_number(part, rule) for part in entry]
    return round_number(entry, rule)


def round_number(text: str, rule: Tolerance | None) -> str:
    """Return a number of a key as far as a rule asks; as it is without one, or if it is shorter."""
    if rule is None:
        return text
    value = parse_exact(text)
    if isinstance(value, fmpq) and is_short_decimal(value) and rule.decimals is None:
        return text
    rounded = format_key(rule, value)
    return rounded.rstrip("0").rstrip(".") if "." in rounded and "e" not in rounded else rounded


def show_entry(entry: EntryText) -> str:
    """Return an entry of a key as it is printed, and as it can be typed back."""
    plain = format_plain(parse_entry(entry))
    return (
        pretty.format_number(plain) if _NUMBER.fullmatch(plain) else pretty.format_constant(plain)
    )


def parse_entry(entry: EntryText) -> Expr:
    """Return the tree of an entry of a key; of a complex one as a formula of ``i``."""
    if isinstance(entry, str):
        return parse_formula(entry, symbols=())
    real, imaginary = map(parse_entry, entry)
    return tidy_formula(Call("add", (real, Call("mul", (imaginary, Sym("i"))))))


class TypedEntry(msgspec.Struct, frozen=True):
    """An entry of a typed matrix: its value, or the parts of a complex one, and the echo."""

    value: Value | ComplexValue
    read_as: str


def read_any_entry(piece: str | SourceText, decimal: str, *, as_complex: bool) -> TypedEntry:
    """Return a typed entry, which may be a formula of ``i`` or ``j`` if complex ones are asked.

    Raises
    ------
    FormulaReadError
        If it is no number.
    """
    if not as_complex:
        number = read_entry(piece, decimal)
        return TypedEntry(number.value, number.read_as)
    text = separate_unit(piece if isinstance(piece, str) else piece.text)
    tree = read_formula(text, IMAGINARY, decimal).tree
    value = evaluate_complex(tree, frozenset(IMAGINARY))
    return TypedEntry(value, pretty.format_formula(format_tree(tree)))


_UNIT_FIRST = re.compile(r"(?<![^\W\d_])([ij]) ?(?=\d)")
_UNIT_APART = re.compile(r"(?<=[\d)])(?P<blank> *)(?=[ij](?![^\W_]))")
"""The unit behind a number, which is no part of the denominator: ``11/29i``."""


def separate_unit(typed: str) -> str:
    """Return ``j40``, as engineers write it, and ``√3/2 i`` as products."""
    return _UNIT_APART.sub("*", _UNIT_FIRST.sub(r"\1*", typed))


def write_constant(value: Value | ComplexValue) -> Expr:
    """Return a typed number as a form; a ball becomes its midpoint."""
    if isinstance(value, tuple):
        return Call("complex", tuple(map(to_constant, value)))
    return to_constant(value)


def read_entry(piece: str | SourceText, decimal: str) -> ReadNumber:
    """Return a typed real number.

    Raises
    ------
    FormulaReadError
        If it is none.
    """
    source = normalise_typed(piece) if isinstance(piece, str) else piece
    return read_number(source, decimal).main


def entry_matches(
    value: Value | ComplexValue, text: EntryText, rule: Tolerance | None = None
) -> bool:
    """Whether a value is an entry of a key: as near as a rule asks, if one is stated.

    Without one, it may be rounded where it has no short decimals.
    """
    if isinstance(value, tuple) or isinstance(text, list):
        parts = value if isinstance(value, tuple) else (value, fmpq(0))
        pairs = zip(parts, _split_parts(text), strict=True)
        return all(entry_matches(part, asked, rule) for part, asked in pairs)
    key = parse_exact(text)
    if rule is not None:
        return rule.is_within(value, key)
    if values_agree(value, key) is not False:
        return True
    return not is_short_decimal(key) and bool(abs(value - key) <= abs(key) * ROUNDED)


_EQUALS = re.compile(r"(?<![<>:!=])=(?!=)")
_DERIVED = re.compile(
    r" *(?:\$|\\\()? *(?:\\frac ?\{ ?d\w? ?\} ?\{ ?d\w ?\}"
    r"|d\w? ?/ ?d\w|d/d\w(?: ?\([^()]*\)| \w)?|\w+['′’]*(?:\(\w(?:, ?\w)*\))?|\\mathrm ?\{\w+\}) *"
)
"""What a function or its derivative is called: ``df/dx``, ``f'(x)``."""
_IN_DOLLARS = re.compile(r" *\$([^$]*)\$ *")


def split_sides(typed: str, names: Collection[str] = ()) -> list[str]:
    """Return the sides of ``SNR = N/√N = √N``, without what it is called in front.

    A name of the formula in front is a side: ``N = √N`` says something else than ``√N``.
    """
    inside = _IN_DOLLARS.fullmatch(typed)
    first, *others = _EQUALS.split(inside[1] if inside else typed)
    if not others or not all(map(str.strip, others)):
        return [typed]
    called = not first.strip() or (
        _DERIVED.fullmatch(first) is not None
        and re.sub("[′’]", "'", first.strip(" $")) not in names
    )
    product = not names and _CALLED.sub("", f"{first}=0") == "0"
    return others if called or product else [first, *others]


def drop_name(typed: str) -> str:
    """Return an answer without the box around it and what the student calls it in front."""
    boxed = _BOXED.fullmatch(typed)
    return _CALLED.sub("", boxed[1] if boxed else typed)
