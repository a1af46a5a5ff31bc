"""What to practise until an exam: first round its questions, then what gains most per minute.

Of the policies tried on simulated learners (``benchmarks/learners.py``), going round the templates
of the exam gains nearly all; choosing greedily after that gains on questions never seen, too.
"""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterable, Sequence
from functools import cache
from typing import NamedTuple

import msgspec
import numpy as np

from quizgen.bank.bank import Bank
from quizgen.paper.blueprint import EVERYTHING, MOCK, TRIAL, Blueprint, SlotRule, load_blueprint
from quizgen.practice.ability import (
    AbilityModel,
    Flags,
    Floats,
    PracticeItem,
    read_practice_items,
)
from quizgen.practice.scheduler import DAY
from quizgen.practice.session_state import Attempt

ROUND_AGAIN = 1.5
"""Days after which a question of the exam is asked once more in the round."""
OF_EXAM, OF_ALL = 0.7, 0.3
"""What is worked for after the round: mostly the exam, partly all that the notes hold."""
SPACING = 2
"""A template comes back after this many others at the earliest."""
TOO_SHORT = 1.5
"""Minutes in which no question is begun."""
FROM_RANGE, FROM_NUMBER = 5, 10
"""Attempts from which a range of the score is shown, and from which a number."""


class ExamSlot(msgspec.Struct, frozen=True):
    """A question of the exam: its points, and the templates that may stand there."""

    points: float
    templates: tuple[str, ...]


class ExamGoal(msgspec.Struct, frozen=True):
    """The exam that is practised for, and what a longer one asks.

    Parameters
    ----------
    name : str
        Of the blueprint.
    slots : tuple of ExamSlot
    wider : tuple of ExamSlot
        Of the long mock, so that what the exam may ask instead is not forgotten.
    """

    name: str
    slots: tuple[ExamSlot, ...]
    wider: tuple[ExamSlot, ...]

    @property
    def points(self) -> float:
        """Return what the exam is worth."""
        return sum(slot.points for slot in self.slots)

    @property
    def templates(self) -> frozenset[str]:
        """Return the templates that the exam may ask."""
        return frozenset(name for slot in self.slots for name in slot.templates)


class ScoreEstimate(msgspec.Struct, frozen=True):
    """What one sitting of the exam would bring today.

    Parameters
    ----------
    expected : float, optional
        Points; None before there are ``FROM_NUMBER`` attempts.
    low, high : float
        Range that holds in 8 of 10 sittings, outwards to half points.
    of : float
        Points of the whole exam.
    """

    expected: float | None
    low: float
    high: float
    of: float


@cache
def read_exam_goal(bank: Bank) -> ExamGoal:
    """Return what a bank is practised for: its trial exam, else its mock, else all topics."""
    items = read_practice_items(bank)
    names = [name for name in (TRIAL, MOCK) if name in bank.blueprints]
    exam = _read_slots(load_blueprint(names[0], bank), items) if names else ()
    wider = _read_slots(load_blueprint(names[-1], bank), items) if names else ()
    if not exam:
        inside = tuple(item.name for item in items if not item.beyond)
        exam = wider = tuple(ExamSlot(1.0, (name,)) for name in inside or [i.name for i in items])
    return ExamGoal(names[0] if names else EVERYTHING, exam, wider or exam)


def _read_slots(blueprint: Blueprint, items: Sequence[PracticeItem]) -> tuple[ExamSlot, ...]:
    """Return the questions of a blueprint with their points; equal shares where it gives none."""
    rules = [rule for rule in blueprint.slot for _ in range(rule.count)]
    share = (blueprint.total or len(rules)) / max(1, len(rules))
    slots = (ExamSlot(rule.points or share, _matching_names(rule, items)) for rule in rules)
    return tuple(slot for slot in slots if slot.templates)


def _matching_names(rule: SlotRule, items: Sequence[PracticeItem]) -> tuple[str, ...]:
    """Return the templates that may fill a slot."""
    return tuple(
        item.name
        for item in items
        if (not rule.templates or item.name in rule.templates)
        and rule.topic in (None, item.topic)
        and rule.tier in (None, item.tier)
        and (rule.templates or not item.beyond)
    )


class PracticeBlock(NamedTuple):
    """What is practised in one go: templates in their order, and the minutes they take."""

    templates: list[str]
    minutes: float


