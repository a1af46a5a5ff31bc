"""Practising: choose, answer, hints, solution, a fresh variant."""

from __future__ import annotations

import time
from dataclasses import dataclass
from datetime import timedelta
from typing import Any

from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Route

from quizgen.bank.formulas import templates_by_formula
from quizgen.bank.levels import GUIDED
from quizgen.practice.scheduler import local_date
from quizgen.practice.selection import matching_templates
from quizgen.practice.session_state import PracticeRequest
from quizgen.store import AttemptRecord, QuestionRef
from quizgen.web.block import begin_block, find_block
from quizgen.web.forms import field_text, read_answer, read_form, read_ticked_criteria
from quizgen.web.live_preview import preview_lines, preview_reading
from quizgen.web.question_attempt import AttemptInBrowser, AttemptPart
from quizgen.web.question_view import MarkedFigureJob, QuestionRequest, QuestionView
from quizgen.web.questions import list_places
from quizgen.web.state import ServerState
from quizgen.web.tonight import MINUTES, count_days, look_at_tonight, progress_of
from quizgen.web.views import page_response, redirect, request_language, translate_page

MOST_DAYS = 400
"""Days ahead in which an exam may be."""
PLACED = "a-"
"""Before the name of a part whose field stands inside a text."""


@dataclass(frozen=True)
class WeakAttempt:
    """A question of a block that did not go well.

    Parameters
    ----------
    attempt, title : str
    message : str
        The mistake in words, if it has a name.
    minutes : int
    """

    attempt: str
    title: str
    message: str
    minutes: int


async def show_practice(request: Request) -> Response:
    """Return the start page: where one stands, what to do now, and topics to choose from."""
    site: ServerState = request.app.state.site
    latest = await run_in_threadpool(site.store.latest, request.state.learner.id, 1)
    going_on = latest[0] if latest and latest[0].ended is None else None
    tonight = await run_in_threadpool(look_at_tonight, request)
    return page_response(
        request, "home.html.j2", going_on=going_on, tonight=tonight, lengths=MINUTES,
        days_in_a_row=await run_in_threadpool(count_days, request), phone=site.settings.phone,
    )  # fmt: skip


async def start_evening(request: Request) -> Response:
    """Store when the exam is and how long there is now, and start the first block."""
    form = await read_form(request)
    days, minutes = field_text(form, "days"), field_text(form, "minutes")
    chosen = {"minutes": minutes} if minutes in map(str, MINUTES) else {}
    if days.isdecimal() and int(days) <= MOST_DAYS:
        chosen["exam"] = str(local_date(time.time()) + timedelta(days=int(days)))
    site: ServerState = request.app.state.site
    await run_in_threadpool(site.store.update_settings, request.state.learner.id, chosen)
    request.state.learner.settings.update(chosen)
    return await _open_next_question(request, await run_in_threadpool(_plan_block, request))


def _plan_block(request: Request) -> dict[str, Any]:
    """Return the wish of a block of questions that fills the learner's minutes."""
    tonight = look_at_tonight(request)
    return begin_block(tonight.count, tonight.expected_points) if tonight else {}


async def show_block_end(request: Request) -> Response:
    """Return the page at the end of a block: what it brought, and its mistakes to try again."""
    attempt = await _get_attempt(request)
    store, learner = progress_of(request).store, request.state.learner.id
    block = await run_in_threadpool(find_block, store, learner, attempt.wish)
    tonight = await run_in_threadpool(look_at_tonight, request)
    if block is None or tonight is None:
        return redirect("/")
    weak = [await _describe_weak_attempt(request, one) for one in block.weak_attempts()]
    mended = block.count_mended(await run_in_threadpool(store.list_outcomes, learner))
    return page_response(
        request, "block.html.j2", block=block, tonight=tonight, weak=weak, mended=mended
    )


async def _describe_weak_attempt(request: Request, attempt: AttemptRecord) -> WeakAttempt:
    """Return the title of a question that did not go well, and its first named mistake."""
    decimal = progress_of(request).decimal
    site: ServerState = request.app.state.site
    made = await _make_question(request, attempt)
    question = AttemptInBrowser(made, attempt, decimal)
    wrong = [place.task.explain_wrong() for place in question.places if not place.is_right]
    minutes = max(1, round(site.bank.minutes(attempt.template)))
    return WeakAttempt(attempt.id, made.title, next(filter(None, wrong), ""), minutes)


