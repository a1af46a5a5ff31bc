"""What every request passes first: from which page it comes, under which name, and how much.

Sources: OWASP cheat sheets "Cross-Site Request Forgery Prevention" (fetch metadata, tokens bound
to the session) and "Content Security Policy".
"""

from __future__ import annotations

import logging
import re
import secrets
import time

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from quizgen.locale import list_languages, load_words
from quizgen.web.event_log import find_cause, log_event
from quizgen.web.settings import ServerSettings

MOST_BYTES = 1_000_000
"""Of a request's body."""
LARGER = {"/progress/import": 17_000_000}
"""Where a body may be larger: a file of everything that somebody did."""
OPEN = "/static/"
"""What anybody may see."""

_NAME = re.compile(r"(\[[0-9a-f:.]+\]|[^\[\]:@]+)(:[0-9]+)?")
"""A name or a number, and a port."""

HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; font-src 'self'; connect-src 'self'; form-action 'self'; "
    "base-uri 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}


def body_limit(scope: Scope) -> int:
    """Return the most bytes that the body of a request may have."""
    return LARGER.get(scope["path"], MOST_BYTES)


class SecurityMiddleware:
    """Rejects requests under foreign host names, of other sites, or too large.

    Parameters
    ----------
    app : ASGI application
    settings : ServerSettings
    """

    def __init__(self, app: ASGIApp, settings: ServerSettings) -> None:
        self.app, self.settings = app, settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a rejected request, or pass it on and add security headers."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        state = scope.setdefault("state", {})
        state["request_id"], began, begun = secrets.token_hex(4), time.monotonic(), False

        async def send_guarded(message: Message) -> None:
            """Send a message, with security headers added; log a server error."""
            nonlocal begun
            if message["type"] == "http.response.start":
                begun = True
                if message["status"] >= 500:
                    _log_failure(scope, message["status"], time.monotonic() - began)
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
                headers.setdefault("cache-control", _choose_cache_control(scope["path"]))
                headers["x-request-id"] = state["request_id"]
            await send(message)

        refused = self._find_refusal(scope)
        if refused is not None:
            await refused(scope, receive, send_guarded)
            return
        try:
            await self.app(scope, _Measured(receive, body_limit(scope)), send_guarded)
        except ClientDisconnect:
            return
        except Exception as error:
            state["cause"] = find_cause(error)
            if begun:
                _log_failure(scope, 500, time.monotonic() - began)
                raise
            crash = plain_error("crash", 500, state["request_id"])
            await crash(scope, receive, send_guarded)

    def _find_refusal(self, scope: Scope) -> Response | None:
        """Return the response to a rejected request; None if it is accepted."""
        headers = Headers(scope=scope)
        name = _NAME.fullmatch(headers.get("host", "").lower())
        if name is None or not self.settings.is_own_name(name[1].strip("[]")):
            return plain_error("host", 400)
        length = headers.get("content-length", "0")
        if not length.isdecimal() or "\0" in scope["path"]:
            return plain_error("400", 400)
        if int(length[:12]) > body_limit(scope):
            return plain_error("413", 413)
        if scope["method"] not in {"GET", "HEAD"} and not _is_from_own_page(headers):
            return plain_error("403", 403)
        return None


def plain_error(name: str, status: int, request_id: str = "") -> Response:
    """Return an error as plain text in every language, with the request's id for the log."""
    errors = [load_words(lang, "web")["error"] for lang in list_languages()]
    said = [error[name] for error in errors]
    said += [error["number"].format(number=request_id) for error in errors if request_id]
    return PlainTextResponse("\n".join(said), status)


def _log_failure(scope: Scope, status: int, seconds: float) -> None:
    """Log which page failed and why, without its address: that may hold what was typed."""
    state, page = scope["state"], scope.get("endpoint")
    log_event(
        "failed",
        logging.ERROR,
        id=state["request_id"],
        status=status,
        page=getattr(page, "__qualname__", type(page).__name__),
        module=getattr(page, "__module__", ""),
        milliseconds=round(1000 * seconds),
        learner=getattr(state.get("learner"), "id", 0),
        **state.get("cause", {}),
    )


def _choose_cache_control(path: str) -> str:
    """Return how a browser may cache the response to a path."""
    if path.startswith("/static/fonts/"):
        return "max-age=604800"
    return "no-cache" if path.startswith(OPEN) else "no-store"


def _is_from_own_page(headers: Headers) -> bool:
    """Return whether a request comes from our own pages, as far as browsers tell."""
    site = headers.get("sec-fetch-site")
    if site is not None:
        return site == "same-origin"
    origin = headers.get("origin")
    return origin is None or origin.partition("://")[2] == headers.get("host")


class _Measured:
    """A request body that raises HTTP 413 once it is longer than allowed."""

    def __init__(self, receive: Receive, most: int) -> None:
        self.receive, self.left = receive, most

    async def __call__(self) -> Message:
        """Return the next message of the body."""
        message = await self.receive()
        self.left -= len(message.get("body", b""))
        if self.left < 0:
            raise HTTPException(413)
        return message
