"""Showing a learner's own text back: shortened, and harmless in a terminal.

Who writes a page escapes there: a message is text, also for JSON and for listeners.
"""

from __future__ import annotations

import unicodedata

LONGEST_ECHO = 40
_BREAKS = frozenset({"Zl", "Zp"})
"""Separators of lines and paragraphs: readers of JSON Lines would cut there."""


def shorten(text: str, longest: int = LONGEST_ECHO) -> str:
    """Cut a text to a length that fits into a sentence."""
    return text if len(text) <= longest else text[: longest - 1] + "…"


def safe(text: str, longest: int = LONGEST_ECHO) -> str:
    """Shorten, and name control characters."""
    cut = shorten(text, longest)
    return cut if cut.isprintable() else "".join(map(_visible, cut))


def _visible(character: str) -> str:
    kind = unicodedata.category(character)
    if (kind[0] != "C" and kind not in _BREAKS) or character == "\u200d":
        return character
    name = unicodedata.name(character, "control character")
    return f"[U+{ord(character):04X} {name}]"
