"""Whole numbers in another base than ten, as people write them: ``0x3F``, ``3f h``, ``(101)_2``."""

from __future__ import annotations

import re

from flint import fmpq

from quizgen.grading.reading.numbers import ReadNumber
from quizgen.maths.notation import FormulaReadError

TEN, MOST = 10, 16
DIGITS = "0123456789ABCDEF"
LONGEST = 64
"""Digits of a typed number."""
_PREFIXES = {2: "0B", 8: "0O", 16: "0X"}
_SUFFIXES = {2: "B", 8: "O", 16: "H"}
_LOWERED = str.maketrans("₀₁₂₃₄₅₆₇₈₉−", "0123456789-")
_BASE = re.compile(r"(?:_\{?|(?=[₀-₉]))(?P<base>[\d₀-₉]+)\}?$")
"""A base at the end, as an index."""


_REMARK = re.compile(r"(?<=[0-9A-Fa-f]) ?\([^()]*[=+][^()]*\)\s*$")
"""How a number was checked, behind it: ``1011110 (54 + 40 = 94)``."""


def read_in_base(typed: str, base: int) -> ReadNumber:
    """Return a typed whole number; blanks, a prefix and the base as an index may stand there.

    Raises
    ------
    FormulaReadError
        If a sign is no digit of the base, or another base is named.
    """
    text = _REMARK.sub("", typed).rpartition("=")[2].strip(" \t\r\n$.").upper()
    named = _BASE.search(text)
    said = int(named["base"].translate(_LOWERED)) if named else base
    if named:
        text = text[: named.start()]
    text = text.translate(_LOWERED).strip("() ")
    minus, text = text.startswith("-"), text.lstrip("+- ")
    text = re.sub(r"[ _'\u00a0\u202f]", "", text).removeprefix(_PREFIXES.get(base, ""))
    if (suffix := _SUFFIXES.get(base, "")) not in DIGITS[:base]:
        text = text.removesuffix(suffix)
    allowed = DIGITS[:base]
    if not typed.strip():
        raise FormulaReadError("no-answer", 1)
    wrong = next((sign for sign in text if sign not in allowed), "")
    if not text or wrong or said != base or len(text) > LONGEST:
        found = wrong or typed.strip()[:LONGEST]
        column = typed.upper().find(wrong) + 1 if wrong else 1
        raise FormulaReadError("digits-expected", max(column, 1), found, [*allowed])
    value = int(text, base)
    return ReadNumber(fmpq(-value if minus else value), format_in_base(value, base), "integer")


def format_in_base(value: int, base: int) -> str:
    """Return a whole number in the digits of a base."""
    digits, rest = "", abs(value)
    while rest or not digits:
        rest, digit = divmod(rest, base)
        digits = DIGITS[digit] + digits
    return f"-{digits}" if value < 0 else digits
