"""What kinds share whose key is a form of the solver: its numbers, read and compared one by one."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TYPE_CHECKING

from flint import fmpq

from quizgen.core.decoding import convert
from quizgen.grading.judging.sampled_equality import values_agree
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import ReadNumber, read_number
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.rounding import format_key
from quizgen.grading.spec import WordSpec
from quizgen.kinds.asking import precision_on_paper, rounding_hint
from quizgen.kinds.contract import AuthoredAnswer, PartContext
from quizgen.maths.constants import Scalar, parse_exact
from quizgen.maths.notation import format_tree, parse_formula, pretty
from quizgen.maths.numbers import is_short_decimal
from quizgen.maths.tolerance import RULES, Tolerance
from quizgen.maths.tree import Call, Expr, Num
from quizgen.maths.values import Value

if TYPE_CHECKING:
    from quizgen.typeset.prose import TextOrInlines

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


class EntriesSpec(WordSpec, kw_only=True, frozen=True):
    """Fields of a key of several numbers, and how near each must be.

    Without a rule numbers with a short decimal form are exact, and others may be rounded.
    """

    decimals: int | None = None
    sigfigs: int | None = None
    rel: Scalar | None = None
    abs: Scalar | None = None

    def validate(self) -> None:
        """Check the rule; errors as ``WordSpec.validate``."""
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


def round_entry(text: str, rule: Tolerance | None) -> str:
    """Return a number of a key as far as a rule asks; as it is without one, or if it is shorter."""
    if rule is None:
        return text
    value = parse_exact(text)
    if isinstance(value, fmpq) and is_short_decimal(value) and rule.decimals is None:
        return text
    rounded = format_key(rule, value)
    return rounded.rstrip("0").rstrip(".") if "." in rounded and "e" not in rounded else rounded


def show_entry(text: str) -> str:
    """Return a number of a key as it is printed, and as it can be typed back."""
    plain = format_plain(parse_entry(text))
    return (
        pretty.format_number(plain) if _NUMBER.fullmatch(plain) else pretty.format_constant(plain)
    )


def parse_entry(text: str) -> Expr:
    """Return the tree of a number of a key."""
    return parse_formula(text, symbols=())


def read_entry(piece: str | SourceText, decimal: str) -> ReadNumber:
    """Return a typed number.

    Raises
    ------
    FormulaReadError
        If it is none.
    """
    source = normalise_typed(piece) if isinstance(piece, str) else piece
    return read_number(source, decimal).main


def entry_matches(value: Value, text: str, rule: Tolerance | None = None) -> bool:
    """Whether a value is a number of a key: as near as a rule asks, if one is stated.

    Without one, it may be rounded where it has no short decimals.
    """
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
