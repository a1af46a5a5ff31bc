"""How well a learner would do at each template now: a Gaussian over abilities, learnt by attempts.

The ability at a template is a logit. Before any attempt all are alike but for their tier, and
correlated by what templates share: formulas, topic, answer kinds. An attempt moves all of them by
an extended Kalman update, then adds what its solution taught; what was taught fades with time.
Nothing of this is stored: a learner's attempts are replayed, so constants may change.

Sources: Elo-like models of practice as Gaussians in Pelánek, "Bayesian knowledge tracing, logistic
models, and beyond", UMUAI 27 (2017); forgetting as in FSRS, see ``scheduler``. The constants were
chosen with simulated learners of another make, which ``benchmarks/learners.py`` has.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Any, TypeAlias

import msgspec
import numpy as np
from numpy.typing import NDArray

from quizgen.bank.bank import Bank
from quizgen.bank.rules import Rules, part_points
from quizgen.practice.scheduler import DAY
from quizgen.practice.session_state import Attempt

Floats: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]

GUESSED: Mapping[str, float] = {
    "tf": 0.5, "multi": 0.45, "match": 0.2, "order": 0.2, "gap": 0.1, "sketch": 0.1, "rubric": 0.1,
    "code": 0.05, "table": 0.05, "point": 0.03,
}  # fmt: skip
"""Share of a part's points that is got by guessing, by kind; that of ``choice`` follows from it."""
RARELY_GUESSED = 0.02
MEAN, BY_TIER = -0.3, {"A": 0.5, "B": 0.0, "C": -0.4, "D": -0.8}
COMMON, BY_TOPIC, BY_FORMULA, BY_KIND, OWN = 3.0, 0.3, 0.5, 0.15, 1.0
"""Variances of the ability: what all templates have in common, and what those that are alike do."""
SLIP = 0.05
"""Chance of a wrong answer where the right one is known."""
TAUGHT_BY_WRONG, TAUGHT_BY_RIGHT = 0.6, 0.3
"""Logits that an attempt with its solution adds, by its credit."""
SOON, SOON_MINUTES = 0.7, 12.0
"""Share that is lost where the template was asked just now, and how fast that passes."""
SHARED_BY_FORMULA, SHARED_BY_TOPIC = 0.45, 0.08
"""Share of what is taught that reaches templates with the same formulas, with the same topic."""
DAILY_NOISE, DRIFT = 0.7, 0.05
"""Standard deviation of how well a day goes; variance that a day adds."""
TRIALS = 1.2
"""Independent tries that the credit of a question is worth."""
FIRST_STABILITY = (0.5, 3.0)
"""Days in which a tenth is forgotten after a first attempt: a wrong one, a right one."""
NO_STABILITY, LEAST_STABILITY, MOST_STABILITY = 2.0, 0.3, 200.0
RIGHT_FROM = 0.6
"""Credit from which an attempt counts as right for forgetting."""
NEVER = -1e9


class PartWeight(msgspec.Struct, frozen=True):
    """A part as the model sees it: share of the points, pieces, share got by guessing."""

    share: float
    pieces: int
    guessed: float


class PracticeItem(msgspec.Struct, frozen=True):
    """A template as the model sees it.

    Parameters
    ----------
    name, topic, tier : str
    formulas : tuple of str
        Items of the curriculum's group ``formulas`` that it covers.
    kinds : mapping
        Answer kind to its share of the points.
    minutes : float
    parts : tuple of PartWeight
    beyond : bool
        Whether nothing of it is in the curriculum proper.
    """

    name: str
    topic: str
    tier: str
    formulas: tuple[str, ...]
    kinds: dict[str, float]
    minutes: float
    parts: tuple[PartWeight, ...]
    beyond: bool = False

    @property
    def guess_share(self) -> float:
        """Return the share of the points that somebody gets who knows nothing."""
        return sum(part.share * part.guessed for part in self.parts)


