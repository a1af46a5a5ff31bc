"""What the page is written with, without anything that measures: a server serves it as it is."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

from quizgen.locale import table


def words(lang: str) -> dict[str, Any]:
    """All sentences of the page in one language."""
    return table(lang, "tradeoff")


def style_sheet() -> str:
    """The style of what is measured."""
    return _beside("tradeoff.css")


def script() -> str:
    """What moves the slider."""
    return _beside("tradeoff.js")


def _beside(name: str) -> str:
    return (files("quizgen.tradeoff") / "pages" / name).read_text("utf-8")
