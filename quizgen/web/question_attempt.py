"""A question that somebody practises: its parts as tasks, and how far each has got."""

from __future__ import annotations

import time
from collections.abc import Mapping
from fractions import Fraction

import msgspec

from quizgen.core.decoding import convert
from quizgen.grading.offered_readings import OfferedReading, list_offered_readings
from quizgen.grading.options import DECIMALS, GradingOptions
from quizgen.grading.verdict import Verdict, unreadable
from quizgen.kinds.rubric import share_of_marks
from quizgen.paper.answer_key import KeyPart
from quizgen.paper.grading import QuestionGrader
from quizgen.practice.input_fields import is_complete, join_fields
from quizgen.practice.part_attempt import TRIES, NextStep, PartAttempt
from quizgen.practice.session_state import PartState
from quizgen.store import AttemptRecord, OutcomeRecord
from quizgen.store.learner import outcome_record
from quizgen.web.question_view import PartView, QuestionView
from quizgen.web.read_errors import ReadErrorView, explain_read_error

HALF = unreadable("values-missing")
"""Said where some fields are empty."""
BLANK = " "
"""Stands for an answer of which nothing was filled in."""
LADDER = ("nudge", "formula", "step", "solution")
"""Kinds of help, in the order in which a learner climbs them."""
RUNGS = {"quantity": "nudge", "why": "nudge", "formula": "formula", "numbers": "step",
         "result": "step"}  # fmt: skip
"""Kind of a hint to its rung."""
HINTS_FIRST = 2
"""Hints after which the solution is offered to somebody who has not tried."""


class PartProgress(msgspec.Struct):
    """Progress of a part, and the texts in its fields."""

    state: PartState = msgspec.field(default_factory=PartState)
    values: list[str] = msgspec.field(default_factory=list)
    asked_back: str = ""
    """What stands there, if it could not be read as meant."""


class AttemptPart:
    """A part on the page: its attempt, its fields, and the last verdict."""

    def __init__(
        self,
        task: PartAttempt[PartView, PartView],
        progress: PartProgress,
        verdict: Verdict | None,
        lang: str,
    ) -> None:
        self.task, self.progress, self.verdict = task, progress, verdict
        self.part, self._lang = task.part, lang

    @property
    def name(self) -> str:
        """Return the part's id in addresses and forms."""
        return self.part.field.id

    @property
    def is_finished(self) -> bool:
        """Whether the part is answered, given up or skipped."""
        return self.task.outcome is not None

    @property
    def is_right(self) -> bool:
        """Whether the part ended well."""
        return self.task.outcome is not None and self.task.outcome.right

    @property
    def rungs(self) -> list[str]:
        """Return the kinds of help there are, from a nudge to the whole solution."""
        there = {RUNGS[hint.kind] for line in self.part.lines for hint in line.hints}
        return [rung for rung in LADDER if rung in there or rung == LADDER[-1]]

    @property
    def height(self) -> int:
        """Return how many rungs of the ladder have been climbed."""
        climbed = [self.rungs.index(RUNGS[hint.kind]) for hint in self.task.hints]
        return max(climbed, default=-1) + 1

    @property
    def next_rung(self) -> str:
        """Return what kind of help comes next; the solution after all hints."""
        hints = [hint for line in self.part.lines for hint in line.hints]
        return RUNGS[hints[self.task.state.hints].kind] if self.task.more_hints else LADDER[-1]

    @property
    def may_show(self) -> bool:
        """Whether the solution is offered: after a try or two hints, or where there is no hint."""
        state = self.task.state
        return bool(state.tries) or state.hints >= HINTS_FIRST or not self.task.more_hints

    @property
    def is_placed(self) -> bool:
        """Whether its field stands inside a sentence or a cell."""
        return self.part.field.near is not None

    def has_checked(self, values: list[str]) -> bool:
        """Return whether these texts are those that the last verdict is on."""
        return self.verdict is not None and self.progress.values == values

    @property
    def explained_verdict(self) -> Verdict | None:
        """The verdict with its message: for pages, since an answer sent is only stored."""
        return self.task.explain_verdict(self.verdict) if self.verdict else None

    @property
    def readings(self) -> tuple[OfferedReading, ...]:
        """The readings of an answer asked back; whole ones only where one field holds them."""
        if self.verdict is None or not self.progress.asked_back:
            return ()
        several = len(self.progress.values) > 1
        offered = list_offered_readings(self.verdict)
        return () if several and any(one.typed for one in offered) else offered

    @property
    def unread(self) -> ReadErrorView | None:
        """Return why the answer could not be read; None if it could."""
        if self.explained_verdict is None or not self.progress.asked_back:
            return None
        return explain_read_error(
            self.part.field, self.progress.values, self.explained_verdict, self._lang
        )

    @property
    def tries_left(self) -> int:
        """Return the number of tries left."""
        return TRIES - self.task.state.tries

    @property
    def to_judge(self) -> bool:
        """Whether the learner must grade the own answer."""
        return not self.is_finished and self.verdict is not None and self.verdict.needs_self_marking

    @property
    def gave(self) -> float | None:
        """The points that the learner gave to an own sentence; None where there is none."""
        judged = self.part.scheme and self.is_finished and self.verdict is not None
        return self.task.state.credit * self.part.points if judged else None

    def give_marks(self, marks: Mapping[str, Fraction]) -> None:
        """End the part with the points of the criteria that the learner ticked."""
        self.task.self_mark(float(share_of_part(self.part, marks)))


