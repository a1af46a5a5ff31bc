"""What went wrong in practice and in exams, made into a package for Anki; in a worker process."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec

from quizgen.bank.bank import Bank
from quizgen.core.decoding import convert
from quizgen.core.errors import QuizgenError
from quizgen.grading.options import GradingOptions
from quizgen.paper.answer_key import make_key_question
from quizgen.paper.grading import QuestionGrader
from quizgen.paper.paper import PaperItem, rebuild_paper
from quizgen.practice.input_fields import join_fields
from quizgen.question.compose import compose_variant, draw_instance
from quizgen.store import QuestionRef

if TYPE_CHECKING:
    from quizgen.cards.error_deck import GradedPart, MissedPart


class PracticedPart(msgspec.Struct, frozen=True):
    """What was typed at a part of a question, and whether that was wrong."""

    id: str
    typed: str
    wrong: bool


class PracticedQuestion(msgspec.Struct, frozen=True):
    """A question that was practised."""

    which: QuestionRef
    parts: tuple[PracticedPart, ...]


class FinishedExam(msgspec.Struct, frozen=True):
    """An exam that was handed in: what stood in the fields of its parts."""

    code: str
    answers: tuple[tuple[str, tuple[str, ...]], ...]


def pack_error_cards(
    bank: Bank, lang: str, sat: tuple[FinishedExam, ...], practised: tuple[PracticedQuestion, ...]
) -> bytes:
    """Cards of what went wrong, as a package for Anki; nothing if nothing did.

    Parameters
    ----------
    bank : Bank
    lang : str
    sat : tuple of Sat
        The latest first: of a mistake that was made twice, the first one counts.
    practised : tuple of Practised
        Likewise.
    """
    from quizgen.cards.apkg import write_apkg  # here, because the server itself makes no cards
    from quizgen.cards.error_deck import deck_from_missed

    lang = lang if lang in bank.languages else bank.languages[0]
    found: list[MissedPart] = []
    every: tuple[FinishedExam | PracticedQuestion, ...] = (*sat, *practised)
    for one in every:
        with contextlib.suppress(QuizgenError):  # of a bank that has changed since
            found += _iter_missed_parts(bank, one, lang)
    deck = deck_from_missed(found, lang, bank=bank)
    return write_apkg(deck) if deck.notes else b""


def _iter_missed_parts(
    bank: Bank, one: FinishedExam | PracticedQuestion, lang: str
) -> list[MissedPart]:
    if isinstance(one, FinishedExam):
        return _of_exam(bank, one, lang)
    return _of_question(bank, one, lang)


def _of_exam(bank: Bank, sat: FinishedExam, lang: str) -> list[MissedPart]:
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


def _of_question(bank: Bank, practised: PracticedQuestion, lang: str) -> list[MissedPart]:
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
    """The parts of a question, marked one after another as a paper's are."""
    from quizgen.cards.error_deck import GradedPart

    keyed = make_key_question(item)
    marker = QuestionGrader(keyed, GradingOptions(lang))
    for part in keyed.parts:
        result = marker.grade_part(part, typed.get(part.id, ""))
        yield convert(result.as_json(), GradedPart)
