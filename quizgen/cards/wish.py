"""What a deck should hold; every kind of card makes its notes from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

from quizgen.bank.folder import Bank, builtin
from quizgen.cards.note import Note

SEED = 0


@dataclass(frozen=True)
class Wish:
    """What the deck should hold.

    Parameters
    ----------
    langs : tuple of str
        Languages, the leading one first.
    topics : tuple of str
        Only these topics; all if empty.
    seed : int
        Fixes the numbers of the worked questions.
    bank : Bank
        Where the questions come from.
    """

    langs: tuple[str, ...] = ("en",)
    topics: tuple[str, ...] = ()
    seed: int = SEED
    bank: Bank = field(default_factory=builtin)

    def wants(self, topic: str) -> bool:
        """Whether a topic is asked for."""
        return not self.topics or topic in self.topics


class CardKind(Protocol):
    """A kind of cards: what is wished for goes in, its notes come out in the order of learning."""

    def __call__(self, wish: Wish, /) -> Iterator[Note]:
        """Make the notes."""
