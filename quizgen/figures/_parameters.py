"""Parameters of figures: what each number means, and one clear line when one is missing."""

from __future__ import annotations

import math
from collections.abc import Mapping

import msgspec

from quizgen.errors import BankError

Values = Mapping[str, float]


class Parameter(msgspec.Struct, frozen=True):
    """One number a figure is drawn from.

    Attributes
    ----------
    unit : str
        Unit the number is given in; empty for plain numbers.
    meaning : str
        What it is, and what its codes mean when it is a choice.
    default : float or None
        Taken when the number is left out; None if it must be given.
    low, high : float
        Allowed range, both ends included.
    whole : bool
        Only whole numbers: a code or a count.
    """

    unit: str
    meaning: str
    default: float | None = None
    low: float = -math.inf
    high: float = math.inf
    whole: bool = False


def complete(figure: str, table: Mapping[str, Parameter], values: Values) -> dict[str, float]:
    """Check values against a table and fill in the defaults, in the order of the table.

    Raises
    ------
    BankError
        If a name is unknown or missing, or a value is not finite, not whole or out of range.
    """
    unknown = sorted(set(values) - set(table))
    if unknown:
        raise BankError(f"figure {figure!r}: unknown parameter {unknown[0]!r}")
    full = {name: _value(figure, name, rule, values) for name, rule in table.items()}
    return {name: value for name, value in full.items() if value is not None}


def _value(figure: str, name: str, rule: Parameter, values: Values) -> float | None:
    if name not in values:
        if rule.default is None:
            raise BankError(f"figure {figure!r}: missing parameter {name!r} ({rule.meaning})")
        return None if math.isnan(rule.default) else rule.default
    number = isinstance(values[name], (int, float))
    require(figure, number, f"{name} = {values[name]!r} is not a number")
    value = float(values[name]) + 0.0  # the sum turns -0.0 into 0.0
    require(
        figure,
        math.isfinite(value) and rule.low <= value <= rule.high,
        f"{name} = {value:g} is not between {rule.low:g} and {rule.high:g}",
    )
    require(figure, not rule.whole or value.is_integer(), f"{name} = {value:g} is not whole")
    return value


def require(figure: str, holds: bool, message: str) -> None:
    """Refuse values that cannot be drawn.

    Raises
    ------
    BankError
        If the condition does not hold.
    """
    if not holds:
        raise BankError(f"figure {figure!r}: {message}")


ABSENT = math.nan
"""Default of a parameter that may be left out altogether."""
