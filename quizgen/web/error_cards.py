"""What went wrong, as cards for Anki: of one exam, or of all that was practised and sat."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.core.decoding import convert
from quizgen.practice.session_state import PartState
from quizgen.store import AttemptRecord, ExamRecord
from quizgen.web.mistakes import FinishedExam, PracticedPart, PracticedQuestion, pack_error_cards
from quizgen.web.question_attempt import PartProgress
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language

LOOKED_AT = 300
"""Questions that were practised, the latest ones."""
PRACTISED = 60
"""Of these, those that cards are made of."""
SAT = 5
"""Exams, the latest ones."""


@dataclass(frozen=True)
class ErrorCardsJob:
    """Cards of what went wrong, the latest first."""

    lang: str
    sat: tuple[FinishedExam, ...]
    practised: tuple[PracticedQuestion, ...] = ()

    def run(self, bank: Bank) -> bytes:
        """Make them: a package for Anki, or nothing."""
        return pack_error_cards(bank, self.lang, self.sat, self.practised)


async def download_exam_cards(request: Request) -> Response:
    """Cards of an exam that was handed in."""
    site: ServerState = request.app.state.site
    store, learner = site.store.sittings, request.state.learner.id
    sitting = await run_in_threadpool(store.find, learner, request.path_params["sitting"])
    if sitting is None or sitting.handed is None:
        raise HTTPException(404)
    return await _send_cards(
        request, ErrorCardsJob(request_language(request), (_read_sitting(site, sitting),))
    )


async def download_all_cards(request: Request) -> Response:
    """Cards of the latest that was practised and sat."""

    def collected() -> ErrorCardsJob:
        site: ServerState = request.app.state.site
        learner = request.state.learner.id
        handed = [one for one in site.store.sittings.latest(learner) if one.handed is not None]
        sat = tuple(_read_sitting(site, one) for one in handed[:SAT])
        latest = site.store.latest(learner, LOOKED_AT)
        return ErrorCardsJob(
            request_language(request), sat, tuple(_iter_wrong_attempts(latest))[:PRACTISED]
        )

    return await _send_cards(request, await run_in_threadpool(collected))


def _read_sitting(site: ServerState, sitting: ExamRecord) -> FinishedExam:
    answers = site.store.sittings.answers(sitting)
    return FinishedExam(
        sitting.code, tuple((part, tuple(fields)) for part, fields in answers.items())
    )


def _iter_wrong_attempts(attempts: Iterable[AttemptRecord]) -> Iterator[PracticedQuestion]:
    """Questions of which something was not right, each mistake once."""
    known: set[tuple[str, str, str]] = set()
    for attempt in attempts:
        kept = convert(attempt.state.get("parts", {}), dict[str, PartProgress])
        parts = tuple(_make_card_part(name, one.state) for name, one in kept.items())
        wrong = {
            (attempt.template, part.id, kept[part.id].state.note) for part in parts if part.wrong
        }
        if wrong - known:
            known |= wrong
            yield PracticedQuestion(attempt.which, parts)


def _make_card_part(name: str, state: PartState) -> PracticedPart:
    """The wrong answer that was given, or the one at which it was given up."""
    outcome = state.outcome
    given_up = outcome is not None and not (outcome.right or outcome.skipped)
    return PracticedPart(name, state.wrong or state.typed, bool(state.wrong) or given_up)


async def _send_cards(request: Request, job: ErrorCardsJob) -> Response:
    site: ServerState = request.app.state.site
    data = await site.workers.get_result(job, request.state.learner.id)
    if not data:
        return page_response(
            request, "message.html.j2", 404, title="anki.title", text="anki.nothing"
        )
    named = {"content-disposition": 'attachment; filename="quizgen-mistakes.apkg"'}
    return Response(data, media_type="application/octet-stream", headers=named)


ROUTES = [
    Route("/exam/{sitting}/mistakes.apkg", download_exam_cards),
    Route("/progress/mistakes.apkg", download_all_cards),
]
