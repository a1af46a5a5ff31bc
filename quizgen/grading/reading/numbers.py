"""Reading one number as people type it, exactly, with how it was written."""

from __future__ import annotations

import re
from collections.abc import Callable

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.grading.reading.literals import (
    Ambiguity,
    find_ambiguity,
    join_digit_groups,
    with_decimal_points,
)
from quizgen.grading.reading.source_map import SourceText
from quizgen.maths.constants import evaluate_constant
from quizgen.maths.notation import FormulaReadError, format_tree, parse_tokens, pretty, tokenize
from quizgen.maths.notation.lexer import LARGEST_EXPONENT, LONGEST_NUMBER, SMALLEST_EXPONENT
from quizgen.maths.tree import Expr
from quizgen.maths.values import Value

LARGEST_VALUE = fmpq(10) ** LARGEST_EXPONENT
"""Largest number read."""


class ReadNumber(msgspec.Struct, frozen=True):
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

    main: ReadNumber
    other: ReadNumber | None = None
    doubt: Ambiguity | None = None


def map_readings(readings: Readings, change: Callable[[ReadNumber], ReadNumber]) -> Readings:
    """Return both readings, changed."""
    other = None if readings.other is None else change(readings.other)
    return Readings(change(readings.main), other, readings.doubt)


def scale_number(number: ReadNumber, scale: Value) -> ReadNumber:
    """Return the number in another unit; how it was written stays."""
    return number if scale == 1 else replace(number, value=number.value * scale)


def as_percent(number: ReadNumber) -> ReadNumber:
    """Return the number as one with a percent sign behind it."""
    return replace(number, read_as=f"{number.read_as} %", percent=True)


def percent_to_fraction(number: ReadNumber) -> ReadNumber:
    """Return the share that a percentage is: ``5 %`` is 0.05."""
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
_BRACKETED = re.compile(r"\(([-+]?\d*\.?\d+)\)", re.ASCII)
_E_SPACED = re.compile(r"(?<=[\d.]) ?[eE] ?(?=[-+]?\d)")


def read_plain_number(typed: str, decimal: str) -> Readings | None:
    """Return the readings of a plain number without any rewriting; None if it is not plain.

    Most of what people type is one: ``6.67``, ``6,67``, ``20/3``, ``1.5e-3``.
    """
    match = _FAST.fullmatch(typed if typed.isascii() else typed.translate(_DIGITS))
    if match is None:
        return None
    sign, whole, mark, digits, exponent, bottom = match.groups()
    sign = "-" if sign else ""
    if bottom:
        return (
            None
            if mark or not int(bottom)
            else Readings(_make_quotient_number(sign, whole, bottom))
        )
    main = _make_decimal_number(sign, whole, digits or "")
    if main.places != 3 or len(whole) > 3 or whole[0] == "0":
        return Readings(_multiply_by_power_of_ten(main, int(exponent)) if exponent else main)
    if exponent:
        return None
    doubt = find_ambiguity(mark, decimal)
    if doubt is None:
        return Readings(main)
    return Readings(main, _make_decimal_number(sign, whole + digits, ""), doubt)


def _make_decimal_number(sign: str, whole: str, digits: str) -> ReadNumber:
    """Return the number of a sign (``-`` or empty) and digits before and after the point."""
    top = int(whole + digits)
    value = fmpq(-top if sign else top, 10 ** len(digits))
    shown = whole if len(whole) <= pretty.LONGEST_UNGROUPED else pretty.group_digits(whole)
    if sign:
        shown = pretty.MINUS + shown
    if digits:
        significant = len((whole + digits).lstrip("0")) or len(digits)
        return ReadNumber(
            value, f"{shown}.{digits}", "decimal", len(digits), (significant, significant)
        )
    least = len(whole.strip("0")) or 1
    return ReadNumber(value, shown, "integer", 0, (least, len(whole.lstrip("0")) or 1))


