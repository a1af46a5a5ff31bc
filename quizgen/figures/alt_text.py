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
    text = f"{number.normalize():f}"
    return ("−" + text[1:] if text.startswith("-") else text) if number else "0"


def format_given(value: float) -> str:
    """Print a number that the question states, in full."""
    return _format_plain(_GIVEN.create_decimal(repr(float(value))))


def format_derived(value: float) -> str:
    """Print a computed number: whole or rounded half away from zero to 4 significant digits."""
    return _format_plain(_to_short_decimal(value))


def _to_short_decimal(value: float) -> Decimal:
    value = float(value)
    return Decimal(value) if value.is_integer() else _DERIVED.create_decimal(repr(value))


def relation_sign(value: float) -> str:
    """``=`` if the printed number is the value, else ``≈``."""
    shown = float(_to_short_decimal(value))
    return "=" if abs(shown - value) <= 1e-12 * abs(value) else "≈"


def format_equation(name: str, value: float, unit: str = "", *, hide: bool = False) -> str:
    """``name = value unit`` for a computed value, or ``name = ?``."""
    if hide:
        return f"{name} = ?"
    return f"{name} {relation_sign(value)} {format_derived(value)}{_after_number(unit)}"


def format_statement(name: str, value: float, unit: str = "") -> str:
    """``name = value unit`` for a number that the question states."""
    return f"{name} = {format_given(value)}{_after_number(unit)}"


def _after_number(unit: str) -> str:
    return f" {unit}" if unit else ""


_MATHTEXT = re.compile(r"\\[,;! ]|[${}]|\\(?:mathrm|mathit|mathbf|text)")
_COMMANDS = {r"\lambda": "λ", r"\sigma": "σ", r"\mu": "μ", r"\varphi": "φ", r"\Delta": "Δ",
             r"\alpha": "α", r"\theta": "θ", r"\nu": "ν", r"\cdot": "·", r"\times": "×",
             r"\pm": "±", r"\le": "≤", r"\ge": "≥", r"\approx": "≈", r"\circ": "°"}  # fmt: skip
_COMMAND = re.compile(rf"({'|'.join(map(re.escape, _COMMANDS))})(?![A-Za-z])\s?")


def strip_mathtext(label: str) -> str:
    """A label of a figure as plain text: ``$z'_p$ = 60 mm`` is ``z'_p = 60 mm``."""
    label = _COMMAND.sub(lambda found: _COMMANDS[found[1]], label)
    return _MATHTEXT.sub("", label)


@cache
def load_alt_words(module: str, lang: str) -> dict[str, str]:
    """Sentences of a figure, from ``<lang>.toml`` beside it; in English where there is none.

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
    """Have the sentences of all figures read again."""
    load_alt_words.cache_clear()
    _load_table.cache_clear()


@cache
def _load_table(file: Path) -> dict[str, Any]:
    with error_context(file, BankError):
        return tomllib.loads(read_bytes(file, BankError).decode())