async def set_minutes(request: Request) -> Response:
    """Store how many minutes the learner has now."""
    minutes = field_text(await read_form(request), "minutes")
    site: ServerState = request.app.state.site
    if minutes in map(str, MINUTES):
        await run_in_threadpool(
            site.store.update_settings, request.state.learner.id, {"minutes": minutes}
        )
    return redirect("/")


async def start_question(request: Request) -> Response:
    """Choose a question by topic, template or an exam to repair, and redirect to it."""
    form = await read_form(request)
    named = {name: field_text(form, name) for name in ("topic", "section", "formula", "repair")}
    wish: dict[str, Any] = {name: value for name, value in named.items() if value}
    template = field_text(form, "template")
    site: ServerState = request.app.state.site
    if template in site.bank.template_paths:
        seed = await run_in_threadpool(progress_of(request).seed_of_next)
        return await _begin_attempt(request, QuestionRef(template, seed), wish)
    if not wish:
        wish = await run_in_threadpool(_plan_block, request)
    elif "repair" in wish:
        repairs = await run_in_threadpool(progress_of(request).list_repairs, wish["repair"])
        wish |= begin_block(max(1, len(repairs)), None)
    return await _open_next_question(request, wish)


async def _open_next_question(request: Request, wish: dict[str, Any]) -> Response:
    """Start the next question for a request; return a page if none fits."""
    which = await _find_next_question(request, wish)
    if which is None:
        return page_response(
            request, "message.html.j2", 404, title="practice.title", text="practice.none"
        )
    return await _begin_attempt(request, which, wish)


async def _find_next_question(request: Request, wish: dict[str, Any]) -> QuestionRef | None:
    """Return the next question for a request; None if none fits."""
    site: ServerState = request.app.state.site
    names = matching_templates(
        site.bank,
        PracticeRequest(
            request_language(request),
            topic=wish.get("topic") or None,
        ),
    )
    if wish.get("section"):
        names = tuple(n for n in names if site.bank.notes_section(n) == wish["section"])
    if wish.get("formula"):
        about = templates_by_formula(site.bank).get(wish["formula"], ())
        names = tuple(name for name in names if name in about)
    learning, sitting = progress_of(request), wish.get("repair")
    if names and sitting:
        repairs = await run_in_threadpool(learning.list_repairs, sitting)
        names = tuple(name for name in repairs if name in names)[:1] or names
    return await run_in_threadpool(learning.next_question, names) if names else None


async def _begin_attempt(request: Request, which: QuestionRef, wish: dict[str, Any]) -> Response:
    """Store a new attempt at a question and redirect to it."""
    site: ServerState = request.app.state.site
    site.spend_quota("practice", request.state.learner.id)
    attempt = await run_in_threadpool(
        site.store.start_attempt, request.state.learner.id, which, wish
    )
    return redirect(f"/q/{attempt.id}")


async def _get_attempt(request: Request) -> AttemptRecord:
    """Return the learner's attempt that the address names; HTTP 404 if there is none."""
    site: ServerState = request.app.state.site
    name = request.path_params["attempt"]
    found = await run_in_threadpool(site.store.attempt, request.state.learner.id, name)
    if found is None:
        raise HTTPException(404)
    return found


def _build_question_request(request: Request, which: QuestionRef) -> QuestionRequest:
    """Return the request for a question in the learner's language."""
    return QuestionRequest(which.template, which.seed, request_language(request), level=which.level)


async def _make_question(request: Request, attempt: AttemptRecord) -> QuestionView:
    """Return the rendered question of an attempt."""
    site: ServerState = request.app.state.site
    wanted = _build_question_request(request, attempt.which)
    return await site.workers.get_question(wanted, request.state.learner.id)


async def _get_question_attempt(request: Request) -> AttemptInBrowser:
    """Return the attempt with its rendered question and progress."""
    attempt = await _get_attempt(request)
    return AttemptInBrowser(
        await _make_question(request, attempt), attempt, progress_of(request).decimal
    )


