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

from quizgen.bank.draw import Draw
from quizgen.bank.folder import Bank
from quizgen.bank.prose import Paragraph, Words
from quizgen.cards.content import words
from quizgen.cards.deck import Deck
from quizgen.cards.kinds.question import Pair, answer, front, once, section_of, shared
from quizgen.cards.note import Blocks, Note
from quizgen.cards.prose import Label
from quizgen.cards.versions import template_version
from quizgen.cards.wish import Wish
from quizgen.errors import CodeError, KeyFileError
from quizgen.outside import located, parse_json, read_text
from quizgen.paper.banks import UsedBank, compared
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.code import parse_code
from quizgen.paper.paper import Paper, rebuild
from quizgen.question.compose import Key, put_into_words
from quizgen.shapes import converted

LOOKED_AT = frozenset({"wrong", "partial", "blank"})
"""What becomes a card; an answer that could not be read is not a mistake."""


class MarkedPart(msgspec.Struct, frozen=True):
    """One part of a marked paper, as ``quizgen check --json`` prints it."""

    id: str
    question: str
    template: str
    status: Literal["correct", "partial", "wrong", "unreadable", "ambiguous", "open", "blank"]
    typed: str = ""
    read_as: str = ""
    note: str = ""
    message: str = ""


class Marked(msgspec.Struct, frozen=True):
    """A marked paper."""

    code: str
    parts: tuple[MarkedPart, ...]
    banks: tuple[UsedBank, ...] = ()


def read_marks(path: Path) -> tuple[Marked, ...]:
    """Read the output of ``quizgen check --json``, of one paper or of several.

    Raises
    ------
    KeyFileError
        Naming the file and what is wrong in it.
    """
    table = parse_json(read_text(path, KeyFileError), path, KeyFileError)
    papers = table if isinstance(table, list) else [table]
    try:
        return tuple(converted(paper, Marked) for paper in papers)
    except msgspec.ValidationError as error:
        raise KeyFileError(f"{path}: not a result of `quizgen check --json`: {error}") from error


@dataclass(frozen=True)
class Missed:
    """A part that was not right, and the question that it belongs to.

    Parameters
    ----------
    part : MarkedPart
    draw : Draw
    level : str
        At which the question was asked.
    """

    part: MarkedPart
    draw: Draw
    level: str


def from_marks(path: Path, lang: str, *, bank: Bank, blueprint: str | None = None) -> Deck:
    """Make a deck of what went wrong.

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
    CodeError
        If the paper cannot be made again with this installation.
    """
    own = load_blueprint(blueprint, bank) if blueprint else None
    found: list[Missed] = []
    seed = 0
    for marked in read_marks(path):
        with located(path, CodeError), compared(partial(tuple, marked.banks), bank):
            code = parse_code(marked.code)
            paper = rebuild(bank, marked.code, own)
        seed = max(seed, 0 if code.is_reference else int(code.seed))
        with located(path, KeyFileError):
            found += missed(marked, paper)
    with located(path, KeyFileError):
        return deck_of(found, lang, bank=bank, seed=seed)


def missed(marked: Marked, paper: Paper) -> Iterator[Missed]:
    """Parts of a paper that were not right.

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
            yield Missed(part, item.keys[0].draw, item.keys[0].level)


def deck_of(missed: Iterable[Missed], lang: str, *, bank: Bank, seed: int = 0) -> Deck:
    """A deck of parts that were not right, each mistake once: as it was made first.

    Parameters
    ----------
    missed : iterable of Missed
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
    wish = Wish(bank.chosen(lang), bank=bank, seed=seed)
    notes: dict[str, Note] = {}
    for one in missed:
        found = _note(one, wish)
        notes.setdefault(found.key, found)
    return Deck(tuple(notes.values()), wish)


def _note(missed: Missed, wish: Wish) -> Note:
    part, drawn = missed.part, missed.draw
    wish = replace(wish, bank=wish.bank.home(drawn.template.id)[0])
    pairs = {
        lang: put_into_words(drawn, lang, number=part.question, level=missed.level)
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
        section=section_of(wish.bank, rules.covers, question.topic),
        refs=(key.template,),
        langs=wish.langs,
        columns=wish.columns,
        words={
            "Front": {lang: _front(pair, index, part, lang) for lang, pair in pairs.items()},
            "Back": once({lang: _back(pair, index, part, lang) for lang, pair in pairs.items()}),
        },
        shared=shared(pairs, index),
        version=template_version(drawn.template, wish.bank),
    )


def _front(pair: Pair, index: int, part: MarkedPart, lang: str) -> Blocks:
    question, said = pair[0], words(lang)
    asks = front(question, index)
    if not part.typed.strip():
        return (*asks, Label(said["start"]))
    typed = Paragraph((Words(part.read_as or part.typed),))
    return (*asks, Label(said["answered"]), typed, Label(said["wrongly"]))


def _back(pair: Pair, index: int, part: MarkedPart, lang: str) -> Blocks:
    key = pair[1]
    return (
        *_reason(key, index, part),
        Label(words(lang)["right"]),
        *answer(key.solution.parts[index]),
    )


def _reason(key: Key, index: int, part: MarkedPart) -> Iterator[Paragraph]:
    """The sentence of the template's mistake in this language, else what the checker said."""
    name = part.note.removeprefix("trap:")
    for mistake in key.solution.parts[index].mistakes:
        if mistake.name == name:
            yield Paragraph(mistake.sentence)
            return
    if part.message and part.status != "blank":
        yield Paragraph((Words(part.message),))