@cache
def read_practice_items(bank: Bank) -> tuple[PracticeItem, ...]:
    """Return every template of a bank as the model sees it, in alphabetical order."""
    curriculum = bank.curriculum
    formulas = frozenset(curriculum.inventory.get("formulas", ()))
    return tuple(
        _read_item(name, bank.rules(name), float(bank.minutes(name)), formulas, curriculum.beyond)
        for name in bank.template_paths
    )


def _read_item(
    name: str, rules: Rules, minutes: float, formulas: frozenset[str], beyond: Sequence[str]
) -> PracticeItem:
    """Return one template as the model sees it."""
    points = [*part_points(rules).values()]
    whole = sum(points)
    kinds: dict[str, float] = {}
    for part, worth in zip(rules.part, points, strict=True):
        kind = str(part.answer["kind"])
        kinds[kind] = kinds.get(kind, 0.0) + worth / whole
    return PracticeItem(
        name,
        rules.topic,
        rules.tier,
        tuple(item for item in rules.covers if item in formulas),
        kinds,
        minutes,
        tuple(
            PartWeight(worth / whole, _count_pieces(part.answer), _guess_share(part.answer))
            for part, worth in zip(rules.part, points, strict=True)
        ),
        rules.beyond or is_past_curriculum(rules.covers, beyond),
    )


def is_past_curriculum(covers: Iterable[str], beyond: Sequence[str]) -> bool:
    """Return whether all that a template covers lies past the curriculum; False if it covers none.

    Parameters
    ----------
    covers : iterable of str
    beyond : sequence of str
        How items past the curriculum begin; a number follows.
    """
    items = tuple(covers)
    return bool(items) and all(_begins_with(item, beyond) for item in items)


def _begins_with(item: str, beginnings: Sequence[str]) -> bool:
    """Return whether an item is one of these beginnings and a number."""
    return any(item.startswith(one) and item[len(one) :].isdecimal() for one in beginnings)


def _count_pieces(answer: Mapping[str, Any]) -> int:
    """Return how many pieces of an answer earn points of their own."""
    for name in ("of", "options", "pairs", "gaps", "steps", "features"):
        listed = answer.get(name)
        if isinstance(listed, (list, tuple, dict)) and listed and answer["kind"] != "choice":
            taken = answer.get("take")
            return taken if isinstance(taken, int) and taken else len(listed)
    return 1


def _guess_share(answer: Mapping[str, Any]) -> float:
    """Return the share of a part's points that somebody gets who knows nothing."""
    kind = str(answer["kind"])
    if kind == "choice":
        taken = answer.get("take")
        return 1 / max(
            2, taken if isinstance(taken, int) and taken else len(answer.get("options", ())) or 4
        )
    return GUESSED.get(kind, RARELY_GUESSED)


def logistic(x: Floats) -> Floats:
    """Return the chance that belongs to a logit."""
    return np.asarray(1 / (1 + np.exp(-np.clip(x, -30, 30))))


