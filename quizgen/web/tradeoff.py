"""What accuracy costs in time: the page of ``quizgen tradeoff``, measured on this machine."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

import msgspec
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.folder import Bank
from quizgen.locale import languages
from quizgen.shapes import decoded
from quizgen.tradeoff.texts import script, style_sheet, words
from quizgen.web.made import Html
from quizgen.web.site import Site
from quizgen.web.views import lang_of, page

PATIENCE = 0.3
"""Seconds in which a measurement that is kept has come."""
COMMAND = "quizgen tradeoff"
"""What measures the same."""


@dataclass(frozen=True)
class Measurement:
    """Everything measured once; what is said of it in every language."""

    def run(self, bank: Bank) -> bytes:
        """Measure."""
        from quizgen.tradeoff.page import fragment
        from quizgen.tradeoff.report import measure

        report = measure(bank)
        return msgspec.json.encode({lang: fragment(report, COMMAND, lang) for lang in languages()})


async def tradeoff(request: Request) -> Response:
    """What was measured; a page that looks again by itself while it is being measured."""
    site: Site = request.app.state.site
    said: dict[str, Html] = {}
    try:
        data = await asyncio.wait_for(site.workers.done(Measurement()), PATIENCE)
        said = decoded(data, dict[str, Html])
    except TimeoutError:
        pass
    lang = lang_of(request)
    title = words(lang)["page"]["title"]
    return page(request, "tradeoff.html.j2", title=title, measured=said.get(lang, ""))


async def style(_request: Request) -> Response:
    """The style of what was measured."""
    return Response(style_sheet(), media_type="text/css")


async def moves(_request: Request) -> Response:
    """What moves its slider."""
    return Response(script(), media_type="text/javascript")


ROUTES = [
    Route("/tradeoff", tradeoff),
    Route("/static/tradeoff.css", style),
    Route("/static/tradeoff.js", moves),
]
