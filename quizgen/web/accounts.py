"""Signing in and out, one's own account, and for those who manage everybody's."""

from __future__ import annotations

import hashlib
import hmac
import secrets
import time
from dataclasses import dataclass

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.store import Invitation, Person
from quizgen.store.accounts import DAY, Accounts, fold_user_name
from quizgen.web.auth import INVITED, SIGN_IN, set_cookie, set_session_cookie
from quizgen.web.event_log import log_event
from quizgen.web.forms import field_text, read_form
from quizgen.web.passwords import (
    LONGEST_NAME,
    hash_password,
    is_acceptable,
    normalise_user_name,
    verify_password,
)
from quizgen.web.state import ServerState
from quizgen.web.views import (
    page_response,
    redirect,
    request_language,
    safe_redirect_target,
    translate_page,
)

BROWSER = "quizgen-browser"
"""Cookie of a browser in which somebody has signed in; it lets nobody in."""
BROWSER_DAYS = 365


@dataclass(frozen=True)
class AccountLink:
    """A link that was just issued and is shown once, to be handed to somebody."""

    address: str
    person: Person | None = None
    """Who may choose a new password with it; None for somebody new."""


def _get_accounts(request: Request) -> Accounts:
    """Return the accounts of the server that a request came to."""
    site: ServerState = request.app.state.site
    return site.store.accounts


def _get_client_address(request: Request) -> str:
    """Return the IP address that a request came from; empty if it is unknown."""
    return request.client.host if request.client else ""


def _sign_browser_proof(request: Request, learner: int, number: str) -> str:
    """Return the value of the cookie that marks a browser in which this learner signed in before.

    An HMAC under the server's secret, so that nobody can make one; ``number`` is random.
    """
    site: ServerState = request.app.state.site
    text, secret = f"{learner}.{number}".encode(), site.browser_secret.encode()
    return f"{number}.{hmac.new(secret, text, hashlib.sha256).hexdigest()}"


def _read_browser_proof(request: Request, learner: int | None) -> str:
    """Return the proof cookie if it is valid for this learner; else an empty string."""
    given = request.cookies.get(BROWSER, "")
    right = _sign_browser_proof(request, learner or 0, given.partition(".")[0])
    return given if learner and secrets.compare_digest(given.encode(), right.encode()) else ""


async def _try_password(
    request: Request, name: str, known: tuple[int, str] | None, password: str
) -> tuple[int, bool]:
    """Return the seconds to wait before a try is allowed, and whether the password is right.

    ``known`` is the learner's id and password hash, None for a name that nobody has. Tries are
    limited and counted by name, address and browser.
    """
    site: ServerState = request.app.state.site
    limits, browser = (
        site.password_limits,
        _read_browser_proof(request, known[0] if known else None),
    )
    who = (fold_user_name(name[:LONGEST_NAME]), _get_client_address(request), browser)
    wait = limits.begin(*who)
    learner = known[0] if known else 0
    if wait:
        log_event("password not tried yet", learner=learner, address=who[1], seconds=wait)
        return wait, False
    async with limits.turns.turn(browser or _get_client_address(request)):
        right = await verify_password(known[1] if known else None, password)
    if right:
        limits.count_right(*who)
    log_event("password right" if right else "password wrong", learner=learner, address=who[1])
    return 0, right


async def _begin_session(request: Request, learner: int, address: str) -> Response:
    """Start a new session and redirect to ``address``.

    The old session ends, so that a token planted in the browser before is worth nothing.
    """
    accounts = _get_accounts(request)
    await run_in_threadpool(accounts.end_session, request.state.token)
    token = await run_in_threadpool(accounts.start_session, learner)
    answer = set_session_cookie(request.scope, redirect(safe_redirect_target(address)), token)
    proof = _sign_browser_proof(request, learner, secrets.token_urlsafe(12))
    return set_cookie(request.scope, answer, BROWSER, proof, BROWSER_DAYS * DAY)


def _render_sign_in_page(
    request: Request, status: int = 200, problem: str = "", name: str = ""
) -> Response:
    """Return the sign-in page, with a problem and the typed name if there was a try."""
    kept = {"to": safe_redirect_target(request.query_params.get("to", "/"))}
    return page_response(
        request, "sign_in.html.j2", status, kept=kept, problem=problem, name=name[:LONGEST_NAME]
    )


async def show_sign_in(request: Request) -> Response:
    """Return the sign-in page; somebody signed in is redirected to the start page."""
    if request.state.learner.id:
        return redirect("/")
    ended = (
        translate_page(request_language(request), "account.ended")
        if "ended" in request.query_params
        else ""
    )
    return _render_sign_in_page(request, problem=ended)


