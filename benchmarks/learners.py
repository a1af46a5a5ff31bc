"""Does the plan gain points, and is its range honest? ``uv run python benchmarks/learners.py``.

Simulated learners of two makes that the model does not know practise for an evening by several
policies. *Smooth*: two abilities (sums, facts), and a strength for each formula, trap, topic, kind
and template; the weakest formula counts half. *Steps*: each formula, trap and template is known or
not. Both slip, guess, forget by a power law, learn less from what comes again soon, and find some
templates harder than the bank says. How fast they learn is assumed, not measured on students: gains
scale with it, ratios and coverage hardly do.

Prints the gain in points of 10 by the next morning for each policy, the score's range after 10
answers beside what one sitting really brings, each mean with its standard error, and what the
project holds itself to; exit code 1 if a line is missed. ``--learners N`` (default 48 of each of
four populations and both makes).
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

import fsrs
import numpy as np

from quizgen.bank.bank import builtin_bank
from quizgen.practice.ability import read_practice_items
from quizgen.practice.exam_plan import ExamPlan, read_exam_goal
from quizgen.practice.scheduler import DAY
from quizgen.practice.session_state import Attempt

BANK = builtin_bank()
ITEMS = read_practice_items(BANK)
GOAL = read_exam_goal(BANK)
PLACE = {item.name: place for place, item in enumerate(ITEMS)}
TRAPS = [
    tuple(one for one in BANK.rules(item.name).covers if one.startswith("TR")) for item in ITEMS
]
START, EXAM = 20_000.0, 20_000.6
"""Days since 1970: the evening begins, the exam is the next morning."""
POPULATIONS = {"weak": (-1.5, 0.6), "mixed": (-0.3, 1.1), "strong": (1.2, 0.6),
               "crammer": (-0.8, 0.9)}  # fmt: skip
STRENGTH = {"template": 0.7, "formula": 0.8, "trap": 0.5, "topic": 0.5, "kind": 0.35}
AMOUNT = {"template": 0.75, "formula": 0.45, "trap": 0.3, "topic": 0.07, "kind": 0.05}
CAP = {"template": 2.2, "formula": 1.6, "trap": 1.0, "topic": 0.8, "kind": 0.4}
HARDER = {"A": -0.5, "B": 0.0, "C": 0.5, "D": 0.9}
SUMS = frozenset({"number", "quantity", "table", "point", "angle", "expression", "witness"})
FORM = 0.6
"""Standard deviation of how well one question goes on the same knowledge."""
GAUSS = ((-math.sqrt(3), 1 / 6), (0.0, 2 / 3), (math.sqrt(3), 1 / 6))
"""Three points that integrate over it."""

Concept = tuple[str, object]


def logistic(x: float) -> float:
    """Return the chance that belongs to a logit."""
    return 1 / (1 + math.exp(-max(-30.0, min(30.0, x))))


@dataclass
class Memory:
    """What a learner was taught of one concept: how much, when last, and how long it lasts."""

    taught: float = 0.0
    last: float = START
    lasts: float = 1.0
    known: bool = False
    forgets: float = 0.5


@dataclass
class World:
    """What all learners of a world share and no model knows: how hard things really are."""

    template: np.ndarray
    part: list[np.ndarray]

    @classmethod
    def draw(cls, rng: np.random.Generator) -> World:
        """Return a random world."""
        return cls(rng.normal(0, 0.6, len(ITEMS)),
                   [rng.normal(0, 0.5, len(item.parts)) for item in ITEMS])  # fmt: skip


@dataclass
class SimulatedLearner:
    """Somebody who practises: ``make`` is ``smooth`` or ``steps``."""

    make: str
    rng: np.random.Generator
    world: World
    population: str
    speed: float = 1.0
    memories: dict[Concept, Memory] = field(default_factory=dict)
    born: dict[Concept, float] = field(default_factory=dict)
    seen: dict[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Draw what the learner is like."""
        mean, spread = POPULATIONS[self.population]
        general = self.rng.normal(mean, spread)
        self.sums, self.facts = general + self.rng.normal(0, 0.5, 2)
        self.rate = self.speed * math.exp(self.rng.normal(0, 0.4))
        self.slips, self.guesses = self.rng.beta(2, 30), self.rng.beta(4, 1.5)
        hurry = 0.85 if self.population == "crammer" else 1.0
        self.pace = math.exp(self.rng.normal(0.1, 0.3)) * hurry

    @property
    def general(self) -> float:
        """Return the mean of both abilities."""
        return float(self.sums + self.facts) / 2

    def memory(self, concept: Concept) -> Memory:
        """Return what is known of a concept, drawn when it is first met."""
        if concept not in self.memories:
            strength = self.born[concept] = float(self.rng.normal(0, STRENGTH[concept[0]]))
            base = 0.6 if self.population == "crammer" else 1.0
            found = Memory(lasts=0.7 * base * math.exp(self.rng.normal(0, 0.4)))
            found.known = bool(self.rng.random() < logistic(1.3 * strength + self.general))
            found.forgets = 0.0 if found.known else float(self.rng.random())
            self.memories[concept] = found
        return self.memories[concept]

    def strength(self, concept: Concept, day: float) -> float:
        """Return the logits of a concept on a day."""
        memory = self.memory(concept)
        return self.born[concept] + memory.taught * self.remembered(memory, day)

    @staticmethod
    def remembered(memory: Memory, day: float) -> float:
        """Return the share of what was taught that is still there."""
        return 1 / (1 + 0.11 * max(day - memory.last, 0.0) / memory.lasts)

    def knows(self, concept: Concept, day: float) -> bool:
        """Return whether a concept is known on a day, in the world of steps."""
        memory = self.memory(concept)
        return memory.known and self.remembered(memory, day) > memory.forgets

    def formulas(self, place: int) -> list[Concept]:
        """Return the formulas that a template needs; its topic if there is none."""
        item = ITEMS[place]
        return [("formula", one) for one in item.formulas] or [("topic", item.topic)]

    def traps(self, place: int) -> list[Concept]:
        """Return the traps of a template; its topic if there is none."""
        return [("trap", one) for one in TRAPS[place]] or [("topic", ITEMS[place].topic)]

    def blend(self, concepts: list[Concept], day: float) -> float:
        """Return half the mean strength and half that of the weakest."""
        found = [self.strength(one, day) for one in concepts]
        return 0.5 * float(np.mean(found)) + 0.5 * min(found)

    def chances(self, place: int, day: float, form: float, fresh: bool = False) -> np.ndarray:
        """Return the chance of each part of a template; ``fresh``: one never seen, as hard."""
        item, own = ITEMS[place], ("template", place)
        guessed = np.array([part.guessed for part in item.parts])
        harder = HARDER[item.tier] + self.world.template[place]
        if self.make == "steps":
            needed = [*self.formulas(place), self.traps(place)[0]]
            share = float(np.mean([self.knows(one, day) for one in needed]))
            memory = self.memory(own)
            mine = (memory.known and memory.forgets == 0) if fresh else self.knows(own, day)
            level = 7 * (0.75 * share + 0.25 * mine - 0.62) + 0.6 * (self.general - harder) + form
            known = np.full(len(guessed), logistic(level))
        else:
            sums = sum(share for kind, share in item.kinds.items() if kind in SUMS)
            level = sums * self.sums + (1 - sums) * self.facts - harder + form
            level += self.blend(self.formulas(place), day)
            level += 0.5 * self.blend(self.traps(place), day)
            level += self.strength(("topic", item.topic), day)
            own_strength = self.strength(own, day)
            level += self.born[own] if fresh else own_strength
            kind = float(np.mean([self.strength(("kind", one), day) for one in item.kinds]))
            known = np.array([logistic(level + kind - d) for d in self.world.part[place]])
        return known * (1 - self.slips) + (1 - known) * guessed * self.guesses

    def answer(self, place: int, day: float) -> float:
        """Return the credit of one attempt."""
        total = 0.0
        chances = self.chances(place, day, self.rng.normal(0, FORM))
        for part, chance in zip(ITEMS[place].parts, chances, strict=True):
            luck = self.rng.random(min(part.pieces, 8))
            same = self.rng.random(luck.size) < 0.5  # pieces hang together
            total += part.share * float(np.mean(np.where(same, luck[0], luck) < chance))
        return total

    def study(self, place: int, credit: float, day: float) -> None:
        """Read the solution after an attempt."""
        item = ITEMS[place]
        gap = min(day - self.seen.get(place, -99.0), 99.0) * 1440
        ready = self.blend(self.formulas(place), day) + self.general + 1.5
        ready += self.strength(("topic", item.topic), day)
        ready -= HARDER[item.tier] + self.world.template[place]
        spaced = 1 - 0.65 * math.exp(-gap / 10)
        dose = self.rate * spaced * (0.35 + 0.65 * logistic(ready)) * (0.45 + 0.55 * (1 - credit))
        kinds: list[Concept] = [("kind", one) for one in list(item.kinds)[:1]]
        for concept in [("template", place), *self.formulas(place), *self.traps(place), *kinds]:
            self._learn(concept, dose, credit, day)
        self.seen[place] = day

    def _learn(self, concept: Concept, dose: float, credit: float, day: float) -> None:
        """Learn one concept by a dose."""
        memory, kind = self.memory(concept), concept[0]
        kept = self.remembered(memory, day)
        still = self.knows(concept, day)
        fresh = self.rng.random() < 1 - math.exp(
            -(0.55 if kind == "template" else 0.3) * dose * 1.3
        )
        memory.known = still or bool(fresh)
        if fresh and not still:
            memory.forgets = float(self.rng.random())
        before = memory.taught * kept
        memory.taught = before + AMOUNT[kind] * dose * max(1 - before / CAP[kind], 0.0)
        growth = 1 + 2.5 * (1 - kept) * (1.0 if credit > 0.5 else 0.4)
        memory.lasts, memory.last = min(memory.lasts * growth, 60.0), day

    def minutes(self, place: int, credit: float) -> float:
        """Return how long an attempt with its solution takes."""
        once = ITEMS[place].minutes * self.pace * math.exp(self.rng.normal(0, 0.35))
        return once * (1 + 0.35 * (1 - credit)) + 0.4

    def true_score(self, day: float, fresh: bool = False) -> float:
        """Return the expected points of the exam; ``fresh``: of a sister paper never seen."""
        total = 0.0
        for slot in GOAL.slots:
            for name in slot.templates:
                place = PLACE[name]
                worth = np.array([part.share for part in ITEMS[place].parts])
                for form, weight in GAUSS:
                    got = self.chances(place, day, form * FORM, fresh) @ worth
                    total += slot.points / len(slot.templates) * weight * float(got)
        return total

    def sit(self, day: float) -> float:
        """Return the points of one sitting of the exam."""
        return sum(
            slot.points * self.answer(PLACE[self.rng.choice(slot.templates)], day)
            for slot in GOAL.slots
        )