def share_of_part(part: PartView, marks: Mapping[str, Fraction]) -> Fraction:
    """Return the share of a part's points that ticked criteria earn."""
    points = {row.name: Fraction(str(row.points)) for row in part.scheme}
    return share_of_marks(marks, points, Fraction(str(part.points)))


class AttemptInBrowser:
    """An attempt at a question, as its page shows it.

    Parameters
    ----------
    made : QuestionView
        In the language of who asks.
    attempt : AttemptRecord
    decimal : str
        The decimal sign that the learner declared: ``auto``, ``point`` or ``comma``.
    """

    def __init__(
        self, made: QuestionView, attempt: AttemptRecord, decimal: str = DECIMALS[0]
    ) -> None:
        self.made, self.attempt = made, attempt
        kept = attempt.state.get("parts", {})
        self._marker = QuestionGrader(made.key, GradingOptions(made.wanted.lang, decimal))
        self.places = [
            self._open_part_attempt(part, keyed, convert(kept.get(part.field.id, {}), PartProgress))
            for part, keyed in zip(made.parts, made.key.parts, strict=True)
        ]

    def _open_part_attempt(
        self, part: PartView, keyed: KeyPart, progress: PartProgress
    ) -> AttemptPart:
        """Return a part with its stored progress and the verdict on its last answer."""
        task = PartAttempt(self.made.topic, part, part, keyed, progress.state, marker=self._marker)
        verdict = task.verdict
        if progress.asked_back:
            whole = _is_fully_filled(part, progress.values)
            verdict = self._marker.judge_part(keyed, progress.asked_back).verdict if whole else HALF
        return AttemptPart(task, progress, verdict, self.made.wanted.lang)

    def find_part(self, name: str) -> AttemptPart | None:
        """Return the part with an id; None if there is none."""
        return next((place for place in self.places if place.name == name), None)

    @property
    def groups(self) -> list[list[AttemptPart]]:
        """The parts in order, those together whose fields stand in one text."""
        found: list[list[AttemptPart]] = []
        for place in self.places:
            if place.is_placed and not place.part.body:
                found[-1].append(place)
            else:
                found.append([place])
        return found

    def find_group(self, part: AttemptPart) -> list[AttemptPart]:
        """Return the parts whose fields are sent together with those of a part."""
        return next(group for group in self.groups if part in group)

    def choose_group(self, name: str) -> list[AttemptPart]:
        """Return the parts to show: those of a part, else the first that are open."""
        named = self.find_part(name)
        if named is not None:
            return self.find_group(named)
        return next((group for group in self.groups if not _has_ended(group)), self.groups[-1])

    def next_open(self, group: list[AttemptPart]) -> AttemptPart | None:
        """Return the first of the parts after a group that are open, or before it; else None."""
        at = self.groups.index(group)
        following = [*self.groups[at + 1 :], *self.groups[:at]]
        return next((one[0] for one in following if not _has_ended(one)), None)

    @property
    def is_finished(self) -> bool:
        """Whether every part has ended."""
        return _has_ended(self.places)

    def answer(self, place: AttemptPart, values: list[str]) -> None:
        """Grade the fields of a part; nothing happens if it has ended.

        A field that was left out costs no try: Enter sends all of them from any of them. Where all
        are blank that is said, unless they were sent along with those of another part.
        """
        typed = join_fields(place.part.field.control, values, place.part.field.marks)
        place.progress.values = values
        if place.is_finished or (not typed and len(self.find_group(place)) > 1):
            return
        if not _is_fully_filled(place.part, values):
            place.verdict, place.progress.asked_back = HALF, typed or BLANK
            return
        feedback = place.task.answer(typed)
        place.verdict = feedback.verdict
        place.progress.asked_back = typed if feedback.then is NextStep.ASK_BACK else ""

    def save_state(self) -> tuple[OutcomeRecord, ...]:
        """Write the progress into the attempt; return the outcomes of parts that just ended."""
        before = self.attempt.state.get("ended", [])
        ended = [place for place in self.places if place.is_finished]
        self.attempt.state = {
            "parts": {p.name: msgspec.to_builtins(p.progress) for p in self.places},
            "ended": [place.name for place in ended],
        }
        if self.is_finished and self.attempt.ended is None:
            self.attempt.ended = time.time()
        return tuple(self._build_review_event(place) for place in ended if place.name not in before)

    @property
    def states(self) -> list[PartState]:
        """Return the state of each part, in order."""
        return [place.task.state for place in self.places]

    def _build_review_event(self, place: AttemptPart) -> OutcomeRecord:
        """Return the outcome of a part, for progress."""
        return outcome_record(self.attempt, self.made.topic, place.part.label, place.task.state)


def _has_ended(group: list[AttemptPart]) -> bool:
    """Return whether all of some parts have ended."""
    return all(place.is_finished for place in group)


def _is_fully_filled(part: PartView, values: list[str]) -> bool:
    """Return whether every field of a part is filled."""
    return is_complete(part.field.control, values, part.field.marks)
