"""Parameters of figures: what each value means, and one clear line when one is missing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal, TypeAlias, get_args

import msgspec

from quizgen.core.errors import BankError

Values = Mapping[str, Any]
"""Parameter name to a number, a list or table of numbers, or a text."""

ABSENT = math.nan
"""Default of a parameter that may be left out altogether."""


Kind: TypeAlias = Literal["number", "list", "table", "text", "texts"]


class Parameter(msgspec.Struct, frozen=True):
    """One parameter of a figure: unit, meaning, default and allowed values.

    Attributes
    ----------
    unit : str
        Unit that numbers are given in; empty for plain numbers.
    meaning : str
        What it is, and what its codes mean when it is a choice.
    default : number, list, text or None
        Taken when the value is left out; None if it must be given.
    low, high : float
        Allowed range of each number, both ends included.
    whole : bool
        Only whole numbers: a code or a count.
    kind : {"number", "list", "table", "text", "texts"}
        A number; a list of numbers; a list of lists of equal length; words or a name; a list of
        these.
    """

    unit: str
    meaning: str
    default: Any = None
    low: float = -math.inf
    high: float = math.inf
    whole: bool = False
    kind: Kind = "number"


def fill_defaults(figure: str, table: Mapping[str, Parameter], values: Values) -> dict[str, Any]:
    """Return checked values with defaults filled in, in the order of the table.

    Raises
    ------
    BankError
        If a name is unknown or missing, or a value is not finite, not whole, out of range or of
        another kind.
    """
    unknown = sorted(set(values) - set(table))
    if unknown:
        what = f"figure {figure!r}: unknown parameter {unknown[0]!r}"
        raise BankError(what, rule="QG142", place=("figure", "values", unknown[0]))
    full = {name: _check_value(figure, name, rule, values) for name, rule in table.items()}
    return {name: value for name, value in full.items() if value is not None}


def _check_value(figure: str, name: str, rule: Parameter, values: Values) -> Any:
    """Return one value as its parameter defines it; raise ``BankError`` if it does not fit."""
    if name not in values:
        if rule.default is None:
            what = f"figure {figure!r}: missing parameter {name!r} ({rule.meaning})"
            raise BankError(what, rule="QG143", place=("figure", "values"))
        is_absent = isinstance(rule.default, float) and math.isnan(rule.default)
        return None if is_absent else rule.default
    value = values[name]
    require(figure, rule.kind in get_args(Kind), f"{name}: there is no kind {rule.kind!r}")
    if rule.kind == "text":
        require(figure, isinstance(value, str), f"{name} = {value!r} is no text")
        return value
    if rule.kind == "number":
        return _check_number(figure, name, rule, value)
    rows = _require_list(figure, name, value)
    if rule.kind == "texts":
        require(figure, all(isinstance(one, str) for one in rows), f"{name}: not all are texts")
        return tuple(rows)
    if rule.kind == "list":
        return tuple(_check_number(figure, name, rule, item) for item in rows)
    table = [_require_list(figure, name, row) for row in rows]
    require(figure, len(set(map(len, table))) <= 1, f"{name}: rows of different lengths")
    return tuple(tuple(_check_number(figure, name, rule, item) for item in row) for row in table)


_WORDS = {"number": "text", "list": "texts", "table": "texts"}
"""The kind that takes words where another takes numbers."""


def _require_list(figure: str, name: str, value: Any) -> list[Any]:
    """Return an array, list or tuple as a list; raise ``BankError`` for anything else."""
    if hasattr(value, "tolist"):  # an array
        value = value.tolist()
    require(figure, isinstance(value, (list, tuple)), f"{name} = {value!r} is no list")
    return list(value)


def _check_number(figure: str, name: str, rule: Parameter, given: Any) -> float:
    """Return a number that is finite, whole if asked, and in range; else raise ``BankError``."""
    number = isinstance(given, (int, float)) and not isinstance(given, bool)
    words = f' (words are kind="{_WORDS[rule.kind]}")' if isinstance(given, str) else ""
    require(figure, number, f"{name} = {given!r} is not a number{words}")
    value = float(given) + 0.0  # the sum turns -0.0 into 0.0
    inside = math.isfinite(value) and rule.low <= value <= rule.high
    require(figure, inside, f"{name} = {value:g} is not between {rule.low:g} and {rule.high:g}")
    require(figure, not rule.whole or value.is_integer(), f"{name} = {value:g} is not whole")
    return value


def require(figure: str, holds: bool, message: str) -> None:
    """Raise ``BankError`` about a figure unless a condition holds.

    Raises
    ------
    BankError
        If the condition does not hold.
    """
    if not holds:
        raise BankError(f"figure {figure!r}: {message}", rule="QG144", place=("figure", "values"))
