"""Generic slips that show in one number alone: sign, power of ten, reciprocal, percent, factor."""

from __future__ import annotations

import math
from collections.abc import Sequence

from flint import arb, fmpq

from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.verdict import Verdict
from quizgen.maths.numbers import decimal_exponent, to_float
from quizgen.maths.precision import working_precision
from quizgen.maths.values import Value

CLOSE = fmpq(1, 200)
"""Relative distance within which a slip is said to explain a number."""

with working_precision():
    FACTORS = {
        "2": fmpq(2),
        "1/2": fmpq(1, 2),
        "3": fmpq(3),
        "1/3": fmpq(1, 3),
        "4": fmpq(4),
        "1/4": fmpq(1, 4),
        "8": fmpq(8),
        "1/8": fmpq(1, 8),
        "π": arb.pi(),
        "1/π": 1 / arb.pi(),
        "2π": 2 * arb.pi(),
        "1/(2π)": 1 / (2 * arb.pi()),
        "√2": arb(2).sqrt(),
        "1/√2": 1 / arb(2).sqrt(),
    }
"""Constant factors worth naming."""

_ABOUT = {name: to_float(factor) for name, factor in FACTORS.items()}
NEAR = 0.01
"""Relative distance of floats beyond which exact arithmetic need not be asked: twice ``CLOSE``."""

_TENS = {power: fmpq(10) ** power for power in range(-19, 20)}


def agrees_within_half_percent(value: Value, target: Value) -> bool:
    """Return whether two values agree within half a percent of the target."""
    return bool(abs(value - target) <= CLOSE * abs(target))


def power_of_ten_off(value: Value, key: Value) -> int:
    """Return the exponent k if the value is 10^k times the key (within half a percent), else 0."""
    ratio = _compute_ratio_to_key(value, key)
    power = round(math.log10(ratio)) if 1e-19 < ratio < 1e19 else 0
    return power if power and agrees_within_half_percent(value, key * _TENS[power]) else 0


def _compute_ratio_to_key(value: Value, key: Value) -> float:
    """Return about how many times the key a value is; 0 where no float can hold that."""
    try:
        return to_float(value / key)
    except (ZeroDivisionError, OverflowError):
        return 0.0


def is_in_radians(value: Value, key: Value) -> bool:
    """Return whether a number is the key's angle, given in radians for degrees."""
    return value != 0 and agrees_within_half_percent(value * 180 / arb.pi(), key)


def find_generic_slip(
    number: ReadNumber, value: Value, key: Value, *, ratio: bool
) -> tuple[str, dict[str, object]]:
    """Return the one generic slip that explains a wrong number; a turned sign is tested before.

    Parameters
    ----------
    number : ReadNumber
        How it was written.
    value, key : Value
        The wrong number and the right one, in one unit.
    ratio : bool
        Whether the key is a plain ratio: only one of these can be upside down.

    Returns
    -------
    tuple of str and dict
        The note (empty if nothing explains it) and what its sentence fills in.
    """
    power = power_of_ten_off(value, key)
    if power:
        return _choose_power_note(number, key, power)
    if ratio and agrees_within_half_percent(value * key, fmpq(1)):
        return "reciprocal", {}
    if power_of_ten_off(-value, key):
        return "sign-and-power", {}
    return _find_common_factor(value, key)


def find_common_slip(cells: Sequence[Verdict]) -> tuple[str, dict[str, object]]:
    """Return the note that all cells of a table or coordinates of a point share, and its fields.

    The note is empty if they have several, or if a cell is right. Only fields with one value in
    all cells are returned; a sentence does without the others.
    """
    notes = {cell.note for cell in cells}
    if len(notes) != 1 or any(cell.credit == 1 for cell in cells):
        return "", {}
    first = cells[0].fields
    same = {k: v for k, v in first.items() if all(c.fields.get(k) == v for c in cells)}
    return notes.pop(), same


def _choose_power_note(number: ReadNumber, key: Value, power: int) -> tuple[str, dict[str, object]]:
    """Return the note for a number that is off by 10^power, and what its sentence fills in.

    A turned sign of the exponent and a percent sign forgotten have notes of their own.
    """
    if number.form == "scientific" and power == -2 * decimal_exponent(key):
        return "exponent-sign", {}
    if power == 2 and 0 < key <= 1:
        return "percent-slip", {}
    return "power-of-ten", {"power": power}


def _find_common_factor(value: Value, key: Value) -> tuple[str, dict[str, object]]:
    """Return the note ``factor`` and the constant that the value is off by; empty if none."""
    ratio = _compute_ratio_to_key(value, key)
    for name, factor in FACTORS.items():
        if abs(ratio / _ABOUT[name] - 1) < NEAR and agrees_within_half_percent(value, key * factor):
            return "factor", {"factor": name}
    return "", {}
