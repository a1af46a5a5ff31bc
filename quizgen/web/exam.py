"""Sitting an exam: autosave, a clock, handing in, marks with the worked solutions beside them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Route

from quizgen.core.decoding import decode_json
from quizgen.core.errors import BlueprintError, PaperCodeError, QuizgenError
from quizgen.grading.options import DECIMALS
from quizgen.paper.blueprint import EVERYTHING, TRIAL, find_blueprint
from quizgen.paper.code import parse_code
from quizgen.paper.quota import draw_first_seed
from quizgen.practice.input_fields import is_complete
from quizgen.store import ExamRecord
from quizgen.store.exam_attempts import GRACE, ExamStore
from quizgen.web.exam_results import (
    ExamResults,
    grade_exam,
    outcome_records,
    plan_seconds,
    review_events,
)
from quizgen.web.forms import (
    field_text,
    field_texts,
    read_answer,
    read_form,
    read_ticked_criteria,
)
from quizgen.web.live_preview import preview_lines, preview_reading
from quizgen.web.papers import MakePaper
from quizgen.web.question_attempt import share_of_part
from quizgen.web.question_view import PaperView, PartView, QuestionView
from quizgen.web.state import ServerState
from quizgen.web.tonight import progress_of
from quizgen.web.views import (
    page_response,
    redirect,
    relative_time,
    request_language,
    translate_page,
)

FIELDS = "a-"
"""Before the name of a part in a form."""
SHOWN = "on-"
"""Before the name of a part in a form: what its fields held when the page was made."""
SPENT = "spent-"
"""Before the number of a question in a form: seconds on the screen since the last time."""
QUESTION = re.compile(r"[0-9]{1,4}")
SECONDS = re.compile(r"[0-9]{1,6}(?:\.[0-9]{1,3})?")
PART = re.compile(r"[0-9]{1,4}[a-z]{0,4}[0-9]{0,2}")
"""Names of parts."""
MINUTES = (15, 30, 45, 60, 90)
"""Lengths of a paper of a topic."""
LONGEST_MINUTES = 300
"""Of a paper of a topic: a longer one occupies a process that others wait for."""


class GoneError(HTTPException):
    """HTTP 410: an exam without a stored paper, which cannot be built any more."""


@dataclass(frozen=True)
class ExamChoice:
    """A paper that a learner can choose."""

    name: str
    title: str
    pauses: bool | None
    """Whether it says itself that the clock may be stopped."""


async def list_exams(request: Request) -> Response:
    """Return the page of exams to choose from and of those taken."""
    site: ServerState = request.app.state.site
    store = site.store.sittings
    sittings = await run_in_threadpool(store.latest, request.state.learner.id)
    problem, now = request.query_params.get("problem"), request.app.state.site.store.clock.now()
    return page_response(
        request,
        "exams.html.j2",
        choices=_list_exam_choices(request),
        lengths=MINUTES,
        sat=[(one, _find_exam_title(request, one)) for one in sittings],
        when=relative_time(now, request_language(request)),
        now=now,
        problem=problem,
        code=request.query_params.get("code", ""),
    )


def _list_exam_choices(request: Request) -> list[ExamChoice]:
    """Return the bank's blueprints, the trial exam first, then its topics."""
    bank = request.app.state.site.bank
    blueprints = sorted(bank.blueprints, key=lambda name: name != TRIAL)
    names = (*blueprints, EVERYTHING, *bank.topics)
    return [found for name in names if (found := _find_exam_choice(request, name)) is not None]


def _find_exam_choice(request: Request, name: str) -> ExamChoice | None:
    """Return the choice of a blueprint's name; None if there is none."""
    plan = find_blueprint(name, request.app.state.site.bank)
    if plan is None:
        return None
    return ExamChoice(
        name, plan.title.get(request_language(request)) or plan.title["en"], plan.pauses
    )


def _find_exam_title(request: Request, sitting: ExamRecord) -> str:
    """Return the title of an exam; its code if its blueprint or language is gone."""
    try:
        found = _find_exam_choice(request, parse_code(sitting.code).blueprint)
    except PaperCodeError:
        found = None
    return found.title if found else sitting.code


