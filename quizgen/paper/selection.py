"""Which templates a paper holds: filling slots, filling a time, and how many papers there are."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cache, partial
from itertools import repeat

from quizgen.bank.bank import Bank
from quizgen.bank.rules import Rules, suggested_minutes
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError, BlueprintError
from quizgen.core.untrusted import error_context
from quizgen.paper.blueprint import EVERYTHING, Blueprint, SlotRule
from quizgen.paper.constraints import (
    Candidate,
    ConstraintSolver,
    explain_infeasible,
    make_candidate,
    paper_minutes,
)
from quizgen.question.figure import coloured

ORDERS = 3
"""Orders in which the places of a demanding blueprint are filled; an impossible one takes all."""
DRAWN = 20
"""Draws by which a template is judged whose figure needs colour for some values alone."""
TRIES = 20
"""Choices of templates until none is used more often than it has numbers."""


def select_templates(bank: Bank, blueprint: Blueprint, seed: int | str) -> list[str]:
    """Names of the templates, in order of the paper.

    Raises
    ------
    BlueprintError
        If no template fits a slot, or the time.
    """
    if blueprint.topic:
        return _fill_minutes(bank, blueprint, seed)
    if blueprint.has_constraints:
        return _as_a_whole(bank, blueprint, seed)
    tries = (_fill_slots(bank, blueprint, f"{seed}/{n}" if n else str(seed)) for n in range(TRIES))
    first = next(tries)
    if not _is_overused(bank, first):
        return first
    return next((chosen for chosen in tries if not _is_overused(bank, chosen)), first)


def _as_a_whole(bank: Bank, blueprint: Blueprint, seed: int | str) -> list[str]:
    """Fill the slots so that the paper holds what its blueprint asks for as a whole."""
    slots = [n for n, slot in enumerate(blueprint.slot, 1) for _ in range(slot.count)]
    places = [
        [make_candidate(bank, name, points) for name in fitting]
        for fitting, points in zip(_open_to(bank, blueprint), slot_points(blueprint), strict=False)
    ]
    for n in range(ORDERS):
        salt = f"{seed}/{n}" if n else str(seed)
        ranked = [
            sorted(place, key=partial(_of_candidate, bank, salt, index, number))
            for number, (index, place) in enumerate(zip(slots, places, strict=True))
        ]
        whole = ConstraintSolver(blueprint, ranked, _shuffle_fill_order(salt, len(places)))
        if not whole.is_reachable():
            break  # whatever the order
        chosen = whole.solve()
        if chosen:
            return chosen
    with error_context(blueprint.file):
        raise BlueprintError(explain_infeasible(blueprint, places))


def _shuffle_fill_order(salt: str, count: int) -> list[int]:
    """The order in which places are filled: the last ones have the least choice."""
    return sorted(range(count), key=lambda place: _hash_candidate(salt, 0, place, "order"))


def _of_candidate(bank: Bank, salt: str, index: int, place: int, one: Candidate) -> bytes:
    return _hash_candidate(salt, index, place, bank.origin(one.name))


def _is_overused(bank: Bank, chosen: list[str]) -> bool:
    """Whether a template is to stand in the paper more often than it has numbers."""
    return any(count > (bank.rules(name).pool or count) for name, count in Counter(chosen).items())


def slot_points(blueprint: Blueprint) -> Iterator[float | None]:
    """Marks that the blueprint gives to each question; no end where it gives none."""
    for slot in blueprint.slot:
        yield from repeat(slot.points, slot.count)
    yield from repeat(None)


def slot_levels(blueprint: Blueprint) -> Iterator[str]:
    """The level wanted of each question, without end: its slot's, else that of the paper."""
    for slot in blueprint.slot:
        yield from repeat(slot.level or blueprint.level, slot.count)
    yield from repeat(blueprint.level)


def _fill_slots(bank: Bank, blueprint: Blueprint, seed: str) -> list[str]:
    """Fill the slots: each template is used once before any is used again."""
    uses: dict[str, int] = {}
    chosen: list[str] = []
    for index, slot in enumerate(blueprint.slot, 1):
        fitting = _find_templates_for_slot(bank, blueprint, index)
        for place in range(slot.count):
            best = min(
                fitting,
                key=lambda name: (
                    _gives_away(bank, name, chosen),
                    uses.get(name, 0),
                    _hash_candidate(seed, index, place, bank.origin(name)),
                ),
            )
            uses[best] = uses.get(best, 0) + 1
            chosen.append(best)
    return chosen


def _gives_away(bank: Bank, name: str, chosen: list[str]) -> bool:
    """Whether a question and one already in the paper tell each other's answer."""
    return any(are_exclusive(bank, name, other) for other in chosen)


def are_exclusive(bank: Bank, one: str, other: str) -> bool:
    """Whether one of two templates says that they may not stand in one paper."""
    return one in bank.rules(other).apart or other in bank.rules(one).apart


