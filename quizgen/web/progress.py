"""How far somebody has got: by topic, by formula, by mistake; the day of the exam."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.formulas import read_formulas, templates_by_formula
from quizgen.bank.language_file import read_language_file
from quizgen.bank.markdown import fill_inlines
from quizgen.core.errors import StoreError
from quizgen.practice.agenda import Agenda, Mastery
from quizgen.practice.scheduler import NAMED, ReviewCard
from quizgen.question.entry_prose import entry_inlines, typeset_slot
from quizgen.question.html import inlines_to_html
from quizgen.store.archive import read_archive
from quizgen.typeset.leaves import LeafValue, fill_leaves, list_leaf_names
from quizgen.typeset.nodes import Phrase
from quizgen.typeset.prose import (
    Inline,
    InlineFormula,
    LaidOutFormula,
    PlainText,
    Unfilled,
    typeset_layout,
)
from quizgen.web.forms import field_text, read_form, read_upload
from quizgen.web.question_view import Html
from quizgen.web.state import ServerState
from quizgen.web.tonight import progress_of
from quizgen.web.views import (
    page_response,
    redirect,
    relative_time,
    request_language,
    translate_page,
)

SHOWN = 30
"""Mistakes on the page, those that are due first before others."""
BLANK = "…"
"""Stands in a sentence where a certain question would have its number."""


@dataclass(frozen=True)
class MasteryRow:
    """A topic or a formula, and how well it is known."""

    name: str
    title: Html
    standing: Mastery


@dataclass(frozen=True)
class MistakeRow:
    """A mistake in words, and the template in which it was made."""

    card: ReviewCard
    template: str
    title: str
    told: Html


async def show_progress(request: Request) -> Response:
    """Return the page of a learner's progress."""
    return await run_in_threadpool(_render_progress_page, request)


def _render_progress_page(request: Request, status: int = 200, problem: str = "") -> Response:
    """Return the page of progress; ``problem`` is the text of what went wrong."""
    learning, lang = progress_of(request), request_language(request)
    agenda = learning.agenda()
    came = request.query_params.get("came", "")[:9]
    return page_response(
        request,
        "progress.html.j2",
        status,
        exam=learning.exam or "",
        problem=problem,
        came=came if came.isdecimal() else "",
        topics=_build_topic_rows(agenda, lang),
        formulas=_build_formula_rows(agenda, lang),
        mistakes=[
            told
            for card in agenda.mistakes[:SHOWN]
            if (told := _describe_mistake(agenda, card, lang))
        ],
        when=relative_time(agenda.now, lang),
    )


def _build_topic_rows(agenda: Agenda, lang: str) -> list[MasteryRow]:
    """Return the mastery of each topic, in the bank's order."""
    bank = agenda.bank
    names: dict[str, list[str]] = {topic: [] for topic in bank.topics}
    for name in bank.template_paths:
        names[bank.rules(name).topic].append(name)
    return [
        MasteryRow(topic, bank.topic_title(topic, lang), agenda.mastery_of(found))
        for topic, found in names.items()
    ]


def _build_formula_rows(agenda: Agenda, lang: str) -> list[MasteryRow]:
    """Return the mastery of each formula that a template uses."""
    names = templates_by_formula(agenda.bank)
    return [
        MasteryRow(
            entry.id,
            inlines_to_html(entry_inlines(entry, "title", lang), lang),
            agenda.mastery_of(names[entry.id]),
        )
        for entry in read_formulas(agenda.bank)
        if names[entry.id]
    ]


def _describe_mistake(agenda: Agenda, card: ReviewCard, lang: str) -> MistakeRow | None:
    """Return a mistake in the words of its template; None if it has none any more."""
    bank, name = agenda.bank, agenda.names[card.template]
    found = (
        lang if lang in bank.template_languages(name) else next(iter(bank.template_languages(name)))
    )
    text = read_language_file(bank.template_paths[name] / f"{found}.md")
    trap = card.note.removeprefix(NAMED)
    cases = text.cases.get(("traps", trap))
    told = cases[-1][1] if cases else text.sentence("traps", trap)
    if told is None:
        return None
    words = inlines_to_html(fill_inlines(told, _replace_formula_by_blank, str), found)
    return MistakeRow(card, name, text.title, words)


def _replace_formula_by_blank(part: Unfilled) -> tuple[Inline, ...]:
    """Return a part of a sentence with a blank for a drawn value.

    A mistake is of any variant, so no numbers belong into its sentence.
    """
    if isinstance(part, LaidOutFormula):
        names = list_leaf_names(part.node)
        blanks = dict.fromkeys(names, LeafValue(Phrase(BLANK)))
        return (typeset_layout(fill_leaves(part.node, blanks)),)
    return typeset_slot(part) if isinstance(part, InlineFormula) else (PlainText(BLANK),)


async def set_exam(request: Request) -> Response:
    """Store the date of the exam; an empty field removes it."""
    form = await read_form(request)
    typed = field_text(form, "exam").strip()
    try:
        day = date.fromisoformat(typed).isoformat() if typed else ""
    except ValueError:
        problem = translate_page(request_language(request), "progress.no_date")
        return await run_in_threadpool(_render_progress_page, request, 400, problem)
    site: ServerState = request.app.state.site
    await run_in_threadpool(site.store.update_settings, request.state.learner.id, {"exam": day})
    return redirect("/")


async def download_archive(request: Request) -> Response:
    """Return all that a learner did, as a JSON file."""
    site: ServerState = request.app.state.site
    data = await run_in_threadpool(site.store.archives.write, request.state.learner.id)
    named = {"content-disposition": 'attachment; filename="quizgen-progress.json"'}
    return Response(data, media_type="application/json", headers=named)


async def upload_archive(request: Request) -> Response:
    """Import an archive into the learner's progress."""
    site: ServerState = request.app.state.site
    data = await read_upload(request, "file")
    site.spend_quota("import", request.state.learner.id)
    return await run_in_threadpool(_import_archive, request, data)


def _import_archive(request: Request, data: bytes) -> Response:
    """Import an archive and redirect; return the page with the problem if it is damaged."""
    site: ServerState = request.app.state.site
    try:
        archive = read_archive(data)
    except StoreError as error:
        reason = translate_page(request_language(request), "progress.no_file", reason=str(error))
        return _render_progress_page(request, 400, reason)
    count = site.store.archives.import_archive(request.state.learner.id, archive)
    return redirect(f"/progress?came={count}")


ROUTES = [
    Route("/progress/export", download_archive),
    Route("/progress/import", upload_archive, methods=["POST"]),
    Route("/progress", show_progress),
    Route("/progress/exam", set_exam, methods=["POST"]),
]
