"""What a deck should hold; every kind of card makes its notes from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.cards.note import Note
from quizgen.locale import FIRST, list_languages

SEED = 0


@dataclass(frozen=True)
class DeckRequest:
    """What a deck should hold.

    Parameters
    ----------
    langs : tuple of str
        Languages, the leading one first.
    topics : tuple of str
        Only these topics; all if empty.
    seed : int
        Fixes the numbers of the worked questions.
    bank : Bank
        Where content and questions come from.
    templates : tuple of str
        Only worked questions of these templates; of all if empty.
    """

    langs: tuple[str, ...] = (FIRST,)
    topics: tuple[str, ...] = ()
    seed: int = SEED
    bank: Bank = field(default_factory=builtin_bank)
    templates: tuple[str, ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        """The languages that notes have fields for: the bank's, not only those requested.

        So a deck in one language and a later one in another meet in the same notes.
        """
        held = {FIRST, *self.bank.languages, *self.langs}
        return tuple(lang for lang in list_languages() if lang in held)

    def includes_topic(self, topic: str) -> bool:
        """Return whether a topic is requested."""
        return not self.topics or topic in self.topics


class CardKind(Protocol):
    """A kind of cards: a function from a request to its notes."""

    def __call__(self, wish: DeckRequest, /) -> Iterator[Note]:
        """Yield the notes in the order of learning."""