async def start_exam(request: Request) -> Response:
    """Make a paper and begin it."""
    form = await read_form(request)
    site: ServerState = request.app.state.site
    learner = request.state.learner.id
    try:
        wanted = _parse_wanted_paper(request, form)
        site.spend_quota("exam", learner)
        sitting = await _begin_from_stock(site, learner, wanted, form)
        if sitting is not None:
            return redirect(f"/exam/{sitting.id}")
        paper = await site.papers.make(wanted, learner)
    except QuizgenError as error:
        problem = "code" if isinstance(error, PaperCodeError) else "paper"
        return redirect(f"/exam?problem={problem}")
    limit = paper.minutes * 60.0 if field_text(form, "clock") else None
    pauses = bool(field_text(form, "pauses")) if paper.pauses is None else paper.pauses
    sitting = await run_in_threadpool(
        site.store.sittings.begin,
        learner,
        paper.code,
        limit,
        pauses=pauses,
        paper=paper,
        practice=bool(field_text(form, "practice")),
        decimal=progress_of(request).decimal,
    )
    if sitting is None:
        return redirect(f"/exam?{urlencode({'problem': 'shown', 'code': paper.code})}")
    return redirect(f"/exam/{sitting.id}")


async def _begin_from_stock(
    site: ServerState, learner: int, wanted: MakePaper, form: FormData
) -> ExamRecord | None:
    """Return an exam with a paper made ahead; a code asks for its own paper, so None."""
    if wanted.code:
        return None
    return await site.papers_ahead.begin_exam(
        learner, wanted.blueprint,
        has_clock=bool(field_text(form, "clock")), pauses=bool(field_text(form, "pauses")),
    )  # fmt: skip


def _parse_wanted_paper(request: Request, form: FormData) -> MakePaper:
    """Return which paper a form asks for, by code or by blueprint and minutes."""
    code = field_text(form, "code").strip()
    if code:
        parsed = parse_code(code)
        _refuse_long(parsed.blueprint)
        return MakePaper(str(parsed))
    name, minutes = field_text(form, "blueprint"), field_text(form, "minutes")
    site: ServerState = request.app.state.site
    if minutes.isdecimal() and name not in site.bank.blueprints:
        name = f"{name}.{int(minutes[:4])}"
    _refuse_long(name)
    return MakePaper(blueprint=name, seed=draw_first_seed())


def _refuse_long(name: str) -> None:
    """Reject a paper of more than ``LONGEST_MINUTES``: building it would block a worker.

    Raises
    ------
    BlueprintError
        If a topic is to be asked for longer than ``LONGEST_MINUTES``.
    """
    minutes = name.rpartition(".")[2]
    if minutes.isdecimal() and (len(minutes) > 3 or int(minutes) > LONGEST_MINUTES):
        raise BlueprintError(f"{name[:80]}: more than {LONGEST_MINUTES} minutes")


async def _get_sitting(request: Request) -> ExamRecord:
    """Return the learner's exam that the address names; HTTP 404 if there is none."""
    site: ServerState = request.app.state.site
    name = request.path_params["sitting"]
    found = await run_in_threadpool(site.store.sittings.find, request.state.learner.id, name)
    if found is None:
        raise HTTPException(404)
    return found


async def _make_paper(request: Request, sitting: ExamRecord) -> PaperView:
    """Return the paper of an exam in the learner's language; ``GoneError`` if it is gone."""
    site: ServerState = request.app.state.site
    try:
        return await site.papers.of(sitting, request_language(request))
    except QuizgenError as error:
        raise GoneError(410) from error


async def show_exam(request: Request) -> Response:
    """Return the paper, or the results once it is submitted or its time is over."""
    sitting = await _get_sitting(request)
    if sitting.handed is None and sitting.is_over(request.app.state.site.store.clock.now()):
        await _hand_in(request, sitting)
        sitting = await _get_sitting(request)
    paper, now = await _make_paper(request, sitting), request.app.state.site.store.clock.now()
    store = request.app.state.site.store.sittings
    answers = await run_in_threadpool(store.answers, sitting)
    if sitting.handed is not None and request.app.state.site.room:
        return redirect("/seat")
    if sitting.handed is not None:
        results = await _count(request, sitting, paper, answers)
        learning = progress_of(request)
        repairs = await run_in_threadpool(learning.list_repairs, sitting.id)
        bank = learning.bank
        minutes = {name: max(1, round(bank.minutes(name))) for name in repairs}
        return page_response(
            request, "results.html.j2", sitting=sitting, paper=paper, results=results,
            repairs=minutes, planned=plan_seconds(paper, learning.bank),
        )  # fmt: skip
    flags = await run_in_threadpool(store.flags, sitting)
    return page_response(request, "exam.html.j2", sitting=sitting, paper=paper, answers=answers,
                flags=flags, now=now)  # fmt: skip


