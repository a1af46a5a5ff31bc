"""Splitting a typed quantity into its number and its unit."""

from __future__ import annotations

import re

import msgspec
from flint import fmpq

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.units import TypedUnit, read_unit, suggest_unit
from quizgen.maths.notation import FormulaReadError

_NUMBER_PART = re.compile(
    r"(?:[\d.,' +()√π^*/-]|[eE](?=[-+]?\d)|sqrt(?=\()|pi(?![^\W\d_])|[xX](?= ?10))*"
)

_SCALED = re.compile(r"(?P<unit>.*[^\W\d_]) ?(?P<sign>[/*]) ?10\^\(?(?P<power>-?\d{1,2})\)?")
"""A unit with a power of ten behind it: ``Mg/10^6``."""


class TypedQuantity(msgspec.Struct, frozen=True):
    """The number part and the unit of an answer; the unit is None when none was typed."""

    number: SourceText
    unit: TypedUnit | None


def split_quantity(source: SourceText) -> TypedQuantity:
    """Return the number part and the unit, split at the first letter of no number.

    Raises
    ------
    FormulaReadError
        If what follows the number is not a listed unit, or there is no number.
    """
    match = _NUMBER_PART.match(source.text)
    end = match.end() if match else 0
    number, rest = source.text[:end], source.text[end:]
    if rest.endswith(")") and number.rstrip(" ").endswith("("):
        number, rest = _move_bracket_to_unit(number, rest)
    if rest and number.rstrip().endswith(("/", "*")):
        number, rest = _unit_with_sign(number, rest)
    if not rest.strip():
        return TypedQuantity(source.strip(), None)
    if not any(map(str.isdigit, number)) and not re.search("[π√]|pi", number):
        raise FormulaReadError("number-missing", source.column(0), rest)
    return TypedQuantity(
        source.slice(0, len(number)).strip(), _read_quantity_unit(rest, source, end)
    )


def put_unit_behind(typed: str, asked: str) -> str:
    """Return ``102.5 mm`` for ``mm 102.5``, where a unit of the kind asked stands first.

    With an equals sign it would be a name, ``s = 3``.
    """
    match = _UNIT_FIRST.fullmatch(typed.strip())
    if match is None:
        return typed
    try:
        first = read_unit(match[1])
    except FormulaError:
        return typed
    alike = first.dimension == read_unit(asked).dimension
    return f"{match[2]} {match[1]}" if alike else typed


_UNIT_FIRST = re.compile(
    r"([^\W\d_]{1,12}(?:/[^\W\d_]{1,12})?|[%°€$£৳])(?: ?: ?| |(?<=[€$£৳]))([-+−]?[\d.,]*\d)"
)


def _move_bracket_to_unit(number: str, rest: str) -> tuple[str, str]:
    """Return number and rest of ``66.67 (mm)``, where the bracket belongs to the unit."""
    kept = number.rstrip(" (")
    return (number[: len(kept)], number[len(kept) :].lstrip() + rest) if kept else (number, rest)


def _unit_with_sign(number: str, rest: str) -> tuple[str, str]:
    """Return number and unit of ``15 1/mm`` and ``0.015/mm``: the unit has the division sign."""
    match = re.search(r"(?:(?<=[\d)] )1 ?)?([/*]) ?$", number)
    if match is None:
        return number, rest
    return number[: match.start()], ("1/" if match[1] == "/" else "") + rest


def _read_quantity_unit(text: str, source: SourceText, position: int) -> TypedUnit:
    """Return the unit behind a number.

    Raises
    ------
    FormulaReadError
        With the unit that may be meant, if it differs in case only.
    """
    scaled = _SCALED.fullmatch(text.strip())
    try:
        if scaled is not None:
            unit = read_unit(scaled["unit"])
            power = fmpq(10) ** (int(scaled["power"]) * (-1 if scaled["sign"] == "/" else 1))
            return msgspec.structs.replace(unit, text=text.strip(), factor=unit.factor * power)
        return read_unit(text)
    except FormulaError:
        column = source.column(position)
        meant = suggest_unit(text)
        raise FormulaReadError(
            "unknown-unit", column, text.strip(), [meant] if meant else []
        ) from None
