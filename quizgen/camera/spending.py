"""How a budget of grey levels is spent: where it saves most time."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.camera.chain import EXACT, SKIP, Chain
from quizgen.camera.decision import Unit
from quizgen.camera.effect import same_error

Costs = list[dict[str, float]]
"""Of each effect, by the way it is made, ms."""
Choice = dict[int, str]
"""What is made of each effect, by its place."""


def spend(chain: Chain, units: tuple[Unit, ...], costs: Costs, budget: float) -> Choice:
    """Take the affordable choice that saves most per grey level, again and again."""
    choice = {i: EXACT if unit.fixed else SKIP for unit in units for i in unit.members}
    free = [unit.members for unit in units if not unit.fixed]
    hopeless = any(chain.hopeless(members, SKIP, budget) for members in free)
    if not hopeless and chain.dn(choice) <= budget:
        return choice
    return spend_more(chain, units, costs, dict.fromkeys(choice, EXACT), budget)


def spend_more(
    chain: Chain,
    units: tuple[Unit, ...],
    costs: Costs,
    choice: Choice,
    budget: float,
) -> Choice:
    """The same, beginning with what is already left out."""
    while True:
        possible = list(_affordable(chain, units, choice, budget))
        more = _greedily(chain, possible, costs, choice, budget)
        again, choice = _opens_more(chain, choice, more), more
        if not again:
            return choice


def _greedily(
    chain: Chain,
    possible: list[tuple[Unit, str]],
    costs: Costs,
    choice: Choice,
    budget: float,
) -> Choice:
    while True:
        now, best, most = chain.dn(choice), choice, 0.0
        for unit, made in possible:
            if made == choice[unit.members[0]]:
                continue
            saved = sum(costs[i][choice[i]] - costs[i][made] for i in unit.members)
            if saved <= 0.0:
                continue
            trial = {**choice, **dict.fromkeys(unit.members, made)}
            error = chain.dn(trial)
            if error <= budget:
                score = saved / (max(error - now, 0.0) + 1e-6)
                if score > most:
                    best, most = trial, score
        if not most:
            return choice
        choice = best


def _affordable(
    chain: Chain, units: tuple[Unit, ...], choice: Choice, budget: float
) -> Iterator[tuple[Unit, str]]:
    """Choices that the budget allows beside those already made."""
    least_fits = any(choice.values())  # asked once: what has opened something makes more fit
    for unit in units:
        if unit.fixed:
            continue
        yield unit, EXACT
        if not least_fits and chain.present[unit.members[-1]].stage == "optics":
            least_fits = chain.least(unit.members[-1], choice) <= budget
            if not least_fits:
                continue
        for made in unit.choices[1:]:
            if not chain.hopeless(unit.members, made, budget):
                trial = {**choice, **dict.fromkeys(unit.members, made)}
                if chain.dn(trial) <= budget:
                    yield unit, made


def _opens_more(chain: Chain, before: Choice, now: Choice) -> bool:
    """Whether something is newly left out that makes errors larger, such as a converter."""
    newly = [index for index, made in now.items() if made == SKIP != before[index]]
    known = any(chain.present[index].carried is not same_error for index in newly)
    return known and any(chain.enlarges(index) for index in newly)