def _get_part_attempt(request: Request, question: AttemptInBrowser) -> AttemptPart:
    """Return the part that the address names; HTTP 404 if there is none."""
    part = question.find_part(request.path_params["part"])
    if part is None:
        raise HTTPException(404)
    return part


async def show_question(request: Request) -> Response:
    """Return the page of a question with the learner's progress in it."""
    site: ServerState = request.app.state.site
    question = await _get_question_attempt(request)
    said = question.find_part(request.query_params.get("said", ""))
    group = question.choose_group(said.name if said else request.query_params.get("part", ""))
    block = await run_in_threadpool(
        find_block, progress_of(request).store, request.state.learner.id, question.attempt.wish
    )
    shown = page_response(
        request,
        "question.html.j2",
        turn=question,
        made=question.made,
        group=group,
        figure=await _choose_figure(request, question, group),
        block=block,
        place=(await run_in_threadpool(list_places, site.bank))[question.attempt.template],
        section=site.bank.notes_section(question.attempt.template),
        said_last=group if said else [],
    )
    shown.background = BackgroundTask(_prepare_likely_next, request, question.attempt)
    return shown


async def _choose_figure(
    request: Request, question: AttemptInBrowser, group: list[AttemptPart]
) -> str:
    """Return the figure to show as SVG.

    It is the one with the solution once every part has ended; a wrong value of the part that was
    answered is drawn into it, where the figure can show such a value.
    """
    made, site = question.made, request.app.state.site
    plain = made.solved_figure or made.figure if question.is_finished else made.figure
    own = {name: one for place in group for name, one in place.task.own_values().items()}
    if not plain or not own:
        return plain
    job = MarkedFigureJob(made.wanted, tuple(own.items()), quiz=not question.is_finished)
    marked: bytes = await site.workers.get_result(job, request.state.learner.id)
    return marked.decode() or plain


async def _prepare_likely_next(request: Request, attempt: AttemptRecord) -> None:
    """Prefetch what is likely requested next: another question, and other numbers."""
    site: ServerState = request.app.state.site
    following = await _find_next_question(request, attempt.wish) if site.workers.has_spare else None
    if following is not None:
        variant = QuestionRef(attempt.template, following.seed, attempt.level)
        for which in (following, variant):
            await site.workers.prefetch(_build_question_request(request, which))


async def _store_attempt(
    request: Request, question: AttemptInBrowser, part: AttemptPart
) -> Response:
    """Store the progress of an attempt; redirect to the part that was answered."""
    site: ServerState = request.app.state.site
    ended, seen = question.attempt.ended, question.save_state()
    await run_in_threadpool(site.store.save_attempt, question.attempt, seen)
    if ended is None and question.attempt.ended is not None:
        await run_in_threadpool(
            progress_of(request).finish_attempt, question.attempt, question.states
        )
    return redirect(f"/q/{question.attempt.id}?said={part.name}#part-{part.name}")


async def submit_answer(request: Request) -> Response:
    """Grade a part, or do what another button asks for; redirect to the question."""
    form = await read_form(request)
    site: ServerState = request.app.state.site
    async with site.attempt_lock(request.path_params["attempt"]):
        question = await _get_question_attempt(request)
        part = _get_part_attempt(request, question)
        chosen = field_text(form, "reading")
        if chosen:
            question, part = await _choose_reading(request, question, part, chosen)
            return await _store_attempt(request, question, part)
        group, (action, _, named) = question.find_group(part), field_text(form, "do").partition(":")
        for place in group:
            values, checks = _read_part(form, place.name), action in {"", "answer"}
            if action == "marks" and place.name == (named or part.name) and place.to_judge:
                place.give_marks(read_ticked_criteria(form, place.name))
                continue
            if len(group) > 1 and (place.is_finished or (checks and place.has_checked(values))):
                continue  # one button checks all: what has been checked costs no further try
            if checks or place.name == (named or part.name):
                _perform_action(question, place, action, values)
            else:
                place.progress.values = values
        return await _store_attempt(request, question, part)


