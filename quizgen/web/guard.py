"""What every request passes before a route sees it: who asks, from where, and how much.

Sources: OWASP cheat sheets "Cross-Site Request Forgery Prevention" (fetch metadata, tokens bound
to the session) and "Content Security Policy".
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from http.cookies import CookieError, SimpleCookie

from starlette.datastructures import MutableHeaders, QueryParams
from starlette.exceptions import HTTPException
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from quizgen.web.settings import Settings

COOKIE = "quizgen"
MOST_BYTES = 1_000_000
"""Of a request's body."""
LARGER = {"/progress/import": 17_000_000}
"""Where a body may be larger: a file of everything that somebody did."""
ENTRANCE = "/enter"
"""Where the address that is opened first leads: ``/enter?key=TOKEN``."""
OPEN = ("/static/",)
"""What anybody may see."""

HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; "
    "style-src 'self' 'unsafe-inline'; "  # figures have styles in their elements
    "img-src 'self' data:; font-src 'self'; connect-src 'self'; form-action 'self'; "
    "base-uri 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}


def form_token(token: str) -> str:
    """What every form holds, so that no other site can post one."""
    return hmac.new(token.encode(), b"form", hashlib.sha256).hexdigest()


def most_bytes(scope: Scope) -> int:
    """How large the body of a request may be."""
    return LARGER.get(scope["path"], MOST_BYTES)


class Guard:
    """Lets in whom the opened address let in, asked by one of its own pages.

    Parameters
    ----------
    app : ASGI application
    settings : Settings
    """

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app, self.settings = app, settings

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer at once, or hand on."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers.setdefault(name, value)
                headers.setdefault("cache-control", _kept(scope["path"]))
            await send(message)

        refused = self._refused(scope)
        if refused is not None:
            await refused(scope, receive, guarded)
            return
        await self.app(scope, _Measured(receive, most_bytes(scope)), guarded)

    def _refused(self, scope: Scope) -> Response | None:
        headers = {name.decode("latin-1"): value.decode("latin-1")
                   for name, value in scope["headers"]}  # fmt: skip
        wrong = self._misplaced(headers, most_bytes(scope))
        if "\0" in scope["path"]:
            return PlainTextResponse("This address is no text.", 400)
        if wrong is not None or scope["path"].startswith(OPEN):
            return wrong
        if scope["path"] == ENTRANCE:
            return self._entered(scope)
        if not secrets.compare_digest(_cookie(headers).encode(), self.settings.token.encode()):
            said = "Open the address that quizgen serve printed: it lets this browser in."
            return PlainTextResponse(said, 403)
        if scope["method"] not in {"GET", "HEAD"} and not _own(headers):
            return PlainTextResponse("A page of another site may not send this.", 403)
        return None

    def _misplaced(self, headers: dict[str, str], most: int) -> Response | None:
        """What is wrong with a request whoever sends it."""
        name, _, port = headers.get("host", "").rpartition(":")
        if (name or port).strip("[]") not in self.settings.hosts:
            return PlainTextResponse("This address is not served here.", 400)
        length = headers.get("content-length", "0")
        if not length.isdecimal():
            return PlainTextResponse("The length of the body is no number.", 400)
        return PlainTextResponse("Too much was sent.", 413) if int(length[:12]) > most else None

    def _entered(self, scope: Scope) -> Response:
        key = QueryParams(scope["query_string"]).get("key", "")
        if not secrets.compare_digest(key.encode(), self.settings.token.encode()):
            return PlainTextResponse("This is not the address that was printed.", 403)
        response = RedirectResponse("/", 303)
        response.set_cookie(COOKIE, key, httponly=True, samesite="strict", path="/")
        return response


def _kept(path: str) -> str:
    """How long a browser may keep what it was sent."""
    if path.startswith("/static/fonts/"):
        return "max-age=604800"
    return "no-cache" if path.startswith(OPEN) else "no-store"


def _cookie(headers: dict[str, str]) -> str:
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return found.value if found else ""


def _own(headers: dict[str, str]) -> bool:
    """Whether one of our own pages sends this, as far as browsers say."""
    site = headers.get("sec-fetch-site")
    if site is not None:
        return site == "same-origin"
    origin = headers.get("origin")
    return origin is None or origin.partition("://")[2] == headers.get("host")


class _Measured:
    """A body that is refused where it is longer than its header said, or says nothing."""

    def __init__(self, receive: Receive, most: int) -> None:
        self.receive, self.left = receive, most

    async def __call__(self) -> Message:
        message = await self.receive()
        self.left -= len(message.get("body", b""))
        if self.left < 0:
            raise HTTPException(413)
        return message
