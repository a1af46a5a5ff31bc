"""What went wrong, as cards for Anki: of one exam, or of all that was practised and sat."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.core.decoding import convert
from quizgen.core.errors import QuizgenError
from quizgen.grading.options import GradingOptions
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.grading import QuestionGrader
from quizgen.paper.paper import PaperItem, rebuild_paper
from quizgen.practice.input_fields import join_fields
from quizgen.practice.scheduler import NAMED
from quizgen.question.compose import compose_variant, draw_instance
from quizgen.store import AttemptRecord, ExamRecord, QuestionRef
from quizgen.web.question_attempt import PartProgress
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language

if TYPE_CHECKING:
    from quizgen.cards.error_deck import GradedPart, MissedPart

LOOKED_AT = 300
"""Questions that were practised, the latest ones."""
PRACTISED = 60
"""Of these, those that cards are made of."""
SAT = 5
"""Exams, the latest ones."""


@dataclass(frozen=True)
class ErrorCardsJob:
    """Builds flashcards of mistakes, the latest first; ``named`` keeps those with a name alone."""

    lang: str
    sat: tuple[FinishedExam, ...]
    practised: tuple[PracticedQuestion, ...] = ()
    named: bool = False

    def run(self, bank: Bank) -> bytes:
        """Return an Anki package; empty bytes if there is nothing to learn."""
        return pack_error_cards(bank, self.lang, self.sat, self.practised, named=self.named)


async def download_exam_cards(request: Request) -> Response:
    """Return the flashcards of a submitted exam's mistakes."""
    site: ServerState = request.app.state.site
    store, learner = site.store.sittings, request.state.learner.id
    exam = await run_in_threadpool(store.find, learner, request.path_params["sitting"])
    if exam is None or exam.handed is None:
        raise HTTPException(404)
    return await _send_cards(
        request, ErrorCardsJob(request_language(request), (_read_exam_answers(site, exam),))
    )


async def download_all_cards(request: Request) -> Response:
    """Return the flashcards of the latest mistakes in practice and exams."""

    def collect_mistakes() -> ErrorCardsJob:
        """Return the job for the latest exams and questions, read in a thread."""
        site: ServerState = request.app.state.site
        learner = request.state.learner.id
        handed = [one for one in site.store.sittings.latest(learner) if one.handed is not None]
        sat = tuple(_read_exam_answers(site, one) for one in handed[:SAT])
        latest = site.store.latest(learner, LOOKED_AT)
        practised = tuple(_iter_wrong_attempts(latest))[:PRACTISED]
        return ErrorCardsJob(request_language(request), sat, practised, named=True)

    return await _send_cards(request, await run_in_threadpool(collect_mistakes))


def _read_exam_answers(site: ServerState, exam: ExamRecord) -> FinishedExam:
    """Return an exam's code and answers."""
    answers = site.store.sittings.answers(exam)
    return FinishedExam(exam.code, tuple((part, tuple(fields)) for part, fields in answers.items()))


def _iter_wrong_attempts(attempts: Iterable[AttemptRecord]) -> Iterator[PracticedQuestion]:
    """Yield each mistake with a name that no later attempt had; the latest come first."""
    known: set[tuple[str, str, str]] = set()
    for attempt in attempts:
        kept = convert(attempt.state.get("parts", {}), dict[str, PartProgress])
        right = {name: PracticedPart(name, one.state.typed, False) for name, one in kept.items()}
        for name, one in kept.items():
            for note, typed in one.state.mistakes.items():
                if (attempt.template, name, note) not in known:
                    known.add((attempt.template, name, note))
                    parts = right | {name: PracticedPart(name, typed, True)}
                    yield PracticedQuestion(attempt.which, tuple(parts.values()))


async def _send_cards(request: Request, job: ErrorCardsJob) -> Response:
    """Return the Anki package of a job as a download, or a page that there is nothing."""
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


class PracticedPart(msgspec.Struct, frozen=True):
    """What was typed at a part, and whether it was wrong."""

    id: str
    typed: str
    wrong: bool


