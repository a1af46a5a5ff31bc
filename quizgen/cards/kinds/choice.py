"""Multiple-choice twins of the vocabulary: one meaning, four related terms."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence

from quizgen.cards.content import VocabularyEntry, load_card_words, read_card_entries
from quizgen.cards.kinds._entry_note import entry_note
from quizgen.cards.markup import CardLabel
from quizgen.cards.note import CardBlocks, Note
from quizgen.cards.request import DeckRequest
from quizgen.locale import FIRST
from quizgen.question.entry_prose import entry_blocks, entry_inlines
from quizgen.typeset.prose import Emphasis, Paragraph, PlainText

LETTERS = "ABCD"


def notes(wish: DeckRequest) -> Iterator[Note]:
    """Yield one multiple-choice note per term; none if the bank has too few terms."""
    terms = read_card_entries(wish.bank, VocabularyEntry)
    if len(terms) < len(LETTERS):
        return
    for entry in terms:
        options = pick_distractors(entry, terms)
        sides = {
            "Front": {lang: _build_front(entry, options, lang) for lang in wish.langs},
            "Back": {lang: _build_back(entry, options, lang) for lang in wish.langs},
        }
        yield entry_note(wish, entry, "choice", sides, (f"V{entry.number:02}",))


def pick_distractors(
    entry: VocabularyEntry, terms: Sequence[VocabularyEntry]
) -> list[VocabularyEntry]:
    """Return four terms in a fixed order: this one, and three of its group, else its neighbours."""
    others = sorted(
        (t for t in terms if t.id != entry.id), key=lambda t: _rank_distractor(entry, t)
    )
    return sorted(
        [entry, *others[: len(LETTERS) - 1]], key=lambda term: _hash_entry_pair(entry, term)
    )


def _rank_distractor(entry: VocabularyEntry, other: VocabularyEntry) -> tuple[int, bytes]:
    """Return the sort key of a distractor: its group first, then its distance in the list."""
    far = 0 if other.group == entry.group else abs(other.number - entry.number)
    return far, _hash_entry_pair(entry, other)


def _hash_entry_pair(entry: VocabularyEntry, other: VocabularyEntry) -> bytes:
    """Return a digest of two terms, by which options are ordered: fixed, but without a pattern."""
    return hashlib.sha256(f"choice/{entry.id}/{other.id}".encode()).digest()


def _build_front(entry: VocabularyEntry, options: list[VocabularyEntry], lang: str) -> CardBlocks:
    """Return the front: the meaning, and the lettered options."""
    lines = [
        Paragraph(
            (Emphasis("strong", (PlainText(f"{letter} "),)), *_build_term_blocks(option, lang))
        )
        for letter, option in zip(LETTERS, options, strict=True)
    ]
    return (
        CardLabel(load_card_words(lang)["which"]),
        *entry_blocks(entry, "meaning", lang),
        *lines,
    )


def _build_back(entry: VocabularyEntry, options: list[VocabularyEntry], lang: str) -> CardBlocks:
    """Return the back: the letter of the right option and the term."""
    letter = LETTERS[options.index(entry)]
    return (
        Paragraph(
            (Emphasis("strong", (PlainText(f"{letter} "),)), *_build_term_blocks(entry, lang))
        ),
    )


def _build_term_blocks(entry: VocabularyEntry, lang: str) -> CardBlocks:
    """Return a term in a language, with the English one where it differs."""
    if lang == FIRST:
        return entry_inlines(entry, "term", lang)
    return (
        *entry_inlines(entry, "term", FIRST),
        PlainText(" – "),
        *entry_inlines(entry, "term", lang),
    )
