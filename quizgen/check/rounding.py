"""Rounding exact values and certified balls, half away from zero, and writing them out."""

from __future__ import annotations

from typing import Any

import flint
from flint import arb, fmpq

from quizgen.expr import PRECISION


def nearest(value: Any, places: int) -> fmpq:
    """Round to decimal places, half away from zero.

    A ball that straddles a tie is rounded by its midpoint (draws exclude such keys).
    """
    if isinstance(value, arb):
        with flint.ctx.workprec(PRECISION):
            value = value.mid().fmpq()
    scaled = abs(value) * fmpq(10) ** places
    units = fmpq((scaled + fmpq(1, 2)).floor())
    return (units if value >= 0 else -units) / fmpq(10) ** places


def magnitude(value: Any) -> int:
    """Return the decimal exponent of the first significant figure (0 for zero)."""
    exact = value.mid().fmpq() if isinstance(value, arb) else value
    exact = abs(exact)
    if exact == 0:
        return 0
    guess = int((exact.p.bit_length() - exact.q.bit_length()) * 0.30103) - 1
    while fmpq(10) ** (guess + 1) <= exact:
        guess += 1
    return guess


def places_for(value: Any, figures: int) -> int:
    """Return the decimal places that show so many significant figures."""
    return figures - 1 - magnitude(value)


def decimal_text(value: fmpq, places: int) -> str:
    """Write a value that is a multiple of ``10**-places``; more than zero places are all shown."""
    scaled = abs(value) * fmpq(10) ** max(places, 0)
    digits = str(int(scaled.p)).rjust(places + 1, "0") if places > 0 else str(int(scaled.p))
    sign = "-" if value < 0 else ""
    return f"{sign}{digits[:-places]}.{digits[-places:]}" if places > 0 else sign + digits


def rounded(value: Any, places: int) -> str:
    """Round and write out: ``rounded(20/3, 3)`` is ``6.667``."""
    return decimal_text(nearest(value, places), places)


def with_figures(value: Any, figures: int) -> str:
    """Round to significant figures; very large and small numbers as ``5.05e-4``."""
    places = places_for(nearest(value, places_for(value, figures)), figures)
    power = magnitude(value)
    if -4 <= power < 7:
        return rounded(value, places)
    mantissa = rounded(value / fmpq(10) ** power, figures - 1)
    return f"{mantissa}e{power}"


def exact_or_figures(value: Any, figures: int) -> str:
    """Write an integer or short decimal exactly, anything else with so many figures."""
    if isinstance(value, fmpq) and abs(value) < 10**7:
        for places in range(figures):
            if (value * 10**places).q == 1:
                return decimal_text(value, places)
    return with_figures(value, figures)
