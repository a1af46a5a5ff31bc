"""Numbers as they are shown: exact where possible, certified where rounded.

Rounding is half away from zero, as every stem promises, and is decided on exact rationals or on
balls that exclude a tie; binary floating point never decides a digit.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction

from flint import arb, fmpq, fmpz

from quizgen.core.errors import FormulaError, MathError, UndecidedError
from quizgen.maths.precision import WIDE, working_precision
from quizgen.maths.values import Value

MINUS = "\u2212"
LONGEST_DECIMAL = 6
"""A terminating decimal with more places than this is shown as a fraction or rounded."""
LONGEST_SMALL = 24
SMALL_DIGITS = 4
"""Significant digits of a small number, such as 2.5·10⁻⁷, that is shown exactly all the same."""
LARGEST_IN_FRACTION = 9999
"""Fractions of larger numbers are not shown."""
EASY = 20
"""Numbers below this make a fraction that is read at a glance."""
LARGEST_UNIT_FRACTION = 10_000
"""Exposure times are written as 1/n."""
SHORTEST = 8
"""Longer exposures than 1/8 s are written as decimals."""
LONGEST_NUMBER = 4000
"""Characters, and size of the power of ten, of a number that is read."""
_WRITTEN = re.compile(
    r"\s*[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?(?P<power>\d+))?(?:/\d+)?\s*", re.ASCII
)
SMALLEST_MAGNITUDE = -6
"""Power of ten below which a value is written with one."""


def parse_written_number(value: float | str | Fraction) -> Fraction:
    """Return an integer, ``"1/500"`` or a decimal text as it is meant; a float as it prints.

    Raises
    ------
    FormulaError
        If it is no number, or has so many digits that nobody can mean it.
    """
    if isinstance(value, (int, Fraction)):
        return Fraction(value)
    text = str(value)
    match = _WRITTEN.fullmatch(text) if len(text) <= LONGEST_NUMBER else None
    if match is None or len(match["power"] or "") > len(str(LONGEST_NUMBER)):
        raise FormulaError(f"{text[:40]!r} is no number (allowed: 12, 0.5, 1e-3, 1/500)")
    try:
        return Fraction(text)
    except ZeroDivisionError:
        raise FormulaError(f"{text[:40]!r} divides by zero") from None


def to_rational(value: int | str | Fraction) -> fmpq:
    """Return the exact rational of an integer, ``"1/500"`` or a decimal text.

    Raises
    ------
    FormulaError
        If it is no number.
    """
    fraction = parse_written_number(value)
    return fmpq(fraction.numerator, fraction.denominator)


def to_fraction(value: fmpq) -> Fraction:
    """Return a rational in Python's own type, as formula trees hold it."""
    return Fraction(int(value.p), int(value.q))


def is_exact(value: Value) -> bool:
    """Return whether an exact value is a rational, not a ball."""
    return isinstance(value, fmpq)


def to_float(value: Value) -> float:
    """Return the nearest float of a rational or of a ball's midpoint."""
    return int(value.p) / int(value.q) if isinstance(value, fmpq) else float(value)


def round_to(value: Value, decimals: int) -> fmpq:
    """Return a value rounded to ``decimals`` places, half away from zero, certified.

    Raises
    ------
    UndecidedError
        If a ball is too wide to tell the last digit.
    """
    scale = fmpq(10) ** decimals
    if not isinstance(value, fmpq):
        whole = fmpq(_nearest_to_ball(value, scale)) / scale
        return -whole if value < 0 else whole
    top, bottom, times = int(value.p), int(value.q), 10 ** abs(decimals)
    top, bottom = (top * times, bottom) if decimals >= 0 else (top, bottom * times)
    nearest = (2 * abs(top) + bottom) // (2 * bottom)
    return fmpq(-nearest if top < 0 else nearest) / scale


@working_precision(WIDE)
def _nearest_to_ball(value: arb, scale: fmpq) -> fmpz:
    """Return the integer nearest to the size of a ball times a scale.

    Raises
    ------
    UndecidedError
        If the ball is too wide for that.
    """
    whole = (abs(value) * scale + fmpq(1, 2)).floor().unique_fmpz()
    if whole is None:
        raise UndecidedError("the last digit cannot be certified")
    return whole


def decimal_exponent(value: Value) -> int:
    """Return the power of ten of the leading digit: 0 for 6.7, -4 for 0.00050505; 0 for 0.

    Raises
    ------
    MathError
        If it is beyond all floats.
    """
    number = abs(to_float(value))
    if number == 0:
        return 0
    if not math.isfinite(number):
        raise MathError("too large to be written")
    guess = int(f"{number:e}".split("e")[1])  # may have been rounded up to a power of ten
    if isinstance(value, fmpq):
        return guess - 1 if abs(value) < fmpq(10) ** guess else guess
    with working_precision(WIDE):
        return guess - 1 if abs(value) < fmpq(10) ** guess else guess


