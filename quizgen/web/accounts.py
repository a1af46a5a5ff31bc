"""Signing in and out, one's own account, and for those who manage everybody's."""

from __future__ import annotations

import time
from dataclasses import dataclass

from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.store import Invitation, Person
from quizgen.store.accounts import Accounts, fold_user_name
from quizgen.web.auth import INVITED, SIGN_IN, set_session_cookie
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


@dataclass(frozen=True)
class AccountLink:
    """A link that was just made, to be handed to somebody."""

    address: str
    person: Person | None = None
    """Who may choose a new password with it; None for somebody new."""


def _get_accounts(request: Request) -> Accounts:
    site: ServerState = request.app.state.site
    return site.store.accounts


def _begin_sign_in_attempt(request: Request, name: str) -> tuple[object, int]:
    """Who tries to sign in, as far as can be told, and how many seconds they have to wait."""
    site: ServerState = request.app.state.site
    who = (request.client.host if request.client else "", fold_user_name(name[:LONGEST_NAME]))
    return who, site.patience.seconds_to_wait(who)


async def _begin_session(request: Request, learner: int, address: str) -> Response:
    """Begin a session of its own, whatever the browser had before."""
    accounts = _get_accounts(request)
    await run_in_threadpool(accounts.end_session, request.state.token)
    token = await run_in_threadpool(accounts.start_session, learner)
    return set_session_cookie(request.scope, redirect(safe_redirect_target(address)), token)


def _render_sign_in_page(
    request: Request, status: int = 200, problem: str = "", name: str = ""
) -> Response:
    kept = {"to": safe_redirect_target(request.query_params.get("to", "/"))}
    return page_response(
        request, "sign_in.html.j2", status, kept=kept, problem=problem, name=name[:LONGEST_NAME]
    )


async def show_sign_in(request: Request) -> Response:
    """Where one signs in."""
    if request.state.learner.id:
        return redirect("/")
    ended = (
        translate_page(request_language(request), "account.ended")
        if "ended" in request.query_params
        else ""
    )
    return _render_sign_in_page(request, problem=ended)


async def sign_in(request: Request) -> Response:
    """Sign in by name and password."""
    form = await read_form(request)
    site: ServerState = request.app.state.site
    name = field_text(form, "name")
    who, wait = _begin_sign_in_attempt(request, name)
    if wait:
        slow = translate_page(request_language(request), "account.wait", count=wait)
        answer = _render_sign_in_page(request, 429, slow, name)
        answer.headers["retry-after"] = str(wait)
        return answer
    known = await run_in_threadpool(_get_accounts(request).password_hash_of, name)
    if (
        not await verify_password(known[1] if known else None, field_text(form, "password"))
        or known is None
    ):
        return _render_sign_in_page(
            request, 403, translate_page(request_language(request), "account.wrong"), name
        )
    site.patience.reset(who)
    return await _begin_session(request, known[0], request.query_params.get("to", "/"))


async def sign_out(request: Request) -> Response:
    """End the session."""
    await read_form(request)
    await run_in_threadpool(_get_accounts(request).end_session, request.state.token)
    return redirect(SIGN_IN)


async def _find_invitation(request: Request) -> Invitation:
    key = request.query_params.get("key", "")
    found = await run_in_threadpool(_get_accounts(request).invited, key)
    if found is None:
        raise HTTPException(410)
    return found


def _render_invitation_page(
    request: Request, invitation: Invitation, problem: str = "", name: str = ""
) -> Response:
    return page_response(
        request, "invited.html.j2", 400 if problem else 200, kept=dict(request.query_params),
        invitation=invitation, problem=problem and translate_page(request_language(request), f"account.{problem}"),
        name=name[:LONGEST_NAME],
    )  # fmt: skip


async def show_invitation(request: Request) -> Response:
    """Where an invitation leads."""
    return _render_invitation_page(request, await _find_invitation(request))


async def accept_invitation(request: Request) -> Response:
    """Choose a name and a password, or a new password."""
    form = await read_form(request)
    invitation = await _find_invitation(request)
    typed, key = field_text(form, "name"), request.query_params["key"]
    problem, name = _wrong_password(form), normalise_user_name(typed)
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
    return await _begin_session(request, learner, "/")


def _wrong_password(form: FormData) -> str:
    """What is wrong with a new password, typed twice."""
    if not is_acceptable(field_text(form, "password")):
        return "no_password"
    return "" if field_text(form, "password") == field_text(form, "again") else "not_again"


