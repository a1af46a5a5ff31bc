"""Who asks: somebody with the address that was printed, or who has signed in."""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import re
import secrets
from http.cookies import CookieError, SimpleCookie
from urllib.parse import urlencode

from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers, MutableHeaders, QueryParams
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from quizgen.classes.safe_exam_browser import FILE as SETTINGS_FILE
from quizgen.store import Learner, Seat
from quizgen.store.accounts import hash_token
from quizgen.web.event_log import find_cause
from quizgen.web.security import OPEN, plain_error
from quizgen.web.state import ServerState

COOKIE = "quizgen"
ENTRANCE = "/enter"
"""Where the address that is opened first leads: ``/enter?key=KEY``."""
HEALTH = "/health"
"""Where a monitor asks how the server is; it lets nobody in and tells of nobody."""
LONGEST_CHECK = 5.0
"""Seconds in which the database is to answer."""
SUPERVISION = "/live"
"""Before the pages of those who watch an exam."""
SIGN_IN, INVITED = "/sign-in", "/invited"
SETTINGS = f"/{SETTINGS_FILE}"
"""Of Safe Exam Browser, for a class that sits its exam in it."""
"""What somebody may see who has not signed in."""


def csrf_token(token: str) -> str:
    """Return the token that every form of a session holds: other sites cannot post one."""
    return hmac.new(token.encode(), b"form", hashlib.sha256).hexdigest()


