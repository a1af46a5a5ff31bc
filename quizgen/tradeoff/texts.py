"""What the page is written with, without anything that measures: a server serves it as it is."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

from quizgen.locale import load_words


def words(lang: str) -> dict[str, Any]:
    """Return all sentences of the page in one language."""
    return load_words(lang, "tradeoff")


def tradeoff_css() -> str:
    """Return the style sheet of the page's content."""
    return _read_page_file("tradeoff.css")


def script() -> str:
    """Return the JavaScript of the slider."""
    return _read_page_file("tradeoff.js")


def _read_page_file(name: str) -> str:
    """Return the text of a file in ``pages``."""
    return (files("quizgen.tradeoff") / "pages" / name).read_text("utf-8")
