"""What went wrong, as cards for Anki: of one exam, or of all that was practised and sat."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.folder import Bank
from quizgen.practice.state import PartState
from quizgen.shapes import converted
from quizgen.web.mistakes import Part, Practised, Sat, packed
from quizgen.web.site import Site
from quizgen.web.store import Attempt, Sitting
from quizgen.web.turn import Progress
from quizgen.web.views import lang_of, page

LOOKED_AT = 300
"""Questions that were practised, the latest ones."""
PRACTISED = 60
"""Of these, those that cards are made of."""
SAT = 5
"""Exams, the latest ones."""


@dataclass(frozen=True)
class MistakeCards:
    """Cards of what went wrong, the latest first."""

    lang: str
    sat: tuple[Sat, ...]
    practised: tuple[Practised, ...] = ()

    def run(self, bank: Bank) -> bytes:
        """Make them: a package for Anki, or nothing."""
        return packed(bank, self.lang, self.sat, self.practised)


async def of_exam(request: Request) -> Response:
    """Cards of an exam that was handed in."""
    site: Site = request.app.state.site
    store, learner = site.store.sittings, request.state.learner.id
    sitting = await run_in_threadpool(store.find, learner, request.path_params["sitting"])
    if sitting is None or sitting.handed is None:
        raise HTTPException(404)
    return await _cards(request, MistakeCards(lang_of(request), (_sat(site, sitting),)))


async def of_everything(request: Request) -> Response:
    """Cards of the latest that was practised and sat."""

    def collected() -> MistakeCards:
        site: Site = request.app.state.site
        learner = request.state.learner.id
        handed = [one for one in site.store.sittings.latest(learner) if one.handed is not None]
        sat = tuple(_sat(site, one) for one in handed[:SAT])
        latest = site.store.latest(learner, LOOKED_AT)
        return MistakeCards(lang_of(request), sat, tuple(_practised(latest))[:PRACTISED])

    return await _cards(request, await run_in_threadpool(collected))


def _sat(site: Site, sitting: Sitting) -> Sat:
    answers = site.store.sittings.answers(sitting)
    return Sat(sitting.code, tuple((part, tuple(fields)) for part, fields in answers.items()))


def _practised(attempts: Iterable[Attempt]) -> Iterator[Practised]:
    """Questions of which something was not right, each mistake once."""
    known: set[tuple[str, str, str]] = set()
    for attempt in attempts:
        kept = converted(attempt.state.get("parts", {}), dict[str, Progress])
        parts = tuple(_part(name, one.state) for name, one in kept.items())
        wrong = {
            (attempt.template, part.id, kept[part.id].state.note) for part in parts if part.wrong
        }
        if wrong - known:
            known |= wrong
            yield Practised(attempt.which, parts)


def _part(name: str, state: PartState) -> Part:
    """The wrong answer that was given, or the one at which it was given up."""
    outcome = state.outcome
    given_up = outcome is not None and not (outcome.right or outcome.skipped)
    return Part(name, state.wrong or state.typed, bool(state.wrong) or given_up)


async def _cards(request: Request, job: MistakeCards) -> Response:
    data = await request.app.state.site.workers.done(job)
    if not data:
        return page(request, "message.html.j2", 404, title="anki.title", text="anki.nothing")
    named = {"content-disposition": 'attachment; filename="quizgen-mistakes.apkg"'}
    return Response(data, media_type="application/octet-stream", headers=named)


ROUTES = [
    Route("/exam/{sitting}/mistakes.apkg", of_exam),
    Route("/progress/mistakes.apkg", of_everything),
]
