"""What accuracy costs in time: the page of ``quizgen tradeoff``, measured on this machine."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

import msgspec
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.core.decoding import decode_json
from quizgen.locale import list_languages
from quizgen.tradeoff.texts import script, tradeoff_css, words
from quizgen.web.question_view import Html
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language

PATIENCE = 0.3
"""Seconds in which a measurement that is kept has come."""
COMMAND = "quizgen tradeoff"
"""What measures the same."""


@dataclass(frozen=True)
class TradeoffJob:
    """Measures the cost of accuracy once, and renders it in every language."""

    def run(self, bank: Bank) -> bytes:
        """Return the HTML by language, as JSON."""
        from quizgen.tradeoff.page import render_tradeoff_fragment
        from quizgen.tradeoff.report import measure_tradeoff

        report = measure_tradeoff(bank)
        return msgspec.json.encode(
            {lang: render_tradeoff_fragment(report, COMMAND, lang) for lang in list_languages()}
        )


async def show_tradeoff(request: Request) -> Response:
    """Return the page of measurements; it reloads itself while they are being made."""
    site: ServerState = request.app.state.site
    said: dict[str, Html] = {}
    try:
        data = await asyncio.wait_for(site.workers.get_result(TradeoffJob()), PATIENCE)
        said = decode_json(data, dict[str, Html])
    except TimeoutError:
        pass
    lang = request_language(request)
    title = words(lang)["page"]["title"]
    return page_response(request, "tradeoff.html.j2", title=title, measured=said.get(lang, ""))


async def style(_request: Request) -> Response:
    """Return the style sheet of the page."""
    return Response(tradeoff_css(), media_type="text/css")


async def serve_tradeoff_js(_request: Request) -> Response:
    """Return the script of the page's slider."""
    return Response(script(), media_type="text/javascript")


ROUTES = [
    Route("/tradeoff", show_tradeoff),
    Route("/static/tradeoff.css", style),
    Route("/static/tradeoff.js", serve_tradeoff_js),
]
