"""Figures in words: numbers as figures print them, sentences from ``<lang>.toml``."""

from __future__ import annotations

import re
import tomllib
from decimal import ROUND_HALF_UP, Context, Decimal
from functools import cache
from pathlib import Path
from typing import Any

from quizgen.core.errors import BankError
from quizgen.core.untrusted import error_context, read_bytes
from quizgen.locale import FIRST

_GIVEN = Context(prec=12, rounding=ROUND_HALF_UP)  # hides the noise of floats, nothing else
_DERIVED = Context(prec=4, rounding=ROUND_HALF_UP)


def _format_plain(number: Decimal) -> str:
    """Return a decimal without exponent and trailing zeros, with a true minus sign."""
    text = f"{number.normalize():f}"
    return ("−" + text[1:] if text.startswith("-") else text) if number else "0"


def format_given(value: float) -> str:
    """Return a number that the question states, with all its digits."""
    return _format_plain(_GIVEN.create_decimal(repr(float(value))))


def format_derived(value: float) -> str:
    """Return a computed number: whole, or rounded to 4 significant digits (half away from 0)."""
    return _format_plain(_to_short_decimal(value))


def _to_short_decimal(value: float) -> Decimal:
    """Return a whole number as it is, any other rounded to 4 significant digits."""
    value = float(value)
    return Decimal(value) if value.is_integer() else _DERIVED.create_decimal(repr(value))


def relation_sign(value: float) -> str:
    """Return ``=`` if the printed number is exactly the value, else ``≈``."""
    shown = float(_to_short_decimal(value))
    return "=" if abs(shown - value) <= 1e-12 * abs(value) else "≈"


def format_equation(name: str, value: float, unit: str = "", *, hide: bool = False) -> str:
    """Return ``name = value unit`` for a computed value; ``name = ?`` if it is to be hidden."""
    if hide:
        return f"{name} = ?"
    return f"{name} {relation_sign(value)} {format_derived(value)}{_format_unit_suffix(unit)}"


def format_statement(name: str, value: float, unit: str = "") -> str:
    """Return ``name = value unit`` for a number that the question states."""
    return f"{name} = {format_given(value)}{_format_unit_suffix(unit)}"


def _format_unit_suffix(unit: str) -> str:
    """Return a unit with a space in front, or ""."""
    return f" {unit}" if unit else ""


_MATHTEXT = re.compile(r"\\[,;! ]|[${}]|\\(?:mathrm|mathit|mathbf|text)")
_COMMANDS = {r"\lambda": "λ", r"\sigma": "σ", r"\mu": "μ", r"\varphi": "φ", r"\Delta": "Δ",
             r"\alpha": "α", r"\theta": "θ", r"\nu": "ν", r"\cdot": "·", r"\times": "×",
             r"\pm": "±", r"\le": "≤", r"\ge": "≥", r"\approx": "≈", r"\circ": "°"}  # fmt: skip
_COMMAND = re.compile(rf"({'|'.join(map(re.escape, _COMMANDS))})(?![A-Za-z])\s?")


def strip_mathtext(label: str) -> str:
    """Return a label of a figure as plain text: ``$z'_p$ = 60 mm`` is ``z'_p = 60 mm``."""
    label = _COMMAND.sub(lambda found: _COMMANDS[found[1]], label)
    return _MATHTEXT.sub("", label)


@cache
def load_alt_words(module: str, lang: str) -> dict[str, str]:
    """Return the sentences of a figure by key, in English where a language has none.

    Parameters
    ----------
    module : str
        ``__file__`` of the figure; its table is called as the file is, without the suffix.
    lang : str
        A language.

    Raises
    ------
    BankError
        If there is no such file, it is no TOML, or it has no table of this figure.
    """
    place = Path(module)
    file = place.with_name(f"{lang}.toml")
    if not file.is_file():
        file = place.with_name(f"{FIRST}.toml")
    sentences = _load_table(file).get(place.stem)
    if not isinstance(sentences, dict):
        raise BankError(f"{file}: no table [{place.stem}], the figure's sentences")
    return sentences


def clear_alt_words() -> None:
    """Forget the sentences of all figures, so that changed files are read again."""
    load_alt_words.cache_clear()
    _load_table.cache_clear()


@cache
def _load_table(file: Path) -> dict[str, Any]:
    """Return the content of a file of sentences; raise ``BankError`` if it cannot be read."""
    with error_context(file, BankError):
        return tomllib.loads(read_bytes(file, BankError).decode())
