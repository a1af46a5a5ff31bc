"""Showing a learner's own text back: shortened, and harmless in a terminal or a page."""

from __future__ import annotations

import html
import unicodedata

LONGEST_ECHO = 40


def shorten(text: str, longest: int = LONGEST_ECHO) -> str:
    """Cut a text to a length that fits into a sentence."""
    return text if len(text) <= longest else text[: longest - 1] + "…"


def safe(text: str, longest: int = LONGEST_ECHO) -> str:
    """Shorten, name control characters, and escape what a page would read as markup."""
    visible = "".join(map(_visible, shorten(text, longest)))
    return html.escape(visible, quote=False)


def _visible(character: str) -> str:
    if unicodedata.category(character)[0] != "C" or character == "\u200d":
        return character
    name = unicodedata.name(character, "control character")
    return f"[U+{ord(character):04X} {name}]"
