"""Answers that say more than one number: ``x = 20/3 ≈ 6.67``, ``[64]``, ``64 times``.

The sides of a chain must agree; names and formulas among them are passed over.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec
from flint import fmpq

from quizgen.errors import FormulaError
from quizgen.marking.reading.formulas import read_formula
from quizgen.marking.reading.lists import unbracketed
from quizgen.marking.reading.literals import Doubt
from quizgen.marking.reading.named import WORDS
from quizgen.marking.reading.quantities import TypedQuantity, split_quantity
from quizgen.marking.reading.scalars import (
    Number,
    Readings,
    constant_number,
    quick,
    read_source,
    scaled,
)
from quizgen.marking.reading.source import Source
from quizgen.marking.reading.unit_words import TypedUnit, plain_unit, typed_unit
from quizgen.maths.notation import ReadError
from quizgen.maths.units import shown as shown_unit
from quizgen.maths.values import Value

_EQUAL = re.compile(r" ?(?:=>|⇒|->|→|:=|==?|[≈≃≅≐∼~]) ?")
_NAMED = re.compile(rf"{WORDS}: ?(?=\S)")
_BRACKETS = re.compile(r"[\[{(]([^\[\]{}()]+)[\])}] ?(?=[^\W\d]|[%°])")
_LETTER = re.compile(r"[^\W\d_]")
_CLOSE = fmpq(1, 200)
"""How far apart the sides of a chain may be, if their last decimals say no more."""


class Side(msgspec.Struct, frozen=True):
    """One side of a chain: the number with its readings, and its unit."""

    quantity: TypedQuantity
    readings: Readings

    @property
    def places(self) -> int:
        """Decimals written; a fraction or formula is sharper than any decimal."""
        number = self.readings.main
        return number.places if number.form in {"decimal", "scientific"} else 100


_PLAIN = re.compile(r"([^a-zA-Zµμ°% ]+) ?((?:[a-zA-Zµμ°%][a-zA-Zµμ°%/]{0,24})?)")
_READ = Source("", ())
"""In place of a number part that has been read."""


def plain_side(typed: str, decimal: str) -> Side | None:
    """Read a plain number, alone or with a plain unit behind it, without any rewriting.

    Most of what people type is one: ``6.67 mm``, ``12,5%``, ``20/3``.
    """
    match = _PLAIN.fullmatch(typed)
    readings = match and quick(match[1], decimal)
    if match is None or readings is None:
        return None
    try:
        return Side(TypedQuantity(_READ, typed_unit(match[2]) if match[2] else None), readings)
    except FormulaError:
        return None


def read_sides(source: Source, decimal: str) -> list[Side]:
    """Read a number with or without a unit; every side, if equal things are chained.

    Raises
    ------
    ReadError
        If it cannot be read, or the sides contradict each other.
    """
    plain = plain_side(source.text, decimal)
    if plain is not None:
        return [plain]
    try:
        return [_side(source, decimal)]
    except ReadError as error:
        if error.code == "two-readings":
            raise
        found = list(_otherwise(source, decimal))
        if not found:
            raise
    _check(source, found)
    return found


def sharpest(sides: list[Side]) -> Side:
    """The side that says most: an exact one, else the one with most decimals."""
    return sides[0] if len(sides) == 1 else max(sides, key=lambda side: side.places)


def _side(source: Source, decimal: str) -> Side:
    quantity = split_quantity(source)
    return Side(quantity, read_source(quantity.number, decimal))


def _otherwise(source: Source, decimal: str) -> Iterator[Side]:
    """The sides of a chain, each without names and brackets; none if one cannot be read."""
    pieces = [piece for piece in _cut(source) if piece.text]
    if len({piece.text for piece in pieces}) < len(pieces):
        return
    sides: list[Side] = []
    for piece in pieces:
        side = _eased(piece, decimal)
        if side is not None:
            sides.append(side)
        elif not _LETTER.search(piece.text) or (piece is pieces[-1] and len(piece.text) > 3):
            return
    units = [side.quantity.unit for side in reversed(sides) if side.quantity.unit]
    unit = units[0] if units and units[0].text != "%" else None
    for side in sides:
        yield Side(TypedQuantity(side.quantity.number, side.quantity.unit or unit), side.readings)


def _cut(source: Source) -> Iterator[Source]:
    start = 0
    for match in _EQUAL.finditer(source.text):
        yield source.cut(start, match.start()).strip()
        start = match.end()
    yield source.cut(start).strip()


def _eased(piece: Source, decimal: str) -> Side | None:
    """Read one side, also behind a name in words, in brackets or as a formula of numbers."""
    named = _NAMED.match(piece.text)
    if named is not None:
        piece = piece.cut(named.end())
    inner, tail = unbracketed(piece)
    while inner.text != piece.text and not tail.text:
        piece = inner
        inner, tail = unbracketed(piece)
    piece = piece.sub(_BRACKETS, lambda m: f"{m[1]} ") if _BRACKETS.match(piece.text) else piece
    try:
        return _side(piece, decimal)
    except ReadError:
        return _formula(piece, decimal)


def _formula(piece: Source, decimal: str) -> Side | None:
    try:
        found = read_formula(piece.text, (), decimal)
        if found.other is not None:
            return None
        number = constant_number(found.tree)
    except ReadError:
        return None
    return Side(TypedQuantity(piece, None), Readings(number))


def _check(source: Source, sides: list[Side]) -> None:
    """Ask back when two sides are not equal."""
    for side in sides[1:]:
        if not _agree(sides[0], side):
            raise ReadError("two-readings", source.column(0), source.text)


def _agree(first: Side, second: Side) -> bool:
    one, other = first.quantity.unit, second.quantity.unit
    if one is not None and other is not None and one.dimension != other.dimension:
        return False
    (a, near), (b, close) = _measured(first), _measured(second)
    return bool(abs(a - b) <= max(near, close, key=float) or abs(a - b) <= _CLOSE * abs(b))


def _measured(side: Side) -> tuple[Value, Value]:
    """The value in base units, and what its last decimal stands for."""
    number: Number = side.readings.main
    factor = side.quantity.unit.factor if side.quantity.unit else fmpq(1)
    factor = factor / 100 if number.percent else factor
    last = fmpq(1, 10**number.places) if number.places else fmpq(0)
    return number.value * factor, last * factor


def read_all(
    items: list[Source], asked: str, unit: TypedUnit | None, decimal: str
) -> tuple[list[Number], list[Number] | None, Doubt | None]:
    """Read every item in the asked unit; both readings if one item has two."""
    first, second, doubt = [], [], None
    for item in items:
        side = sharpest(read_sides(item, decimal))
        scale = _scale(side.quantity.unit or unit, asked, item)
        readings = side.readings
        first.append(scaled(readings.main, scale))
        second.append(scaled(readings.other or readings.main, scale))
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
