"""What somebody has done and is to do next, in a terminal as in a browser."""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Iterable, Mapping, Sequence
from datetime import date

import msgspec

from quizgen.bank.bank import Bank
from quizgen.practice.agenda import Agenda
from quizgen.practice.scheduler import ReviewEvent, days_left, local_date, make_review_event
from quizgen.practice.session_state import PartOutcome, PartState
from quizgen.store import AttemptRecord, Learner, OutcomeRecord, QuestionRef, Store


class LearnerProgress(msgspec.Struct, frozen=True):
    """One learner's practice with one bank: the schedule, and a database that records it."""

    store: Store
    bank: Bank
    learner: Learner

    @property
    def exam(self) -> date | None:
        """The day of the learner's exam, if one is set."""
        try:
            return date.fromisoformat(str(self.learner.settings.get("exam", "")))
        except ValueError:
            return None

    def agenda(self) -> Agenda:
        """Return what is due for review today, and what is new."""
        return Agenda(self.bank, self.store.cards.all(self.learner.id), time.time(), self.exam)

    def outcomes(self) -> list[PartOutcome]:
        """Return how the latest parts went, the latest last."""
        return [
            PartOutcome(one.topic, one.right, one.first)
            for one in self.store.list_outcomes(self.learner.id)
        ]

    def next_question(self, names: Sequence[str]) -> QuestionRef:
        """Return which of these templates is due next, with seed and level."""
        latest = self.store.latest(self.learner.id, 1)
        seed = _choose_next_seed(latest)
        template = self.agenda().choose_next(
            names,
            self.outcomes(),
            self.store.count_asked(self.learner.id),
            latest[0].template if latest else "",
            seed,
        )
        return QuestionRef(template, seed)

    def seed_of_next(self) -> str:
        """Return the seed of the question that will be begun next."""
        return _choose_next_seed(self.store.latest(self.learner.id, 1))

    def save_practice(self, which: QuestionRef, topic: str, parts: Mapping[str, PartState]) -> None:
        """Record a question that was finished outside of a browser, part by part.

        Parameters
        ----------
        which : QuestionRef
        topic : str
        parts : mapping
            Label of each part and how it went; one that was skipped went neither well nor badly.
        """
        attempt = self.store.start_attempt(self.learner.id, which, {})
        attempt.ended = time.time()
        names = {f"1{label}": {"state": msgspec.to_builtins(one)} for label, one in parts.items()}
        attempt.state = {"parts": names, "ended": list(names)}
        seen = (
            outcome_record(which, topic, *one) for one in parts.items() if not _is_skipped(one[1])
        )
        self.store.save_attempt(attempt, tuple(seen))
        self.finish_attempt(attempt, list(parts.values()))

    def finish_attempt(self, attempt: AttemptRecord, parts: Sequence[PartState]) -> None:
        """Schedule the template of a finished question; the same numbers again change nothing."""
        asked = make_review_event(self.bank.origin(attempt.template), parts, attempt.level)
        if asked is not None and not self.store.was_finished(attempt):
            self.apply_reviews([asked])

    def apply_reviews(self, asked: Iterable[ReviewEvent]) -> None:
        """Take finished questions into the schedule of their templates."""
        now = time.time()
        left = days_left(self.exam, local_date(now))
        self.store.cards.review(self.learner.id, asked, now, left)


def outcome_record(which: QuestionRef, topic: str, label: str, part: PartState) -> OutcomeRecord:
    """Return the record of how a part went, dated now; ``label`` names the part."""
    outcome = part.outcome
    right, first = (outcome.right, outcome.first) if outcome else (False, False)
    return OutcomeRecord(which.template, topic, label, part.note, right, first, time.time())


def _is_skipped(part: PartState) -> bool:
    """Return whether a part was skipped, which counts neither as right nor as wrong."""
    return part.outcome is not None and part.outcome.skipped


def _choose_next_seed(latest: Sequence[AttemptRecord]) -> str:
    """Return a random seed that stays the same until another attempt is begun.

    So the next question can be built before it is asked for.
    """
    if not latest:
        return secrets.token_hex(4)
    return hashlib.sha256(latest[0].id.encode()).hexdigest()[:8]
