"""Cards of a learner: what is asked again, and when."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
from sqlalchemy import Connection, select

from quizgen.practice.schedule import Asked, Card, Name, after
from quizgen.shapes import converted
from quizgen.web.store.database import Database, put
from quizgen.web.store.tables import CARD


class Cards:
    """Cards in a database.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def all(self, learner: int) -> dict[Name, Card]:
        """A learner's cards."""
        with self.database.reading() as connection:
            return cards_of(connection, learner)

    def review(
        self, learner: int, asked: Iterable[Asked], now: float, left: int | None = None
    ) -> None:
        """Take questions that were finished into the schedule.

        Parameters
        ----------
        learner : int
        asked : iterable of Asked
        now : float
        left : int, optional
            Days until the exam.
        """
        with self.database.writing(learner) as connection:
            cards = cards_of(connection, learner)
            for one in asked:
                for card in list(after(cards, one, now, left)):
                    cards[card.kind, card.name] = card
                    put_card(connection, learner, card)


def cards_of(connection: Connection, learner: int) -> dict[Name, Card]:
    """A learner's cards."""
    rows = connection.execute(select(CARD.c.data).where(CARD.c.learner == learner)).scalars()
    found = (converted(row, Card) for row in rows)
    return {(card.kind, card.name): card for card in found}


def put_card(connection: Connection, learner: int, card: Card) -> None:
    """Write a card in place of the one of its name."""
    row = {"learner": learner, "kind": card.kind, "name": card.name, "due": card.due}
    whole = {**row, "data": msgspec.to_builtins(card)}
    put(connection, CARD, whole, ["learner", "kind", "name"], ["data", "due"])
