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

from quizgen.web.door import INVITED, SIGN_IN, let_in
from quizgen.web.forms import one, posted
from quizgen.web.passwords import LONGEST_NAME, acceptable, as_name, fits, hashed
from quizgen.web.site import Site
from quizgen.web.store import Invitation, Person
from quizgen.web.store.accounts import Accounts, compared
from quizgen.web.views import inside, lang_of, page, said, to


@dataclass(frozen=True)
class Link:
    """A link that was just made, to be handed to somebody."""

    address: str
    person: Person | None = None
    """Who may choose a new password with it; None for somebody new."""


def _accounts(request: Request) -> Accounts:
    site: Site = request.app.state.site
    return site.store.accounts


def _waiting(request: Request, name: str) -> tuple[object, int]:
    """Who tries to sign in, as far as can be told, and how many seconds they have to wait."""
    site: Site = request.app.state.site
    who = (request.client.host if request.client else "", compared(name[:LONGEST_NAME]))
    return who, site.patience.begin(who)


async def _begun(request: Request, learner: int, address: str) -> Response:
    """Begin a session of its own, whatever the browser had before."""
    accounts = _accounts(request)
    await run_in_threadpool(accounts.end, request.state.token)
    token = await run_in_threadpool(accounts.begin, learner)
    return let_in(request.scope, to(inside(address)), token)


def _entry(request: Request, status: int = 200, problem: str = "", name: str = "") -> Response:
    kept = {"to": inside(request.query_params.get("to", "/"))}
    return page(
        request, "sign_in.html.j2", status, kept=kept, problem=problem, name=name[:LONGEST_NAME]
    )


async def entry(request: Request) -> Response:
    """Where one signs in."""
    if request.state.learner.id:
        return to("/")
    ended = said(lang_of(request), "account.ended") if "ended" in request.query_params else ""
    return _entry(request, problem=ended)


async def sign_in(request: Request) -> Response:
    """Sign in by name and password."""
    form = await posted(request)
    site: Site = request.app.state.site
    name = one(form, "name")
    who, wait = _waiting(request, name)
    if wait:
        slow = said(lang_of(request), "account.wait", count=wait)
        answer = _entry(request, 429, slow, name)
        answer.headers["retry-after"] = str(wait)
        return answer
    known = await run_in_threadpool(_accounts(request).known, name)
    if not await fits(known[1] if known else None, one(form, "password")) or known is None:
        return _entry(request, 403, said(lang_of(request), "account.wrong"), name)
    site.patience.succeeded(who)
    return await _begun(request, known[0], request.query_params.get("to", "/"))


async def sign_out(request: Request) -> Response:
    """End the session."""
    await posted(request)
    await run_in_threadpool(_accounts(request).end, request.state.token)
    return to(SIGN_IN)


async def _invitation(request: Request) -> Invitation:
    key = request.query_params.get("key", "")
    found = await run_in_threadpool(_accounts(request).invited, key)
    if found is None:
        raise HTTPException(410)
    return found


def _invited(
    request: Request, invitation: Invitation, problem: str = "", name: str = ""
) -> Response:
    return page(
        request, "invited.html.j2", 400 if problem else 200, kept=dict(request.query_params),
        invitation=invitation, problem=problem and said(lang_of(request), f"account.{problem}"),
        name=name[:LONGEST_NAME],
    )  # fmt: skip


async def invited(request: Request) -> Response:
    """Where an invitation leads."""
    return _invited(request, await _invitation(request))


async def join(request: Request) -> Response:
    """Choose a name and a password, or a new password."""
    form = await posted(request)
    invitation = await _invitation(request)
    typed, key = one(form, "name"), request.query_params["key"]
    problem, name = _wrong_password(form), as_name(typed)
    if invitation.learner is None and name is None:
        problem = "no_name"
    if problem:
        return _invited(request, invitation, problem, typed)
    kept, accounts = await hashed(one(form, "password")), _accounts(request)
    if invitation.learner is not None:
        learner = await run_in_threadpool(accounts.renew, key, kept)
    else:
        settings = {"lang": lang_of(request)}
        learner = await run_in_threadpool(accounts.join, key, str(name), kept, settings)
    if learner is None:
        return _invited(request, await _invitation(request), "taken", typed)
    return await _begun(request, learner, "/")


def _wrong_password(form: FormData) -> str:
    """What is wrong with a new password, typed twice."""
    if not acceptable(one(form, "password")):
        return "no_password"
    return "" if one(form, "password") == one(form, "again") else "not_again"


