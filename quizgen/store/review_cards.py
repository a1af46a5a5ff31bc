"""Cards of a learner: what is asked again, and when."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
from sqlalchemy import Connection, select

from quizgen.core.decoding import convert
from quizgen.practice.scheduler import Name, ReviewCard, ReviewEvent, iter_reviewed_cards
from quizgen.store.database import Database, upsert
from quizgen.store.schema import CARD


class ReviewCardStore:
    """The review cards of learners: how well they know each template.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def all(self, learner: int) -> dict[Name, ReviewCard]:
        """Return a learner's cards by kind and name."""
        with self.database.reading() as connection:
            return read_cards(connection, learner)

    def review(
        self, learner: int, asked: Iterable[ReviewEvent], now: float, left: int | None = None
    ) -> None:
        """Update the cards of templates whose questions were finished.

        Parameters
        ----------
        learner : int
        asked : iterable of ReviewEvent
        now : float
            Seconds since 1970.
        left : int, optional
            Days until the exam.
        """
        with self.database.writing(learner) as connection:
            cards = read_cards(connection, learner)
            for one in asked:
                for card in list(iter_reviewed_cards(cards, one, now, left)):
                    cards[card.kind, card.name] = card
                    write_card(connection, learner, card)


def read_cards(connection: Connection, learner: int) -> dict[Name, ReviewCard]:
    """Return a learner's cards by kind and name, within a transaction."""
    rows = connection.execute(select(CARD.c.data).where(CARD.c.learner == learner)).scalars()
    found = (convert(row, ReviewCard) for row in rows)
    return {(card.kind, card.name): card for card in found}


def write_card(connection: Connection, learner: int, card: ReviewCard) -> None:
    """Insert a card, or replace the one of its name."""
    row = {"learner": learner, "kind": card.kind, "name": card.name, "due": card.due}
    whole = {**row, "data": msgspec.to_builtins(card)}
    upsert(connection, CARD, whole, ["learner", "kind", "name"], ["data", "due"])