Chooser = Callable[[list[Attempt], float], str]


def choose_at_random(rng: np.random.Generator) -> Chooser:
    """Return a policy: anything but the last two."""

    def choose(done: list[Attempt], day: float) -> str:
        del day
        latest = {one.template for one in done[-2:]}
        return str(rng.choice([item.name for item in ITEMS if item.name not in latest]))

    return choose


def choose_by_topic(rng: np.random.Generator) -> Chooser:
    """Return a policy: the bank from its first topic to its last, easy before hard."""
    del rng
    ranked = sorted(ITEMS, key=lambda item: (BANK.topics.index(item.topic), item.tier, item.name))
    return lambda done, _day: ranked[len(done) % len(ranked)].name


def choose_in_round(rng: np.random.Generator) -> Chooser:
    """Return a policy: the exam's templates in turn."""
    del rng
    worth = {name: slot.points / len(slot.templates) for slot in GOAL.slots
             for name in slot.templates}  # fmt: skip
    ranked = sorted(worth, key=lambda name: -worth[name] / ITEMS[PLACE[name]].minutes)
    return lambda done, _day: ranked[len(done) % len(ranked)]


def choose_by_reviews(rng: np.random.Generator) -> Chooser:
    """Return a policy: what spaced repetition has due, then new ones of weak topics."""
    scheduler = fsrs.Scheduler(enable_fuzzing=False)
    cards: dict[str, fsrs.Card] = {}
    counted = 0

    def at(day: float) -> datetime:
        return datetime(2024, 10, 4, tzinfo=UTC) + timedelta(days=day - START)

    def choose(done: list[Attempt], day: float) -> str:
        nonlocal counted
        for one in done[counted:]:
            rating = fsrs.Rating.Good if one.credit > 0.999 else fsrs.Rating.Again
            when = at(one.at / DAY)
            card = cards.get(one.template) or fsrs.Card(card_id=0, due=when)
            cards[one.template], _ = scheduler.review_card(card, rating, when)
        counted = len(done)
        latest = done[-1].template if done else ""
        ready = [(card.due, name) for name, card in cards.items() if card.due <= at(day)]
        ready = [one for one in ready if one[1] != latest]
        if ready:
            return min(ready)[1]
        by_topic: dict[str, list[float]] = {}
        for one in done:
            topic = ITEMS[PLACE[one.template]].topic
            by_topic.setdefault(topic, []).append(float(one.credit > 0.999))
        unseen = [item for item in ITEMS if item.name not in cards]
        for topic in sorted(by_topic, key=lambda name: float(np.mean(by_topic[name])))[:3]:
            weak = [i.name for i in unseen if i.topic == topic and np.mean(by_topic[topic]) < 1]
            if weak:
                return str(rng.choice(weak))
        return str(rng.choice([item.name for item in unseen]))

    return choose


