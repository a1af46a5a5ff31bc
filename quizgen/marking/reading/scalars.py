"""Reading one number as people type it, exactly, with how it was written."""

from __future__ import annotations

import re
from collections.abc import Callable

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.marking.reading.literals import Doubt, doubtful, pointed, tidied
from quizgen.marking.reading.source import Source
from quizgen.maths.constants import constant
from quizgen.maths.notation import ReadError, parse_pieces, people, to_text, tokens
from quizgen.maths.notation.lexer import LARGEST_EXPONENT, LONGEST_NUMBER, SMALLEST_EXPONENT
from quizgen.maths.tree import Expr
from quizgen.maths.values import Value

LARGEST_VALUE = fmpq(10) ** LARGEST_EXPONENT
"""Largest number read."""


class Number(msgspec.Struct, frozen=True):
    """A number that was read.

    Parameters
    ----------
    value : flint.fmpq or flint.arb
        Exact while rational. With ``percent`` it is the number before the sign.
    read_as : str
        Echo in point notation, as people write it.
    form : str
        ``integer``, ``decimal``, ``scientific``, ``fraction``, ``mixed`` or ``expression``.
    places : int
        Decimal places written (0 unless a decimal).
    figures : tuple of int
        Fewest and most significant figures that the spelling can mean.
    lowest : bool
        A fraction in lowest terms with a positive denominator (or an integer).
    percent : bool
        A percent sign follows.
    """

    value: Value
    read_as: str
    form: str
    places: int = 0
    figures: tuple[int, int] = (1, 99)
    lowest: bool = True
    percent: bool = False


class Readings(msgspec.Struct, frozen=True):
    """The reading of a number and, if its literals are doubtful, the other one."""

    main: Number
    other: Number | None = None
    doubt: Doubt | None = None


def each(readings: Readings, change: Callable[[Number], Number]) -> Readings:
    """Both readings, changed."""
    other = None if readings.other is None else change(readings.other)
    return Readings(change(readings.main), other, readings.doubt)


def scaled(number: Number, scale: Value) -> Number:
    """The number in another unit."""
    return number if scale == 1 else replace(number, value=number.value * scale)


def as_percent(number: Number) -> Number:
    """The number with a percent sign behind it."""
    return replace(number, read_as=f"{number.read_as} %", percent=True)


def as_fraction(number: Number) -> Number:
    """The share that a percentage is: ``5 %`` is 0.05."""
    decimal = number.form in {"integer", "decimal"}
    form, places = ("decimal", number.places + 2) if decimal else (number.form, number.places)
    return replace(number, value=number.value / 100, form=form, places=places, percent=False)


_FAST = re.compile(
    r"([-−–]?)([0-9]{1,30})(?:([.,])([0-9]{1,30}))?(?:[eE]([-+]?[0-9]{1,2})|/([0-9]{1,30}))?"
)
_DIGITS = str.maketrans("০১২৩৪৫৬৭৮৯０１２３４５６７８９", "01234567890123456789")
_SCIENTIFIC = re.compile(
    r"(?P<sign>[-+]?) ?(?P<whole>\d*)(?:\.(?P<digits>\d*))?"
    r"(?: ?(?:[eE] ?(?P<e>[-+]?\d{1,5})"
    r"|\* ?10 ?(?:\^|\*\*) ?(?P<p>[-+]?\d{1,5}|\([-+]?\d{1,5}\))))?",
    re.ASCII,
)
_TEN = re.compile(
    r"(?P<sign>[-+]?) ?10 ?(?:\^|\*\*) ?(?P<p>[-+]?\d{1,5}|\([-+]?\d{1,5}\))", re.ASCII
)
_FRACTION = re.compile(
    r"(?P<sign>[-+]?) ?\(?(?P<top>\d+) ?/ ?(?P<minus>-?) ?(?P<bottom>\d+)\)?", re.ASCII
)
_MIXED = re.compile(
    r"(?P<sign>[-+]?) ?(?P<whole>\d+) +(?P<top>\d+) ?/ ?(?P<bottom>\d+)"
    r"|(?P<sign2>[-+]?) ?\((?P<whole2>\d+)\+(?P<top2>\d+)/(?P<bottom2>\d+)\)",
    re.ASCII,
)
_E_SPACED = re.compile(r"(?<=[\d.]) ?[eE] ?(?=[-+]?\d)")


def quick(typed: str, decimal: str) -> Readings | None:
    """Read a plain number without any rewriting, with both readings if there are two.

    Most of what people type is one: ``6.67``, ``6,67``, ``20/3``, ``1.5e-3``.
    """
    match = _FAST.fullmatch(typed if typed.isascii() else typed.translate(_DIGITS))
    if match is None:
        return None
    sign, whole, mark, digits, exponent, bottom = match.groups()
    sign = "-" if sign else ""
    if bottom:
        return None if mark or not int(bottom) else Readings(_quotient(sign, whole, bottom))
    main = _decimal(sign, whole, digits or "")
    if main.places != 3 or len(whole) > 3 or whole[0] == "0":
        return Readings(_raised(main, int(exponent)) if exponent else main)
    if exponent:
        return None
    doubt = doubtful(mark, decimal)
    if doubt is None:
        return Readings(main)
    return Readings(main, _decimal(sign, whole + digits, ""), doubt)


def _decimal(sign: str, whole: str, digits: str) -> Number:
    top = int(whole + digits)
    value = fmpq(-top if sign else top, 10 ** len(digits))
    shown = whole if len(whole) <= people.LONGEST_UNGROUPED else people.grouped(whole)
    if sign:
        shown = people.MINUS + shown
    if digits:
        significant = len((whole + digits).lstrip("0")) or len(digits)
        return Number(
            value, f"{shown}.{digits}", "decimal", len(digits), (significant, significant)
        )
    least = len(whole.strip("0")) or 1
    return Number(value, shown, "integer", 0, (least, len(whole.lstrip("0")) or 1))


