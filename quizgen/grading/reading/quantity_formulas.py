"""Sums, products and quotients of quantities: ``2 m + 30 cm``, ``24 mm · 60 m / 160 m``."""

from __future__ import annotations

import re
from collections.abc import Iterator

from flint import fmpq

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.literals import with_decimal_points
from quizgen.grading.reading.numbers import Readings, read_plain_number
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import TypedUnit, read_unit
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.values import Value

_UNIT = r"(?:[^\W\d_]|[µμ°])+(?:\^\d)?"
_TOKEN = re.compile(rf" *(?:(\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)|({_UNIT}(?:[/*]{_UNIT})*)|([-+*/()]))")
_MOST_TOKENS = 40
Measured = tuple[Value, dict[str, int]]
"""A value in base units, and its dimension."""


def read_quantity_formula(source: SourceText, decimal: str) -> tuple[Readings, TypedUnit | None] | None:
    """Return what a formula of quantities gives, in the first of its units that fits.

    None if it is no such formula: it has no unit or no sign of arithmetic, has two readings, or
    adds what cannot be added.
    """
    try:
        text, other, _ = with_decimal_points(source, decimal)
        if other is not None:
            return None
        tokens = list(_tokenize(text.text))
        signs = [sign for _, _, sign in tokens if sign and sign not in "()"]
        units = [unit for _, unit, _ in tokens if unit is not None]
        if not signs or not units or len(tokens) > _MOST_TOKENS:
            return None
        value, dimension = _Evaluator(tokens).evaluate()
    except (FormulaError, FormulaReadError, ZeroDivisionError):
        return None
    return _write_in_unit(value, tuple(sorted(dimension.items())), units)


def _write_in_unit(
    value: Value, dimension: tuple[tuple[str, int], ...], units: list[TypedUnit]
) -> tuple[Readings, TypedUnit | None] | None:
    """Return a value in the first unit of its dimension; None if it has none of the units."""
    unit = next((one for one in units if one.dimension == dimension), None)
    if unit is None and dimension:
        return None
    value = value / unit.factor if unit else value
    if not isinstance(value, fmpq):
        return None
    readings = read_plain_number(f"{value.p}/{value.q}" if value.q != 1 else f"{value.p}", "point")
    return (readings, unit) if readings else None


def _tokenize(text: str) -> Iterator[tuple[str, TypedUnit | None, str]]:
    """Yield numbers, units and signs.

    Raises
    ------
    FormulaError
        If anything else stands there, or a unit is not listed.
    """
    position = 0
    while position < len(text.rstrip()):
        match = _TOKEN.match(text, position)
        if match is None:
            raise FormulaError("no quantity")
        yield match[1] or "", read_unit(match[2]) if match[2] else None, match[3] or ""
        position = match.end()


class _Evaluator:
    """Works out a list of tokens by the usual precedence."""

    def __init__(self, tokens: list[tuple[str, TypedUnit | None, str]]) -> None:
        """Begin with the first token."""
        self.tokens, self.place = tokens, 0

    def evaluate(self) -> Measured:
        """Return the value of all tokens.

        Raises
        ------
        FormulaError
            If they are no formula.
        """
        found = self._read_sum()
        if self.place < len(self.tokens):
            raise FormulaError("no quantity")
        return found

    def _next_sign(self) -> str:
        """Return the sign that comes next; empty at the end and before a number."""
        return self.tokens[self.place][2] if self.place < len(self.tokens) else ""

    def _read_sum(self) -> Measured:
        """Return a sum of terms, which must be of one dimension."""
        value, dimension = self._read_product()
        while (sign := self._next_sign()) in {"+", "-"}:
            self.place += 1
            more, other = self._read_product()
            if other != dimension:
                raise FormulaError("unlike quantities")
            value = value + more if sign == "+" else value - more
        return value, dimension

    def _read_product(self) -> Measured:
        """Return a product of factors."""
        value, dimension = self._read_factor()
        while (sign := self._next_sign()) in {"*", "/"}:
            self.place += 1
            more, other = self._read_factor()
            turned = 1 if sign == "*" else -1
            value = value * more if sign == "*" else value / more
            powers = {base: dimension.get(base, 0) + turned * other.get(base, 0) for base in {*dimension, *other}}
            dimension = {base: power for base, power in powers.items() if power}
        return value, dimension

    def _read_factor(self) -> Measured:
        """Return a number with its unit, or a sum in brackets, which may have a unit behind it."""
        if self.place >= len(self.tokens):
            raise FormulaError("no quantity")
        number, unit, sign = self.tokens[self.place]
        self.place += 1
        if sign == "(":
            value, dimension = self._read_sum()
            if self._next_sign() != ")":
                raise FormulaError("no quantity")
            self.place += 1
        elif number:
            value, dimension = fmpq(*_split_decimal(number)), {}
        else:
            raise FormulaError(f"no quantity {unit}")
        following = self.tokens[self.place][1] if self.place < len(self.tokens) else None
        if following is None:
            return value, dimension
        if dimension:
            raise FormulaError("two units")
        self.place += 1
        return value * following.factor, dict(following.dimension)


def _split_decimal(number: str) -> tuple[int, int]:
    """Return a number in point notation as a fraction.

    Raises
    ------
    FormulaError
        If it is out of range.
    """
    found = read_plain_number(number, "point")
    if found is None:
        raise FormulaError("number out of range")
    value = found.main.value
    return int(value.p), int(value.q)