def _fill_minutes(bank: Bank, blueprint: Blueprint, seed: int | str) -> list[str]:
    """Questions of a topic, tiers (and banks) in turn, as many as the minutes allow, by tier."""
    rules = {name: bank.rules(name) for name in bank.template_paths}
    open_names = [n for n in rules if blueprint.topic in (EVERYTHING, rules[n].topic)]
    budget = blueprint.budget or paper_minutes(sum(suggested_minutes(rules[n]) for n in open_names))
    used = 0
    chosen: list[str] = []
    group = {n: (rules[n].tier, bank.members.index(bank.owner_of(n)[0])) for n in open_names}
    while True:
        before = len(chosen)
        for turn, one in enumerate(sorted({*group.values()})):
            fitting = [
                n for n in open_names
                if n not in chosen and group[n] == one
                and paper_minutes(used + suggested_minutes(rules[n])) <= budget
                and not _gives_away(bank, n, chosen)
            ]  # fmt: skip
            if fitting:
                best = min(
                    fitting, key=lambda n: _hash_candidate(seed, turn, len(chosen), bank.origin(n))
                )
                chosen.append(best)
                used += suggested_minutes(rules[best])
        if len(chosen) == before:
            break
    if not open_names:
        raise BlueprintError(f"there is no question of topic {blueprint.topic!r} to choose from")
    if not chosen:
        shortest = paper_minutes(min(suggested_minutes(rules[n]) for n in open_names))
        raise BlueprintError(
            f"no question of topic {blueprint.topic!r} fits the time"
            f" (the shortest takes {shortest} min)"
        )
    return sorted(chosen, key=lambda n: rules[n].tier)


def alternatives(bank: Bank, blueprint: Blueprint, chosen: Sequence[str]) -> list[tuple[str, ...]]:
    """For each question of a paper, the templates that may stand there instead, itself first.

    They have its tier, topic, points and minutes, and a figure if it has one; none may stand in two
    places, and none tells what another one asks. So papers that take any one of each are alike.
    """
    open_names = dict(enumerate(_open_to(bank, blueprint)))
    taken = list(chosen)
    found = []
    for place, (name, worth) in enumerate(zip(chosen, slot_points(blueprint), strict=False)):
        like = _compute_features(bank, name, worth)
        family = [name]
        for other in sorted(open_names.get(place, bank.template_paths), key=bank.origin):
            alike = other not in taken and _compute_features(bank, other, worth) == like
            if alike and not _gives_away(bank, other, [one for one in taken if one not in family]):
                family.append(other)
                taken.append(other)
        found.append(tuple(family))
    return found


def _open_to(bank: Bank, blueprint: Blueprint) -> Iterator[list[str]]:
    """The templates that may fill each place of a blueprint with slots."""
    for index, slot in enumerate(blueprint.slot, 1):
        yield from repeat(_find_templates_for_slot(bank, blueprint, index), slot.count)


def _compute_features(bank: Bank, name: str, worth: float | None) -> tuple[object, ...]:
    one, rules = make_candidate(bank, name, worth), bank.rules(name)
    return (
        rules.tier,
        rules.topic,
        rules.beyond,
        one.points,
        one.minutes,
        bool(one.figure),
        one.photograph,
    )


def count_papers(bank: Bank, blueprint: Blueprint) -> int:
    """How many different papers a blueprint of slots can make (0 for a topic without slots).

    Questions count as a set; a template without numbers counts as one question.
    """
    total = 1 if blueprint.slot else 0
    for index, slot in enumerate(blueprint.slot, 1):
        pools = [
            bank.rules(name).pool or 1 for name in _find_templates_for_slot(bank, blueprint, index)
        ]
        rounds, rest = divmod(slot.count, len(pools))
        ways = [1] + [0] * rest
        for pool in pools:
            even, more = math.comb(pool, rounds), math.comb(pool, rounds + 1)
            ways = [ways[k] * even + (ways[k - 1] * more if k else 0) for k in range(rest + 1)]
        total *= ways[rest]
    return total


def _hash_candidate(seed: str | int, index: int, place: int, origin: str) -> bytes:
    return hashlib.sha256(f"choose/{seed}/{index}/{place}/{origin}".encode()).digest()


def _find_templates_for_slot(bank: Bank, blueprint: Blueprint, index: int) -> list[str]:
    """Templates that may fill a slot, counted from 1."""
    slot = blueprint.slot[index - 1]
    names = list(slot.templates) or list(bank.template_paths)
    with error_context(blueprint.file):
        _check_known(bank, slot, index)
    fitting = [
        name
        for name in names
        if _is_fit_for_slot(bank.rules(name), slot)
        and (blueprint.colour or not may_need_colour(bank, name))
    ]
    if not fitting:
        wish = f"tier {slot.tier or 'any'} and topic {slot.topic or 'any'}"
        wish += "" if blueprint.colour else ", and is read without colour"
        with error_context(blueprint.file):
            raise BlueprintError(f"slot {index}: no template has {wish}")
    return fitting


@cache
def may_need_colour(bank: Bank, name: str) -> bool:
    """Whether a template asks, in some draws, with a figure that cannot be read on grey paper."""
    rule = bank.rules(name).figure
    if rule is None or not rule.quiz:
        return False
    template = bank.template(name)
    says = getattr(template.figure, "COLOUR", False)
    return (
        any(coloured(draw_variant(template, n)) for n in range(DRAWN))
        if callable(says)
        else bool(says)
    )


def _is_fit_for_slot(rules: Rules, slot: SlotRule) -> bool:
    """Whether a template fits a slot; one past the syllabus must be listed."""
    if rules.beyond and not slot.templates:
        return False
    return slot.tier in {None, rules.tier} and slot.topic in {None, rules.topic}


def _check_known(bank: Bank, slot: SlotRule, index: int) -> None:
    for name in slot.templates:
        try:
            bank.folder_of(name)
        except BankError as error:
            raise BlueprintError(f"slot {index}: {error}") from error
