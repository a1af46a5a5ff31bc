"""Pages from their layouts, in the language of who asks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import cache

import jinja2
from markupsafe import Markup
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import ClassError
from quizgen.figures.inks import write_theme_css
from quizgen.grading.drawing.strokes import read_strokes
from quizgen.kinds.contract import DrawingField
from quizgen.locale import (
    fallback_language,
    format_amount,
    format_marks,
    get_language,
    language_css,
    load_words,
    translate,
)
from quizgen.maths.notation import FormulaReadError
from quizgen.practice.scheduler import local_date
from quizgen.question.html import put_fields
from quizgen.render.layouts import jinja_environment
from quizgen.store import Learner
from quizgen.store.seats import NAMES
from quizgen.web.auth import csrf_token
from quizgen.web.lens_drawing import draw_aperture, draw_lens_scale
from quizgen.web.settings import ServerSettings
from quizgen.web.state import ServerState

SCALE_STEPS = 10
"""Large ticks of a scale, but the one at 0."""


@cache
def _build_environment() -> jinja2.Environment:
    """Return the Jinja environment with the page layouts."""
    layouts = jinja_environment("quizgen.web", "quizgen.render")
    layouts.filters["html"] = Markup  # of what was made here, see ``made.Html``
    layouts.globals.update(
        language=get_language, put_fields=put_fields, strokes=strokes_to_svg, word=translate,
        translate=translate,  # where a page has a macro of its own called ``word``
        aperture=draw_aperture, lens_scale=draw_lens_scale,
    )  # fmt: skip
    return layouts


@cache
def page_language_css() -> str:
    """Return the CSS of languages that need their own, and of figures on dark pages."""
    return language_css(":lang({})") + write_theme_css()


def translate_page(lang: str, key: str, **values: object) -> str:
    """Return a sentence of the pages in a language; ``key`` is ``section.name``."""
    section, _, name = key.partition(".")
    text: str = load_words(fallback_language(lang), "web")[section][name]
    return text.format(**values) if values else text


def request_language(request: Request) -> str:
    """Return the learner's language if the server has it, else its first one."""
    site: ServerState = request.app.state.site
    chosen = str(request.state.learner.settings.get("lang"))
    return chosen if chosen in site.languages else site.languages[0]


def _build_menu(site: ServerState, learner: Learner) -> list[tuple[str, str]]:
    """Return address and key of the name of each page that a learner may open."""
    here = site.settings
    if here.accounts and not learner.id:
        return []
    if here.class_exam:
        return _list_supervision(learner)
    shown = [("/", "practice"), ("/exam", "exam"), ("/progress", "progress")]
    shown += [("/formulas", "formulas")] if "formulas" in site.bank.cards else []
    shown += [("/author", "author")] if here.examine else []
    shown += [("/marking", "marking")] if _is_marker(here, learner) else []
    shown += [("/people", "people")] if learner.manages else []
    return shown + ([("/account", "account")] if here.accounts else [])


def _is_marker(settings: ServerSettings, learner: Learner) -> bool:
    """Return whether a learner may mark the class that the server was started with, if any."""
    if settings.classroom is None or not settings.accounts:
        return settings.classroom is not None
    from quizgen.classes.markers import read_markers

    with suppress(ClassError):  # the page itself says what is wrong with the file
        return learner.manages or read_markers(settings.classroom).names(learner.name)
    return False


def _list_supervision(learner: Learner) -> list[tuple[str, str]]:
    """Return the menu of those who watch an exam; students have none."""
    if learner.name.startswith(NAMES):
        return []
    people = [("/people", "people")] if learner.manages else []
    return [("/live", "live"), *people, ("/account", "account")]


def _list_rooms(site: ServerState) -> list[tuple[str, str]]:
    """Return address and key of the name of the pages that nobody needs for an exam."""
    if site.settings.class_exam:
        return []
    rooms = [("/questions", "questions")]
    # Scenes and measurements are of the built-in bank's chapter.
    if builtin_bank() in site.bank.members:
        rooms += [("/camera", "camera"), ("/tradeoff", "tradeoff")]
    return rooms


def page_response(request: Request, layout: str, status: int = 200, **content: object) -> Response:
    """Return a page rendered from a layout.

    Parameters
    ----------
    request : Request
    layout : str
        A file of ``pages``.
    status : int
    content
        What stands on it.
    """
    site: ServerState = request.app.state.site
    lang = request_language(request)

    def words(key: str, **values: object) -> str:
        """Return a sentence in the language of the page."""
        return translate_page(lang, key, **values)

    html = (
        _build_environment()
        .get_template(layout)
        .render(
            lang=lang,
            say=words,
            points=lambda count: format_marks(Fraction(str(count)), lang),
            amount=lambda count: format_amount(count, lang),
            decimal=lambda lang: get_language(lang).decimal,
            scale_labels=lambda of: _label_scale(of, lang),
            site=site,
            token=csrf_token(request.state.token),
            learner=request.state.learner,
            menu=_build_menu(site, request.state.learner),
            rooms=_list_rooms(site),
            **{
                "here": request.url.path,
                "kept": {},
                "seat": getattr(request.state, "seat", None),
                **content,
            },
        )
    )
    # Formulas and figures have styles in their elements, which the policy of pages forbids: the
    # style sheet knows them by their text instead. What people wrote has no plain quotes here.
    return HTMLResponse(html.replace(' style="', ' data-style="'), status)


def _label_scale(of: float, lang: str) -> list[str]:
    """Return the numbers of the large ticks of a scale of points: at most eleven."""
    steps = round(of) if of == round(of) and of <= SCALE_STEPS else SCALE_STEPS
    return [format_amount(of * k / steps, lang) for k in range(steps + 1)]


def relative_time(now: float, lang: str) -> Callable[..., str]:
    """Return a function that says in words when a time was.

    ``now`` and its argument are in seconds since 1970.
    """

    def format_moment(moment: float | None) -> str:
        """Return a time in words, such as ``yesterday``; for None that it never was."""
        if moment is None:
            return translate_page(lang, "progress.never")
        days = (local_date(now) - local_date(moment)).days
        near = {0: "day", 1: "yesterday"}.get(days)
        if near:
            return translate_page(lang, f"progress.{near}")
        return translate_page(lang, "progress.days_ago", count=days)

    return format_moment


def redirect(address: str) -> Response:
    """Return a redirect (HTTP 303) to an address."""
    return RedirectResponse(address, 303)


def safe_redirect_target(address: str) -> str:
    """Return an address on this server; ``/`` for any other.

    A link from elsewhere must not send a learner to a foreign site.
    """
    own = address.startswith("/") and not address.startswith(("//", "/\\"))
    return address if own else "/"


_LINE = Markup('<polyline points="{}"/>')


def strokes_to_svg(board: DrawingField, values: Sequence[str]) -> Markup:
    """Return the lines of a drawn answer as SVG; empty if they cannot be read."""
    try:
        lines = read_strokes(" ".join(values), board.view)
    except FormulaReadError:
        return Markup()
    _, tall = board.picture_size
    return Markup().join(
        _LINE.format(" ".join(f"{x:.1f},{tall - y:.1f}" for x, y in map(board.to_picture, line)))
        for line in lines
    )
