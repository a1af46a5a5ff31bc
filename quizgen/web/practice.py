"""Practising: choose, answer, hints, solution, a fresh variant."""

from __future__ import annotations

from typing import Any

from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Route

from quizgen.bank.levels import GUIDED
from quizgen.practice.choosing import fitting
from quizgen.practice.state import Wish
from quizgen.web.agenda import learning_of, today
from quizgen.web.echo import read_back
from quizgen.web.forms import every, one, posted
from quizgen.web.made import Made, Wanted
from quizgen.web.site import Site
from quizgen.web.store import Attempt, Which
from quizgen.web.turn import Place, Turn
from quizgen.web.views import lang_of, page, said, to

TIERS = tuple("ABCD")


async def home(request: Request) -> Response:
    """Where practice begins."""
    site: Site = request.app.state.site
    lang = lang_of(request)
    topics = [(name, site.bank.topic_title(name, lang)) for name in site.bank.topics]
    latest = await run_in_threadpool(site.store.latest, request.state.learner.id, 1)
    going_on = latest[0] if latest and latest[0].ended is None else None
    plan = await run_in_threadpool(today, request)
    return page(request, "home.html.j2", topics=topics, tiers=TIERS, going_on=going_on, plan=plan)


async def begin(request: Request) -> Response:
    """Choose a question and go to it."""
    form = await posted(request)
    wish = {name: one(form, name) for name in ("topic", "tier")}
    template = one(form, "template")
    site: Site = request.app.state.site
    if template in site.bank.paths:
        seed = await run_in_threadpool(learning_of(request).seed_of_next)
        return await _begun(request, Which(template, seed), wish)
    return await _asked(request, wish)


async def _asked(request: Request, wish: dict[str, str]) -> Response:
    """The question that fits a wish and is to be done next."""
    which = await _following(request, wish)
    if which is None:
        return page(request, "message.html.j2", 404, title="practice.title", text="practice.none")
    return await _begun(request, which, wish)


async def _following(request: Request, wish: dict[str, str]) -> Which | None:
    site: Site = request.app.state.site
    names = fitting(
        site.bank,
        Wish(lang_of(request), topic=wish.get("topic") or None, tier=wish.get("tier") or None),
    )
    return await run_in_threadpool(learning_of(request).following, names) if names else None


async def _begun(request: Request, which: Which, wish: dict[str, Any]) -> Response:
    site: Site = request.app.state.site
    attempt = await run_in_threadpool(site.store.begin, request.state.learner.id, which, wish)
    return to(f"/q/{attempt.id}")


async def _attempt(request: Request) -> Attempt:
    site: Site = request.app.state.site
    name = request.path_params["attempt"]
    found = await run_in_threadpool(site.store.attempt, request.state.learner.id, name)
    if found is None:
        raise HTTPException(404)
    return found


def _wanted(request: Request, which: Which) -> Wanted:
    return Wanted(which.template, which.seed, lang_of(request), level=which.level)


async def _made(request: Request, attempt: Attempt) -> Made:
    site: Site = request.app.state.site
    return await site.workers.question(_wanted(request, attempt.which))


async def _turn(request: Request) -> Turn:
    attempt = await _attempt(request)
    return Turn(await _made(request, attempt), attempt)


def _place(request: Request, turn: Turn) -> Place:
    place = turn.place(request.path_params["part"])
    if place is None:
        raise HTTPException(404)
    return place


async def question(request: Request) -> Response:
    """The question, as far as it has got."""
    turn = await _turn(request)
    shown = page(request, "question.html.j2", turn=turn, made=turn.made,
                 said_last=turn.place(request.query_params.get("said", "")))  # fmt: skip
    shown.background = BackgroundTask(_prepare, request, turn.attempt)
    return shown


async def _prepare(request: Request, attempt: Attempt) -> None:
    """Make what is likely asked next while this is read: another question, and other numbers."""
    site: Site = request.app.state.site
    following = await _following(request, attempt.wish) if site.workers.spare else None
    if following is not None:
        variant = Which(attempt.template, following.seed, attempt.level)
        for which in (following, variant):
            await site.workers.prepare(_wanted(request, which))


async def _kept(request: Request, turn: Turn, place: Place) -> Response:
    site: Site = request.app.state.site
    ended, seen = turn.attempt.ended, turn.keep()
    await run_in_threadpool(site.store.keep, turn.attempt, seen)
    if ended is None and turn.attempt.ended is not None:
        await run_in_threadpool(learning_of(request).finished, turn.attempt, turn.states)
    return to(f"/q/{turn.attempt.id}?said={place.name}#part-{place.name}")


async def answer(request: Request) -> Response:
    """Mark a part, or do what else its buttons say."""
    form = await posted(request)
    site: Site = request.app.state.site
    async with site.turn_of(request.path_params["attempt"]):
        turn = await _turn(request)
        place = _place(request, turn)
        _do(turn, place, one(form, "do"), every(form, "a"))
        return await _kept(request, turn, place)


def _do(turn: Turn, place: Place, action: str, values: list[str]) -> None:
    if action == "hint":
        place.task.hint()
        place.progress.values = values
    elif action in {"right", "wrong"} and place.to_judge:
        place.task.mark_yourself(right=action == "right")
    elif action == "solution" and not place.done:
        place.task.give_up()
        place.progress.values = values
    elif action in {"", "answer"}:
        turn.answer(place, values)


async def echo(request: Request) -> Response:
    """How what stands in the fields is read; never whether it is right."""
    form = await posted(request)
    made = await _made(request, await _attempt(request))
    name = request.path_params["part"]
    field = next((part.field for part in made.parts if part.field.id == name), None)
    if field is None:
        raise HTTPException(404)
    lang = lang_of(request)
    read = read_back(field, made.key, every(form, "a"), lang)
    return HTMLResponse(said(lang, "practice.read", value=read) if read else "")


async def variant(request: Request) -> Response:
    """The same question with other numbers."""
    await posted(request)
    attempt = await _attempt(request)
    seed = await run_in_threadpool(learning_of(request).seed_of_next)
    return await _begun(request, Which(attempt.template, seed, attempt.level), attempt.wish)


async def again(request: Request) -> Response:
    """The same question with the same numbers, from its beginning."""
    await posted(request)
    attempt = await _attempt(request)
    return await _begun(request, attempt.which, attempt.wish)


async def guided(request: Request) -> Response:
    """The same question step by step."""
    await posted(request)
    attempt = await _attempt(request)
    which = Which(attempt.template, attempt.seed, GUIDED)
    return await _begun(request, which, attempt.wish)


async def following(request: Request) -> Response:
    """The next question of the same wish."""
    await posted(request)
    attempt = await _attempt(request)
    return await _asked(request, attempt.wish)


ROUTES = [
    Route("/", home),
    Route("/practice", begin, methods=["POST"]),
    Route("/q/{attempt}", question),
    Route("/q/{attempt}/again", again, methods=["POST"]),
    Route("/q/{attempt}/variant", variant, methods=["POST"]),
    Route("/q/{attempt}/guided", guided, methods=["POST"]),
    Route("/q/{attempt}/next", following, methods=["POST"]),
    Route("/q/{attempt}/{part}", answer, methods=["POST"]),
    Route("/q/{attempt}/{part}/read", echo, methods=["POST"]),
]