async def sign_in(request: Request) -> Response:
    """Sign in by name and password; return a redirect, or the page with the problem."""
    form = await read_form(request)
    name = field_text(form, "name")
    known = await run_in_threadpool(_get_accounts(request).password_hash_of, name)
    wait, right = await _try_password(request, name, known, field_text(form, "password"))
    if wait:
        slow = translate_page(request_language(request), "account.wait", count=wait)
        answer = _render_sign_in_page(request, 429, slow, name)
        answer.headers["retry-after"] = str(wait)
        return answer
    if not right or known is None:
        return _render_sign_in_page(
            request, 403, translate_page(request_language(request), "account.wrong"), name
        )
    return await _begin_session(request, known[0], request.query_params.get("to", "/"))


async def sign_out(request: Request) -> Response:
    """End the session and redirect to the sign-in page."""
    await read_form(request)
    await run_in_threadpool(_get_accounts(request).end_session, request.state.token)
    return redirect(SIGN_IN)


async def _find_invitation(request: Request) -> Invitation:
    """Return the invitation that the link's key names; HTTP 410 if it is used or expired."""
    key = request.query_params.get("key", "")
    found = await run_in_threadpool(_get_accounts(request).find_valid_invitation, key)
    if found is None:
        raise HTTPException(410)
    return found


def _render_invitation_page(
    request: Request, invitation: Invitation, problem: str = "", name: str = ""
) -> Response:
    """Return the page of an invitation; ``problem`` is the key of its message, if any.

    ``name`` is what was typed before, so that nobody types it twice.
    """
    return page_response(
        request,
        "invited.html.j2",
        400 if problem else 200,
        kept=dict(request.query_params),
        invitation=invitation,
        problem=problem and translate_page(request_language(request), f"account.{problem}"),
        name=name[:LONGEST_NAME],
    )


async def show_invitation(request: Request) -> Response:
    """Return the page on which an invited person chooses name and password."""
    return _render_invitation_page(request, await _find_invitation(request))


async def accept_invitation(request: Request) -> Response:
    """Create the account, or set the new password, of an invitation; begin a session."""
    form = await read_form(request)
    invitation = await _find_invitation(request)
    typed, key = field_text(form, "name"), request.query_params["key"]
    problem, name = _find_password_problem(form), normalise_user_name(typed)
    if invitation.learner is None and name is None:
        problem = "no_name"
    if problem:
        return _render_invitation_page(request, invitation, problem, typed)
    kept, accounts = await hash_password(field_text(form, "password")), _get_accounts(request)
    if invitation.learner is not None:
        learner = await run_in_threadpool(accounts.renew, key, kept)
    else:
        settings = {"lang": request_language(request)}
        learner = await run_in_threadpool(accounts.join, key, str(name), kept, settings)
    if learner is None:
        return _render_invitation_page(request, await _find_invitation(request), "taken", typed)
    log_event("invitation used", learner=learner, address=_get_client_address(request))
    return await _begin_session(request, learner, "/")


def _find_password_problem(form: FormData) -> str:
    """Return the key of what is wrong with a new password, typed twice; empty if nothing."""
    if not is_acceptable(field_text(form, "password")):
        return "no_password"
    return "" if field_text(form, "password") == field_text(form, "again") else "not_again"


def _render_own_account(request: Request, status: int = 200, problem: str = "") -> Response:
    """Return the account page; ``problem`` is the key of its message."""
    told = problem and translate_page(request_language(request), f"account.{problem}")
    changed = bool(request.query_params.get("changed"))
    return page_response(request, "account.html.j2", status, problem=told, changed=changed)


async def show_account(request: Request) -> Response:
    """Return the page of the learner's own account."""
    return _render_own_account(request)


async def set_password(request: Request) -> Response:
    """Change the learner's own password by the old one; all other sessions end."""
    form = await read_form(request)
    learner = request.state.learner
    known = await run_in_threadpool(_get_accounts(request).password_hash_of, learner.name)
    wait, right = await _try_password(request, learner.name, known, field_text(form, "old"))
    if wait:
        raise HTTPException(429)
    if not right:
        return _render_own_account(request, 403, "wrong_old")
    problem = _find_password_problem(form)
    if problem:
        return _render_own_account(request, 400, problem)
    kept = await hash_password(field_text(form, "password"))
    await run_in_threadpool(_get_accounts(request).set_password, learner.id, kept)
    log_event("password changed", learner=learner.id)
    return await _begin_session(request, learner.id, "/account?changed=1")


def _require_manager(request: Request) -> None:
    """Raise HTTP 403 unless the learner manages accounts."""
    if not request.state.learner.manages:
        raise HTTPException(403)