def _own(request: Request, status: int = 200, problem: str = "") -> Response:
    told = problem and said(lang_of(request), f"account.{problem}")
    changed = bool(request.query_params.get("changed"))
    return page(request, "account.html.j2", status, problem=told, changed=changed)


async def own(request: Request) -> Response:
    """One's own account."""
    return _own(request)


async def set_password(request: Request) -> Response:
    """Change one's own password, by the old one; other browsers have to sign in again."""
    form = await posted(request)
    site: Site = request.app.state.site
    learner = request.state.learner
    who, wait = _waiting(request, learner.name)
    if wait:
        raise HTTPException(429)
    known = await run_in_threadpool(_accounts(request).known, learner.name)
    if not known or not await fits(known[1], one(form, "old")):
        return _own(request, 403, "wrong_old")
    site.patience.succeeded(who)
    problem = _wrong_password(form)
    if problem:
        return _own(request, 400, problem)
    kept = await hashed(one(form, "password"))
    await run_in_threadpool(_accounts(request).set_password, learner.id, kept)
    return await _begun(request, learner.id, "/account?changed=1")


def _manager(request: Request) -> None:
    if not request.state.learner.manages:
        raise HTTPException(403)


def _people(request: Request, link: Link | None = None) -> Response:
    accounts = _accounts(request)
    return page(
        request, "people.html.j2", here="/people", link=link, people=accounts.people(),
        invitations=accounts.invitations(), now=time.time(),
    )  # fmt: skip


async def people(request: Request) -> Response:
    """Everybody, and who is invited."""
    _manager(request)
    return await run_in_threadpool(_people, request)


def _link(request: Request, learner: Person | None, *, manages: bool = False) -> Link:
    token = _accounts(request).invite(learner.id if learner else None, manages=manages)
    return Link(f"{request.base_url}{INVITED[1:]}?key={token}", learner)


async def invite(request: Request) -> Response:
    """Make a link that lets somebody in, once; it is shown, and nowhere kept."""
    form = await posted(request)
    _manager(request)
    manages = bool(one(form, "manages"))

    def made() -> Response:
        return _people(request, _link(request, None, manages=manages))

    return await run_in_threadpool(made)


async def withdraw(request: Request) -> Response:
    """Take an invitation back."""
    form = await posted(request)
    _manager(request)
    await run_in_threadpool(_accounts(request).withdraw, one(form, "invitation"))
    return to("/people")


async def _person(request: Request) -> Person:
    """Whom a page of those who manage is about."""
    _manager(request)
    name = request.path_params["person"]
    for found in await run_in_threadpool(_accounts(request).people):
        if str(found.id) == name:
            return found
    raise HTTPException(404)


def _about(request: Request, found: Person, status: int = 200, problem: str = "") -> Response:
    told = problem and said(lang_of(request), f"account.{problem}")
    here = f"/people/{found.id}"
    return page(request, "person.html.j2", status, here=here, person=found, problem=told)


async def person(request: Request) -> Response:
    """Somebody's account."""
    return _about(request, await _person(request))


async def rename(request: Request) -> Response:
    """Give somebody another name."""
    form = await posted(request)
    found = await _person(request)
    name = as_name(one(form, "name"))
    if name is None:
        return _about(request, found, 400, "no_name")
    if not await run_in_threadpool(_accounts(request).rename, found.id, name):
        return _about(request, found, 400, "taken")
    return to("/people")


async def renew(request: Request) -> Response:
    """Make a link with which somebody chooses a new password."""
    await posted(request)
    found = await _person(request)
    return await run_in_threadpool(lambda: _people(request, _link(request, found)))


async def remove(request: Request) -> Response:
    """Remove somebody else and all that they did, where that is meant."""
    form = await posted(request)
    found = await _person(request)
    if found.id == request.state.learner.id or not one(form, "sure"):
        return _about(request, found, 400, "not_sure")
    await run_in_threadpool(_accounts(request).remove, found.id)
    return to("/people")


ROUTES = [
    Route(SIGN_IN, entry),
    Route(SIGN_IN, sign_in, methods=["POST"]),
    Route("/sign-out", sign_out, methods=["POST"]),
    Route(INVITED, invited),
    Route(INVITED, join, methods=["POST"]),
    Route("/account", own),
    Route("/account", set_password, methods=["POST"]),
    Route("/people", people),
    Route("/people/invite", invite, methods=["POST"]),
    Route("/people/withdraw", withdraw, methods=["POST"]),
    Route("/people/{person}", person),
    Route("/people/{person}/name", rename, methods=["POST"]),
    Route("/people/{person}/password", renew, methods=["POST"]),
    Route("/people/{person}/remove", remove, methods=["POST"]),
]
