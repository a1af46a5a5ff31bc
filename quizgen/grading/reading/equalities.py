"""Answers that say more than one number: ``x = 20/3 ≈ 6.67``, ``[64]``, ``64 times``.

The sides of a chain must agree; names and formulas among them are passed over.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

import msgspec
from flint import fmpq

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.formulas import read_formula
from quizgen.grading.reading.labels import WORDS, drop_name
from quizgen.grading.reading.lists import strip_brackets
from quizgen.grading.reading.literals import Ambiguity
from quizgen.grading.reading.normalise import normalise_typed
from quizgen.grading.reading.numbers import (
    Readings,
    ReadNumber,
    map_readings,
    number_from_tree,
    read_number,
    read_plain_number,
    scale_number,
)
from quizgen.grading.reading.quantities import TypedQuantity, split_quantity
from quizgen.grading.reading.quantity_formulas import read_quantity_formula
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import TypedUnit, listed_unit, read_unit
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value

_EQUAL = re.compile(r" ?(?:=>|⇒|->|→|:=|==?|[≈≃≅≐∼~]) ?")
_REST_OF_ALL = re.compile(r"(?<![\w.,])1 ?[-−–] ?(?=\d[\d.,]* ?%)")
"""All but a percentage, ``1 - 68 %``."""
_NAMED = re.compile(rf"{WORDS}: ?(?=\S)")
_BRACKETS = re.compile(r"[\[{(]([^\[\]{}()]+)[\])}] ?(?=[^\W\d]|[%°])")
_LETTER = re.compile(r"[^\W\d_]")
_HEADED = re.compile(r"\d[^,;]*[,;] +[^\W\d_]{2,}:")
"""A number and, behind a comma, a heading: what follows is no side of the same chain."""
_CLOSE = fmpq(1, 200)
"""How far apart the sides of a chain may be, if their last decimals say no more."""


class EqualitySide(msgspec.Struct, frozen=True):
    """One side of a chain: the number with its readings, and its unit."""

    quantity: TypedQuantity
    readings: Readings

    @property
    def places(self) -> int:
        """Decimals written; 100 for a fraction or formula, which is sharper than any decimal."""
        number = self.readings.main
        return number.places if number.form in {"decimal", "scientific"} else 100


_PLAIN = re.compile(r"([^a-zA-Zµμ°% ]+) ?((?:[a-zA-Zµμ°%][a-zA-Zµμ°%/]{0,24})?)")
_READ = SourceText("", ())
"""In place of a number part that has been read."""


def read_plain_side(typed: str, decimal: str) -> EqualitySide | None:
    """Return a plain number, alone or with a plain unit behind it; None if it is not plain.

    Most of what people type is one, and needs no rewriting: ``6.67 mm``, ``12,5%``, ``20/3``.
    """
    match = _PLAIN.fullmatch(typed)
    readings = match and read_plain_number(match[1], decimal)
    if match is None or readings is None:
        return None
    try:
        return EqualitySide(
            TypedQuantity(_READ, read_unit(match[2]) if match[2] else None), readings
        )
    except FormulaError:
        return None


def read_typed_sides(typed: str, decimal: str) -> list[EqualitySide]:
    """Return the sides of what was typed, without names and odd spellings.

    Raises
    ------
    FormulaReadError
        If it cannot be read, or the sides contradict each other.
    """
    plain = read_plain_side(typed, decimal)  # most answers, and needs no rewriting
    return [plain] if plain else read_sides(drop_name(normalise_typed(typed)), decimal)


def read_sides(source: SourceText, decimal: str) -> list[EqualitySide]:
    """Return a number with or without a unit; every side, if equal things are chained.

    Raises
    ------
    FormulaReadError
        If it cannot be read, or the sides contradict each other.
    """
    plain = read_plain_side(source.text, decimal)
    if plain is not None:
        return [plain]
    source = source.substitute(_REST_OF_ALL, lambda _m: "100 - ")
    try:
        return [_read_side(source, decimal)]
    except FormulaReadError as error:
        if error.code == "two-readings":
            raise
        found = list(_iter_lenient_sides(source, decimal))
        if not found:
            raise
    _check_sides_agree(source, found)
    return found


def most_precise_side(sides: list[EqualitySide]) -> EqualitySide:
    """Return the side that is most precise: an exact one, else the one with most decimals."""
    return sides[0] if len(sides) == 1 else max(sides, key=lambda side: side.places)


def _read_side(source: SourceText, decimal: str) -> EqualitySide:
    """Return one side, read strictly: a number and maybe a unit.

    Raises
    ------
    FormulaReadError
        If it is anything else.
    """
    quantity = split_quantity(source)
    return EqualitySide(quantity, read_number(quantity.number, decimal))


def _iter_lenient_sides(source: SourceText, decimal: str) -> Iterator[EqualitySide]:
    """Yield the sides of a chain, each without names and brackets.

    Nothing is yielded where a side of digits alone, or the last one, cannot be read.
    """
    pieces = [piece for piece in _split_at_equal_signs(source) if piece.text]
    if len(pieces) == 1 and (worked := read_quantity_formula(pieces[0], decimal)):
        yield EqualitySide(TypedQuantity(pieces[0], worked[1]), worked[0])
        return
    if len({piece.text for piece in pieces}) < len(pieces):
        return
    sides: list[EqualitySide] = []
    for piece in pieces:
        side = _read_lenient_side(piece, decimal)
        if side is not None:
            sides.append(side)
        elif _tells_value(piece.text) or (piece is pieces[-1] and len(piece.text) > len("max")):
            return
    yield from reversed([*_give_units(sides)])


def _tells_value(side: str) -> bool:
    """Return whether a side that cannot be read is no name: digits, or a value and a heading."""
    return not _LETTER.search(side) or _HEADED.search(side) is not None


def _give_units(sides: list[EqualitySide]) -> Iterator[EqualitySide]:
    """Yield the sides from the last on; one without a unit has that of the next one with one.

    Behind the last unit there is only the one before it.
    """
    units = [side.quantity.unit for side in sides if side.quantity.unit]
    unit = units[-1] if units and units[-1].text != "%" else None
    for side in reversed(sides):
        own = side.quantity.unit
        unit = own if own and own.text != "%" else unit
        given = None if _is_in_radians(side, unit) else unit
        yield EqualitySide(TypedQuantity(side.quantity.number, own or given), side.readings)


def _is_in_radians(side: EqualitySide, unit: TypedUnit | None) -> bool:
    """Return whether a side is a multiple of π beside one in degrees: ``60° = π/3``."""
    in_degrees = unit is not None and unit.text in _DEGREES
    return in_degrees and bool(re.search(r"π|\bpi\b", side.quantity.number.text))


def _split_at_equal_signs(source: SourceText) -> Iterator[SourceText]:
    """Yield the pieces between equals signs and arrows."""
    start = 0
    for match in _EQUAL.finditer(source.text):
        yield source.slice(start, match.start()).strip()
        start = match.end()
    yield source.slice(start).strip()


def _read_lenient_side(piece: SourceText, decimal: str) -> EqualitySide | None:
    """Return one side, also behind a name in words, in brackets or as a formula of numbers.

    None if it is none of these.
    """
    named = _NAMED.match(piece.text)
    if named is not None:
        piece = piece.slice(named.end())
    inner, tail = strip_brackets(piece)
    while inner.text != piece.text and not tail.text:
        piece = inner
        inner, tail = strip_brackets(piece)
    piece = (
        piece.substitute(_BRACKETS, lambda m: f"{m[1]} ") if _BRACKETS.match(piece.text) else piece
    )
    try:
        return _read_side(piece, decimal)
    except FormulaReadError:
        return _read_constant_formula(piece, decimal) or _read_formula_with_unit(piece, decimal)


def _read_formula_with_unit(piece: SourceText, decimal: str) -> EqualitySide | None:
    """Return ``20·lg(30) dB`` as a side; None if no unit stands behind a formula of numbers."""
    match = _FORMULA_WITH_UNIT.fullmatch(piece.text)
    if match is None:
        return None
    try:
        unit = read_unit(match[2])
    except FormulaError:
        return None
    side = _read_constant_formula(piece.slice(0, match.end(1)), decimal)
    return side and EqualitySide(TypedQuantity(side.quantity.number, unit), side.readings)


_FORMULA_WITH_UNIT = re.compile(r"(.*[\d)]) ?([^\W\d_]+|[%°])")


def _read_constant_formula(piece: SourceText, decimal: str) -> EqualitySide | None:
    """Return a formula of numbers as a side; None if it cannot be read or has two readings."""
    try:
        found = read_formula(piece.text, (), decimal)
        if found.other is not None:
            return None
        number = number_from_tree(found.tree)
    except FormulaReadError:
        return None
    return EqualitySide(TypedQuantity(piece, None), Readings(number))


def _check_sides_agree(source: SourceText, sides: list[EqualitySide]) -> None:
    """Ask back when two sides are not equal.

    Raises
    ------
    FormulaReadError
        ``two-readings``.
    """
    for before, side in pairwise(sides):
        alike = _is_equal_side(sides[0], side) or _is_rounded_to(source, before, side)
        alike = alike or _is_in_base_units(sides[0], side)
        if not alike and not _is_equal_side(*_without_percent(sides[0], side)):
            raise FormulaReadError("sides-differ", source.column(0), source.text)


def _is_rounded_to(source: SourceText, before: EqualitySide, side: EqualitySide) -> bool:
    """Return whether a whole number rounds what is worked out before it, or behind an arrow or ≈.

    ``sqrt(1000) = 32`` and ``2.8 → 3`` are such, ``31.6 = 32`` is not.
    """
    whole = side is not before and side.readings.main.form == "integer"
    worked = before.readings.main.form == "expression" and abs(side.readings.main.value) >= _SHARP
    if not whole or not (worked or _ROUNDED.search(source.text)):
        return False
    (a, _), (b, _) = _convert_to_base_units(before), _convert_to_base_units(side)
    unit = side.quantity.unit.factor if side.quantity.unit else fmpq(1)
    return bool(b != 0 and 2 * abs(a - b) <= unit)


def _is_in_base_units(first: EqualitySide, second: EqualitySide) -> bool:
    """Return whether a side worked out without units is the other one, but for its prefix.

    ``1920*1080*8*25 = 415 Mbit/s``: the side before has its unit from behind.
    """
    worked = [one for one in (first, second) if _WORKED_OUT.search(one.quantity.number.text)]
    (a, _), (b, _) = _convert_to_base_units(first), _convert_to_base_units(second)
    if len(worked) != 1 or not first.quantity.unit or not second.quantity.unit or a * b <= 0:
        return False
    factor = first.quantity.unit.factor
    scales = [factor, *(fmpq(1000) ** power for power in range(1, 5))]
    return any(
        bool(abs(a - b * scale) <= _CLOSE * abs(a)) for one in scales for scale in (one, 1 / one)
    )


_DEGREES = frozenset({"deg", "°"})
_RADIAN = fmpq(17453292519943296, 10**18)
"""A degree in radians, as near as sides of a chain are compared."""
_SHARP = 10
"""Whole numbers from here on may round what was worked out."""
_WORKED_OUT = re.compile(r"\d ?[*/^] ?\d")
_ROUNDED = re.compile(r"(?:→|->|≈|=>|⇒) ?[-−]?\d+(?![.,]?\d)[^\d=]*$")


def _without_percent(
    first: EqualitySide, second: EqualitySide
) -> tuple[EqualitySide, EqualitySide]:
    """Return two sides as plain numbers if only one has a percent sign: ``100 - 68 = 32 %``."""
    if _is_percent(first) == _is_percent(second):
        return first, second
    one, other = map(_drop_percent, (first, second))
    return one, other


def _is_percent(side: EqualitySide) -> bool:
    """Return whether a side has a percent sign."""
    unit = side.quantity.unit
    return side.readings.main.percent or (unit is not None and unit.text == "%")


def _drop_percent(side: EqualitySide) -> EqualitySide:
    """Return a side without its percent sign; any other side as it is."""
    if not _is_percent(side):
        return side
    plain = map_readings(side.readings, lambda n: msgspec.structs.replace(n, percent=False))
    return EqualitySide(TypedQuantity(side.quantity.number, None), plain)


def _is_equal_side(first: EqualitySide, second: EqualitySide) -> bool:
    """Return whether two sides agree within the last decimal of either, or half a percent.

    Sides in units of other dimensions never do.
    """
    one, other = first.quantity.unit, second.quantity.unit
    if one is not None and other is not None and one.dimension != other.dimension:
        return False
    (a, near), (b, close) = _convert_to_base_units(first), _convert_to_base_units(second)
    degrees = [unit is not None and unit.text in _DEGREES for unit in (one, other)]
    if (one is None or other is None) and any(degrees):
        x, y = (
            side * _RADIAN if turned else side for side, turned in zip((a, b), degrees, strict=True)
        )
        if abs(x - y) <= _CLOSE * abs(y):
            return True
    unit = max(near, close, key=float)
    if abs(b) < _SHARP * unit:  # 0.4 is not 0.3, though one unit of the last place away
        unit = unit / 2
    return bool(abs(a - b) <= unit or abs(a - b) <= _CLOSE * abs(b))


def _convert_to_base_units(side: EqualitySide) -> tuple[Value, Value]:
    """Return the value in base units, and one unit of its last decimal there (0 if exact)."""
    number: ReadNumber = side.readings.main
    factor = side.quantity.unit.factor if side.quantity.unit else fmpq(1)
    factor = factor / 100 if number.percent else factor
    last = fmpq(1, 10**number.places) if number.places else fmpq(0)
    return number.value * factor, last * factor


def read_items(
    items: list[SourceText], asked: str, unit: TypedUnit | None, decimal: str
) -> tuple[list[ReadNumber], list[ReadNumber] | None, Ambiguity | None]:
    """Return every item in the asked unit, the other readings or None, and why there are two.

    Parameters
    ----------
    items : list of SourceText
    asked : str
        The unit to convert to.
    unit : TypedUnit or None
        What stood behind the list, for items without a unit of their own.
    decimal : str
        The learner's decimal sign.

    Raises
    ------
    FormulaReadError
        If an item cannot be read, or its unit is of another dimension.
    """
    first, second, doubt = [], [], None
    for item in items:
        side = most_precise_side(read_sides(item, decimal))
        scale = _compute_unit_factor(side.quantity.unit or unit, asked, item)
        readings = side.readings
        first.append(scale_number(readings.main, scale))
        second.append(scale_number(readings.other or readings.main, scale))
        doubt = doubt or readings.doubt
    return first, second if doubt else None, doubt


def _compute_unit_factor(unit: TypedUnit | None, asked: str, item: SourceText) -> Value:
    """Return how many asked units a typed one is; 1 if none was typed.

    Raises
    ------
    FormulaReadError
        If it is of another dimension, or no unit was asked for.
    """
    if unit is None:
        return fmpq(1)
    wanted = listed_unit(asked)
    if unit.dimension != wanted.dimension:
        code = "unit-not-asked" if not wanted.dimension else "unit-other"
        raise FormulaReadError(code, item.column(0), format_unit(unit.text), [format_unit(asked)])
    return unit.factor / wanted.factor