def _make_quotient_number(sign: str, top: str, bottom: str) -> ReadNumber:
    """Return the fraction of two runs of digits; the denominator is not 0."""
    value = fmpq(int(top), int(bottom))
    lowest = int(bottom) == value.q
    read_as = (
        f"{pretty.MINUS if sign else ''}{pretty.group_digits(top)}/{pretty.group_digits(bottom)}"
    )
    return ReadNumber(-value if sign else value, read_as, "fraction", lowest=lowest)


_OF_DEGREES = re.compile(
    r"(?<![^\W\d_])(sin|cos|tan|cot)(?: ?\( ?| )([-+]?\d+(?:\.\d+)?) ?°(?: ?\))?"
)
"""A function of an angle in degrees, ``cos(30°)``."""


def read_number(source: SourceText, decimal: str) -> Readings:
    """Return the readings of a number whose text has been normalised already.

    Raises
    ------
    FormulaReadError
        With the column, if it cannot be read.
    """
    found = read_plain_number(source.text, decimal)
    if found:
        return found
    source = source.substitute(_OF_DEGREES, lambda m: f"{m[1]}({m[2]}*pi/180)")
    try:
        main, other, doubt = with_decimal_points(join_digit_groups(source), decimal)
        return Readings(
            _read_point_notation(main),
            None if other is None else _read_point_notation(other),
            doubt,
        )
    except FormulaReadError as error:
        raise _move_error_to_start(error, source) from None


def _move_error_to_start(error: FormulaReadError, source: SourceText) -> FormulaReadError:
    """Return the error with a column in the number: one about all of it points at its beginning."""
    begin = source.column(0)
    if (error.column or 1) >= begin:
        return error
    return FormulaReadError(error.code, begin, error.found, error.expected)


def _read_point_notation(source: SourceText) -> ReadNumber:
    """Return a number in point notation, in the first form that fits.

    Raises
    ------
    FormulaReadError
        If no form fits, or it is too large.
    """
    text = source.text
    percent = text.endswith("%")
    if percent:
        text = text[:-1].rstrip()
    bracketed = _BRACKETED.fullmatch(text)
    text = bracketed[1] if bracketed else text
    number = (
        _read_scientific(text)
        or _read_bare_power_of_ten(text)
        or _read_fraction(text)
        or _read_mixed_number(text)
    )
    number = number or _read_number_expression(source, text)
    if abs(number.value) > LARGEST_VALUE:
        raise FormulaReadError("too-large", 1)
    return as_percent(number) if percent else number


def _parse_power_of_ten(text: str) -> int:
    """Return the exponent of a power of ten.

    Raises
    ------
    FormulaReadError
        If it is out of range.
    """
    exponent = int(text.strip("()"))
    if not SMALLEST_EXPONENT <= exponent <= LARGEST_EXPONENT:
        raise FormulaReadError("number-too-large", 1, text)
    return exponent


def _read_scientific(text: str) -> ReadNumber | None:
    """Return a decimal number, with or without a power of ten; None if it is no such number.

    Raises
    ------
    FormulaReadError
        If it has too many digits or too large an exponent.
    """
    match = _SCIENTIFIC.fullmatch(text)
    if match is None or not (match["whole"] or match["digits"]):
        return None
    sign, whole, digits = match["sign"].replace("+", ""), match["whole"] or "0", match["digits"]
    if len(whole) + len(digits or "") > LONGEST_NUMBER:
        raise FormulaReadError("number-too-long", 1)
    number = _make_decimal_number(sign, whole, digits or "")
    exponent = match["e"] or match["p"]
    if exponent is None:
        return number
    return _multiply_by_power_of_ten(number, _parse_power_of_ten(exponent))


def _multiply_by_power_of_ten(number: ReadNumber, power: int) -> ReadNumber:
    """Return a decimal or whole number times a power of ten."""
    least, most = number.figures
    return ReadNumber(
        number.value * fmpq(10) ** power,
        f"{number.read_as}·{pretty.format_power_of_ten(power)}",
        "scientific",
        max(0, number.places - power),
        (least if number.form == "decimal" else most, most),
    )