def _read_changed_fields(form: FormData) -> dict[str, list[str]]:
    """Return the fields of each part that was changed on this page.

    Parts that were not on the form are left as they are, and so are those that still hold what the
    page was made with: another page of the same exam may have changed them since. The store knows
    which parts the paper has, so that nobody waits until it is read.
    """
    names = {name.removeprefix(SHOWN) for name, _ in form.multi_items() if name.startswith(SHOWN)}
    return {
        name: values
        for name in names
        if PART.fullmatch(name)
        for values in [read_answer(form, FIELDS + name)]
        if any(
            _normalise_fields(values) != shown
            for shown in map(_decode_shown_fields, field_texts(form, SHOWN + name))
        )
    }


def _decode_shown_fields(sent: str) -> list[str] | None:
    """Return the fields that a part had when its page was rendered.

    None where a script sends only what was changed.
    """
    try:
        return _normalise_fields(decode_json(sent, list[str]))
    except msgspec.DecodeError:
        return None


def _read_times(form: FormData) -> dict[str, float]:
    """Return the seconds that were spent on each question; what is no time is left out."""
    times = {
        name.removeprefix(SPENT): str(value)
        for name, value in form.multi_items()
        if name.startswith(SPENT)
    }
    return {
        number: float(seconds)
        for number, seconds in times.items()
        if QUESTION.fullmatch(number) and SECONDS.fullmatch(seconds)
    }


def _normalise_fields(values: list[str]) -> list[str]:
    """Return fields in the form they are compared in.

    Browsers end lines in their own way, and fields that are all blank equal none.
    """
    return [value.replace("\r\n", "\n") for value in values] if any(values) else []


async def save_answers(request: Request) -> Response:
    """Store the answers of a page; a script gets the time, a form a redirect to the paper."""
    form = await read_form(request)
    site: ServerState = request.app.state.site
    store: ExamStore = site.store.sittings
    learner, name = request.state.learner.id, request.path_params["sitting"]
    sitting, kept = await run_in_threadpool(
        store.save, learner, name, _read_changed_fields(form), _read_times(form)
    )
    if sitting is None:
        raise HTTPException(404)
    over = sitting.resting is not None or sitting.is_over(site.store.clock.now() - GRACE)
    if not kept and not over:  # a part that the paper has not: nothing of it is handed in
        raise HTTPException(400)
    if field_text(form, "do") == "end":
        return redirect(f"/exam/{sitting.id}/hand-in")
    if field_text(form, "do") == "hand-in":
        await _hand_in(request, sitting)
    elif field_text(form, "do") in {"rest", "go-on"}:
        await run_in_threadpool(store.set_pause, sitting, on=field_text(form, "do") == "rest")
    elif field_text(form, "do") in DECIMALS:
        await run_in_threadpool(_declare_decimal, request, sitting, field_text(form, "do"))
    elif request.headers.get("accept", "").startswith("application/json"):
        return JSONResponse({"kept": kept, "at": site.store.clock.now()}, 200 if kept else 409)
    return redirect(f"/exam/{sitting.id}")


def _declare_decimal(request: Request, sitting: ExamRecord, decimal: str) -> None:
    """Read the answers of an exam by a decimal sign, and remember it for what comes next."""
    store = request.app.state.site.store
    store.sittings.declare_decimal(sitting, decimal)
    store.update_settings(sitting.learner, {"decimal": decimal})


async def submit_exam(request: Request) -> Response:
    """Return the page that asks before submitting, with unanswered and flagged questions."""
    sitting = await _get_sitting(request)
    if sitting.resting is not None or sitting.is_over(request.app.state.site.store.clock.now()):
        return redirect(f"/exam/{sitting.id}")
    paper = await _make_paper(request, sitting)
    store = request.app.state.site.store.sittings
    answers = await run_in_threadpool(store.answers, sitting)
    flags = await run_in_threadpool(store.flags, sitting)
    now = request.app.state.site.store.clock.now()
    return page_response(request, "hand_in.html.j2", sitting=sitting, paper=paper, now=now,
                blank=_list_unfinished_questions(paper, answers),
                unread=await _list_unread_parts(request, sitting, paper, answers),
                flagged=[one for one in paper.items if one.wanted.number in flags])  # fmt: skip


def _list_unfinished_questions(
    paper: PaperView, answers: Mapping[str, list[str]]
) -> list[tuple[QuestionView, list[PartView]]]:
    """Return the questions with parts of which a field is empty."""
    found = [
        (item, [part for part in item.parts if not _is_answered(part, answers)])
        for item in paper.items
    ]
    return [(item, parts) for item, parts in found if parts]


