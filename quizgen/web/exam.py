"""Sitting an exam: autosave, a clock, handing in, marks with the worked solutions beside them."""

from __future__ import annotations

import re
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import FormData
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Route

from quizgen.errors import BlueprintError, CodeError, QuizgenError
from quizgen.paper.blueprint import EVERYTHING, named_blueprint
from quizgen.paper.code import LARGEST_SEED, parse_code
from quizgen.practice.boxes import filled
from quizgen.shapes import decoded
from quizgen.web.agenda import learning_of
from quizgen.web.echo import read_back
from quizgen.web.forms import every, one, posted
from quizgen.web.made import Made, MadePaper, MadePart, WantedPaper
from quizgen.web.results import asked, marked, outcomes
from quizgen.web.site import Site
from quizgen.web.store import Sitting
from quizgen.web.store.sittings import Sittings
from quizgen.web.views import lang_of, page, said, to, when

FIELDS = "a-"
"""Before the name of a part in a form."""
SHOWN = "on-"
"""Before the name of a part in a form: what its fields held when the page was made."""
PART = re.compile(r"[0-9]{1,4}[a-z]{0,4}[0-9]{0,2}")
"""Names of parts."""
MINUTES = (15, 30, 45, 60, 90)
"""Lengths of a paper of a topic."""
LONGEST_MINUTES = 300
"""Of a paper of a topic: a longer one occupies a process that others wait for."""


@dataclass(frozen=True)
class Choice:
    """A paper that can be chosen."""

    name: str
    title: str
    pauses: bool | None
    """Whether it says itself that the clock may be stopped."""


async def offer(request: Request) -> Response:
    """Which exams there are, and those that were sat."""
    site: Site = request.app.state.site
    store = site.store.sittings
    sittings = await run_in_threadpool(store.latest, request.state.learner.id)
    problem, now = request.query_params.get("problem"), time.time()
    return page(request, "exams.html.j2", choices=_choices(request), lengths=MINUTES,
                sat=[(one, _title(request, one)) for one in sittings],
                when=when(now, lang_of(request)), now=now, problem=problem)  # fmt: skip


def _choices(request: Request) -> list[Choice]:
    """The bank's blueprints, then its topics."""
    bank = request.app.state.site.bank
    names = (*bank.blueprints, EVERYTHING, *bank.topics)
    return [found for name in names if (found := _choice(request, name)) is not None]


def _choice(request: Request, name: str) -> Choice | None:
    plan = named_blueprint(name, request.app.state.site.bank)
    if plan is None:
        return None
    return Choice(name, plan.title.get(lang_of(request)) or plan.title["en"], plan.pauses)


def _title(request: Request, sitting: Sitting) -> str:
    """Title of a paper; its code, if its blueprint or its language is gone."""
    try:
        found = _choice(request, parse_code(sitting.code).blueprint)
    except CodeError:
        found = None
    return found.title if found else sitting.code


async def begin(request: Request) -> Response:
    """Make a paper and begin it."""
    form = await posted(request)
    site: Site = request.app.state.site
    try:
        paper = await site.workers.paper(_wanted(request, form))
    except QuizgenError as error:
        problem = "code" if isinstance(error, CodeError) else "paper"
        return to(f"/exam?problem={problem}")
    limit = paper.minutes * 60.0 if one(form, "clock") else None
    pauses = bool(one(form, "pauses")) if paper.pauses is None else paper.pauses
    sitting = await run_in_threadpool(
        site.store.sittings.begin,
        request.state.learner.id,
        paper.code,
        limit,
        pauses=pauses,
    )
    return to(f"/exam/{sitting.id}")


def _wanted(request: Request, form: FormData) -> WantedPaper:
    lang, code = lang_of(request), one(form, "code").strip()
    if code:
        parsed = parse_code(code)
        _refuse_long(parsed.blueprint)
        return WantedPaper(lang, code=str(parsed))
    name, minutes = one(form, "blueprint"), one(form, "minutes")
    site: Site = request.app.state.site
    if minutes.isdecimal() and name not in site.bank.blueprints:
        name = f"{name}.{int(minutes[:4])}"
    _refuse_long(name)
    return WantedPaper(lang, blueprint=name, seed=secrets.randbelow(LARGEST_SEED))


