"""Pages that stand alone, of papers and formula sheets: MathML, embedded fonts, no network."""

from __future__ import annotations

from functools import cache, partial
from importlib.resources import files
from pathlib import Path

import jinja2
from markupsafe import Markup

from quizgen.figures.inks import write_theme_css
from quizgen.locale import format_amount, format_marks, get_language, language_css, translate
from quizgen.paper.paper import Paper
from quizgen.question.formula_sheet import NOTES, FormulaSheet
from quizgen.question.html import (
    OURS,
    HtmlDialect,
    blocks_to_html,
    chain_to_html,
    display_to_html,
    inlines_to_html,
    put_fields,
)
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.mark_scheme import mark_lines
from quizgen.question.solution import scheme_examples, scheme_title
from quizgen.render import fonts
from quizgen.render.layouts import count_working_rows, jinja_environment

_HERE = Path(__file__).parent


@cache
def _build_environment(way: HtmlDialect = OURS) -> jinja2.Environment:
    """Return Jinja's environment for pages, writing formulas in a dialect of HTML."""
    layouts = jinja_environment("quizgen.render")
    layouts.globals.update(
        inline=partial(inlines_to_html, way=way),
        blocks=partial(blocks_to_html, way=way),
        display=partial(display_to_html, way=way),
        worked=partial(chain_to_html, way=way),
        word=translate,
        marks=format_marks,
        amount=format_amount,
        decimal=lambda lang: get_language(lang).decimal,
        mark_lines=mark_lines,
        squares=count_working_rows,
        plain=inlines_to_text,
        put_fields=put_fields,
        scheme_examples=scheme_examples,
        scheme_title=scheme_title,
        drawing=_read_board_file,
        svg=lambda figure: Markup(figure.inline_svg.decode()),
    )
    return layouts


@cache
def _build_paper_css() -> str:
    """Return the style sheet of papers."""
    shared, own = (
        (_HERE / name).read_text(encoding="utf-8") for name in ("look/look.css", "pages/paper.css")
    )
    return language_css(":lang({})") + write_theme_css() + shared + own


def _read_board_file(name: str) -> Markup:
    """Return a file that a page needs to be drawn in, as markup."""
    return Markup((_HERE / "board" / name).read_text(encoding="utf-8"))


def render_html_page(
    layout: str, langs: tuple[str, ...], style: str = "", **content: object
) -> bytes:
    """Return a whole HTML page with its fonts, in UTF-8.

    Parameters
    ----------
    layout : str
        A file of ``pages``.
    langs : tuple of str
        Languages on the page, the leading one first.
    style : str
        What its style has beyond that of a paper.
    content : object
        What stands on it.
    """
    made = (
        _build_environment()
        .get_template(layout)
        .render(
            main=langs[0],
            style=Markup(_build_paper_css() + style),
            text_font=fonts.text_uri(),
            maths_font=fonts.maths_uri(),
            bangla_fonts=fonts.bangla_faces(langs),
            **content,
        )
    )
    if fonts.has_rare_signs(made):
        made = made.replace(fonts.maths_uri(), fonts.all_maths_uri())
    return made.encode()


def render_html_fragment(layout: str, way: HtmlDialect, **content: object) -> Markup:
    """Return a piece of a page, without its head, in a dialect of HTML.

    ``layout`` and ``content`` are as in `render_html_page`.
    """
    return Markup(_build_environment(way).get_template(layout).render(**content))


def render_paper_html(paper: Paper, kind: str) -> bytes:
    """Return a paper as an HTML page.

    Parameters
    ----------
    paper : Paper
    kind : str
        ``exam`` or ``solutions``.
    """
    return render_html_page("paper.html.j2", paper.langs, paper=paper, kind=kind)


@cache
def sheet_css() -> str:
    """Return the style of formulas, which pages of a server add to their own, too."""
    return (files("quizgen.render") / "pages" / "sheet.css").read_text(encoding="utf-8")


def render_sheet_html(sheet: FormulaSheet) -> bytes:
    """Return a formula sheet as an HTML page."""
    return render_html_page("sheet.html.j2", sheet.langs, sheet_css(), sheet=sheet, notes=NOTES)