class AbilityModel:
    """What is known of one learner: mean and covariance of the ability at every template.

    Parameters
    ----------
    items : sequence of PracticeItem
        Those of the bank.

    Attributes
    ----------
    clock : float
        Time of the last event, in days since 1970.
    seen : array, shape (templates,)
        When each was asked last, in days; ``NEVER`` if it was not.
    """

    def __init__(self, items: Sequence[PracticeItem]) -> None:
        self.items = tuple(items)
        self.places = {item.name: place for place, item in enumerate(self.items)}
        self.minutes = np.array([item.minutes for item in self.items])
        self.guessed = np.array([item.guess_share for item in self.items])
        formulas = self._compare(lambda item: dict.fromkeys(item.formulas, 1.0))
        topics = self._compare(lambda item: {item.topic: 1.0})
        count = len(self.items)
        self._mean = np.array([MEAN + BY_TIER[item.tier] for item in self.items])
        self._covariance = (
            COMMON + BY_TOPIC * topics + BY_FORMULA * formulas + OWN * np.eye(count)
            + BY_KIND * self._compare(lambda item: item.kinds)
        )  # fmt: skip
        self._shared = SHARED_BY_FORMULA * formulas + SHARED_BY_TOPIC * topics
        np.fill_diagonal(self._shared, 1.0)
        self._taught = np.zeros(count)
        self._stability = np.full(count, NO_STABILITY)
        self.seen, self.clock = np.full(count, NEVER), 0.0

    def _compare(self, features: Callable[[PracticeItem], Mapping[str, float]]) -> Floats:
        """Return the cosine between what two templates are made of, for every pair."""
        rows = [features(item) for item in self.items]
        names = sorted({name for row in rows for name in row})
        table = np.array([[row.get(name, 0.0) for name in names] for row in rows])
        table = table.reshape(len(rows), len(names))
        table /= np.maximum(np.linalg.norm(table, axis=1, keepdims=True), 1e-9)
        return np.asarray(table @ table.T)

    def advance_to(self, day: float) -> None:
        """Let time pass until ``day`` (since 1970): what was taught fades, and doubt grows."""
        passed = max(day - self.clock, 0.0) if self.clock else 0.0
        self._taught *= 0.9 ** (passed / self._stability)
        self._covariance[np.diag_indices(len(self.items))] += DRIFT * min(passed, 1.0)
        self.clock = max(self.clock, day)

    def ability(self, day: float | None = None) -> Floats:
        """Return the mean ability at each template on a day, without one now."""
        ahead = 0.0 if day is None else max(day - self.clock, 0.0)
        return np.asarray(self._mean + self._taught * 0.9 ** (ahead / self._stability))

    def variance(self) -> Floats:
        """Return the variance of the ability at each template, that of a day's form included."""
        return np.asarray(self._covariance.diagonal() + DAILY_NOISE**2)

    def expected_credit(self, day: float | None = None) -> Floats:
        """Return the share of the points expected at each template."""
        return mean_credit(self.ability(day), self.variance(), self.guessed)

    def observe(self, attempt: Attempt) -> None:
        """Take an attempt in: what it says of the learner, and what it taught.

        One at a template that the bank does not have, or no longer has, is passed over.
        """
        place = self.places.get(attempt.template)
        if place is None:
            return
        day = attempt.at / DAY
        self.advance_to(day)
        if not attempt.helped:
            self._update(place, attempt.credit)
        if attempt.taught:
            self._teach(place, attempt.credit, day)
        self._remember(place, attempt.credit, day)

    def _update(self, place: int, credit: float) -> None:
        """Move all abilities by the credit of one attempt (extended Kalman filter)."""
        guessed = self.guessed[place]
        known = logistic(self._mean + self._taught)[place]
        span = 1 - SLIP - guessed
        expected, slope = guessed + span * known, max(span * known * (1 - known), 0.06)
        noise = (expected * (1 - expected) + 0.02) / TRIALS + (slope * DAILY_NOISE) ** 2
        column = self._covariance[:, place].copy()
        gain = column * (slope / (slope**2 * column[place] + noise))
        self._mean += gain * (credit - expected)
        self._covariance -= np.outer(gain, slope * column)

    def _teach(self, place: int, credit: float, day: float) -> None:
        """Add what an attempt with its solution taught, here and where it is of use."""
        gained = self.dose(np.array(credit), day)[place] * self._shared[place]
        self._taught += gained
        self._covariance += np.outer(gained, gained)

    def dose(self, credit: Floats, day: float) -> Floats:
        """Return the logits that an attempt at each template teaches; less soon after the last."""
        since = np.clip(day - self.seen, 0, 9) * 1440 / SOON_MINUTES
        whole = TAUGHT_BY_WRONG * (1 - credit) + TAUGHT_BY_RIGHT * credit
        return np.asarray(whole * (1 - SOON * np.exp(-since)))

    def _remember(self, place: int, credit: float, day: float) -> None:
        """Note when a template was asked, and for how long what it taught lasts."""
        right, old = credit > RIGHT_FROM, self._stability[place]
        gap = min(max(day - self.seen[place], 0.0), 60.0)
        grown = old * (1 + 6 * (1 - 0.9 ** (gap / old)) if right else 0.7)
        known = self.seen[place] > NEVER / 10
        self._stability[place] = (
            min(max(grown, LEAST_STABILITY), MOST_STABILITY) if known else FIRST_STABILITY[right]
        )
        self.seen[place] = day

    def expect_attempt(self, place: int) -> float:
        """Let an attempt happen as it is expected to; return the minutes that it takes."""
        credit = float(self.expected_credit()[place])
        minutes = float(self.working_minutes(self.expected_credit())[place])
        day = self.clock + minutes / 1440
        self._taught += self.dose(np.array(credit), self.clock)[place] * self._shared[place]
        self.seen[place], self.clock = day, day
        return minutes

    def working_minutes(self, credit: Floats) -> Floats:
        """Return the minutes that each template takes with its solution read, by its credit."""
        return np.asarray(self.minutes * (1.3 - 0.3 * credit) + 0.5)

    def gains(self, goal: Floats, day: float) -> Floats:
        """Return what asking each template now adds to a goal on a day, per minute.

        Parameters
        ----------
        goal : array, shape (templates,)
            Points that each template is worth.
        day : float
            When they are to be earned, in days since 1970.
        """
        use = np.flatnonzero(goal)
        credit = self.expected_credit()
        ability, variance, guessed = self.ability(day)[use], self.variance()[use], self.guessed[use]
        taught = self.dose(credit, self.clock)[:, None] * self._shared[:, use]
        after = mean_credit(ability + taught, variance, guessed)
        before = mean_credit(ability, variance, guessed)
        return np.asarray((after - before) @ goal[use] / self.working_minutes(credit))

    def draw_scores(
        self, slots: Sequence[tuple[float, Sequence[int]]], day: float, count: int = 400
    ) -> Floats:
        """Return random scores of one sitting, luck and the day's form included.

        Parameters
        ----------
        slots : sequence of (float, sequence of int)
            Points of each question, and the places of the templates that it may be.
        day : float
        count : int
            How many scores; the same ones for the same learner, so that a page does not flicker.

        Returns
        -------
        array, shape (count,)
        """
        rng = np.random.default_rng(1)
        use = sorted({place for _, places in slots for place in places})
        within = self._covariance[np.ix_(use, use)] + 1e-4 * np.eye(len(use))
        draws = rng.standard_normal((count, len(use))) @ np.linalg.cholesky(within).T
        ability = self.ability(day)[use] + draws
        ability += DAILY_NOISE * rng.standard_normal(ability.shape)
        total = np.zeros(count)
        for points, places in slots:
            chosen = rng.integers(len(places), size=count)
            for number, place in enumerate(places):
                got = _draw_credit(self.items[place], ability[:, use.index(place)], rng)
                total += points * got * (chosen == number)
        return total


def _draw_credit(item: PracticeItem, ability: Floats, rng: np.random.Generator) -> Floats:
    """Return a random share of a question's points for each ability."""
    got = np.zeros(ability.shape)
    for part in item.parts:
        chance = part.guessed + (1 - SLIP - part.guessed) * logistic(ability)
        pieces = part.pieces if part.pieces > 2 else 1  # two mostly hang together
        got += part.share * rng.binomial(pieces, chance) / pieces
    return got


def mean_credit(ability: Floats, variance: Floats, guessed: Floats) -> Floats:
    """Return the expected share of the points where the ability is Gaussian.

    The mean of the logistic function of a Gaussian is nearly that of a flatter one at its mean.
    """
    known = logistic(ability / np.sqrt(1 + 0.39 * variance))
    return np.asarray(guessed + (1 - SLIP - guessed) * known)
