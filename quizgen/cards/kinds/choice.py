"""Multiple-choice twins of the vocabulary: one meaning, four related terms."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence

from quizgen.bank.prose import Paragraph, Styled, Words
from quizgen.cards.content import Term, entries, words
from quizgen.cards.kinds._authored import noted
from quizgen.cards.note import Blocks, Note
from quizgen.cards.prose import Label
from quizgen.cards.wish import Wish
from quizgen.locale import FIRST
from quizgen.question.authored import passage, sentence

LETTERS = "ABCD"


def notes(wish: Wish) -> Iterator[Note]:
    """One note per term, its distractors in a fixed order; none if there are too few terms."""
    terms = entries(wish.bank, Term)
    if len(terms) < len(LETTERS):
        return
    for entry in terms:
        options = choices(entry, terms)
        sides = {
            "Front": {lang: _front(entry, options, lang) for lang in wish.langs},
            "Back": {lang: _back(entry, options, lang) for lang in wish.langs},
        }
        yield noted(wish, entry, "choice", sides, (f"V{entry.number:02}",))


def choices(entry: Term, terms: Sequence[Term]) -> list[Term]:
    """Four terms in a fixed order: this one, and three of its group, else its neighbours."""
    others = sorted((t for t in terms if t.id != entry.id), key=lambda t: _nearness(entry, t))
    return sorted([entry, *others[: len(LETTERS) - 1]], key=lambda term: _rank(entry, term))


def _nearness(entry: Term, other: Term) -> tuple[int, bytes]:
    """How close a distractor is: any of the group comes first, then the nearest in the list."""
    far = 0 if other.group == entry.group else abs(other.number - entry.number)
    return far, _rank(entry, other)


def _rank(entry: Term, other: Term) -> bytes:
    return hashlib.sha256(f"choice/{entry.id}/{other.id}".encode()).digest()


def _front(entry: Term, options: list[Term], lang: str) -> Blocks:
    lines = [
        Paragraph((Styled("strong", (Words(f"{letter} "),)), *_name(option, lang)))
        for letter, option in zip(LETTERS, options, strict=True)
    ]
    return (Label(words(lang)["which"]), *passage(entry, "meaning", lang), *lines)


def _back(entry: Term, options: list[Term], lang: str) -> Blocks:
    letter = LETTERS[options.index(entry)]
    return (Paragraph((Styled("strong", (Words(f"{letter} "),)), *_name(entry, lang))),)


def _name(entry: Term, lang: str) -> Blocks:
    if lang == FIRST:
        return sentence(entry, "term", lang)
    return (*sentence(entry, "term", FIRST), Words(" – "), *sentence(entry, "term", lang))
