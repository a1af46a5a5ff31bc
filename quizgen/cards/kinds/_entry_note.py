"""What every authored entry gives to its note."""

from __future__ import annotations

from collections.abc import Mapping

from quizgen.bank.entries import Entry
from quizgen.cards.note import CardWords, Note
from quizgen.cards.request import DeckRequest


def entry_note(
    wish: DeckRequest,
    entry: Entry,
    kind: str,
    words: Mapping[str, CardWords],
    refs: tuple[str, ...],
) -> Note:
    """Return a note with a front and a back, made of one authored entry.

    Parameters
    ----------
    wish : DeckRequest
    entry : Entry
    kind : str
        The kind of card, which is also the first half of its key.
    words : mapping
        Field to language to blocks.
    refs : tuple of str
        Curriculum ids.
    """
    return Note(
        key=f"{kind}/{entry.id}",
        kind=kind,
        form="basic",
        topic=entry.topic,
        tier=entry.tier,
        section=entry.section,
        refs=refs,
        langs=wish.langs,
        words=words,
    )
