"""Writing key values as far as a tolerance asks, so that they can be typed back."""

from __future__ import annotations

from flint import arb, fmpq

from quizgen.core.errors import UndecidedError
from quizgen.maths.constants import parse_exact
from quizgen.maths.numbers import count_decimals, decimal_exponent, format_decimal, round_to
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value

LARGEST_PLAIN = 10**12
"""Whole numbers below this are written out: a power of ten would hide their digits."""
LARGEST_SHOWN = fmpq(10) ** 250


def round_ball_half_away(value: Value, decimals: int) -> fmpq:
    """Round half away from zero; a ball that straddles a tie is rounded by its midpoint."""
    try:
        return round_to(value, decimals)
    except UndecidedError:
        return round_to(value.mid().fmpq(), decimals)


def format_rounded_key(value: Value, decimals: int) -> str:
    """Round and write out: ``rounded(20/3, 3)`` is ``6.667``."""
    return format_decimal(round_ball_half_away(value, decimals), max(decimals, 0), minus="-")


def format_figures(value: Value, figures: int) -> str:
    """Round to significant figures; very large and small numbers as ``5.05e-4``."""
    power = decimal_exponent(value)
    first = round_ball_half_away(value, figures - 1 - power)
    power = decimal_exponent(first)
    if -4 <= power < 7:
        return format_rounded_key(first, figures - 1 - power)
    return f"{format_rounded_key(first / fmpq(10) ** power, figures - 1)}e{power}"


def format_exact_or_figures(value: Value, figures: int) -> str:
    """Write an integer or short decimal exactly, anything else with so many figures."""
    if abs(value) > LARGEST_SHOWN:
        return "-∞" if value < 0 else "∞"
    if not isinstance(value, arb) and abs(value) < LARGEST_PLAIN:
        needed = count_decimals(value)
        if needed is not None and needed < figures:
            return format_decimal(value, minus="-")
    return _without_noughts(format_figures(value, figures), value)


def _without_noughts(text: str, value: Value) -> str:
    """Drop the noughts that end a mantissa which is exact without them: ``9.600e-8``."""
    mantissa, e, power = text.partition("e")
    if not e or isinstance(value, arb) or parse_exact(text) != value:
        return text
    return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}e{power}"


def format_key(tolerance: Tolerance, value: Value, form: str = "") -> str:
    """Write a key value as far as its tolerance asks."""
    if form in {"fraction", "lowest"} and isinstance(value, fmpq):
        return str(value)
    if tolerance.decimals is not None:
        return format_rounded_key(value, tolerance.decimals)
    if tolerance.sigfigs is not None:
        return _with_sigfigs(value, tolerance.sigfigs, strict=tolerance.strict)
    if tolerance.exact and isinstance(value, fmpq):
        decimal = count_decimals(value) is not None and value.q != 1
        return format_exact_or_figures(value, 12) if decimal else str(value)
    return _for_tolerance(tolerance, value)


def _with_sigfigs(value: Value, figures: int, *, strict: bool) -> str:
    """Write as many figures as asked; a whole number that has no more is written out."""
    text = format_figures(value, figures)
    if strict or "e" not in text or abs(value) >= LARGEST_PLAIN:
        return text
    whole = isinstance(value, fmpq) and value.q == 1 and parse_exact(text) == value
    return str(value) if whole else text


def _for_tolerance(tolerance: Tolerance, value: Value) -> str:
    """Write enough figures that rounding takes at most a tenth of the tolerance."""
    width = tolerance.half_width(value)
    figures = 4
    while figures < 30 and value != 0:
        text = format_exact_or_figures(value, figures)
        if not abs(parse_exact(text) - value) * 10 > width:
            return text
        figures += 1
    return format_exact_or_figures(value, figures)