def _quotient(sign: str, top: str, bottom: str) -> Number:
    value = fmpq(int(top), int(bottom))
    lowest = int(bottom) == value.q
    read_as = f"{people.MINUS if sign else ''}{people.grouped(top)}/{people.grouped(bottom)}"
    return Number(-value if sign else value, read_as, "fraction", lowest=lowest)


def read_source(source: Source, decimal: str) -> Readings:
    """Read a number whose text has been normalised already.

    Raises
    ------
    ReadError
        With the column, if it cannot be read.
    """
    found = quick(source.text, decimal)
    if found:
        return found
    try:
        main, other, doubt = pointed(tidied(source), decimal)
        return Readings(_written(main), None if other is None else _written(other), doubt)
    except ReadError as error:
        raise _inside(error, source) from None


def _inside(error: ReadError, source: Source) -> ReadError:
    """What is wrong with a number as a whole is wrong where the number begins."""
    begin = source.column(0)
    if (error.column or 1) >= begin:
        return error
    return ReadError(error.code, begin, error.found, error.expected)


def _written(source: Source) -> Number:
    """Read a number in point notation."""
    text = source.text
    percent = text.endswith("%")
    if percent:
        text = text[:-1].rstrip()
    number = _scientific(text) or _ten(text) or _fraction(text) or _mixed(text)
    number = number or _expression(source, text)
    if abs(number.value) > LARGEST_VALUE:
        raise ReadError("too-large", 1)
    return as_percent(number) if percent else number


def _power(text: str) -> int:
    exponent = int(text.strip("()"))
    if not SMALLEST_EXPONENT <= exponent <= LARGEST_EXPONENT:
        raise ReadError("number-too-large", 1, text)
    return exponent


def _scientific(text: str) -> Number | None:
    match = _SCIENTIFIC.fullmatch(text)
    if match is None or not (match["whole"] or match["digits"]):
        return None
    sign, whole, digits = match["sign"].replace("+", ""), match["whole"] or "0", match["digits"]
    if len(whole) + len(digits or "") > LONGEST_NUMBER:
        raise ReadError("number-too-long", 1)
    number = _decimal(sign, whole, digits or "")
    exponent = match["e"] or match["p"]
    if exponent is None:
        return number
    return _raised(number, _power(exponent))


def _raised(number: Number, power: int) -> Number:
    """A decimal or whole number times a power of ten."""
    least, most = number.figures
    return Number(
        number.value * fmpq(10) ** power,
        f"{number.read_as}·{people.power_of_ten(power)}",
        "scientific",
        max(0, number.places - power),
        (least if number.form == "decimal" else most, most),
    )


def _ten(text: str) -> Number | None:
    match = _TEN.fullmatch(text)
    if match is None:
        return None
    power = _power(match["p"])
    sign = -1 if match["sign"] == "-" else 1
    read_as = f"{people.MINUS if sign < 0 else ''}{people.power_of_ten(power)}"
    return Number(sign * fmpq(10) ** power, read_as, "scientific", max(0, -power), (1, 1))


def _fraction(text: str) -> Number | None:
    match = _FRACTION.fullmatch(text)
    if match is None or len(text) > 2 * LONGEST_NUMBER:
        return None
    if not int(match["bottom"]):
        raise ReadError("division-by-zero", 1, text)
    value = fmpq(int(match["top"]), int(match["bottom"]))
    negative = (match["sign"] == "-") != (match["minus"] == "-")
    lowest = int(match["bottom"]) == value.q and not match["minus"]
    top, bottom = people.grouped(match["top"]), people.grouped(match["bottom"])
    read_as = f"{_signed(match['sign'])}{top}/{_signed(match['minus'])}{bottom}"
    return Number(-value if negative else value, read_as, "fraction", lowest=lowest)


def _signed(sign: str) -> str:
    return people.MINUS if sign == "-" else ""


def _mixed(text: str) -> Number | None:
    match = _MIXED.fullmatch(text)
    if match is None or len(text) > 2 * LONGEST_NUMBER:
        return None
    sign, whole, top, bottom = [group or "" for group in match.groups() if group is not None]
    if not int(bottom):
        raise ReadError("division-by-zero", 1, text)
    part = fmpq(int(top), int(bottom))
    value = int(whole) + part
    lowest = part.q == int(bottom) and part < 1
    read_as = f"{_signed(sign)}{whole} {top}/{bottom}"
    return Number(-value if sign == "-" else value, read_as, "mixed", lowest=lowest)


def _expression(source: Source, text: str) -> Number:
    text = _E_SPACED.sub("e", text) if "e " in text or "E " in text else text
    try:
        pieces = tokens(text, frozenset(), loose=True)
        tree = parse_pieces(pieces, len(text), tight=False)
    except ReadError as error:
        raise moved(error, source) from None
    return constant_number(tree)


def constant_number(tree: Expr) -> Number:
    """The number that a formula without names stands for.

    Raises
    ------
    ReadError
        If it has no finite real value or is too large.
    """
    value = constant(tree)
    if abs(value) > LARGEST_VALUE:
        raise ReadError("too-large", 1)
    return Number(value, people.formula(to_text(tree)), "expression")


def moved(error: ReadError, source: Source) -> ReadError:
    """Point a reading error at the column in the typed text."""
    if error.code == "unknown-name" and not error.expected:
        error.code = "number-expected"
    column = source.column((error.column or 1) - 1)
    return ReadError(error.code, column, error.found, error.expected)