class AuthMiddleware:
    """Admits requests of known learners and sets ``learner`` and ``token`` in their state.

    Parameters
    ----------
    app : ASGI application
    site : ServerState
    """

    def __init__(self, app: ASGIApp, site: ServerState) -> None:
        self.app, self.site = app, site
        self._open = {SIGN_IN, INVITED, *(["/", SETTINGS] if site.room else [])}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request that is not admitted, or pass it to the application."""
        if scope["type"] != "http" or scope["path"].startswith(OPEN):
            await self.app(scope, receive, send)
            return
        if scope["path"] == HEALTH:
            await (await self._health())(scope, receive, send)
            return
        self.site.papers_ahead.note_request()
        try:
            sign = self._signed_in if self.site.settings.accounts else self._admit_sole_learner
            answer = await sign(scope)
        except SQLAlchemyError as error:
            state = scope["state"]
            state["cause"] = find_cause(error)
            answer = plain_error("503", 503, state["request_id"])
        if answer is not None:
            await answer(scope, receive, send)
            return
        await self.app(scope, receive, _with_cookie(scope, send))

    async def _health(self) -> Response:
        """Return as JSON whether the database answers and how many workers are alive."""
        try:
            await asyncio.wait_for(run_in_threadpool(self.site.store.check), LONGEST_CHECK)
            is_well = True
        except (SQLAlchemyError, TimeoutError):
            is_well = False
        told = {"status": "ok" if is_well else "failing", "database": is_well,
                "workers": self.site.workers.alive}  # fmt: skip
        return JSONResponse(told, 200 if is_well else 503)

    async def _admit_sole_learner(self, scope: Scope) -> Response | None:
        """Admit the sole learner; return HTTP 403 for a browser without a key."""
        store = self.site.store
        if scope["path"] == ENTRANCE:
            return await self._begin_keyed_session(scope)
        token = _read_session_cookie(scope)
        learner = await self._find_learner()
        if token not in self.site.admitted:
            if not token or not await run_in_threadpool(
                store.accounts.is_session, token, learner.id
            ):
                return plain_error("entrance", 403)
            self.site.admitted.add(token)
        scope.setdefault("state", {}).update(learner=learner, token=token)
        return None

    async def _find_learner(self) -> Learner:
        """Return the sole learner, from memory if it was read before."""
        store = self.site.store
        found: Learner | None = store.cached_learner()
        return found if found is not None else await run_in_threadpool(store.learner)

    async def _begin_keyed_session(self, scope: Scope) -> Response:
        """Start a session for a browser that brings a valid key."""
        store = self.site.store
        if not self.site.keys.is_good(QueryParams(scope["query_string"]).get("key", "")):
            return plain_error("entrance", 403)
        learner = await self._find_learner()
        token = await run_in_threadpool(store.accounts.start_session, learner.id)
        self.site.admitted.add(token)
        scope.setdefault("state", {})
        return set_session_cookie(scope, RedirectResponse("/", 303), token)

    async def _signed_in(self, scope: Scope) -> Response | None:
        """Admit a learner who has a session; else return the way to the sign-in page."""
        token = _read_session_cookie(scope)
        state = scope.setdefault("state", {})
        learner, state["seat"] = await run_in_threadpool(self._find_session, token)
        state.update(learner=learner or _make_visitor(scope, self.site.languages), token=token)
        if learner is not None or scope["path"] in self._open:
            if not token:
                state["token"] = state["new_token"] = secrets.token_urlsafe(24)
            return None
        if self.site.room and not scope["path"].startswith(SUPERVISION):
            return _to_sign_in(scope, "/")
        return _to_sign_in(scope, SIGN_IN)

    def _find_session(self, token: str) -> tuple[Learner | None, Seat | None]:
        """Return whose session a token is, and the seat of one who sits an exam of a class."""
        store = self.site.store
        found = store.seats.signed_in(hash_token(token)) if token and self.site.room else None
        if found is not None:
            return found
        return (store.accounts.signed_in(token) if token else None), None


def set_session_cookie(scope: Scope, response: Response, token: str) -> Response:
    """Return the response with another session token in its cookie.

    Not ``samesite=strict``: the entrance is a local file, which browsers take for another site.
    Forged posts are rejected by the token in each form and by ``SecurityMiddleware``.
    """
    scope["state"].pop("new_token", None)
    return set_cookie(scope, response, COOKIE, token)


def set_cookie(
    scope: Scope, response: Response, name: str, value: str, seconds: float | None = None
) -> Response:
    """Return the response with a cookie that no script can read.

    It lasts ``seconds``, or until the browser closes if None.
    """
    response.set_cookie(
        name, value, max_age=None if seconds is None else int(seconds),
        httponly=True, samesite="lax", secure=scope["scheme"] == "https",
    )  # fmt: skip
    return response


def _with_cookie(scope: Scope, send: Send) -> Send:
    """Return ``send`` extended by the cookie of a new token.

    A browser without a session needs one for its forms; it admits to nothing.
    """

    async def sending(message: Message) -> None:
        """Send a message, with the cookie added to the head of the response."""
        token = scope.get("state", {}).get("new_token")
        if token and message["type"] == "http.response.start":
            given = set_session_cookie(scope, Response(), token).headers["set-cookie"]
            MutableHeaders(scope=message).append("set-cookie", given)
        await send(message)

    return sending


def _make_visitor(scope: Scope, spoken: tuple[str, ...]) -> Learner:
    """Return a learner without account, in the language that the address or browser asks for."""
    asked = [QueryParams(scope["query_string"]).get("lang", "")]
    asked += [
        one.partition(";")[0].strip()
        for one in Headers(scope=scope).get("accept-language", "").split(",")[:10]
    ]
    by_name = {_strip_country(lang): lang for lang in reversed(spoken)}
    by_name |= {lang.lower(): lang for lang in spoken}
    known = (by_name.get(one.lower()) or by_name.get(_strip_country(one)) for one in asked)
    return Learner(0, "", {"lang": next(filter(None, known), spoken[0])})


def _strip_country(lang: str) -> str:
    """Return a language without its country: ``pt`` of ``pt-BR``."""
    return lang.partition("-")[0].lower()


def _to_sign_in(scope: Scope, door: str) -> Response:
    """Return a redirect to a page to sign in on, which leads back to the page of the request.

    A script gets a header instead, and what is no page a plain error.
    """
    headers = Headers(scope=scope)
    by_script = "hx-request" in headers
    if scope["method"] in {"GET", "HEAD"} and not by_script:
        return RedirectResponse(f"{door}?{urlencode({'to': scope['path']})}", 303)
    page = headers.get("hx-current-url") or headers.get("referer", "")
    back = re.sub("^[a-z]+://[^/]*", "", page).partition("?")[0] or "/"
    where = f"{door}?{urlencode({'to': back, 'ended': 1})}"
    if by_script:
        return Response(status_code=403, headers={"hx-redirect": where})
    if "text/html" in headers.get("accept", ""):
        return RedirectResponse(where, 303)
    return plain_error("sign_in", 403)


def _read_session_cookie(scope: Scope) -> str:
    """Return the session token in the cookie; empty if there is none."""
    try:
        found = SimpleCookie(Headers(scope=scope).get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return found.value if found else ""