def choose_by_plan(rng: np.random.Generator) -> Chooser:
    """Return the policy of the project."""
    del rng
    return lambda done, day: make_plan(done, day).choose_next()


def make_plan(done: Iterable[Attempt], day: float) -> ExamPlan:
    """Return the plan of somebody with these attempts."""
    return ExamPlan(GOAL, ITEMS, done, day * DAY, EXAM * DAY)


POLICIES = {
    "random": choose_at_random, "agenda of due cards": choose_by_reviews,
    "topic order": choose_by_topic, "trial round": choose_in_round, "plan": choose_by_plan,
}  # fmt: skip


def practise(learner: SimulatedLearner, choose: Chooser, minutes: float, stops: set[float]
             ) -> tuple[list[Attempt], dict[float, tuple[float, float]]]:  # fmt: skip
    """Let somebody practise; return the attempts, and both true scores at each stop (minutes)."""
    done: list[Attempt] = []
    spent, found = 0.0, dict[float, tuple[float, float]]()
    for stop in sorted(stops | {minutes}):
        while spent < stop - 1.5:
            place = PLACE[choose(done, START + spent / 1440)]
            credit = learner.answer(place, START + spent / 1440)
            spent += learner.minutes(place, credit)
            learner.study(place, credit, START + spent / 1440)
            done.append(Attempt(ITEMS[place].name, credit, (START + spent / 1440) * DAY))
        found[stop] = learner.true_score(EXAM), learner.true_score(EXAM, fresh=True)
    return done, found


