"""What somebody has done and is to do next, in a terminal as in a browser."""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from datetime import date, datetime, timedelta
from datetime import time as day_time
from typing import TYPE_CHECKING

import msgspec

from quizgen.bank.bank import Bank
from quizgen.bank.levels import GUIDED
from quizgen.bank.rules import Rules, part_points
from quizgen.grading.options import DECIMALS
from quizgen.practice.agenda import Agenda
from quizgen.practice.scheduler import ReviewEvent, days_left, local_date, make_review_event
from quizgen.practice.session_state import Attempt, PartOutcome, PartState
from quizgen.store import AttemptRecord, Learner, OutcomeRecord, QuestionRef, Store

if TYPE_CHECKING:
    from quizgen.practice.exam_plan import ExamPlan

TOGETHER = 1800.0
"""Seconds within which parts of a template belong to one attempt, where none is named."""
EXAM_BEGINS = day_time(10)
"""When an exam is assumed to begin."""


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

    @property
    def decimal(self) -> str:
        """The decimal sign that the learner declared; ``auto`` before that."""
        kept = str(self.learner.settings.get("decimal", ""))
        return kept if kept in DECIMALS else DECIMALS[0]

    def save_decimal(self, decimal: str) -> None:
        """Keep the decimal sign that the learner declared."""
        self.store.update_settings(self.learner.id, {"decimal": decimal})
        self.learner.settings["decimal"] = decimal

    def agenda(self) -> Agenda:
        """Return what is due for review today, and what is new."""
        return Agenda(self.bank, self.store.cards.all(self.learner.id), time.time(), self.exam)

    def outcomes(self) -> list[PartOutcome]:
        """Return how the latest parts went, the latest last."""
        return [
            PartOutcome(one.topic, one.right, one.first)
            for one in self.store.list_outcomes(self.learner.id)
        ]

    def attempts(self) -> list[Attempt]:
        """Return what the learner's attempts say, the earliest first; equal numbers count once."""
        repeated = self.store.list_repeated(self.learner.id)
        outcomes = self.store.list_outcomes(self.learner.id)
        return group_attempts(self.bank, [one for one in outcomes if one.attempt not in repeated])

    def plan(self, names: Collection[str]) -> ExamPlan:
        """Return the plan until the exam, with questions of some templates."""
        from quizgen.practice.ability import read_practice_items  # NumPy, only where it is asked
        from quizgen.practice.exam_plan import SPACING, ExamPlan, read_exam_goal

        now = time.time()
        latest = self.store.latest(self.learner.id, SPACING)
        return ExamPlan(
            read_exam_goal(self.bank),
            read_practice_items(self.bank),
            self.attempts(),
            now,
            exam_time(self.exam, now),
            names,
            [one.template for one in latest],
        )

    def next_question(self, names: Sequence[str]) -> QuestionRef:
        """Return which of these templates to ask next, with seed and level."""
        return QuestionRef(self.plan(names).choose_next(), self.seed_of_next())

    def list_repairs(self, sitting: str) -> list[str]:
        """Return the templates that cost points in an exam and were not asked again since.

        Those that cost most per minute come first.

        Parameters
        ----------
        sitting : str
            Id of the exam.
        """
        lost: dict[str, float] = {}
        for one in self.store.list_outcomes(self.learner.id):
            if one.template not in self.bank.template_paths:
                continue
            if (one.attempt or "").startswith(f"{sitting}/"):
                worth = part_points(self.bank.rules(one.template)).get(one.part, 1.0)
                lost[one.template] = lost.get(one.template, 0.0) + worth * (1 - (one.credit or 0))
            else:
                lost.pop(one.template, None)
        minutes = {name: self.bank.minutes(name) for name in lost}
        return sorted(
            (name for name, points in lost.items() if points),
            key=lambda name: (-lost[name] / minutes[name], name),
        )

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
            outcome_record(attempt, topic, *one) for one in parts.items() if not _is_skipped(one[1])
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


def group_attempts(bank: Bank, outcomes: Iterable[OutcomeRecord]) -> list[Attempt]:
    """Return attempts from how their parts went; parts that help came before say nothing.

    Parameters
    ----------
    bank : Bank
        Says what each part is worth; attempts at templates that it does not have are left out.
    outcomes : iterable of OutcomeRecord
        The earliest first. Rows of earlier versions name no attempt: those of one template within
        ``TOGETHER`` seconds are one.
    """
    groups: dict[tuple[str, str], list[OutcomeRecord]] = {}
    open_since: dict[str, tuple[float, str]] = {}
    for one in outcomes:
        name = one.attempt
        if name is None:
            since, name = open_since.get(one.template, (-TOGETHER, ""))
            if one.at - since > TOGETHER or not name:
                since, name = one.at, f"{one.at}"
            open_since[one.template] = since, name
        groups.setdefault((one.template, name), []).append(one)
    known = [rows for (template, _), rows in groups.items() if template in bank.template_paths]
    found = [_read_attempt(bank.rules(rows[0].template), rows) for rows in known]
    return sorted(found, key=lambda attempt: attempt.at)


def _read_attempt(rules: Rules, rows: Sequence[OutcomeRecord]) -> Attempt:
    """Return one attempt from how its parts went."""
    points = part_points(rules)
    alone = [row for row in rows if not row.helped]
    worth = [points.get(row.part, 1.0) for row in alone]
    got = (
        weight * (float(row.first) if row.credit is None else row.credit)
        for row, weight in zip(alone, worth, strict=True)
    )
    credit = sum(got) / sum(worth) if alone else 0.0
    return Attempt(rows[0].template, credit, rows[-1].at, helped=not alone)


def exam_time(exam: date | None, now: float) -> float:
    """Return when the points are to be earned, in seconds since 1970: tomorrow if no day is set."""
    today = local_date(now)
    day = exam if exam is not None and exam > today else today + timedelta(days=1)
    return datetime.combine(day, EXAM_BEGINS).astimezone().timestamp()


def outcome_record(
    attempt: AttemptRecord, topic: str, label: str, part: PartState
) -> OutcomeRecord:
    """Return the record of how a part went, dated now; ``label`` names the part."""
    outcome = part.outcome
    right, first = (outcome.right, outcome.first) if outcome else (False, False)
    helped = part.helped or attempt.level == GUIDED
    return OutcomeRecord(
        attempt.template, topic, label, part.note, right, first, time.time(), part.credit, helped,
        attempt.id,
    )  # fmt: skip


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
