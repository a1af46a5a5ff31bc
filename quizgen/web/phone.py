"""Going on with a phone: a code to scan lets it in as the same learner."""

from __future__ import annotations

import segno
from markupsafe import Markup
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.web.auth import ENTRANCE
from quizgen.web.forms import read_form
from quizgen.web.state import SCAN_SECONDS, ServerState
from quizgen.web.views import page_response


async def explain_phone(request: Request) -> Response:
    """Return the page that says what scanning the code does."""
    return _phone_page(request)


async def show_code(request: Request) -> Response:
    """Return the page with a new code: it lets in one device, once, within ten minutes."""
    await read_form(request)
    site: ServerState = request.app.state.site
    port = request.scope["server"][1]
    address = f"{site.settings.phone_url(port)}{ENTRANCE}?key={site.keys.make_for_phone()}"
    return _phone_page(request, address)


async def end_others(request: Request) -> Response:
    """Sign out every other device of the learner."""
    await read_form(request)
    site: ServerState = request.app.state.site
    learner, token = request.state.learner.id, request.state.token
    await run_in_threadpool(site.store.accounts.end_other_sessions, learner, token)
    site.admitted.clear()
    return _phone_page(request, ended=True)


def _phone_page(request: Request, address: str = "", *, ended: bool = False) -> Response:
    """Return the page, with the code of an address if there is one."""
    code = draw_code(address) if address else ""
    minutes = round(SCAN_SECONDS / 60)
    return page_response(
        request, "phone.html.j2", address=address, code=code, ended=ended, minutes=minutes
    )


def draw_code(address: str) -> Markup:
    """Return the QR code of an address as SVG."""
    code = segno.make(address, error="m", micro=False)
    return Markup(code.svg_inline(dark="#000", light="#fff", svgclass=None, lineclass=None,  # noqa: S704
                                  omitsize=True, border=2))  # fmt: skip


ROUTES = [
    Route("/phone", explain_phone),
    Route("/phone", show_code, methods=["POST"]),
    Route("/phone/end", end_others, methods=["POST"]),
]