def _refuse_long(name: str) -> None:
    """Make nobody wait for a paper that nobody sits.

    Raises
    ------
    BlueprintError
        If a topic is to be asked for longer than ``LONGEST_MINUTES``.
    """
    minutes = name.rpartition(".")[2]
    if minutes.isdecimal() and (len(minutes) > 3 or int(minutes) > LONGEST_MINUTES):
        raise BlueprintError(f"{name[:80]}: more than {LONGEST_MINUTES} minutes")


async def _sitting(request: Request) -> Sitting:
    site: Site = request.app.state.site
    name = request.path_params["sitting"]
    found = await run_in_threadpool(site.store.sittings.find, request.state.learner.id, name)
    if found is None:
        raise HTTPException(404)
    return found


async def _paper(request: Request, sitting: Sitting) -> MadePaper:
    site: Site = request.app.state.site
    return await site.workers.paper(WantedPaper(lang_of(request), code=sitting.code))


async def sit(request: Request) -> Response:
    """The paper, or its results once it is handed in or its time is over."""
    sitting = await _sitting(request)
    if sitting.handed is None and sitting.over(time.time()):
        await _hand_in(request, sitting)
        sitting = await _sitting(request)
    paper, now = await _paper(request, sitting), time.time()
    store = request.app.state.site.store.sittings
    answers = await run_in_threadpool(store.answers, sitting)
    if sitting.handed is not None:
        results = marked(paper, answers, sitting.marks)
        return page(request, "results.html.j2", sitting=sitting, paper=paper, results=results)
    flags = await run_in_threadpool(store.flags, sitting)
    return page(request, "exam.html.j2", sitting=sitting, paper=paper, answers=answers,
                flags=flags, now=now)  # fmt: skip


def _fields(form: FormData) -> dict[str, list[str]]:
    """What was changed, by part.

    Parts that were not on the form are left as they are, and so are those that still hold what the
    page was made with: another page of the same exam may have changed them since. The paper is not
    asked which parts it has, so that nobody waits for it; what it lacks is never looked at.
    """
    names = {name.removeprefix(SHOWN) for name, _ in form.multi_items() if name.startswith(SHOWN)}
    return {
        name: values
        for name in names
        if PART.fullmatch(name)
        for values in [every(form, FIELDS + name)]
        if any(_plain(values) != shown for shown in map(_shown, every(form, SHOWN + name)))
    }


def _shown(sent: str) -> list[str] | None:
    """What a part held when the page was made; None where a script sends only what was changed."""
    try:
        return _plain(decoded(sent, list[str]))
    except msgspec.DecodeError:
        return None


def _plain(values: list[str]) -> list[str]:
    """Fields as they compare: browsers end lines in their own way, and none filled is none."""
    return [value.replace("\r\n", "\n") for value in values] if any(values) else []


async def save(request: Request) -> Response:
    """Keep what was typed; a script is told when, a form leads back to the paper."""
    form = await posted(request)
    store: Sittings = request.app.state.site.store.sittings
    learner, name = request.state.learner.id, request.path_params["sitting"]
    sitting, kept = await run_in_threadpool(store.save, learner, name, _fields(form))
    if sitting is None:
        raise HTTPException(404)
    if one(form, "do") == "end":
        return to(f"/exam/{sitting.id}/hand-in")
    if one(form, "do") == "hand-in":
        await _hand_in(request, sitting)
    elif one(form, "do") in {"rest", "go-on"}:
        await run_in_threadpool(store.rest, sitting, on=one(form, "do") == "rest")
    elif request.headers.get("accept", "").startswith("application/json"):
        return JSONResponse({"kept": kept, "at": time.time()}, 200 if kept else 409)
    return to(f"/exam/{sitting.id}")