def _render_own_account(request: Request, status: int = 200, problem: str = "") -> Response:
    told = problem and translate_page(request_language(request), f"account.{problem}")
    changed = bool(request.query_params.get("changed"))
    return page_response(request, "account.html.j2", status, problem=told, changed=changed)


async def show_account(request: Request) -> Response:
    """One's own account."""
    return _render_own_account(request)


async def set_password(request: Request) -> Response:
    """Change one's own password, by the old one; other browsers have to sign in again."""
    form = await read_form(request)
    site: ServerState = request.app.state.site
    learner = request.state.learner
    who, wait = _begin_sign_in_attempt(request, learner.name)
    if wait:
        raise HTTPException(429)
    known = await run_in_threadpool(_get_accounts(request).password_hash_of, learner.name)
    if not known or not await verify_password(known[1], field_text(form, "old")):
        return _render_own_account(request, 403, "wrong_old")
    site.patience.reset(who)
    problem = _wrong_password(form)
    if problem:
        return _render_own_account(request, 400, problem)
    kept = await hash_password(field_text(form, "password"))
    await run_in_threadpool(_get_accounts(request).set_password, learner.id, kept)
    return await _begin_session(request, learner.id, "/account?changed=1")


def _require_manager(request: Request) -> None:
    if not request.state.learner.manages:
        raise HTTPException(403)


def _render_people_page(request: Request, link: AccountLink | None = None) -> Response:
    accounts = _get_accounts(request)
    return page_response(
        request, "people.html.j2", here="/people", link=link, people=accounts.people(),
        invitations=accounts.invitations(), now=time.time(),
    )  # fmt: skip


async def list_people(request: Request) -> Response:
    """Everybody, and who is invited."""
    _require_manager(request)
    return await run_in_threadpool(_render_people_page, request)


def _make_invitation_link(
    request: Request, learner: Person | None, *, manages: bool = False
) -> AccountLink:
    token = _get_accounts(request).invite(learner.id if learner else None, manages=manages)
    return AccountLink(f"{request.base_url}{INVITED[1:]}?key={token}", learner)


async def invite(request: Request) -> Response:
    """Make a link that lets somebody in, once; it is shown, and nowhere kept."""
    form = await read_form(request)
    _require_manager(request)
    manages = bool(field_text(form, "manages"))

    def made() -> Response:
        return _render_people_page(request, _make_invitation_link(request, None, manages=manages))

    return await run_in_threadpool(made)


async def revoke_invitation(request: Request) -> Response:
    """Take an invitation back."""
    form = await read_form(request)
    _require_manager(request)
    await run_in_threadpool(_get_accounts(request).withdraw, field_text(form, "invitation"))
    return redirect("/people")


async def _find_person(request: Request) -> Person:
    """Whom a page of those who manage is about."""
    _require_manager(request)
    name = request.path_params["person"]
    for found in await run_in_threadpool(_get_accounts(request).people):
        if str(found.id) == name:
            return found
    raise HTTPException(404)


def _render_person_page(
    request: Request, found: Person, status: int = 200, problem: str = ""
) -> Response:
    told = problem and translate_page(request_language(request), f"account.{problem}")
    here = f"/people/{found.id}"
    return page_response(request, "person.html.j2", status, here=here, person=found, problem=told)


async def show_person(request: Request) -> Response:
    """Somebody's account."""
    return _render_person_page(request, await _find_person(request))


async def rename(request: Request) -> Response:
    """Give somebody another name."""
    form = await read_form(request)
    found = await _find_person(request)
    name = normalise_user_name(field_text(form, "name"))
    if name is None:
        return _render_person_page(request, found, 400, "no_name")
    if not await run_in_threadpool(_get_accounts(request).rename, found.id, name):
        return _render_person_page(request, found, 400, "taken")
    return redirect("/people")


async def issue_password_link(request: Request) -> Response:
    """Make a link with which somebody chooses a new password."""
    await read_form(request)
    found = await _find_person(request)
    return await run_in_threadpool(
        lambda: _render_people_page(request, _make_invitation_link(request, found))
    )


async def remove(request: Request) -> Response:
    """Remove somebody else and all that they did, where that is meant."""
    form = await read_form(request)
    found = await _find_person(request)
    if found.id == request.state.learner.id or not field_text(form, "sure"):
        return _render_person_page(request, found, 400, "not_sure")
    await run_in_threadpool(_get_accounts(request).remove, found.id)
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
