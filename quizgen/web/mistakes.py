"""What went wrong in practice and in exams, made into a package for Anki; in a worker process."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import msgspec

from quizgen.bank.folder import Bank
from quizgen.errors import QuizgenError
from quizgen.marking.options import Options
from quizgen.paper.key import key_question
from quizgen.paper.marking import Marker
from quizgen.paper.paper import Item, rebuild
from quizgen.practice.boxes import joined
from quizgen.question.compose import instance, put_into_words
from quizgen.shapes import converted
from quizgen.web.store import Which

if TYPE_CHECKING:
    from quizgen.cards.mistakes import MarkedPart, Missed


class Part(msgspec.Struct, frozen=True):
    """What was typed at a part of a question, and whether that was wrong."""

    id: str
    typed: str
    wrong: bool


class Practised(msgspec.Struct, frozen=True):
    """A question that was practised."""

    which: Which
    parts: tuple[Part, ...]


class Sat(msgspec.Struct, frozen=True):
    """An exam that was handed in: what stood in the fields of its parts."""

    code: str
    answers: tuple[tuple[str, tuple[str, ...]], ...]


def packed(bank: Bank, lang: str, sat: tuple[Sat, ...], practised: tuple[Practised, ...]) -> bytes:
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
    from quizgen.cards.apkg import package  # here, because the server itself makes no cards
    from quizgen.cards.mistakes import deck_of

    lang = lang if lang in bank.languages else bank.languages[0]
    found: list[Missed] = []
    every: tuple[Sat | Practised, ...] = (*sat, *practised)
    for one in every:
        with contextlib.suppress(QuizgenError):  # of a bank that has changed since
            found += _of(bank, one, lang)
    deck = deck_of(found, lang, bank=bank)
    return package(deck) if deck.notes else b""


def _of(bank: Bank, one: Sat | Practised, lang: str) -> list[Missed]:
    if isinstance(one, Sat):
        return _of_exam(bank, one, lang)
    return _of_question(bank, one, lang)


def _of_exam(bank: Bank, sat: Sat, lang: str) -> list[Missed]:
    from quizgen.cards.mistakes import Marked, missed

    paper, answers = rebuild(bank, sat.code), dict(sat.answers)
    place = paper.langs.index(lang) if lang in paper.langs else 0
    parts: list[MarkedPart] = []
    for item in paper.items:
        typed = {
            field.id: joined(
                field.control, answers.get(field.id, ()), [m for m, _ in field.options]
            )
            for field in (part.field for part in item.questions[place].parts)
        }
        parts += _marked(item, typed, lang)
    return list(missed(Marked(sat.code, tuple(parts)), paper))


def _of_question(bank: Bank, practised: Practised, lang: str) -> list[Missed]:
    from quizgen.cards.mistakes import Missed

    which = practised.which
    drawn = instance(bank.template(which.template), which.seed)
    question, key = put_into_words(drawn, lang, level=which.level, figures=False)
    wrong = {part.id for part in practised.parts if part.wrong}
    typed = {part.id: part.typed for part in practised.parts}
    paper = _marked(Item(question.number, (question,), (key,)), typed, lang)
    return [Missed(part, drawn, which.level) for part in paper if part.id in wrong]


def _marked(item: Item, typed: Mapping[str, str], lang: str) -> Iterator[MarkedPart]:
    """The parts of a question, marked one after another as a paper's are."""
    from quizgen.cards.mistakes import MarkedPart

    keyed = key_question(item)
    marker = Marker(keyed, Options(lang))
    for part in keyed.parts:
        result = marker.mark(part, typed.get(part.id, ""))
        yield converted(result.as_json(), MarkedPart)
