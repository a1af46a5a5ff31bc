"""Splitting a typed quantity into its number and its unit."""

from __future__ import annotations

import re

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.errors import FormulaError
from quizgen.marking.reading.literals import Doubt
from quizgen.marking.reading.rewrites import Source
from quizgen.marking.reading.scalars import Number, read_source
from quizgen.marking.reading.unit_words import TypedUnit, plain_unit, suggestion, typed_unit
from quizgen.maths.notation import ReadError
from quizgen.maths.units import shown as shown_unit
from quizgen.maths.values import Value

_NUMBER_PART = re.compile(
    r"(?:[\d.,' +()√π^*/-]|[eE](?=[-+]?\d)|sqrt(?=\()|pi(?![^\W\d_])|[xX](?= ?10))*"
)
_FAST = re.compile(r"(-?\d+(?:[.,]\d+)?) ?([a-zA-Zµμ°%]+)", re.ASCII)


class TypedQuantity(msgspec.Struct, frozen=True):
    """The number part and the unit of an answer; the unit is None when none was typed."""

    number: Source
    unit: TypedUnit | None


def split_quantity(source: Source) -> TypedQuantity:
    """Split at the first letter that is not part of the number.

    Raises
    ------
    ReadError
        If what follows the number is not a listed unit.
    """
    match = _NUMBER_PART.match(source.text)
    end = match.end() if match else 0
    number, rest = source.text[:end], source.text[end:]
    if rest and number.rstrip().endswith(("/", "*")):
        number, rest = _unit_with_sign(number, rest)
    if not rest.strip():
        return TypedQuantity(source.strip(), None)
    if not any(map(str.isdigit, number)) and not re.search("[π√]|pi", number):
        raise ReadError("number-missing", source.column(0), rest)
    return TypedQuantity(source.cut(0, len(number)).strip(), _unit(rest, source, end))


def _unit_with_sign(number: str, rest: str) -> tuple[str, str]:
    """``15 1/mm`` and ``0.015/mm``: the division sign belongs to the unit."""
    match = re.search(r"(?:(?<=[\d)] )1 ?)?([/*]) ?$", number)
    if match is None:
        return number, rest
    return number[: match.start()], ("1/" if match[1] == "/" else "") + rest


def _unit(text: str, source: Source, position: int) -> TypedUnit:
    try:
        return typed_unit(text)
    except FormulaError:
        column = source.column(position)
        meant = suggestion(text)
        raise ReadError("unknown-unit", column, text.strip(), [meant] if meant else []) from None


def read_all(
    items: list[Source], asked: str, unit: TypedUnit | None, decimal: str
) -> tuple[list[Number], list[Number] | None, Doubt | None]:
    """Read every item in the asked unit; both readings if one item has two."""
    first, second, doubt = [], [], None
    for item in items:
        quantity = split_quantity(item)
        scale = _scale(quantity.unit or unit, asked, item)
        readings = read_source(quantity.number, decimal)
        first.append(_scaled(readings.main, scale))
        second.append(_scaled(readings.other or readings.main, scale))
        doubt = doubt or readings.doubt
    return first, second if doubt else None, doubt


def _scale(unit: TypedUnit | None, asked: str, item: Source) -> Value:
    if unit is None:
        return fmpq(1)
    wanted = plain_unit(asked)
    if unit.dimension != wanted.dimension:
        code = "unit-not-asked" if not wanted.dimension else "unit-other"
        raise ReadError(code, item.column(0), shown_unit(unit.text), [shown_unit(asked)])
    return unit.factor / wanted.factor


def _scaled(number: Number, scale: Value) -> Number:
    return number if scale == 1 else replace(number, value=number.value * scale)
