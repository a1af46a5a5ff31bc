"""How many columns of a terminal text takes."""

from __future__ import annotations

import unicodedata


def width(text: str) -> int:
    """Columns of a text (combining marks take none)."""
    return sum(0 if unicodedata.category(c) in {"Mn", "Me", "Cf"} else 1 + is_wide(c) for c in text)


def is_wide(character: str) -> bool:
    """Whether a character takes two."""
    return unicodedata.east_asian_width(character) in {"W", "F"}
