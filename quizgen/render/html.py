"""A paper as one self-contained HTML page: MathML, embedded fonts, no network."""

from __future__ import annotations

from functools import cache, partial
from pathlib import Path

import jinja2
from markupsafe import Markup

from quizgen.figures.inks import write_theme_css
from quizgen.locale import amount, language, marks, styles, word
from quizgen.paper.paper import Paper
from quizgen.question.markup import OURS, Manner, blocks, display, inline
from quizgen.render import fonts
from quizgen.render.layouts import environment
from quizgen.render.room import squares

_HERE = Path(__file__).parent


@cache
def _layouts(way: Manner = OURS) -> jinja2.Environment:
    layouts = environment("quizgen.render")
    layouts.globals.update(
        inline=partial(inline, way=way),
        blocks=partial(blocks, way=way),
        display=partial(display, way=way),
        word=word,
        marks=marks,
        amount=amount,
        decimal=lambda lang: language(lang).decimal,
        squares=squares,
        drawing=_board,
        svg=lambda figure: Markup(figure.inline_svg.decode()),
    )
    return layouts


@cache
def _style() -> str:
    page = (_HERE / "pages" / "paper.css").read_text(encoding="utf-8")
    return styles(":lang({})") + write_theme_css() + page


def _board(name: str) -> Markup:
    """A file that a page needs to be drawn in."""
    return Markup((_HERE / "board" / name).read_text(encoding="utf-8"))


def page(layout: str, langs: tuple[str, ...], style: str = "", **content: object) -> bytes:
    """A whole page with its fonts.

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
        _layouts()
        .get_template(layout)
        .render(
            main=langs[0],
            style=Markup(_style() + style),
            maths_font=fonts.maths_uri(),
            bangla_fonts=fonts.bangla_faces(langs),
            **content,
        )
    )
    return made.encode()


def fragment(layout: str, way: Manner, **content: object) -> Markup:
    """A piece of a page, without its head, in the manner of the page."""
    return Markup(_layouts(way).get_template(layout).render(**content))


def render(paper: Paper, kind: str) -> bytes:
    """Render a paper as an HTML page.

    Parameters
    ----------
    paper : Paper
    kind : str
        ``exam`` or ``solutions``.
    """
    return page("paper.html.j2", paper.langs, paper=paper, kind=kind)
