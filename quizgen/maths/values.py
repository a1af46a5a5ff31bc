"""Names for the values that formulas take."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NoReturn, TypeAlias

from flint import arb, fmpq

Value: TypeAlias = fmpq | arb
"""An exact rational, or a certified ball where the value is irrational."""

Values: TypeAlias = Mapping[str, Value]
"""Quantities by name, in base units unless said otherwise."""

AnyNumber: TypeAlias = Any
"""A number of whichever number system a formula runs in: rational, ball, float, array, ...

They share operators but no static type.
"""


class NumberList(tuple[Any, ...]):
    """A drawn list: numbers of one number system.

    Python would join two tuples for a sum, and order them by their first numbers. No formula means
    that.
    """

    __slots__ = ()

    def _refuse(self, _other: object) -> NoReturn:
        """Raise ``TypeError``: a tuple would be joined, repeated or compared as no list may be."""
        raise TypeError("a list stands where a number is needed")

    __add__ = __mul__ = __rmul__ = __lt__ = __le__ = __gt__ = __ge__ = _refuse


def map_numbers(function: Callable[[Any], AnyNumber], value: Any) -> Any:
    """Return what a function gives for a number, or for each number of a list."""
    return NumberList(map(function, value)) if isinstance(value, tuple) else function(value)
