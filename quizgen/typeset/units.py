"""How units are printed: ``um^2/px`` as upright parts with exponents."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from quizgen.core.errors import RenderError
from quizgen.maths.superscripts import LOWERED
from quizgen.maths.units import SHOWN

TIGHT = frozenset({"deg", "°"})
"""Units set without a space after the number."""

_PART = re.compile(r"(?P<sign>[*/·]?)(?P<name>e[-⁻]|[^*/·^⁻⁰-⁹²³]+)(?:\^?(?P<power>-?\d|⁻?[²³¹]))?")


_NAME = re.compile(r"[^\W\d_]+|e-|[%°1]")


class UnitPart(NamedTuple):
    """One simple unit: the sign before it, its listed name, how it is shown, its power."""

    sign: str
    name: str
    shown: str
    power: str


@lru_cache(maxsize=512)
def split_unit(text: str) -> tuple[UnitPart, ...]:
    """Split a unit into its simple parts.

    Raises
    ------
    RenderError
        If a part is no name of a unit.
    """
    compact = text.replace(" ", "")
    found, position = [], 0
    while position < len(compact):
        match = _PART.match(compact, position)
        listed = match["name"].replace("⁻", "-") if match else ""
        if match is None or not _NAME.fullmatch(listed):
            raise RenderError(f"no way to print the unit {text!r}")
        sign = "/" if match["sign"] == "/" else "·" * bool(match["sign"])
        power = (match["power"] or "").translate(LOWERED)
        found.append(UnitPart(sign, listed, SHOWN.get(listed, listed), power))
        position = match.end()
    return tuple(found)