def answer_some(learner: SimulatedLearner, count: int) -> tuple[list[Attempt], float]:
    """Let somebody answer some questions by the plan; return the attempts and the day after."""
    done: list[Attempt] = []
    day = START
    while len(done) < count:
        place = PLACE[make_plan(done, day).choose_next()]
        credit = learner.answer(place, day)
        day += learner.minutes(place, credit) / 1440
        learner.study(place, credit, day)
        done.append(Attempt(ITEMS[place].name, credit, day * DAY))
    return done, day


missed: list[str] = []


def hold(name: str, values: np.ndarray, least: float, most: float = math.inf) -> None:
    """Print a mean with its standard error beside what is promised of it."""
    value, error = float(values.mean()), float(values.std() / math.sqrt(len(values)))
    good = least <= value <= most
    if not good:
        missed.append(name)
    bound = f">= {least}" if most == math.inf else f"{least} to {most}"
    print(f"{name:58} {value:6.2f} ± {error:4.2f}   {bound}{'' if good else '   MISSED'}")


def main() -> int:
    """Print everything; return 1 if something promised is missed."""
    parser = argparse.ArgumentParser(description="Simulated learners practise for an evening.")
    parser.add_argument("--learners", type=int, default=48)
    count = parser.parse_args().learners
    who = [(make, population, number) for make in ("smooth", "steps")
           for population in POPULATIONS for number in range(count)]  # fmt: skip
    gains: dict[str, np.ndarray] = {}
    for name, policy in POLICIES.items():
        rows = []
        for make, population, number in who:
            learner = _make_learner(make, population, number)
            start = learner.true_score(EXAM), learner.true_score(EXAM, fresh=True)
            chooser = policy(np.random.default_rng(number))
            found = practise(learner, chooser, 120.0, {60.0})[1]
            rows.append([after - before for stop in (60.0, 120.0)
                         for after, before in zip(found[stop], start, strict=True)])  # fmt: skip
        gains[name] = np.array(rows)
        shown = "  ".join(f"{value:+.2f}" for value in gains[name].mean(axis=0))
        print(f"{name:22} trial, sister at 60 and 120 min: {shown}", flush=True)
    for other, column, least in (("random", 0, 1.0), ("agenda of due cards", 0, 1.0),
                                 ("topic order", 0, 0.7), ("topic order", 2, 1.0),
                                 ("trial round", 0, -0.15), ("trial round", 1, 0.05)):  # fmt: skip
        what = ("trial, 60 min", "sister, 60 min", "trial, 120 min")[column]
        difference = gains["plan"][:, column] - gains[other][:, column]
        hold(f"plan over {other} ({what})", difference, least)
    inside, errors = [], []
    for make, population, number in who:
        learner = _make_learner(make, population, 1000 + number)
        done, day = answer_some(learner, 10)
        plan = make_plan(done, day)
        estimate = plan.estimate()
        draws = plan.model.draw_scores(plan._slots, day)  # noqa: SLF001 - before rounding outwards
        low, high = np.percentile(draws, [10, 90])
        inside.append(low - 1e-9 <= learner.sit(day) <= high + 1e-9)
        assert estimate is not None
        assert estimate.expected is not None
        errors.append(abs(estimate.expected - learner.true_score(day)))
    hold("of 100 sittings within the range, after 10 answers", 100 * np.array(inside), 75, 88)
    hold("mean error of the expected score, after 10 answers", np.array(errors), 0.0, 1.1)
    return bool(missed)


def _make_learner(make: str, population: str, number: int) -> SimulatedLearner:
    """Return a learner of a number, the same for every policy, in one of ten worlds."""
    seed = [number, list(POPULATIONS).index(population), make == "steps"]
    world = World.draw(np.random.default_rng(number % 10))
    return SimulatedLearner(make, np.random.default_rng(seed), world, population)


if __name__ == "__main__":
    sys.exit(main())