def _read_bare_power_of_ten(text: str) -> ReadNumber | None:
    """Return ``10^-3`` as a number; None if it is none.

    Raises
    ------
    FormulaReadError
        If the exponent is out of range.
    """
    match = _TEN.fullmatch(text)
    if match is None:
        return None
    power = _parse_power_of_ten(match["p"])
    sign = -1 if match["sign"] == "-" else 1
    read_as = f"{pretty.MINUS if sign < 0 else ''}{pretty.format_power_of_ten(power)}"
    return ReadNumber(sign * fmpq(10) ** power, read_as, "scientific", max(0, -power), (1, 1))


def _read_fraction(text: str) -> ReadNumber | None:
    """Return a fraction of whole numbers; None if it is none.

    Raises
    ------
    FormulaReadError
        If its denominator is 0.
    """
    match = _FRACTION.fullmatch(text)
    if match is None or len(text) > 2 * LONGEST_NUMBER:
        return None
    if not int(match["bottom"]):
        raise FormulaReadError("division-by-zero", 1, text)
    value = fmpq(int(match["top"]), int(match["bottom"]))
    negative = (match["sign"] == "-") != (match["minus"] == "-")
    lowest = int(match["bottom"]) == value.q and not match["minus"]
    top, bottom = pretty.group_digits(match["top"]), pretty.group_digits(match["bottom"])
    read_as = f"{_format_minus(match['sign'])}{top}/{_format_minus(match['minus'])}{bottom}"
    return ReadNumber(-value if negative else value, read_as, "fraction", lowest=lowest)


def _format_minus(sign: str) -> str:
    """Return the minus sign for a typed ``-``, nothing for ``+`` or no sign."""
    return pretty.MINUS if sign == "-" else ""


def _read_mixed_number(text: str) -> ReadNumber | None:
    """Return a mixed number such as ``1 2/3``; None if it is none.

    Raises
    ------
    FormulaReadError
        If its denominator is 0.
    """
    match = _MIXED.fullmatch(text)
    if match is None or len(text) > 2 * LONGEST_NUMBER:
        return None
    sign, whole, top, bottom = [group or "" for group in match.groups() if group is not None]
    if not int(bottom):
        raise FormulaReadError("division-by-zero", 1, text)
    part = fmpq(int(top), int(bottom))
    value = int(whole) + part
    lowest = part.q == int(bottom) and part < 1
    read_as = f"{_format_minus(sign)}{whole} {top}/{bottom}"
    return ReadNumber(-value if sign == "-" else value, read_as, "mixed", lowest=lowest)


def _read_number_expression(source: SourceText, text: str) -> ReadNumber:
    """Return the number that a formula without names gives.

    Raises
    ------
    FormulaReadError
        If it cannot be read or has no value.
    """
    text = _E_SPACED.sub("e", text) if "e " in text or "E " in text else text
    try:
        pieces = tokenize(text, frozenset(), loose=True)
        tree = parse_tokens(pieces, len(text), tight=False)
    except FormulaReadError as error:
        raise relocate_error(error, source) from None
    return number_from_tree(tree)


def number_from_tree(tree: Expr) -> ReadNumber:
    """Return the number that a formula without names stands for.

    Raises
    ------
    FormulaReadError
        If it has no finite real value or is too large.
    """
    value = evaluate_constant(tree)
    if abs(value) > LARGEST_VALUE:
        raise FormulaReadError("too-large", 1)
    return ReadNumber(value, pretty.format_formula(format_tree(tree)), "expression")


def relocate_error(error: FormulaReadError, source: SourceText) -> FormulaReadError:
    """Return a reading error that points at the column in the typed text."""
    if error.code == "unknown-name" and not error.expected:
        error.code = "number-expected"
    if error.code == "empty":  # a sign such as % alone
        error.code = "no-answer"
    position = (error.column or 1) - 1
    found = error.found
    if error.code == "number-expected" and source.text.startswith(found, position):
        # A Bangla vowel sign is no letter: the word is quoted whole, not up to its first sign.
        word = _WORD.match(source.text, position)
        found = word[0] if word else found
    return FormulaReadError(error.code, source.column(position), found, error.expected)


_WORD = re.compile(r"(?:[^\W\d_]|[\u0981-\u0983\u09bc\u09be-\u09cd\u09d7])+")