class PracticedQuestion(msgspec.Struct, frozen=True):
    """A practised question with the answers to its parts."""

    which: QuestionRef
    parts: tuple[PracticedPart, ...]


class FinishedExam(msgspec.Struct, frozen=True):
    """A submitted exam: the code of its paper and the fields of its parts."""

    code: str
    answers: tuple[tuple[str, tuple[str, ...]], ...]


def pack_error_cards(
    bank: Bank,
    lang: str,
    sat: tuple[FinishedExam, ...],
    practised: tuple[PracticedQuestion, ...],
    *,
    named: bool = False,
) -> bytes:
    """Return cards of what went wrong, as a package for Anki; nothing if nothing did.

    Parameters
    ----------
    bank : Bank
    lang : str
    sat : tuple of FinishedExam
        The latest first: of a mistake that was made twice, the first one counts.
    practised : tuple of PracticedQuestion
        Likewise.
    named : bool
        Whether only mistakes with a name count: not what was left blank or is wrong without one.
    """
    from quizgen.cards.apkg import write_apkg  # here, because the server itself makes no cards
    from quizgen.cards.error_deck import deck_from_missed

    lang = lang if lang in bank.languages else bank.languages[0]
    found: list[MissedPart] = []
    every: tuple[FinishedExam | PracticedQuestion, ...] = (*sat, *practised)
    for one in every:
        with contextlib.suppress(QuizgenError):  # of a bank that has changed since
            found += _iter_missed_parts(bank, one, lang)
    found = [one for one in found if not named or one.part.note.startswith(NAMED)]
    deck = deck_from_missed(found, lang, bank=bank)
    return write_apkg(deck) if deck.notes else b""


def _iter_missed_parts(
    bank: Bank, one: FinishedExam | PracticedQuestion, lang: str
) -> list[MissedPart]:
    """Return the parts of an exam or a question that were not right."""
    if isinstance(one, FinishedExam):
        return _find_missed_in_exam(bank, one, lang)
    return _find_missed_in_question(bank, one, lang)


def _find_missed_in_exam(bank: Bank, sat: FinishedExam, lang: str) -> list[MissedPart]:
    """Return the parts of an exam that were not right, graded again from its code."""
    from quizgen.cards.error_deck import GradedPaper, find_missed

    paper, answers = rebuild_paper(bank, sat.code), dict(sat.answers)
    place = paper.langs.index(lang) if lang in paper.langs else 0
    parts: list[GradedPart] = []
    for item in paper.items:
        typed = {
            field.id: join_fields(
                field.control, answers.get(field.id, ()), [m for m, _ in field.options]
            )
            for field in (part.field for part in item.questions[place].parts)
        }
        parts += _iter_graded_parts(item, typed, lang)
    return list(find_missed(GradedPaper(sat.code, tuple(parts)), paper))


def _find_missed_in_question(
    bank: Bank, practised: PracticedQuestion, lang: str
) -> list[MissedPart]:
    """Return the parts of a practised question that were not right, graded again."""
    from quizgen.cards.error_deck import MissedPart

    which = practised.which
    drawn = draw_instance(bank.template(which.template), which.seed)
    question, key = compose_variant(drawn, lang, level=which.level, figures=False)
    wrong = {part.id for part in practised.parts if part.wrong}
    typed = {part.id: part.typed for part in practised.parts}
    paper = _iter_graded_parts(PaperItem(question.number, (question,), (key,)), typed, lang)
    return [MissedPart(part, drawn, which.level) for part in paper if part.id in wrong]


def _iter_graded_parts(
    item: PaperItem, typed: Mapping[str, str], lang: str
) -> Iterator[GradedPart]:
    """Yield the parts of a question graded in order, as a paper's are."""
    from quizgen.cards.error_deck import GradedPart

    keyed = make_key_question(item)
    marker = QuestionGrader(keyed, GradingOptions(lang))
    for part in keyed.parts:
        result = marker.grade_part(part, typed.get(part.id, ""))
        yield convert(result.as_json(), GradedPart)