class ExamPlan:
    """The plan of one learner: what comes next, a block of minutes, and the points to expect.

    Parameters
    ----------
    goal : ExamGoal
    items : sequence of PracticeItem
        Of the bank.
    attempts : iterable of Attempt
        The learner's, the earliest first.
    now, exam : float
        Seconds since 1970: this moment, and when the points are to be earned.
    allowed : collection of str, optional
        Templates that may be asked; by default, and where these are more than one topic, those
        beyond the curriculum are left out.
    latest : collection of str
        Templates that were begun last, finished or not: they do not come at once.
    """

    def __init__(  # noqa: PLR0913, PLR0917 - what is planned for, by whom and when
        self,
        goal: ExamGoal,
        items: Sequence[PracticeItem],
        attempts: Iterable[Attempt],
        now: float,
        exam: float,
        allowed: Collection[str] | None = None,
        latest: Collection[str] = (),
    ) -> None:
        self.goal, self.exam = goal, exam / DAY
        self.model = AbilityModel(items)
        self.attempts = tuple(attempts)
        for attempt in self.attempts:
            self.model.observe(attempt)
        self.model.advance_to(now / DAY)
        places = self.model.places
        self._allowed = _find_allowed(items, allowed)
        self._slots = _locate_slots(goal.slots, places)
        self._worth = _spread_points(self._slots, len(items))
        wider = _spread_points(_locate_slots(goal.wider, places), len(items))
        scale = self._worth.sum() / max(wider.sum(), 1e-9)
        self._aim = OF_EXAM * self._worth + OF_ALL * scale * wider
        asked = latest or [one.template for one in self.attempts[-SPACING:]]
        self._latest = [places[name] for name in asked if name in places]

    @property
    def evidence(self) -> int:
        """Return how many attempts say something of what is known."""
        return sum(not one.helped for one in self.attempts)

    @property
    def missing(self) -> int:
        """Return how many more attempts there must be for an estimate."""
        return max(0, FROM_RANGE - self.evidence)

    def choose_next(self) -> str:
        """Return the template to ask now.

        Raises
        ------
        ValueError
            If no template is allowed.
        """
        place = _choose_place(self, self.model, self._latest)
        if place is None:
            raise ValueError("no template may be asked")
        return self.model.items[place].name

    def plan_block(self, minutes: float) -> PracticeBlock:
        """Return what fits into a number of minutes, as if each question went as expected.

        At least one question; it is planned again after every answer.
        """
        ahead, latest, left = copy.deepcopy(self.model), list(self._latest), minutes
        chosen: list[int] = []
        while left > TOO_SHORT or not chosen:
            place = _choose_place(self, ahead, latest, left if chosen else np.inf)
            if place is None:
                break
            left -= ahead.expect_attempt(place)
            chosen.append(place)
            latest = [*latest, place][-SPACING:]
        return PracticeBlock([self.model.items[place].name for place in chosen], minutes - left)

    def estimate(self) -> ScoreEstimate | None:
        """Return the points that the exam would bring today; None before there is evidence."""
        if self.evidence < FROM_RANGE or not self._slots:
            return None
        draws = self.model.draw_scores(self._slots, self.model.clock)
        low, high = np.percentile(draws, [10, 90])
        return ScoreEstimate(
            self.expected_points() if self.evidence >= FROM_NUMBER else None,
            float(np.floor(2 * low) / 2),
            float(min(np.ceil(2 * high) / 2, self.goal.points)),
            self.goal.points,
        )

    def expected_points(self) -> float:
        """Return the mean of the exam's points today, without its luck."""
        return float(self.model.expected_credit() @ self._worth)

    def expected_share(self, slot: ExamSlot) -> float:
        """Return the expected share of the points of one question of the exam."""
        credit = self.model.expected_credit()
        found = [credit[self.model.places[name]] for name in slot.templates]
        return float(np.mean(found))

    def gain_per_minute(self, model: AbilityModel) -> Floats:
        """Return the points that each template brings per minute, those not allowed below all."""
        rates = model.gains(self._aim, max(self.exam, model.clock))
        return np.where(self._allowed, rates, -np.inf)

    def round_places(self, model: AbilityModel) -> list[int]:
        """Return the templates of exam questions that were not asked lately."""
        since = model.clock - ROUND_AGAIN
        return [
            place
            for _, places in self._slots
            for place in places
            if self._allowed[place] and model.seen[place] < since
        ]


def _choose_place(
    plan: ExamPlan, model: AbilityModel, latest: Sequence[int], most: float = np.inf
) -> int | None:
    """Return the template to ask, by the model as it is or as it is expected to be.

    None if none may be asked that takes ``most`` minutes at the most.
    """
    rates = plan.gain_per_minute(model)
    rates[model.working_minutes(model.expected_credit()) > most] = -np.inf
    spaced = rates.copy()
    spaced[list(latest)] = -np.inf
    open_round = [place for place in plan.round_places(model) if np.isfinite(spaced[place])]
    if open_round:
        return max(open_round, key=lambda place: spaced[place])
    best = int(np.argmax(spaced if np.isfinite(spaced).any() else rates))
    return best if np.isfinite(rates[best]) else None


def _find_allowed(items: Sequence[PracticeItem], names: Collection[str] | None) -> Flags:
    """Return which templates may be asked: of a mixed choice those within the curriculum."""
    fits = [item for item in items if names is None or item.name in names]
    inside = {item.name for item in fits if not item.beyond}
    if not inside or len({item.topic for item in fits}) == 1:
        inside = {item.name for item in fits}
    return np.array([item.name in inside for item in items])


def _locate_slots(
    slots: Sequence[ExamSlot], places: dict[str, int]
) -> list[tuple[float, list[int]]]:
    """Return the points of each question and the places of its templates."""
    found = [(slot.points, [places[n] for n in slot.templates if n in places]) for slot in slots]
    return [(points, here) for points, here in found if here]


def _spread_points(slots: Sequence[tuple[float, Sequence[int]]], count: int) -> Floats:
    """Return the points that each template is worth on average."""
    worth = np.zeros(count)
    for points, places in slots:
        worth[list(places)] += points / len(places)
    return worth
