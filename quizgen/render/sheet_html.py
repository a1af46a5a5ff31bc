"""A formula sheet as one self-contained HTML page; each formula has an anchor, ``#F05``."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from quizgen.question.formula_sheet import NOTES, FormulaSheet
from quizgen.render.html import render_html_page


@cache
def sheet_css() -> str:
    """Return the style of formulas, which pages of a server add to their own, too."""
    return (files("quizgen.render") / "pages" / "sheet.css").read_text(encoding="utf-8")


def render_sheet_html(sheet: FormulaSheet) -> bytes:
    """Return a formula sheet as an HTML page."""
    return render_html_page("sheet.html.j2", sheet.langs, sheet_css(), sheet=sheet, notes=NOTES)
