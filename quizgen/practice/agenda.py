"""What to do next: what is due, then weak topics, then what was never asked."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable, Mapping, Sequence
from datetime import date

import msgspec

from quizgen.bank.bank import Bank
from quizgen.practice.scheduler import LEARNING, Name, ReviewCard, days_left, due_time, local_date
from quizgen.practice.session_state import PartOutcome
from quizgen.practice.topic_results import RECENT, summarise_by_topic, weak_topics

FRESH = 5
"""New templates of a day, where no exam says how many."""


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
    """What a learner should practise now, by the bank and the learner's review cards.

    Parameters
    ----------
    bank : Bank
    cards : mapping
        Those of the learner.
    now : float
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

    def due_templates(self, names: Iterable[str]) -> list[str]:
        """Return those of ``names`` that are due, themselves or by a mistake; longest due first."""
        wanted = set(names)
        since: dict[str, float] = {}
        for card in self.cards.values():
            name, moment = self.names.get(card.template), self.due(card)
            if name in wanted and name is not None and moment <= self.now:
                since[name] = min(moment, since.get(name, moment))
        return sorted(since, key=lambda name: (since[name], name))

    def unseen(self, names: Iterable[str]) -> list[str]:
        """Return those of ``names`` that have no review card, in the order given."""
        return [name for name in names if self.card(name) is None]

    def new_per_day(self, names: Sequence[str]) -> int:
        """Return how many unseen templates to begin today, so that all come up before the exam.

        Those begun today are already subtracted; without an exam ``FRESH`` a day are enough.
        """
        today = local_date(self.now)
        begun = sum(
            card.kind == "template" and card.state == LEARNING and local_date(card.last) == today
            for card in self.cards.values()
        )
        count = len(self.unseen(names))
        whole = FRESH if self.left is None else math.ceil((count + begun) / self.left)
        return max(0, min(count, whole - begun))

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

    def choose_next(
        self, names: Sequence[str], outcomes: Sequence[PartOutcome], times: Mapping[str, int],
        latest: str = "", seed: str = "",
    ) -> str:  # fmt: skip
        """Return the template to ask now: one that is due, else a weak topic's, else an unseen one.

        If all were seen, the one that becomes due first.

        Parameters
        ----------
        names : sequence of str
            Those that fit, at least one.
        outcomes : sequence of PartOutcome
            How parts went, the latest last: they say which topics are weak.
        times : mapping
            Template to how often it was begun.
        latest : str
            The one asked before, which does not come twice if there is another.
        seed : str
            Decides between equals.
        """
        others = [name for name in names if name != latest] or list(names)
        ready = self.due_templates(others)
        if ready:
            return ready[0]
        unseen = self.unseen(others)
        for topic in weak_topics(summarise_by_topic(outcomes, RECENT)):
            weak = [name for name in unseen if self.bank.rules(name).topic == topic]
            if weak:
                return _choose_least_attempted(weak, times, seed)
        if unseen:
            return _choose_least_attempted(unseen, times, seed)
        return min(others, key=lambda name: (self._find_due_time(name), name))

    def _find_due_time(self, name: str) -> float:
        """Return when a template is due, in seconds since 1970; now if it was never finished."""
        card = self.card(name)
        return self.due(card) if card else self.now


def _choose_least_attempted(names: Sequence[str], times: Mapping[str, int], seed: str) -> str:
    """Return the template that was begun the fewest times; ``seed`` decides between equals."""

    def rank(name: str) -> tuple[int, bytes]:
        """Return how often a template was begun, then a random but repeatable key."""
        return times.get(name, 0), hashlib.sha256(f"next/{seed}/{name}".encode()).digest()

    return min(names, key=rank)
