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
        possible = list(_affordable(chain, units, costs, choice, budget))
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
    """The affordable choice that saves most per grey level, again and again."""
    everything = _cheapest(possible, costs, choice)
    if chain.dn(everything) <= budget:
        return everything
    while True:
        now, best, most = chain.dn(choice), choice, 0.0
        for unit, made in possible:
            saved = _saved(unit, made, costs, choice)
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


def _saved(unit: Unit, made: str, costs: Costs, choice: Choice) -> float:
    """Time that another choice saves, ms; none if it is the same."""
    saved = 0.0
    for i in unit.members:
        if choice[i] != made:
            saved += costs[i][choice[i]] - costs[i][made]
    return saved


def _cheapest(possible: list[tuple[Unit, str]], costs: Costs, choice: Choice) -> Choice:
    """What takes least time of all that is possible."""
    for unit, made in possible:
        if _saved(unit, made, costs, choice) > 0.0:
            choice = {**choice, **dict.fromkeys(unit.members, made)}
    return choice


def _affordable(
    chain: Chain, units: tuple[Unit, ...], costs: Costs, choice: Choice, budget: float
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
            if chain.hopeless(unit.members, made, budget):
                continue
            if _saved(unit, made, costs, choice) > 0.0:
                trial = {**choice, **dict.fromkeys(unit.members, made)}
                if chain.dn(trial) <= budget:
                    yield unit, made


def _opens_more(chain: Chain, before: Choice, now: Choice) -> bool:
    """Whether something is newly left out that makes errors larger, such as a converter."""
    newly = [index for index, made in now.items() if made == SKIP != before[index]]
    known = any(chain.present[index].carried is not same_error for index in newly)
    return known and any(chain.enlarges(index) for index in newly)
