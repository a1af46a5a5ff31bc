"""One definition of a unit, in the syntax of Pint: ``newton = kg * m / s**2 = N = newtons``.

First the name, then what it is made of (``[mass]`` or ``[]`` for a unit of a new kind), then, each
optional, the symbol that is printed (``_`` for none) and further words that may be typed.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import NamedTuple

from quizgen.core.errors import FormulaError

SYNTAX = "expected 'name = [kind] = symbol' or 'name = 1000 * kg * m / s**2 = symbol'"

_NAME = re.compile(r"[^\W\d_]+(?:_[^\W\d_]+)*")
_SYMBOL = re.compile(r"[^\W\d_]+")
_KIND = re.compile(r"\[[a-z_]*\]")
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:[eE][+-]?\d{1,2})?")
_FACTOR = re.compile(r"([*/]?)\s*([^\s*/^]+)\s*(?:(?:\*\*|\^)\s*(-?\d))?\s*")
_FEWEST = 2


class UnitDefinition(NamedTuple):
    """A unit as it was defined: ``size`` times ``made_of``, which is None for a new kind."""

    text: str
    symbol: str
    words: tuple[str, ...]
    size: Fraction
    made_of: str | None


def parse_unit_definition(text: str) -> UnitDefinition:
    """Read a definition.

    Raises
    ------
    FormulaError
        If it is not of this form.
    """
    fields = [field.strip() for field in text.split("=")]
    if len(fields) < _FEWEST or not all(fields) or ";" in text:
        raise FormulaError(f"unit {text!r}: {SYNTAX}")
    name, made_of, *further = fields
    symbol = further[0] if further and further[0] != "_" else name
    words = tuple(word.replace("_", " ") for word in (name, f"{name}s", *further[1:]))
    for word in (name, *further[1:]):
        _check_unit_word(_NAME, word, text, "name")
    _check_unit_word(_SYMBOL, symbol, text, "symbol")
    spelt = tuple(word for word in dict.fromkeys(words) if word != symbol)
    if _KIND.fullmatch(made_of):
        return UnitDefinition(text, symbol, spelt, Fraction(1), None)
    return UnitDefinition(text, symbol, spelt, *_parse_unit_product(made_of, text))


def _check_unit_word(pattern: re.Pattern[str], word: str, text: str, what: str) -> None:
    if not pattern.fullmatch(word):
        raise FormulaError(f"unit {text!r}: {word!r} is no {what} (letters alone)")


def _parse_unit_product(made_of: str, text: str) -> tuple[Fraction, str]:
    """A product's number, and its units as they are written elsewhere."""
    size, units, position = Fraction(1), "", 0
    while position < len(made_of):
        match = _FACTOR.match(made_of, position)
        if match is None or bool(match[1]) != bool(position):
            raise FormulaError(f"unit {text!r}: {made_of!r} is no product; {SYNTAX}")
        sign, name, power = match.groups()
        if _NUMBER.fullmatch(name):
            size *= _raise_unit_number(
                Fraction(name), int(power or 1) * (-1 if sign == "/" else 1), text
            )
        else:
            units += f"{sign or '*'}{name}" + (f"^{power}" if power else "")
        position = match.end()
    return size, units.removeprefix("*")


def _raise_unit_number(number: Fraction, power: int, text: str) -> Fraction:
    if not number:
        raise FormulaError(f"unit {text!r}: 0 is no size")
    return number**power
