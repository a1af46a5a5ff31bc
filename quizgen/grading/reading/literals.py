"""Decimal literals: point or comma, thousands groups, and literals with two readings."""

from __future__ import annotations

import re

import msgspec

from quizgen.grading.reading.source_map import SourceText
from quizgen.maths.notation import FormulaReadError

LITERAL = re.compile(r"[.,]?\d+(?:(?:[.,]+|[ '](?=\d{3}(?!\d)))\d+)*\.?")
"""A run of digits with marks and groups, as typed."""

_ONE_MARK = re.compile(r"(\d*)([.,])(\d+)")
_GROUPS = re.compile(r"\d{1,3}(?:([.,])\d{3})(?:\1\d{3})+|\d{1,2}(?:,\d{2})+,\d{3}")
_LAKHS = re.compile(r"\d{1,2}(?:,\d{2})+,\d{3}\.\d+")
_GROUPED_DECIMAL = re.compile(r"\d{1,3}(?:([.,])\d{3})+(?!\1)([.,])\d+")


class Ambiguity(msgspec.Struct, frozen=True):
    """A literal such as ``1.000`` that is a decimal or a group of thousands.

    ``native`` says that the mark is this learner's decimal sign (or could be); ``group_wins`` that
    the learner declared the other mark as decimal sign and groups this way.
    """

    mark: str
    native: bool
    group_wins: bool


class NumberLiteral(msgspec.Struct, frozen=True):
    """A literal in point notation, and its second reading if it has one."""

    text: str
    other: str = ""
    doubt: Ambiguity | None = None


def read_literal(typed: str, decimal: str = "auto", column: int = 1) -> NumberLiteral:
    """Return one decimal literal in point notation, with its second reading if it has two.

    Parameters
    ----------
    typed : str
        Digits with ``.``, ``,``, blanks or apostrophes.
    decimal : str
        The learner's decimal sign: ``auto``, ``point`` or ``comma``.
    column : int
        Where it was typed, for the error.

    Raises
    ------
    FormulaReadError
        If the marks fit no way of writing numbers.
    """
    compact = typed.replace(" ", "").replace("'", "")
    match = _ONE_MARK.fullmatch(compact)
    if match is None:
        return NumberLiteral(_several_marks(compact, column))
    whole, mark, digits = match.groups()
    decimal_reading = f"{whole or 0}.{digits}"
    if compact != typed or len(digits) != 3 or not 1 <= len(whole) <= 3 or whole[0] == "0":
        return NumberLiteral(decimal_reading)
    return NumberLiteral(decimal_reading, whole + digits, find_ambiguity(mark, decimal))


def find_ambiguity(mark: str, decimal: str) -> Ambiguity | None:
    """Return what stays doubtful about ``1.000`` for a decimal sign; None if nothing does."""
    if decimal == "auto":
        return Ambiguity(mark, native=True, group_wins=False)
    declared = mark == {"point": ".", "comma": ","}[decimal]
    return None if declared else Ambiguity(mark, native=False, group_wins=True)


def _several_marks(compact: str, column: int) -> str:
    """Return a literal with no mark or several of them in point notation, without groups.

    Raises
    ------
    FormulaReadError
        If the marks fit no way of writing numbers.
    """
    if compact.rstrip(".").isdigit():
        return compact.rstrip(".")
    match = _GROUPED_DECIMAL.fullmatch(compact)
    if match:
        return compact.replace(match[1], "").replace(match[2], ".")
    if _LAKHS.fullmatch(compact):
        return compact.replace(",", "")
    if _GROUPS.fullmatch(compact):
        return compact.replace(",", "").replace(".", "")
    raise FormulaReadError("bad-number", column, compact)


_ODD = re.compile(r"(?<![\d.,])\d+[.,](?:10 ?(?:\^|\*\*)|\(\d|\d+\(\d+\)(?! ?[*/^]))")
_GROUPS_BEHIND = re.compile(r"(?<![\d.,])\d+[.,]\d{3}(?:[ ']\d{3})*[ ']\d{1,2}(?![\d.,'/]| [\d/])")


def join_digit_groups(source: SourceText) -> SourceText:
    """Return the text with groups of digits behind the decimal sign closed up: ``3.141 592 65``.

    Raises
    ------
    FormulaReadError
        If a point can be a sign of multiplication (``3.10^5``) or mark a period (``6.(6)``).
    """
    odd = _ODD.search(source.text)
    if odd is not None:
        raise FormulaReadError("two-readings", source.column(odd.start()), source.text)
    return source.substitute(_GROUPS_BEHIND, lambda m: re.sub("[ ']", "", m[0]))


def with_decimal_points(
    source: SourceText, decimal: str
) -> tuple[SourceText, SourceText | None, Ambiguity | None]:
    """Return a text with a decimal point in every literal, and its other reading.

    Returns
    -------
    tuple
        The decimal reading; the reading with thousands groups, if it differs, else None; and the
        doubt, else None.

    Raises
    ------
    FormulaReadError
        If a literal cannot be read.
    """
    doubts: list[Ambiguity] = []

    def first(match: re.Match[str]) -> str:
        """Return the decimal reading of a literal, and note its doubt."""
        literal = read_literal(match[0], decimal, source.column(match.start()))
        if literal.doubt:
            doubts.append(literal.doubt)
        return literal.text

    def second(match: re.Match[str]) -> str:
        """Return the reading with thousands groups where there is one."""
        literal = read_literal(match[0], decimal)
        return literal.other or literal.text

    main = source.substitute(_STANDING, first)
    if not doubts:
        return main, None, None
    return main, source.substitute(_STANDING, second), doubts[0]


_STANDING = re.compile(rf"(?<![^\W\d_])(?<![\w'])(?:{LITERAL.pattern})")
