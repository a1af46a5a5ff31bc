"""Cards of what went wrong: from the marks of a paper to the questions worth another look.

``quizgen check --json`` says which mistake was made; the paper's code makes the questions again, in
any language. A card shows the question and the learner's answer, and tells on its back what went
wrong and how it is done.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Literal

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.variant import Variant
from quizgen.cards.content import load_card_words
from quizgen.cards.deck import Deck
from quizgen.cards.kinds.question import (
    Pair,
    answer_blocks,
    deduplicate,
    front_blocks,
    section_for,
    shared_blocks,
)
from quizgen.cards.markup import CardLabel
from quizgen.cards.note import CardBlocks, Note
from quizgen.cards.request import DeckRequest
from quizgen.cards.versions import template_version
from quizgen.core.decoding import convert
from quizgen.core.errors import KeyFileError, PaperCodeError
from quizgen.core.untrusted import error_context, parse_json, read_text
from quizgen.grading.feedback import format_read_back
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.code import parse_code
from quizgen.paper.paper import Paper, rebuild_paper
from quizgen.paper.provenance import BankRecord, bank_difference_context
from quizgen.question.compose import QuestionKey, compose_variant
from quizgen.typeset.prose import Paragraph, PlainText

LOOKED_AT = frozenset({"wrong", "partial", "blank"})
"""What becomes a card; an answer that could not be read is not a mistake."""


class GradedPart(msgspec.Struct, frozen=True):
    """One part of a graded paper, as ``quizgen check --json`` prints it."""

    id: str
    question: str
    template: str
    status: Literal["correct", "partial", "wrong", "unreadable", "ambiguous", "open", "blank"]
    typed: str = ""
    read_as: str = ""
    note: str = ""
    message: str = ""


class GradedPaper(msgspec.Struct, frozen=True):
    """One graded paper, as ``quizgen check --json`` prints it."""

    code: str
    parts: tuple[GradedPart, ...]
    banks: tuple[BankRecord, ...] = ()


def read_graded_papers(path: Path) -> tuple[GradedPaper, ...]:
    """Return the papers in the output of ``quizgen check --json``, one or several.

    Raises
    ------
    KeyFileError
        Naming the file and what is wrong in it.
    """
    table = parse_json(read_text(path, KeyFileError), path, KeyFileError)
    papers = table if isinstance(table, list) else [table]
    try:
        return tuple(convert(paper, GradedPaper) for paper in papers)
    except msgspec.ValidationError as error:
        raise KeyFileError(f"{path}: not a result of `quizgen check --json`: {error}") from error


@dataclass(frozen=True)
class MissedPart:
    """A part that was not right, with the variant that it belongs to.

    Parameters
    ----------
    part : GradedPart
    draw : Draw
    level : str
        At which the question was asked.
    """

    part: GradedPart
    draw: Variant
    level: str


def deck_from_grades(path: Path, lang: str, *, bank: Bank, blueprint: str | None = None) -> Deck:
    """Return a deck of the parts that were not right in graded papers.

    Parameters
    ----------
    path : pathlib.Path
        The result of ``quizgen check --json``.
    lang : str
        A language, or ``both`` for all of them.
    bank : Bank
        The bank that the paper was made from.
    blueprint : str, optional
        The blueprint's file, if it is not one of the bank's.

    Raises
    ------
    KeyFileError
        If the file cannot be read or does not fit the paper.
    PaperCodeError
        If the paper cannot be made again with this installation.
    """
    own = load_blueprint(blueprint, bank) if blueprint else None
    found: list[MissedPart] = []
    seed = 0
    for marked in read_graded_papers(path):
        with (
            error_context(path, PaperCodeError),
            bank_difference_context(partial(tuple, marked.banks), bank),
        ):
            code = parse_code(marked.code)
            paper = rebuild_paper(bank, marked.code, own)
        seed = max(seed, 0 if code.is_reference else int(code.seed))
        with error_context(path, KeyFileError):
            found += find_missed(marked, paper)
    with error_context(path, KeyFileError):
        return deck_from_missed(found, lang, bank=bank, seed=seed)


def find_missed(marked: GradedPaper, paper: Paper) -> Iterator[MissedPart]:
    """Yield the parts of a paper that were not right.

    Raises
    ------
    KeyFileError
        If the paper has no such part.
    """
    items = {item.number: item for item in paper.items}
    for part in marked.parts:
        if part.status in LOOKED_AT:
            item = items.get(part.question)
            if item is None or item.keys[0].template != part.template:
                raise KeyFileError(f"part {part.id!r} is not in the paper {marked.code}")
            yield MissedPart(part, item.keys[0].draw, item.keys[0].level)


def deck_from_missed(missed: Iterable[MissedPart], lang: str, *, bank: Bank, seed: int = 0) -> Deck:
    """Return a deck of parts that were not right, each mistake once: as it was made first.

    Parameters
    ----------
    missed : iterable of MissedPart
    lang : str
        A language, or ``both`` for all of them.
    bank : Bank
        The bank that the questions were made from.
    seed : int
        Of the deck.

    Raises
    ------
    KeyFileError
        If a question has no such part.
    """
    wish = DeckRequest(bank.resolve_languages(lang), bank=bank, seed=seed)
    notes: dict[str, Note] = {}
    for one in missed:
        found = _make_error_note(one, wish)
        notes.setdefault(found.key, found)
    return Deck(tuple(notes.values()), wish)


def _make_error_note(missed: MissedPart, wish: DeckRequest) -> Note:
    """Return the note of a missed part: the question with what was typed, then its solution."""
    part, drawn = missed.part, missed.draw
    wish = replace(wish, bank=wish.bank.owner_of(drawn.template.id)[0])
    pairs = {
        lang: compose_variant(drawn, lang, number=part.question, level=missed.level)
        for lang in wish.langs
    }
    question, key = next(iter(pairs.values()))
    places = [i for i, one in enumerate(question.parts) if one.field.id == part.id]
    if not places:
        raise KeyFileError(f"question {part.question} has no part {part.id!r}")
    index, rules = places[0], drawn.template.rules
    slip = part.note or part.status
    return Note(
        key=f"mistake/{drawn.template.origin}/{question.parts[index].label or '-'}/{slip}",
        kind="mistake",
        form="basic",
        topic=question.topic,
        tier=question.tier,
        section=section_for(wish.bank, rules.covers, question.topic),
        refs=(key.template,),
        langs=wish.langs,
        columns=wish.columns,
        words={
            "Front": {lang: _build_front(pair, index, part, lang) for lang, pair in pairs.items()},
            "Back": deduplicate(
                {lang: _build_back(pair, index, part, lang) for lang, pair in pairs.items()}
            ),
        },
        shared=shared_blocks(pairs, index),
        version=template_version(drawn.template, wish.bank),
    )


def _build_front(pair: Pair, index: int, part: GradedPart, lang: str) -> CardBlocks:
    """Return the front: the question, part number ``index``, and what was typed."""
    question, said = pair[0], load_card_words(lang)
    asks = front_blocks(question, index)
    if not part.typed.strip():
        return (*asks, CardLabel(said["start"]))
    read = format_read_back(pair[1].specs[index].kind, part.read_as, lang)
    typed = Paragraph((PlainText(read or part.typed),))
    return (*asks, CardLabel(said["answered"]), typed, CardLabel(said["wrongly"]))


def _build_back(pair: Pair, index: int, part: GradedPart, lang: str) -> CardBlocks:
    """Return the back: the right answer of part number ``index``, and what was wrong."""
    key = pair[1]
    return (
        *_iter_reasons(key, index, part),
        CardLabel(load_card_words(lang)["right"]),
        *answer_blocks(key.solution.parts[index]),
    )


def _iter_reasons(key: QuestionKey, index: int, part: GradedPart) -> Iterator[Paragraph]:
    """Yield the misconception's sentence in this language, else the checker's message."""
    name = part.note.removeprefix("trap:")
    for mistake in key.solution.parts[index].mistakes:
        if mistake.name == name:
            yield Paragraph(mistake.sentence)
            return
    if part.message and part.status != "blank":
        yield Paragraph((PlainText(part.message),))