async def _choose_reading(
    request: Request, question: AttemptInBrowser, part: AttemptPart, chosen: str
) -> tuple[AttemptInBrowser, AttemptPart]:
    """Grade the answer asked back by the reading of a number, and keep a sign declared by it.

    A page left open may name a reading that there no longer is: then nothing is graded.
    """
    number, _, name = chosen.partition(":")
    part = question.find_part(name) or part
    named = {str(index): one for index, one in enumerate(part.readings, 1)}
    if number not in named:
        return question, part
    reading, values = named[number], part.progress.values
    if reading.decimal:
        await run_in_threadpool(progress_of(request).save_decimal, reading.decimal)
        question = AttemptInBrowser(question.made, question.attempt, reading.decimal)
        part = question.find_part(part.name) or part
    question.answer(part, [reading.typed] if reading.typed else values)
    return question, part


def _read_part(form: FormData, name: str) -> list[str]:
    """Return what stands in the fields of a part: its own, or those inside a text."""
    return read_answer(form, f"{PLACED}{name}") or read_answer(form, "a")


def _perform_action(
    question: AttemptInBrowser, part: AttemptPart, action: str, values: list[str]
) -> None:
    """Apply a button to a part: hint, solution, skip, self-mark or answer."""
    if action == "hint":
        part.task.next_hint()
        part.progress.values = values
    elif action in {"right", "wrong"} and part.to_judge:
        part.task.self_mark(float(action == "right"))
    elif action == "solution" and not part.is_finished:
        part.task.give_up()
        part.progress.values = values
    elif action in {"", "answer"}:
        question.answer(part, values)


async def preview_practice_answer(request: Request) -> Response:
    """Return how the typed answer is read, typeset, and which lines of a derivation hold."""
    form = await read_form(request)
    made = await _make_question(request, await _get_attempt(request))
    name = request.path_params["part"]
    field = next((part.field for part in made.parts if part.field.id == name), None)
    if field is None:
        raise HTTPException(404)
    lang = request_language(request)
    decimal = progress_of(request).decimal
    values = _read_part(form, name)
    if lines := preview_lines(field, made.key, values, lang, decimal, judged=True):
        return page_response(request, "lines_so_far.html.j2", lines=lines)
    read = preview_reading(field, made.key, values, lang, decimal)
    return HTMLResponse(translate_page(lang, "practice.read", value=read) if read else "")


async def new_variant(request: Request) -> Response:
    """Start the same template with other numbers, and redirect to it."""
    await read_form(request)
    attempt = await _get_attempt(request)
    seed = await run_in_threadpool(progress_of(request).seed_of_next)
    return await _begin_attempt(
        request, QuestionRef(attempt.template, seed, attempt.level), attempt.wish
    )


async def repeat_question(request: Request) -> Response:
    """Start the same question from its beginning, and redirect to it."""
    await read_form(request)
    attempt = await _get_attempt(request)
    return await _begin_attempt(request, attempt.which, attempt.wish)


async def show_guided(request: Request) -> Response:
    """Start the same question step by step, and redirect to it."""
    await read_form(request)
    attempt = await _get_attempt(request)
    which = QuestionRef(attempt.template, attempt.seed, GUIDED)
    return await _begin_attempt(request, which, attempt.wish)


async def next_question(request: Request) -> Response:
    """Start the next question for the same request, and redirect to it."""
    await read_form(request)
    attempt = await _get_attempt(request)
    block = await run_in_threadpool(
        find_block, progress_of(request).store, request.state.learner.id, attempt.wish
    )
    if block is not None and block.is_over:
        return redirect(f"/block/{attempt.id}")
    return await _open_next_question(request, attempt.wish)


ROUTES = [
    Route("/", show_practice),
    Route("/start", start_evening, methods=["POST"]),
    Route("/tonight", set_minutes, methods=["POST"]),
    Route("/block/{attempt}", show_block_end),
    Route("/practice", start_question, methods=["POST"]),
    Route("/q/{attempt}", show_question),
    Route("/q/{attempt}/again", repeat_question, methods=["POST"]),
    Route("/q/{attempt}/variant", new_variant, methods=["POST"]),
    Route("/q/{attempt}/guided", show_guided, methods=["POST"]),
    Route("/q/{attempt}/next", next_question, methods=["POST"]),
    Route("/q/{attempt}/{part}", submit_answer, methods=["POST"]),
    Route("/q/{attempt}/{part}/read", preview_practice_answer, methods=["POST"]),
]
