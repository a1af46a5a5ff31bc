"""Writing key values as far as a tolerance asks, so that they can be typed back."""

from __future__ import annotations

from flint import arb, fmpq

from quizgen.errors import Undecided
from quizgen.maths.constants import exact_value
from quizgen.maths.numbers import decimal_text, magnitude, places, round_to
from quizgen.maths.tolerance import Tolerance
from quizgen.maths.values import Value

LARGEST_PLAIN = 10**12
"""Whole numbers below this are written out: a power of ten would hide their digits."""
LARGEST_SHOWN = fmpq(10) ** 250


def nearest(value: Value, decimals: int) -> fmpq:
    """Round half away from zero; a ball that straddles a tie is rounded by its midpoint."""
    try:
        return round_to(value, decimals)
    except Undecided:
        return round_to(value.mid().fmpq(), decimals)


def rounded(value: Value, decimals: int) -> str:
    """Round and write out: ``rounded(20/3, 3)`` is ``6.667``."""
    return decimal_text(nearest(value, decimals), max(decimals, 0), minus="-")


def with_figures(value: Value, figures: int) -> str:
    """Round to significant figures; very large and small numbers as ``5.05e-4``."""
    power = magnitude(value)
    first = nearest(value, figures - 1 - power)
    power = magnitude(first)
    if -4 <= power < 7:
        return rounded(first, figures - 1 - power)
    return f"{rounded(first / fmpq(10) ** power, figures - 1)}e{power}"


def exact_or_figures(value: Value, figures: int) -> str:
    """Write an integer or short decimal exactly, anything else with so many figures."""
    if abs(value) > LARGEST_SHOWN:
        return "-∞" if value < 0 else "∞"
    if not isinstance(value, arb) and abs(value) < LARGEST_PLAIN:
        needed = places(value)
        if needed is not None and needed < figures:
            return decimal_text(value, minus="-")
    return _without_noughts(with_figures(value, figures), value)


def _without_noughts(text: str, value: Value) -> str:
    """Drop the noughts that end a mantissa which is exact without them: ``9.600e-8``."""
    mantissa, e, power = text.partition("e")
    if not e or isinstance(value, arb) or exact_value(text) != value:
        return text
    return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}e{power}"


def shown(tolerance: Tolerance, value: Value, form: str = "") -> str:
    """Write a key value as far as its tolerance asks."""
    if form in {"fraction", "lowest"} and isinstance(value, fmpq):
        return str(value)
    if tolerance.decimals is not None:
        return rounded(value, tolerance.decimals)
    if tolerance.sigfigs is not None:
        return _with_sigfigs(value, tolerance.sigfigs, strict=tolerance.strict)
    if tolerance.exact and isinstance(value, fmpq):
        decimal = places(value) is not None and value.q != 1
        return exact_or_figures(value, 12) if decimal else str(value)
    return _for_tolerance(tolerance, value)


def _with_sigfigs(value: Value, figures: int, *, strict: bool) -> str:
    """Write as many figures as asked; a whole number that has no more is written out."""
    text = with_figures(value, figures)
    if strict or "e" not in text or abs(value) >= LARGEST_PLAIN:
        return text
    whole = isinstance(value, fmpq) and value.q == 1 and exact_value(text) == value
    return str(value) if whole else text


def _for_tolerance(tolerance: Tolerance, value: Value) -> str:
    """Write enough figures that rounding takes at most a tenth of the tolerance."""
    width = tolerance.half_width(value)
    figures = 4
    while figures < 30 and value != 0:
        text = exact_or_figures(value, figures)
        if not abs(exact_value(text) - value) * 10 > width:
            return text
        figures += 1
    return exact_or_figures(value, figures)