async def _list_unread_parts(
    request: Request, sitting: ExamRecord, paper: PaperView, answers: Mapping[str, list[str]]
) -> list[tuple[QuestionView, PartView]]:
    """Return the parts whose answer cannot be read as one; they would get no points."""
    site: ServerState = request.app.state.site
    results = await grade_exam(
        site.workers, paper, answers, {}, request.state.learner.id, sitting.decimal
    )
    return [
        (question.made, one.part)
        for question in results.questions
        for one in question.parts
        if one.result.status in {"unreadable", "ambiguous"} and _is_answered(one.part, answers)
    ]


def _is_answered(part: PartView, answers: Mapping[str, list[str]]) -> bool:
    """Return whether every field of a part is filled."""
    field = part.field
    return is_complete(field.control, answers.get(field.id, ()), field.marks)


async def _hand_in(request: Request, sitting: ExamRecord) -> None:
    """Submit the exam for good.

    It is graded later, so that no submission waits for another's grading.
    """
    store = request.app.state.site.store.sittings
    await run_in_threadpool(store.hand_in, sitting)


async def _count(
    request: Request, sitting: ExamRecord, paper: PaperView, answers: Mapping[str, list[str]]
) -> ExamResults:
    """Return the results; the first time, they are added to the learner's progress."""
    site: ServerState = request.app.state.site
    results = await grade_exam(
        site.workers, paper, answers, sitting.marks, sitting.learner, sitting.decimal
    )
    if not sitting.counted:
        first = await run_in_threadpool(
            site.store.sittings.count, sitting, outcome_records(results, sitting.id)
        )
        if first:
            learning = progress_of(request)
            await run_in_threadpool(learning.apply_reviews, review_events(learning.bank, results))
    return results


async def toggle_flag(request: Request) -> Response:
    """Flag a question to come back to, or remove the flag."""
    await read_form(request)
    sitting = await _get_sitting(request)
    paper = await _make_paper(request, sitting)
    number = request.path_params["number"]
    if number not in {item.wanted.number for item in paper.items}:
        raise HTTPException(404)
    await run_in_threadpool(request.app.state.site.store.sittings.flag, sitting, number)
    return redirect(f"/exam/{sitting.id}#question-{number}")


def _get_part(paper: PaperView, name: str) -> tuple[PartView, int]:
    """Return a part of a paper and the index of its question; HTTP 404 if there is none."""
    for place, item in enumerate(paper.items):
        for part in item.parts:
            if part.field.id == name:
                return part, place
    raise HTTPException(404)


async def preview_exam_answer(request: Request) -> Response:
    """Return how the typed answer is read, typeset; never whether it is right."""
    form = await read_form(request)
    sitting = await _get_sitting(request)
    paper = await _make_paper(request, sitting)
    part, place = _get_part(paper, request.path_params["part"])
    values = read_answer(form, FIELDS + part.field.id)
    lang = request_language(request)
    key = paper.items[place].key
    if lines := preview_lines(part.field, key, values, lang, sitting.decimal, judged=False):
        return page_response(request, "lines_so_far.html.j2", lines=lines)
    read = preview_reading(part.field, key, values, lang, sitting.decimal)
    return HTMLResponse(translate_page(lang, "practice.read", value=read) if read else "")


async def save_self_mark(request: Request) -> Response:
    """Store the share of marks that a learner gives to a sentence, by its criteria."""
    form = await read_form(request)
    sitting = await _get_sitting(request)
    part, _ = _get_part(await _make_paper(request, sitting), request.path_params["part"])
    shares = {"all": 1.0, "half": 0.5, "none": 0.0}
    marks = read_ticked_criteria(form, part.field.id)
    share = (
        float(share_of_part(part, marks)) if part.scheme else shares.get(field_text(form, "share"))
    )
    if share is None or sitting.handed is None:
        raise HTTPException(400)
    store = request.app.state.site.store.sittings
    ticked = {name: float(of) for name, of in marks.items() if name in part.criteria}
    await run_in_threadpool(store.save_self_mark, sitting, part.field.id, share, ticked)
    return redirect(f"/exam/{sitting.id}#part-{part.field.id}")


SITTING_ROUTES = [
    Route("/exam/{sitting}", show_exam),
    Route("/exam/{sitting}", save_answers, methods=["POST"]),
    Route("/exam/{sitting}/hand-in", submit_exam),
    Route("/exam/{sitting}/flag/{number}", toggle_flag, methods=["POST"]),
    Route("/exam/{sitting}/read/{part}", preview_exam_answer, methods=["POST"]),
]
"""While an exam is sat, whoever set it."""
ROUTES = [
    Route("/exam", list_exams),
    Route("/exam", start_exam, methods=["POST"]),
    *SITTING_ROUTES,
    Route("/exam/{sitting}/judge/{part}", save_self_mark, methods=["POST"]),
]
