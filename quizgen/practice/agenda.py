"""How well things are known by their review cards, and when they come again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import date

import msgspec

from quizgen.bank.bank import Bank
from quizgen.practice.scheduler import Name, ReviewCard, days_left, due_time, local_date


class Mastery(msgspec.Struct, frozen=True):
    """How well a learner knows several templates together: those of a topic or a formula.

    Parameters
    ----------
    count, seen : int
        Its templates, and how many of them were asked.
    last : float, optional
        When one of them was last asked.
    stability : float, optional
        Days of the weakest one: until then nine of ten would still know it.
    due : float, optional
        When the first of them is due.
    """

    count: int
    seen: int
    last: float | None
    stability: float | None
    due: float | None


class Agenda:
    """What a learner knows of a bank, by review cards.

    Parameters
    ----------
    bank : Bank
    cards : mapping
        Those of the learner.
    now : float
        Seconds since 1970.
    exam : datetime.date, optional
    """

    def __init__(
        self, bank: Bank, cards: Mapping[Name, ReviewCard], now: float, exam: date | None = None
    ) -> None:
        self.bank, self.cards, self.now = bank, cards, now
        self.left = days_left(exam, local_date(now))
        self.names = {bank.origin(name): name for name in bank.template_paths}

    def due(self, card: ReviewCard) -> float:
        """Return when a card should be reviewed next, as seconds since 1970; before the exam."""
        return due_time(card, self.now, self.left)

    def card(self, name: str) -> ReviewCard | None:
        """Return the review card of a template, or None if it was never finished."""
        return self.cards.get(("template", self.bank.origin(name)))

    @property
    def mistakes(self) -> list[ReviewCard]:
        """Return the review cards of mistakes, the earliest due first.

        Only of templates that are in this bank: cards outlive the bank they were made with.
        """
        found = [c for c in self.cards.values() if c.kind == "mistake" and c.template in self.names]
        return sorted(found, key=lambda card: (self.due(card), card.name))

    def mastery_of(self, names: Sequence[str]) -> Mastery:
        """Return counts, the least stability and the first due time of templates together."""
        cards = [card for name in names if (card := self.card(name)) is not None]
        return Mastery(
            len(names),
            len(cards),
            max((card.last for card in cards), default=None),
            min((card.stability for card in cards), default=None),
            min((self.due(card) for card in cards), default=None),
        )
