"""How far somebody has got: by topic, by formula, by mistake; the day of the exam."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import date

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.formulas import asked_in, formulas
from quizgen.bank.pages import read_text
from quizgen.bank.prose import Formula, Inline, Unfilled, Words, fill
from quizgen.errors import StoreError
from quizgen.practice.agenda import Agenda, Standing
from quizgen.practice.schedule import NAMED, Card
from quizgen.question.authored import printed, sentence
from quizgen.question.markup import inline
from quizgen.web.agenda import learning_of, today
from quizgen.web.forms import one, posted, posted_file
from quizgen.web.made import Html
from quizgen.web.site import Site
from quizgen.web.store.archive import read_archive
from quizgen.web.views import lang_of, page, said, to, when

SHOWN = 30
"""Mistakes on the page, those that are due first before others."""
BLANK = "…"
"""Stands in a sentence where a certain question would have its number."""


@dataclass(frozen=True)
class Row:
    """A topic or a formula, and how far it is known."""

    name: str
    title: Html
    standing: Standing


@dataclass(frozen=True)
class Told:
    """A mistake in words, and the template in which it was made."""

    card: Card
    due: float
    template: str
    title: str
    told: Html


async def progress(request: Request) -> Response:
    """How far somebody has got."""
    return await run_in_threadpool(_shown, request)


def _shown(request: Request, status: int = 200, problem: str = "") -> Response:
    learning, lang = learning_of(request), lang_of(request)
    agenda = learning.agenda()
    came = request.query_params.get("came", "")[:9]
    return page(
        request, "progress.html.j2", status,
        plan=today(request),
        begun=bool(agenda.cards),
        exam=learning.exam or "",
        problem=problem,
        came=came if came.isdecimal() else "",
        topics=_topics(agenda, lang),
        formulas=_formulas(agenda, lang),
        mistakes=[told for card in agenda.mistakes[:SHOWN] if (told := _told(agenda, card, lang))],
        when=when(agenda.now, lang),
        lasting=_lasting(lang),
    )  # fmt: skip


def _topics(agenda: Agenda, lang: str) -> list[Row]:
    bank = agenda.bank
    names: dict[str, list[str]] = {topic: [] for topic in bank.topics}
    for name in bank.paths:
        names[bank.rules(name).topic].append(name)
    return [
        Row(topic, bank.topic_title(topic, lang), agenda.standing(found))
        for topic, found in names.items()
    ]


def _formulas(agenda: Agenda, lang: str) -> list[Row]:
    names = asked_in(agenda.bank)
    return [
        Row(
            entry.id, inline(sentence(entry, "title", lang), lang), agenda.standing(names[entry.id])
        )
        for entry in formulas(agenda.bank)
        if names[entry.id]
    ]


def _told(agenda: Agenda, card: Card, lang: str) -> Told | None:
    """A mistake in the words of its template; None if it has been taken out since."""
    bank, name = agenda.bank, agenda.names[card.template]
    found = lang if lang in bank.written_in(name) else next(iter(bank.written_in(name)))
    text = read_text(bank.paths[name] / f"{found}.md")
    trap = card.note.removeprefix(NAMED)
    cases = text.cases.get(("traps", trap))
    told = cases[-1][1] if cases else text.sentence("traps", trap)
    if told is None:
        return None
    words = inline(fill(told, _blanked, str), found)
    return Told(card, agenda.due(card), name, text.title, words)


def _blanked(part: Unfilled) -> tuple[Inline, ...]:
    return printed(part) if isinstance(part, Formula) else (Words(BLANK),)


def _lasting(lang: str) -> Callable[[float | None], str]:
    """Says in words for how many days something holds."""

    def lasting(days: float | None) -> str:
        if days is None:
            return ""
        whole = round(days)
        if whole < 1:
            return said(lang, "progress.below_day")
        return said(lang, "progress.one_day" if whole == 1 else "progress.days", count=whole)

    return lasting


async def set_exam(request: Request) -> Response:
    """Keep the day of the exam; an empty field takes it away."""
    form = await posted(request)
    typed = one(form, "exam").strip()
    try:
        day = date.fromisoformat(typed).isoformat() if typed else ""
    except ValueError:
        problem = said(lang_of(request), "progress.no_date")
        return await run_in_threadpool(_shown, request, 400, problem)
    site: Site = request.app.state.site
    await run_in_threadpool(site.store.settle, request.state.learner.id, {"exam": day})
    return to("/progress")


async def export(request: Request) -> Response:
    """Everything that somebody did, as a file."""
    site: Site = request.app.state.site
    data = await run_in_threadpool(site.store.archives.write, request.state.learner.id)
    named = {"content-disposition": 'attachment; filename="quizgen-progress.json"'}
    return Response(data, media_type="application/json", headers=named)


async def take_in(request: Request) -> Response:
    """Add what a file holds to what is there, all of it or nothing."""
    data = await posted_file(request, "file")
    return await run_in_threadpool(_taken_in, request, data)


def _taken_in(request: Request, data: bytes) -> Response:
    site: Site = request.app.state.site
    try:
        archive = read_archive(data)
    except StoreError as error:
        reason = said(lang_of(request), "progress.no_file", reason=str(error))
        return _shown(request, 400, reason)
    count = site.store.archives.take_in(request.state.learner.id, archive)
    return to(f"/progress?came={count}")


ROUTES = [
    Route("/progress/export", export),
    Route("/progress/import", take_in, methods=["POST"]),
    Route("/progress", progress),
    Route("/progress/exam", set_exam, methods=["POST"]),
]
