"""Pages from their layouts, in the language of who asks."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import jinja2
from markupsafe import Markup
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from quizgen.locale import FIRST, in_script, known, language, languages, line_heights, marks, table
from quizgen.render.layouts import environment
from quizgen.web.guard import form_token
from quizgen.web.site import Site

HX = "hx-request"
"""The header that htmx sends."""


@cache
def _layouts() -> jinja2.Environment:
    layouts = environment("quizgen.web")
    layouts.filters["html"] = Markup  # of what was made here, see ``made.Html``
    layouts.globals.update(languages=languages, language=language)
    return layouts


@cache
def language_style() -> str:
    """The style of languages whose lines have a height of their own."""
    return line_heights(":lang({})")


def said(lang: str, key: str, **values: object) -> str:
    """A sentence of the pages, with its blanks filled in."""
    section, _, name = key.partition(".")
    text: str = table(known(lang), "web")[section][name]
    return text.format(**values) if values else text


def lang_of(request: Request) -> str:
    """The language that whoever asks has chosen."""
    return known(str(request.state.learner.settings.get("lang", FIRST)))


def page(request: Request, layout: str, status: int = 200, **content: Any) -> Response:
    """A page.

    Parameters
    ----------
    request : Request
    layout : str
        A file of ``pages``.
    status : int
    content
        What stands on it.
    """
    site: Site = request.app.state.site
    lang = lang_of(request)

    def words(key: str, **values: object) -> str:
        return said(lang, key, **values)

    html = (
        _layouts()
        .get_template(layout)
        .render(
            lang=lang,
            say=words,
            points=lambda count: marks(Fraction(str(count)), lang),
            site=site,
            here=request.url.path,
            token=form_token(site.settings.token),
            bangla=bool(in_script("Beng")),
            **content,
        )
    )
    return HTMLResponse(html, status)


def to(address: str) -> Response:
    """Go on to another page."""
    return RedirectResponse(address, 303)
