"""Pages from their layouts, in the language of who asks."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import jinja2
from markupsafe import Markup
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from quizgen.figures.inks import write_theme_css
from quizgen.locale import amount, known, language, marks, styles, table, word
from quizgen.practice.schedule import day_of
from quizgen.render.layouts import environment
from quizgen.web.door import form_token
from quizgen.web.site import Site
from quizgen.web.sketches import strokes
from quizgen.web.store import Learner


@cache
def _layouts() -> jinja2.Environment:
    layouts = environment("quizgen.web", "quizgen.render")
    layouts.filters["html"] = Markup  # of what was made here, see ``made.Html``
    layouts.globals.update(language=language, strokes=strokes, word=word)
    return layouts


@cache
def language_style() -> str:
    """The style of languages that need one, and of figures on a dark page."""
    return styles(":lang({})") + write_theme_css()


def said(lang: str, key: str, **values: object) -> str:
    """A sentence of the pages, with its blanks filled in."""
    section, _, name = key.partition(".")
    text: str = table(known(lang), "web")[section][name]
    return text.format(**values) if values else text


def lang_of(request: Request) -> str:
    """The language that whoever asks has chosen."""
    site: Site = request.app.state.site
    chosen = str(request.state.learner.settings.get("lang"))
    return chosen if chosen in site.languages else site.languages[0]


def _menu(site: Site, learner: Learner) -> list[tuple[str, str]]:
    """Addresses of pages that a learner may see, and what they are called."""
    here = site.settings
    if here.accounts and not learner.id:
        return []
    shown = [("/", "practice"), ("/exam", "exam"), ("/progress", "progress")]
    shown += [("/formulas", "formulas")] if "formulas" in site.bank.cards else []
    shown += [("/camera", "camera"), ("/tradeoff", "tradeoff")]
    shown += [("/author", "author")] if here.examine else []
    shown += [("/class", "class")] if here.classroom else []
    shown += [("/people", "people")] if learner.manages else []
    return shown + ([("/account", "account")] if here.accounts else [])


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
            amount=lambda count: amount(count, lang),
            decimal=lambda lang: language(lang).decimal,
            site=site,
            token=form_token(request.state.token),
            learner=request.state.learner,
            menu=_menu(site, request.state.learner),
            **{"here": request.url.path, "kept": {}, **content},
        )
    )
    return HTMLResponse(html, status)


def when(now: float, lang: str) -> Callable[..., str]:
    """Says in words when something was or will be."""

    def told(moment: float | None, *, ahead: bool = False) -> str:
        if moment is None:
            return "" if ahead else said(lang, "progress.never")
        if ahead and moment <= now:
            return said(lang, "progress.now")
        days = (day_of(moment) - day_of(now)).days
        near = {0: "day", 1: "tomorrow", -1: "yesterday"}.get(days)
        if near:
            return said(lang, f"progress.{near}")
        return said(lang, "progress.in_days" if days > 0 else "progress.days_ago", count=abs(days))

    return told


def to(address: str) -> Response:
    """Go on to another page."""
    return RedirectResponse(address, 303)


def inside(address: str) -> str:
    """An address of these pages; the first page instead of any other."""
    own = address.startswith("/") and not address.startswith(("//", "/\\"))
    return address if own else "/"
