"""A formula sheet as one self-contained HTML page; each formula has an anchor, ``#F05``."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from quizgen.question.sheet import NOTES, Sheet
from quizgen.render.html import page


@cache
def style() -> str:
    """How formulas look, besides what all pages have; the pages of the browser show them alike."""
    return (files("quizgen.render") / "pages" / "sheet.css").read_text(encoding="utf-8")


def render(sheet: Sheet) -> bytes:
    """Render a formula sheet as an HTML page."""
    return page("sheet.html.j2", sheet.langs, style(), sheet=sheet, notes=NOTES)