def _render_people_page(request: Request, link: AccountLink | None = None) -> Response:
    """Return the page of all accounts and invitations, with a link just issued if any."""
    accounts = _get_accounts(request)
    return page_response(
        request, "people.html.j2", here="/people", link=link, people=accounts.people(),
        invitations=accounts.invitations(), now=time.time(),
    )  # fmt: skip


async def list_people(request: Request) -> Response:
    """Return the page of all accounts and open invitations, for managers."""
    _require_manager(request)
    return await run_in_threadpool(_render_people_page, request)


def _make_invitation_link(
    request: Request, learner: Person | None, *, manages: bool = False
) -> AccountLink:
    """Return a new link: an invitation, or for ``learner`` one to choose a new password."""
    token = _get_accounts(request).invite(learner.id if learner else None, manages=manages)
    whose = learner.id if learner else "new"
    log_event("link made", by=request.state.learner.id, learner=whose, manages=manages)
    return AccountLink(f"{request.base_url}{INVITED[1:]}?key={token}", learner)


async def invite(request: Request) -> Response:
    """Issue an invitation link, valid once, and return the page that shows it.

    The database has only a hash of its key, so the link cannot be shown again.
    """
    form = await read_form(request)
    _require_manager(request)
    manages = bool(field_text(form, "manages"))

    def create_invitation() -> Response:
        """Issue the link and render the page, in a thread: both use the database."""
        return _render_people_page(request, _make_invitation_link(request, None, manages=manages))

    return await run_in_threadpool(create_invitation)


async def revoke_invitation(request: Request) -> Response:
    """Revoke an invitation and redirect to the page of all accounts."""
    form = await read_form(request)
    _require_manager(request)
    await run_in_threadpool(_get_accounts(request).withdraw, field_text(form, "invitation"))
    return redirect("/people")


async def _find_person(request: Request) -> Person:
    """Return the account that a manager's page is about; HTTP 404 if there is none."""
    _require_manager(request)
    name = request.path_params["person"]
    for found in await run_in_threadpool(_get_accounts(request).people):
        if str(found.id) == name:
            return found
    raise HTTPException(404)


def _render_person_page(
    request: Request, found: Person, status: int = 200, problem: str = ""
) -> Response:
    """Return a manager's page of an account; ``problem`` is the key of its message, if any."""
    told = problem and translate_page(request_language(request), f"account.{problem}")
    here = f"/people/{found.id}"
    return page_response(request, "person.html.j2", status, here=here, person=found, problem=told)


async def show_person(request: Request) -> Response:
    """Return the page of an account, for managers."""
    return _render_person_page(request, await _find_person(request))


async def rename(request: Request) -> Response:
    """Rename an account; return a redirect, or the page with the problem."""
    form = await read_form(request)
    found = await _find_person(request)
    name = normalise_user_name(field_text(form, "name"))
    if name is None:
        return _render_person_page(request, found, 400, "no_name")
    if not await run_in_threadpool(_get_accounts(request).rename, found.id, name):
        return _render_person_page(request, found, 400, "taken")
    return redirect("/people")


async def issue_password_link(request: Request) -> Response:
    """Issue a link to choose a new password, and return the page that shows it."""
    await read_form(request)
    found = await _find_person(request)
    return await run_in_threadpool(
        lambda: _render_people_page(request, _make_invitation_link(request, found))
    )


async def remove(request: Request) -> Response:
    """Delete another account and its data, if the deletion was confirmed."""
    form = await read_form(request)
    found = await _find_person(request)
    if found.id == request.state.learner.id or not field_text(form, "sure"):
        return _render_person_page(request, found, 400, "not_sure")
    await run_in_threadpool(_get_accounts(request).remove, found.id)
    log_event("learner removed", by=request.state.learner.id, learner=found.id)
    return redirect("/people")


ROUTES = [
    Route(SIGN_IN, show_sign_in),
    Route(SIGN_IN, sign_in, methods=["POST"]),
    Route("/sign-out", sign_out, methods=["POST"]),
    Route(INVITED, show_invitation),
    Route(INVITED, accept_invitation, methods=["POST"]),
    Route("/account", show_account),
    Route("/account", set_password, methods=["POST"]),
    Route("/people", list_people),
    Route("/people/invite", invite, methods=["POST"]),
    Route("/people/withdraw", revoke_invitation, methods=["POST"]),
    Route("/people/{person}", show_person),
    Route("/people/{person}/name", rename, methods=["POST"]),
    Route("/people/{person}/password", issue_password_link, methods=["POST"]),
    Route("/people/{person}/remove", remove, methods=["POST"]),
]
