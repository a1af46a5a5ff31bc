"""Numbers as a figure and its alt text print them: one spelling for both."""

from __future__ import annotations

from decimal import ROUND_HALF_UP, Context, Decimal

_GIVEN = Context(prec=12, rounding=ROUND_HALF_UP)  # hides the noise of floats, nothing else
_DERIVED = Context(prec=4, rounding=ROUND_HALF_UP)


def _plain(number: Decimal) -> str:
    text = f"{number.normalize():f}"
    return ("−" + text[1:] if text.startswith("-") else text) if number else "0"


def given(value: float) -> str:
    """Print a number that the question states, in full."""
    return _plain(_GIVEN.create_decimal(repr(value)))


def derived(value: float) -> str:
    """Print a computed number: whole or rounded half away from zero to 4 significant digits."""
    return _plain(_short(value))


def _short(value: float) -> Decimal:
    return Decimal(value) if value.is_integer() else _DERIVED.create_decimal(repr(value))


def relation(value: float) -> str:
    """``=`` if the printed number is the value, else ``≈``."""
    shown = float(_short(value))
    return "=" if abs(shown - value) <= 1e-12 * abs(value) else "≈"


def equation(name: str, value: float, unit: str = "", *, hide: bool = False) -> str:
    """``name = value unit`` for a computed value, or ``name = ?``."""
    if hide:
        return f"{name} = ?"
    return f"{name} {relation(value)} {derived(value)}{_unit(unit)}"


def statement(name: str, value: float, unit: str = "") -> str:
    """``name = value unit`` for a number that the question states."""
    return f"{name} = {given(value)}{_unit(unit)}"


def _unit(unit: str) -> str:
    return f" {{{unit}}}" if unit else ""


def numbered(number: int, told: str, *, quiz: bool) -> str:
    """Caption of one of several pictures: its number, and outside a quiz what it shows."""
    return f"{{{number}}}" if quiz else f"{{{number}:}}  {told}"


def spoken(label: str) -> str:
    """Turn a label of a figure into plain text: no layout braces."""
    return label.replace("{", "").replace("}", "")