def decimals_for_figures(value: Value, figures: int) -> int:
    """Return how many decimal places show ``figures`` significant figures of a value."""
    return max(figures - 1 - decimal_exponent(value), 0)


def count_decimals(value: fmpq | Fraction) -> int | None:
    """Return the decimal places of a terminating decimal, None if it does not terminate."""
    rest, fives = int(value.denominator), 0
    twos = (rest & -rest).bit_length() - 1
    rest >>= twos
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    return max(twos, fives) if rest == 1 else None


def format_decimal(value: fmpq, decimals: int | None = None, *, minus: str = MINUS) -> str:
    """Return a terminating decimal as text, with exactly ``decimals`` places if given.

    Raises
    ------
    ValueError
        If it does not terminate and no number of places is given.
    """
    count = count_decimals(value) if decimals is None else decimals
    if count is None:
        raise ValueError("this rational has no finite decimal form")
    top, bottom = int(value.p), int(value.q)
    digits = str(abs(top) * 10**count // bottom).rjust(count + 1, "0")
    whole, part = (digits[:-count], digits[-count:]) if count else (digits, "")
    sign = minus if top < 0 else ""
    return f"{sign}{whole}.{part}" if part else f"{sign}{whole}"


def format_fraction(value: fmpq, *, minus: str = MINUS) -> str:
    """Return a rational as ``p/q``."""
    top = int(value.p)
    sign = minus if top < 0 else ""
    return f"{sign}{abs(top)}/{int(value.q)}"


def is_short_decimal(value: Value) -> bool:
    """Return whether a value is a terminating decimal that is short, or small and of few digits."""
    if not is_exact(value):
        return False
    count = count_decimals(value)
    if count is None or count > LONGEST_SMALL:
        return False
    return count <= LONGEST_DECIMAL or bool(abs(value) * fmpq(10) ** count < 10**SMALL_DIGITS)


def is_readable_exactly(value: Value) -> bool:
    """Return whether the exact value helps: a short decimal, 2/3, 16/9, 1/125 but not 70/11."""
    if is_short_decimal(value):
        return True
    if not is_exact(value):
        return False
    top, bottom = abs(int(value.p)), int(value.q)
    return max(top, bottom) < EASY or (top == 1 and bottom < LARGEST_UNIT_FRACTION)


def has_more_figures(value: Value, figures: int = 4) -> bool:
    """Return whether a short decimal has more significant figures than that."""
    return (
        is_short_decimal(value) and round_to(value, decimals_for_figures(value, figures)) != value
    )


def format_duration(value: Value) -> str | None:
    """Return seconds as cameras write them, such as 1/400; None if they are no such fraction."""
    if not is_exact(value) or int(value.p) != 1:
        return None
    return format_fraction(value) if SHORTEST <= int(value.q) < LARGEST_UNIT_FRACTION else None


SECONDS = "s"


def format_exact_in_unit(value: Value, unit: str) -> str | None:
    """Return the exact value as text: 1/400 for a short time in seconds, else as any other."""
    return (unit == SECONDS and format_duration(value)) or format_exact(value)


def format_exact(value: Value, *, minus: str = MINUS) -> str | None:
    """Return the exact value as text: a short decimal, else a readable fraction, else None."""
    if is_short_decimal(value):
        return format_decimal(value, minus=minus)
    if is_exact(value) and max(abs(int(value.p)), int(value.q)) <= LARGEST_IN_FRACTION:
        return format_fraction(value, minus=minus)
    return None


def format_rounded(
    value: Value, *, decimals: int | None = None, figures: int = 4, minus: str = MINUS
) -> str:
    """Return a value for showing: to ``decimals`` places, or to ``figures`` significant figures.

    A tiny value without a number of places is written as ``1.478e-11``.
    """
    if decimals is None and value != 0 and decimal_exponent(value) < SMALLEST_MAGNITUDE:
        power = decimal_exponent(value)
        with working_precision(WIDE):
            scaled = value * fmpq(10) ** -power
        return f"{format_rounded(scaled, figures=figures, minus=minus)}e{power}"
    count = decimals_for_figures(value, figures) if decimals is None else decimals
    return format_decimal(round_to(value, count), count, minus=minus)


def format_for_key(value: Value) -> str:
    """Return the value as stored in a key: an exact rational, or 40 certified digits."""
    if is_exact(value):
        whole = int(value.q) == 1
        return str(int(value.p)) if whole else format_fraction(value, minus="-")
    with working_precision(WIDE):
        return str(value.str(40, radius=False, condense=0))