async def end(request: Request) -> Response:
    """Ask before a paper is handed in, naming what is not answered and what was flagged."""
    sitting = await _sitting(request)
    if sitting.resting is not None or sitting.over(time.time()):
        return to(f"/exam/{sitting.id}")
    paper = await _paper(request, sitting)
    store = request.app.state.site.store.sittings
    answers = await run_in_threadpool(store.answers, sitting)
    flags = await run_in_threadpool(store.flags, sitting)
    return page(request, "hand_in.html.j2", sitting=sitting, paper=paper, now=time.time(),
                blank=_blank(paper, answers),
                flagged=[one for one in paper.items if one.wanted.number in flags])  # fmt: skip


def _blank(paper: MadePaper, answers: Mapping[str, list[str]]) -> list[tuple[Made, list[MadePart]]]:
    """Questions with the parts at which a field is empty."""
    found = [
        (item, [part for part in item.parts if not _answered(part, answers)])
        for item in paper.items
    ]
    return [(item, parts) for item, parts in found if parts]


def _answered(part: MadePart, answers: Mapping[str, list[str]]) -> bool:
    field = part.field
    return filled(field.control, answers.get(field.id, ()), field.marks)


async def _hand_in(request: Request, sitting: Sitting) -> None:
    store = request.app.state.site.store.sittings
    paper = await _paper(request, sitting)
    answers = await run_in_threadpool(store.answers, sitting)
    results = marked(paper, answers, {})
    if await run_in_threadpool(store.hand_in, sitting, outcomes(results)):
        learning = learning_of(request)
        await run_in_threadpool(learning.count, asked(learning.bank, results))


async def flag(request: Request) -> Response:
    """Mark a question to come back to, or take the mark away."""
    await posted(request)
    sitting = await _sitting(request)
    paper = await _paper(request, sitting)
    number = request.path_params["number"]
    if number not in {item.wanted.number for item in paper.items}:
        raise HTTPException(404)
    await run_in_threadpool(request.app.state.site.store.sittings.flag, sitting, number)
    return to(f"/exam/{sitting.id}#question-{number}")


def _part(paper: MadePaper, name: str) -> tuple[MadePart, int]:
    for place, item in enumerate(paper.items):
        for part in item.parts:
            if part.field.id == name:
                return part, place
    raise HTTPException(404)


async def echo(request: Request) -> Response:
    """How what stands in the fields is read; never whether it is right."""
    form = await posted(request)
    paper = await _paper(request, await _sitting(request))
    part, place = _part(paper, request.path_params["part"])
    values = every(form, FIELDS + part.field.id)
    lang = lang_of(request)
    read = read_back(part.field, paper.items[place].key, values, lang)
    return HTMLResponse(said(lang, "practice.read", value=read) if read else "")


async def judge(request: Request) -> Response:
    """Keep what a learner gives to a sentence, compared with the key points."""
    form = await posted(request)
    sitting = await _sitting(request)
    part, _ = _part(await _paper(request, sitting), request.path_params["part"])
    shares = {"all": 1.0, "half": 0.5, "none": 0.0}
    share = shares.get(one(form, "share"))
    if share is None or sitting.handed is None:
        raise HTTPException(400)
    store = request.app.state.site.store.sittings
    await run_in_threadpool(store.judge, sitting, part.field.id, share)
    return to(f"/exam/{sitting.id}#part-{part.field.id}")


ROUTES = [
    Route("/exam", offer),
    Route("/exam", begin, methods=["POST"]),
    Route("/exam/{sitting}", sit),
    Route("/exam/{sitting}", save, methods=["POST"]),
    Route("/exam/{sitting}/hand-in", end),
    Route("/exam/{sitting}/flag/{number}", flag, methods=["POST"]),
    Route("/exam/{sitting}/read/{part}", echo, methods=["POST"]),
    Route("/exam/{sitting}/judge/{part}", judge, methods=["POST"]),
]
