"""A formula sheet as one self-contained HTML page; each formula has an anchor, ``#F05``."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from quizgen.question.formula_sheet import NOTES, FormulaSheet
from quizgen.render.html import render_html_page


@cache
def sheet_css() -> str:
    """How formulas look, added to what all pages have; the pages of the browser show them alike."""
    return (files("quizgen.render") / "pages" / "sheet.css").read_text(encoding="utf-8")


def render_sheet_html(sheet: FormulaSheet) -> bytes:
    """Render a formula sheet as an HTML page."""
    return render_html_page("sheet.html.j2", sheet.langs, sheet_css(), sheet=sheet, notes=NOTES)
