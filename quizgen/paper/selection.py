"""Which templates a paper holds: filling slots, filling a time, and how many papers there are."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import cache, partial
from itertools import chain, repeat

from msgspec.structs import replace

from quizgen.bank.bank import Bank
from quizgen.bank.candidate import Candidate
from quizgen.bank.template import Template
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError, BlueprintError, QuizgenError
from quizgen.paper.blueprint import EVERYTHING, Blueprint, SlotRule
from quizgen.paper.constraints import ConstraintSolver, explain_infeasible, paper_minutes
from quizgen.paper.quota import select_by_quota
from quizgen.question.figure import has_coloured_figure

ORDERS = 3
"""Orders in which the places of a demanding blueprint are filled; an impossible one takes all."""
DRAWN = 20
"""Draws by which a template is judged whose figure needs colour for some values alone."""
NEAR = 1
"""Minutes by which questions may differ that stand for each other."""
TRIES = 20
"""Choices of templates until none is used more often than it has numbers."""


def select_templates(
    bank: Bank, blueprint: Blueprint, seed: int | str, without: Collection[str] = ()
) -> list[str]:
    """Return the names of the templates of a paper, in order.

    Parameters
    ----------
    bank : Bank
    blueprint : Blueprint
    seed : int or str
    without : collection of str
        Templates that must not stand in it, by name or origin.

    Raises
    ------
    BlueprintError
        If no template fits a slot, or the time.
    """
    if blueprint.topic:
        return _fill_minutes(_leave_out(bank.candidates(), without), blueprint, seed)
    slots = _list_slot_candidates(bank, blueprint, without)
    if blueprint.quota:
        return select_by_quota(blueprint, _list_places(slots, blueprint), seed)
    if blueprint.has_constraints:
        return _fill_under_constraints(slots, blueprint, seed)
    tries = (_fill_slots(slots, blueprint, f"{seed}/{n}" if n else str(seed)) for n in range(TRIES))
    first = next(tries)
    found = next((one for one in chain((first,), tries) if not _is_overused(one)), first)
    return [one.name for one in found]


def _leave_out(candidates: Iterable[Candidate], without: Collection[str]) -> list[Candidate]:
    """Return the candidates that are not among those named, by name or origin."""
    return [one for one in candidates if one.name not in without and one.origin not in without]


def _fill_under_constraints(
    slots: Sequence[Sequence[Candidate]], blueprint: Blueprint, seed: int | str
) -> list[str]:
    """Return the names of templates that meet what the blueprint asks of the paper as a whole.

    A solver fills all places together; a greedy choice would run out of points or time. Several
    orders of filling are tried, since the first may use up the solver's steps.

    Raises
    ------
    BlueprintError
        If no choice meets all demands, or none was found.
    """
    numbers = [n for n, slot in enumerate(blueprint.slot, 1) for _ in range(slot.count)]
    places = _list_places(slots, blueprint)
    for n in range(ORDERS):
        salt = f"{seed}/{n}" if n else str(seed)
        ranked = [
            sorted(place, key=partial(_hash_candidate, salt, index, number))
            for number, (index, place) in enumerate(zip(numbers, places, strict=True))
        ]
        whole = ConstraintSolver(blueprint, ranked, _shuffle_fill_order(salt, len(places)))
        if not whole.is_reachable():
            break  # whatever the order
        chosen = whole.solve()
        if chosen:
            return chosen
    raise BlueprintError(explain_infeasible(blueprint, places), file=blueprint.file)


def _list_places(
    slots: Sequence[Sequence[Candidate]], blueprint: Blueprint
) -> tuple[tuple[Candidate, ...], ...]:
    """Return who may stand at each place of a paper, with the points that the place gives."""
    return tuple(
        tuple(one.scale_to(slot.points) for one in fitting)
        for slot, fitting in zip(blueprint.slot, slots, strict=True)
        for _ in range(slot.count)
    )


def _shuffle_fill_order(salt: str, count: int) -> list[int]:
    """Return the order in which places are filled.

    It is drawn: the last ones have the least choice, and should not always be the same.
    """
    return sorted(range(count), key=lambda place: _hash_place(salt, 0, place, "order"))


def _hash_candidate(seed: int | str, index: int, place: int, one: Candidate) -> bytes:
    """Return what a candidate is ranked by at one place: the least hash comes first.

    By origin, so that a rename changes no paper.
    """
    return _hash_place(seed, index, place, one.origin)


def _hash_place(seed: int | str, index: int, place: int, origin: str) -> bytes:
    """Return the hash of seed, slot, place and origin."""
    return hashlib.sha256(f"choose/{seed}/{index}/{place}/{origin}".encode()).digest()


def _is_overused(chosen: Iterable[Candidate]) -> bool:
    """Return whether a template would stand in the paper more often than it has numbers."""
    return any(count > (one.pool or count) for one, count in Counter(chosen).items())


def slot_points(blueprint: Blueprint) -> Iterator[float | None]:
    """Yield the marks that the blueprint gives to each question, without end: None for no marks."""
    for slot in blueprint.slot:
        yield from repeat(slot.points, slot.count)
    yield from repeat(None)


def slot_levels(blueprint: Blueprint) -> Iterator[str]:
    """Yield the level wanted of each question, without end: its slot's, else the paper's."""
    for slot in blueprint.slot:
        yield from repeat(slot.level or blueprint.level, slot.count)
    yield from repeat(blueprint.level)


def _fill_slots(
    slots: Sequence[Sequence[Candidate]], blueprint: Blueprint, seed: str
) -> list[Candidate]:
    """Return a candidate for each place; each is used once before any is used again."""
    uses: Counter[str] = Counter()
    chosen: list[Candidate] = []
    for index, (slot, fitting) in enumerate(zip(blueprint.slot, slots, strict=True), 1):
        for place in range(slot.count):
            best = min(
                fitting,
                key=lambda one: (
                    any(map(one.excludes, chosen)),
                    uses[one.name],
                    _hash_candidate(seed, index, place, one),
                ),
            )
            uses[best.name] += 1
            chosen.append(best)
    return chosen


def _fill_minutes(
    candidates: Sequence[Candidate], blueprint: Blueprint, seed: int | str
) -> list[str]:
    """Return questions of a topic, as many as the minutes allow, sorted by tier.

    Tiers (and banks) choose in turn, so that a short paper has some of each. Raises
    ``BlueprintError`` if the topic has no question, or none that fits the time.
    """
    fitting = [one for one in candidates if blueprint.topic in (EVERYTHING, one.topic)]
    budget = blueprint.budget or paper_minutes(sum(one.minutes for one in fitting))
    used = Fraction(0)
    chosen: list[Candidate] = []
    while True:
        before = len(chosen)
        for turn, group in enumerate(sorted({(one.tier, one.member) for one in fitting})):
            left = [
                one for one in fitting
                if one not in chosen and (one.tier, one.member) == group
                and paper_minutes(used + one.minutes) <= budget
                and not any(map(one.excludes, chosen))
            ]  # fmt: skip
            if left:
                best = min(left, key=partial(_hash_candidate, seed, turn, len(chosen)))
                chosen.append(best)
                used += best.minutes
        if len(chosen) == before:
            break
    if not fitting:
        raise BlueprintError(f"there is no question of topic {blueprint.topic!r} to choose from")
    if not chosen:
        shortest = paper_minutes(min(one.minutes for one in fitting))
        raise BlueprintError(
            f"no question of topic {blueprint.topic!r} fits the time"
            f" (the shortest takes {shortest} min)"
        )
    return [one.name for one in sorted(chosen, key=lambda one: one.tier)]


def alternatives(
    bank: Bank, blueprint: Blueprint, chosen: Sequence[str], without: Collection[str] = ()
) -> list[tuple[str, ...]]:
    """Return, for each question, the templates that may stand there instead, itself first.

    They have its tier, topic and points, about its minutes, and a figure if it has one; none may
    stand in two places, and none tells what another one asks. So papers that take any one of each
    are alike.
    """
    slots = _list_slot_candidates(bank, blueprint, without)
    places = [fitting for slot, fitting in zip(blueprint.slot, slots, strict=True)
              for _ in range(slot.count)]  # fmt: skip
    taken = bank.candidates(chosen)
    found = []
    for place, (one, worth) in enumerate(zip([*taken], slot_points(blueprint), strict=False)):
        like = _get_comparable_features(one.scale_to(worth))
        family = [one]
        fitting = places[place] if place < len(places) else _leave_out(bank.candidates(), without)
        for other in sorted(fitting, key=lambda one: one.origin):
            near = abs(other.minutes - one.minutes) <= NEAR
            alike = other not in taken and _get_comparable_features(other.scale_to(worth)) == like
            alike = alike and near
            if alike and not any(other.excludes(said) for said in taken if said not in family):
                family.append(other)
                taken.append(other)
        found.append(tuple(member.name for member in family))
    return found


def select_instead(
    bank: Bank,
    blueprint: Blueprint,
    chosen: Sequence[str],
    place: int,
    seed: int | str,
    without: Collection[str] = (),
) -> list[str]:
    """Return the templates of a paper with another one at one place.

    It fits the slot and is worth as many points; what the blueprint asks of the paper as a whole
    still holds.

    Parameters
    ----------
    bank : Bank
    blueprint : Blueprint
    chosen : sequence of str
        As it is.
    place : int
        Of the question that is to be another one, from 0.
    seed : int or str
    without : collection of str
        Templates that must not stand there, by name or origin.

    Raises
    ------
    BlueprintError
        If nothing else can stand there.
    """
    out = {*without, *chosen}
    if blueprint.topic:
        families = alternatives(bank, blueprint, chosen, out)
        fitting = families[place][1:]
        slots = tuple(SlotRule() for _ in chosen)
    else:
        slots = tuple(slot for slot in blueprint.slot for _ in range(slot.count))
        (own,) = bank.candidates([chosen[place]])
        worth = own.scale_to(slots[place].points).points
        fitting = tuple(
            one.name
            for one in _list_fitting(bank, blueprint, slots[place], out)
            if one.scale_to(slots[place].points).points == worth
        )
    if not fitting:
        raise BlueprintError(f"nothing else has the slot and the points of {chosen[place]}")
    names: list[tuple[str, ...]] = [(name,) for name in chosen]
    names[place] = tuple(fitting)
    pinned = tuple(replace(slot, templates=names[at], count=1) for at, slot in enumerate(slots))
    only = replace(blueprint, topic="", slot=pinned, shared=None)
    return select_templates(bank, only, seed)


def _list_fitting(
    bank: Bank, blueprint: Blueprint, slot: SlotRule, without: Collection[str]
) -> list[Candidate]:
    """Return the templates that may fill a slot of a blueprint, but for those left out."""
    coloured = frozenset() if blueprint.colour else find_coloured_templates(bank)
    return [
        one
        for one in _leave_out(bank.candidates(slot.templates or None), without)
        if _is_fit_for_slot(one, slot) and one.name not in coloured
    ]


def _get_comparable_features(one: Candidate) -> tuple[object, ...]:
    """Return what templates must share to stand for each other in equal papers."""
    return (
        one.tier,
        one.topic,
        one.beyond,
        one.points,
        bool(one.figure),
        one.photograph,
    )


def count_papers(bank: Bank, blueprint: Blueprint) -> int:
    """Return how many different papers a blueprint can make; 0 for a topic without slots.

    Questions count as a set; a template without numbers counts as one question.
    """
    total = 1 if blueprint.slot else 0
    for slot, fitting in zip(blueprint.slot, _list_slot_candidates(bank, blueprint), strict=True):
        pools = [one.pool or 1 for one in fitting]
        rounds, rest = divmod(slot.count, len(pools))
        ways = [1] + [0] * rest
        for pool in pools:
            even, more = math.comb(pool, rounds), math.comb(pool, rounds + 1)
            ways = [ways[k] * even + (ways[k - 1] * more if k else 0) for k in range(rest + 1)]
        total *= ways[rest]
    return total


def _list_slot_candidates(
    bank: Bank, blueprint: Blueprint, without: Collection[str] = ()
) -> list[list[Candidate]]:
    """Return the templates that may fill each slot of a blueprint, but for those left out.

    Raises
    ------
    BlueprintError
        If a slot names a template that there is not, or nothing fits it.
    """
    slots = []
    for index, slot in enumerate(blueprint.slot, 1):
        for name in slot.templates:
            try:
                bank.folder_of(name)
            except BankError as error:
                raise BlueprintError(f"slot {index}: {error}", file=blueprint.file) from error
        fitting = _list_fitting(bank, blueprint, slot, without)
        if not fitting:
            wish = f"tier {slot.tier or 'any'} and topic {slot.topic or 'any'}"
            wish += "" if blueprint.colour else ", and is read without colour"
            wish += ", and is not to be left out" if without else ""
            raise BlueprintError(f"slot {index}: no template has {wish}", file=blueprint.file)
        slots.append(fitting)
    return slots


@cache
def find_coloured_templates(bank: Bank) -> frozenset[str]:
    """Return the templates whose figure, in some variants, cannot be read on grey paper."""
    found = set()
    for name in bank.template_paths:
        # One that is wrong says so when a paper is to hold it.
        with suppress(QuizgenError):
            (one,) = bank.candidates((name,))
            if one.figure and _needs_colour(bank.template(name)):
                found.add(name)
    return frozenset(found)


def _needs_colour(template: Template) -> bool:
    """Return whether a template's figure says so, or does for one of ``DRAWN`` variants."""
    says = getattr(template.figure, "COLOUR", False)
    return (
        any(has_coloured_figure(draw_variant(template, n)) for n in range(DRAWN))
        if callable(says)
        else bool(says)
    )


def _is_fit_for_slot(one: Candidate, slot: SlotRule) -> bool:
    """Return whether a template fits a slot; one past the syllabus must be listed."""
    if one.beyond and not slot.templates:
        return False
    return slot.tier in {None, one.tier} and slot.topic in {None, one.topic}
