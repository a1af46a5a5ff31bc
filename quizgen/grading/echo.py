"""Showing a learner's own text back: shortened, and harmless in a terminal.

Who writes a page escapes there: a message is text, also for JSON and for listeners.
"""

from __future__ import annotations

from quizgen.core.untrusted import escape_control_characters

LONGEST_ECHO = 40


def shorten(text: str, longest: int = LONGEST_ECHO) -> str:
    """Return a text cut to a length that fits into a sentence."""
    return text if len(text) <= longest else text[: longest - 1] + "…"


def safe_echo(text: str, longest: int = LONGEST_ECHO) -> str:
    """Return a text shortened, with control characters and line breaks named."""
    return escape_control_characters(shorten(text, longest), kept="")
