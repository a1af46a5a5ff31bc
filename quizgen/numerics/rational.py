"""Doubles as the fractions they are, or as the decimals they print as, and back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import SupportsIndex

from flint import fmpq, fmpz

from quizgen.numerics.domain import Array

ONE = fmpz(1)
_BITS = 53


def nearest_double(value: fmpq | float) -> float:
    """Return the float nearest to a fraction, infinity beyond the range; a float stays as it is."""
    if isinstance(value, float):
        return value
    try:
        return int(value.p) / int(value.q)
    except OverflowError:
        return float("inf") if value > 0 else -float("inf")


def to_dyadic(value: fmpq) -> tuple[fmpz, int]:
    """Return (n, p) with value = n / 2**p for a double's fraction; n has at most 53 bits."""
    spare = value.p.bit_length() - _BITS
    return (value.p >> spare, -spare) if spare > 0 else (value.p, value.q.bit_length() - 1)


def from_dyadic(number: fmpz, power: int) -> float:
    """Return the double nearest to ``number / 2**power``, rounded once."""
    spare = number.bit_length() - _KEPT
    if spare > 0:  # the bits left out are one, that tells a tie from more
        tail = int(number != (number >> spare) << spare)
        number, power = (number >> spare) << 1 | tail, power - spare + 1
    try:
        if number.bit_length() - power > _NORMAL:  # rounded once
            return math.ldexp(int(number), -power)
        return int(number) / (1 << min(power, _NOTHING))
    except OverflowError:
        return math.inf if number > 0 else -math.inf


_KEPT = 128
_NORMAL, _NOTHING = -1020, 1300
"""Exponents of doubles that are not subnormal, and that make nothing of so many bits."""


def exact_fraction(value: float) -> fmpq:
    """Return the fraction that a finite double is exactly."""
    part, exponent = math.frexp(value)
    whole, exponent = fmpz(int(math.ldexp(part, _BITS))), exponent - _BITS
    return fmpq(whole << exponent) if exponent >= 0 else fmpq(whole, ONE << -exponent)


def exact_arguments(args: Sequence[Array], i: SupportsIndex) -> list[fmpq]:
    """Return element i of every argument as a fraction; an array of one stands for all elements."""
    return [exact_fraction(arg.item(i if arg.size > 1 else 0)) for arg in args]
