"""How a budget of grey levels is spent: where it saves most time."""

from __future__ import annotations

from collections.abc import Iterator

from quizgen.camera.chain import EXACT, SKIP, Chain
from quizgen.camera.decision import Unit
from quizgen.camera.effect import same_error

Costs = list[dict[str, float]]
"""Of each effect, by the way it is made, ms."""
Choice = dict[int, str]
"""What is made of each effect, by its place; what is not there is exact."""
Way = tuple[Unit, str]
"""What else may be made of the members of a unit."""


def spend(chain: Chain, units: tuple[Unit, ...], costs: Costs, budget: float) -> Choice:
    """Take the affordable choice that saves most per grey level, again and again."""
    choice = {i: EXACT if unit.fixed else SKIP for unit in units for i in unit.members}
    free = [unit.members for unit in units if not unit.fixed]
    # the bounds of what comes last are cheaper, and mostly too large
    hopeless = any(chain.hopeless(members, SKIP, budget) for members in reversed(free))
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
    ways = [(unit, made) for unit in units if not unit.fixed for made in unit.choices[1:]]
    now = {i: made for i, made in choice.items() if made != EXACT}
    again = True
    while again:
        possible = list(_affordable(chain, ways, costs, now, budget))
        more = _greedily(chain, possible, costs, now, budget)
        again, now = _opens_more(chain, now, more), more
    return {**dict.fromkeys(choice, EXACT), **now}


def _greedily(
    chain: Chain, possible: list[Way], costs: Costs, choice: Choice, budget: float
) -> Choice:
    """The affordable choice that saves most per grey level, again and again."""
    everything = _cheapest(possible, costs, choice)
    if chain.dn(everything) <= budget:
        return everything
    while True:
        now, best, most = chain.dn(choice), choice, 0.0
        for way in possible:
            saved = _saved(way, costs, choice)
            if saved <= 0.0:
                continue
            trial = _with(choice, way)
            error = chain.dn(trial)
            if error <= budget:
                score = saved / (max(error - now, 0.0) + 1e-6)
                if score > most:
                    best, most = trial, score
        if not most:
            return choice
        choice = best


def _with(choice: Choice, way: Way) -> Choice:
    return {**choice, **dict.fromkeys(way[0].members, way[1])}


def _saved(way: Way, costs: Costs, choice: Choice) -> float:
    """Time that another choice saves, ms; none if it is the same."""
    (unit, made), saved = way, 0.0
    for i in unit.members:
        now = choice.get(i, EXACT)
        if now != made:
            saved += costs[i][now] - costs[i][made]
    return saved


def _cheapest(possible: list[Way], costs: Costs, choice: Choice) -> Choice:
    """What takes least time of all that is possible."""
    for way in possible:
        if _saved(way, costs, choice) > 0.0:
            choice = _with(choice, way)
    return choice


def _affordable(
    chain: Chain, ways: list[Way], costs: Costs, choice: Choice, budget: float
) -> Iterator[Way]:
    """Choices that the budget allows beside those already made."""
    closed = chain.floor(choice) > budget
    for way in ways:
        members, made = way[0].members, way[1]
        if choice.get(members[0]) == made or (closed and chain.arrives(members[0], made)):
            continue
        if chain.hopeless(members, made, budget):
            continue
        if _saved(way, costs, choice) > 0.0 and chain.dn(_with(choice, way)) <= budget:
            yield way


def _opens_more(chain: Chain, before: Choice, now: Choice) -> bool:
    """Whether something is newly left out that makes errors larger, such as a converter."""
    newly = [i for i, made in now.items() if made == SKIP != before.get(i)]
    known = any(chain.present[i].carried is not same_error for i in newly)
    return known and any(chain.enlarges(i) for i in newly)
