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
USUAL_FIGURES = 3
"""Figures of a number where nothing else is asked."""
LARGEST_SHOWN = fmpq(10) ** 250


def round_ball_half_away(value: Value, decimals: int) -> fmpq:
    """Return a value rounded half away from zero; a ball across a tie by its midpoint."""
    try:
        return round_to(value, decimals)
    except UndecidedError:
        return round_to(value.mid().fmpq(), decimals)


def format_rounded_key(value: Value, decimals: int) -> str:
    """Return a value rounded and written out: 20/3 with 3 decimals is ``6.667``."""
    return format_decimal(round_ball_half_away(value, decimals), max(decimals, 0), minus="-")


def format_figures(value: Value, figures: int) -> str:
    """Return a value with significant figures; very large and small ones as ``5.05e-4``."""
    power = decimal_exponent(value)
    first = round_ball_half_away(value, figures - 1 - power)
    power = decimal_exponent(first)
    if -4 <= power < 7:
        return format_rounded_key(first, figures - 1 - power)
    return f"{format_rounded_key(first / fmpq(10) ** power, figures - 1)}e{power}"


def format_exact_or_figures(value: Value, figures: int) -> str:
    """Return an integer or short decimal exactly, anything else with so many figures.

    Beyond ``LARGEST_SHOWN`` it is written as infinity.
    """
    if abs(value) > LARGEST_SHOWN:
        return "-∞" if value < 0 else "∞"
    if not isinstance(value, arb) and abs(value) < LARGEST_PLAIN:
        needed = count_decimals(value)
        if needed is not None and needed < figures:
            return format_decimal(value, minus="-")
    return _drop_noughts(format_figures(value, figures), value)


def _drop_noughts(text: str, value: Value) -> str:
    """Return ``9.600e-8`` as ``9.6e-8`` where that is still exact."""
    mantissa, e, power = text.partition("e")
    if not e or isinstance(value, arb) or parse_exact(text) != value:
        return text
    return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}e{power}"


def format_key(tolerance: Tolerance, value: Value, form: str = "") -> str:
    """Return a key value, written as far as its tolerance asks.

    ``form`` is the kind's ``fraction``, ``lowest`` or ``decimal``, empty for any.
    """
    if form in {"fraction", "lowest"} and isinstance(value, fmpq):
        return str(value)
    if tolerance.decimals is not None:
        return format_rounded_key(value, tolerance.decimals)
    if tolerance.sigfigs is not None:
        return _format_sigfigs(value, tolerance.sigfigs, strict=tolerance.strict)
    if tolerance.exact and isinstance(value, fmpq):
        decimal = count_decimals(value) is not None and value.q != 1
        return format_exact_or_figures(value, 12) if decimal else str(value)
    return _format_within_tolerance(tolerance, value)


def _format_sigfigs(value: Value, figures: int, *, strict: bool) -> str:
    """Return as many figures as asked; a whole number that has no more is written out."""
    text = format_figures(value, figures)
    if strict or "e" not in text or abs(value) >= LARGEST_PLAIN:
        return text
    whole = isinstance(value, fmpq) and value.q == 1 and parse_exact(text) == value
    return str(value) if whole else text


def _format_within_tolerance(tolerance: Tolerance, value: Value) -> str:
    """Return three figures if rounding takes at most half of the tolerance, else more of them.

    From four figures on it takes at most a tenth.
    """
    width = tolerance.half_width(value)
    short = format_exact_or_figures(value, USUAL_FIGURES)
    if value != 0 and not abs(parse_exact(short) - value) * 2 > width:
        return short
    figures = USUAL_FIGURES + 1
    while figures < 30 and value != 0:
        text = format_exact_or_figures(value, figures)
        if not abs(parse_exact(text) - value) * 10 > width:
            return text
        figures += 1
    return format_exact_or_figures(value, figures)
