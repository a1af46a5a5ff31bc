"""Papers with quotas: so much of each verb, tier and topic, and no two papers much alike.

Papers of ``ROUND`` seeds in a row are made one after the other. Each place of a paper takes, of its
list, the template that brings the sums nearest to what is asked for, and among those the one that
the earlier papers share least; place after place, until nothing gets better.
"""

from __future__ import annotations

import hashlib
import math
import secrets
from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import chain, pairwise
from pathlib import Path
from typing import NamedTuple

from quizgen.bank.candidate import Candidate
from quizgen.bank.compile_cache import CompileCache
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import UNLIMITED, Blueprint, split_quota
from quizgen.paper.code import LARGEST_SEED
from quizgen.paper.constraints import READING

ROUND = 200
"""Papers of a round: seeds in a row that know of each other."""
TRIES, PASSES, GOOD = 60, 6, 100
"""Beginnings of a paper that are tried, how often each is gone through, how many have to do."""
KICKED = 5
"""Places of a paper that are filled with anyone before it is gone through once more."""
FEW = 8
"""Papers that are made again rather than kept."""
TOO_MANY = 100
"""What a question more than may be shared costs, compared with one that may."""

_KEPT = CompileCache("rounds", list[list[int]])

Places = tuple[tuple[Candidate, ...], ...]
"""Who may stand at each place of a paper."""


class Demand(NamedTuple):
    """What all questions together must come to.

    Parameters
    ----------
    group : str
        ``verb``, ``tier``, ``topic``, or the key of a blueprint that limits a sum.
    names : tuple of str
        Verbs, tiers or topics that count together.
    least, most : Fraction
    """

    group: str
    names: tuple[str, ...]
    least: Fraction
    most: Fraction

    @property
    def key(self) -> str:
        """Return how a blueprint writes it."""
        return f"quota.{self.group}.{' + '.join(self.names)}" if self.names else self.group

    def measure(self, one: Candidate) -> Fraction:
        """Return what a candidate adds."""
        if self.group == "verb":
            return sum((worth for verb, worth in one.parts if verb in self.names), Fraction(0))
        if self.names:
            return one.points if getattr(one, self.group) in self.names else Fraction(0)
        sums = {
            "total": one.points,
            "minutes": one.minutes,
            "figures": Fraction(bool(one.figure)),
            "photographs": Fraction(one.photograph),
        }
        return sums[self.group]

    def span(self, places: Places) -> tuple[Fraction, Fraction]:
        """Return the least and the most that the places can come to."""
        sums = [[self.measure(one) for one in place] for place in places]
        return sum(map(min, sums), Fraction(0)), sum(map(max, sums), Fraction(0))


def draw_first_seed() -> int:
    """Return a random seed that begins a round: no papers of others are made before its own."""
    return secrets.randbelow(LARGEST_SEED // ROUND) * ROUND


def list_demands(blueprint: Blueprint) -> tuple[Demand, ...]:
    """Return the demands of a blueprint, those that are missed most often first."""
    found = []
    if isinstance(blueprint.minutes, tuple):
        first, last = blueprint.minutes
        # What is printed is rounded up.
        least = Fraction(first - 1) / READING + Fraction(1, 10**6)
        found.append(Demand("minutes", (), least, last / READING))
    if blueprint.total:
        total = Fraction(str(blueprint.total))
        found.append(Demand("total", (), total, total))
    found += [
        Demand(key, (), Fraction(wanted), Fraction(UNLIMITED))
        for key in ("figures", "photographs")
        if (wanted := getattr(blueprint, key))
    ]
    found += [
        Demand(group, split_quota(key), Fraction(str(low)), Fraction(str(high)))
        for group, limits in blueprint.quota.items()
        for key, (low, high) in limits.items()
    ]
    return tuple(found)


def select_by_quota(blueprint: Blueprint, places: Places, seed: int | str) -> list[str]:
    """Return the names of the templates of one paper.

    Raises
    ------
    BlueprintError
        At the demand that no paper meets, or most papers miss.
    """
    number = int(seed) if str(seed).isdecimal() else _hash_number(str(seed))
    demands = list_demands(blueprint)
    alone = blueprint.shared is None
    round_number, place = (number, 0) if alone else divmod(number, ROUND)
    papers = _open_round(demands, blueprint.shared, places, round_number)
    paper = papers.get_paper(place)
    if paper is None:
        raise _explain_none(blueprint, places, papers.missed)
    return [one.name for one in paper]


class _Round:
    """The papers of one round, made as far as they are asked for.

    Parameters
    ----------
    demands : sequence of Demand
    shared : int or None
        Questions that any two of them may share; None for any number.
    places : sequence of sequences of Candidate
    number : int
        Of the round.
    """

    def __init__(
        self, demands: Sequence[Demand], shared: int | None, places: Places, number: int
    ) -> None:
        self.places, self.number = places, number
        self.shared = len(places) if shared is None else shared
        everyone = {one.name: one for one in chain.from_iterable(places)}
        self.bits = {name: 1 << place for place, name in enumerate(everyone)}
        self.apart = {
            name: sum(self.bits[other.name] for other in everyone.values() if one.excludes(other))
            | self.bits[name]
            for name, one in everyone.items()
        }
        """Templates that may not stand beside each, as bits: itself, too."""
        self.demands = _scale_demands(demands, places)
        self.missed: Counter[str] = Counter()
        self.papers: list[tuple[Candidate, ...]] = []
        self.papers_with: dict[str, list[int]] = {name: [] for name in everyone}
        """Papers so far that hold each template."""
        names = [[one.name for one in place] for place in places]
        told = repr((self.demands, self.shared, number, names, self.apart))
        self.sources = told.encode(), Path(__file__).read_bytes()
        """What the papers follow from."""
        costs = [4**count * (1 if count <= self.shared else TOO_MANY)
                 for count in range(len(places) + 2)]  # fmt: skip
        self.steps = [after - before for before, after in pairwise(costs)]
        """What one more question adds for a paper that shares so many already."""

    def get_paper(self, place: int) -> tuple[Candidate, ...] | None:
        """Return a paper of the round; None where no paper was found that meets all demands.

        A paper far into its round takes the time of all before it, so those are kept.
        """
        if place - len(self.papers) >= FEW:
            for chosen in (_KEPT.get(*self.sources) or [])[len(self.papers) :]:
                whole = zip(self.places, chosen, strict=True)
                self._add_paper(tuple(fitting[at] for fitting, at in whole))
        before = len(self.papers)
        while len(self.papers) <= place:
            paper = self._make_paper()
            if paper is None:
                return None
            self._add_paper(paper)
        if len(self.papers) - before > FEW:
            chosen_so_far = [[*map(tuple.index, self.places, paper)] for paper in self.papers]
            _KEPT.store_compiled(chosen_so_far, *self.sources)
        return self.papers[place]

    def _add_paper(self, paper: tuple[Candidate, ...]) -> None:
        """Take a paper as the next one of the round."""
        for one in paper:
            self.papers_with[one.name].append(len(self.papers))
        self.papers.append(paper)

    def _make_paper(self) -> tuple[Candidate, ...] | None:
        """Return the next paper: the first that meets all demands and shares little, if any does.

        While it shares too much, a few of its places are filled anew, and it is kept if it shares
        no more then: late in a round that finds what beginning anew does not.
        """
        best: tuple[int, tuple[Candidate, ...]] | None = None
        good = 0
        for attempt in range(TRIES + GOOD):
            if best is None and attempt == TRIES:
                return None
            draft = _Draft(self, attempt)
            paper = draft.improve(best[1] if best else ())
            if not paper:
                continue
            key = next((one.key for one in self.demands if not one.holds(paper)), "")
            if key:
                self.missed[key] += 1
                continue
            good += 1
            excess = draft.count_excess()
            if best is None or excess <= best[0]:
                best = excess, tuple(paper)
            if not excess or good == GOOD:
                break
        return best[1] if best else None


class _Draft:
    """A paper of a round while its places are filled.

    Parameters
    ----------
    papers : _Round
        The papers before it.
    attempt : int
        How many drafts of the same paper there were before.
    """

    def __init__(self, papers: _Round, attempt: int) -> None:
        self.round, self.attempt = papers, attempt
        self.chosen: dict[int, Candidate] = {}
        self.sums = [0] * len(papers.demands)
        """What the places filled so far add to each demand."""
        self.alike = [0] * len(papers.papers)
        """Questions that each earlier paper shares."""

    def improve(self, start: Sequence[Candidate] = ()) -> list[Candidate]:
        """Return a template for each place; none where nothing may stand at one of them.

        Again and again each place is filled anew, in any order, until nothing gets better. The
        first time the demands do not count yet; of later attempts it is any template.

        Parameters
        ----------
        start : sequence of Candidate, optional
            A paper to begin from, of which the first time only ``KICKED`` places are filled anew.
        """
        count, papers = len(self.round.places), self.round
        salt = f"quota/{papers.number}/{len(papers.papers)}/{self.attempt}".encode()
        drawn = hashlib.shake_128(salt).digest(2 * count * (PASSES + 1))
        for place, one in enumerate(start):
            self._fill_place(place, one)
        for turn in range(PASSES + 1):
            keys = [drawn[2 * n : 2 * n + 2] for n in range(turn * count, (turn + 1) * count)]
            before = dict(self.chosen)
            order = sorted(range(count), key=keys.__getitem__)
            for place in order[: KICKED if start and not turn else count]:
                self._fill_place(place, None)
                care = 2 if turn else int(not self.attempt)
                best = self._choose_template(place, keys[place][1], care)
                if best is None:
                    return []
                self._fill_place(place, best)
            if turn and self.chosen == before:
                break
        return [self.chosen[place] for place in range(count)]

    def count_excess(self) -> int:
        """Return how many questions more than may be are shared with all papers together."""
        return sum(count - self.round.shared for count in self.alike if count > self.round.shared)

    def _fill_place(self, place: int, one: Candidate | None) -> None:
        """Put a template at a place, or take away what stands there."""
        step = -1 if one is None else 1
        if one is None:
            one = self.chosen.pop(place, None)
            if one is None:
                return
        else:
            self.chosen[place] = one
        for paper in self.round.papers_with[one.name]:
            self.alike[paper] += step
        self.sums = [
            told + step * demand.amounts[place][one.name]
            for told, demand in zip(self.sums, self.round.demands, strict=True)
        ]

    def _choose_template(self, place: int, start: int, care: int) -> Candidate | None:
        """Return who misses the demands least and then shares least, from ``start`` on.

        Parameters
        ----------
        place, start : int
        care : int
            0 for anyone that may stand there, 1 for what is shared alone, 2 for both.
        """
        papers, alike, steps = self.round, self.alike, self.round.steps
        taken = 0
        for one in self.chosen.values():
            taken |= papers.bits[one.name]
        demands = zip(papers.demands, self.sums, strict=True) if care > 1 else ()
        room = [(one.amounts[place], one.least - told, one.most - told) for one, told in demands]
        fitting = papers.places[place]
        best, least = None, (0, 0)
        for n in range(len(fitting)):
            one = fitting[(n + start) % len(fitting)]
            if papers.apart[one.name] & taken:
                continue
            missed = 0
            for amounts, low, high in room:
                amount = amounts[one.name]
                if amount < low:
                    missed += low - amount
                elif amount > high:
                    missed += amount - high
            if best and missed > least[0]:
                continue
            cost = sum([steps[alike[n]] for n in papers.papers_with[one.name]]) if care else 0
            if best is None or (missed, cost) < least:
                best, least = one, (missed, cost)
        return best


@lru_cache(maxsize=16)
def _open_round(
    demands: tuple[Demand, ...], shared: int | None, places: Places, number: int
) -> _Round:
    """Return a round, of which every paper is made once."""
    ordered = tuple(
        tuple(sorted(place, key=lambda one: _hash_number(one.origin))) for place in places
    )
    return _Round(demands, shared, ordered, number)


class _ScaledDemand(NamedTuple):
    """A demand in whole numbers."""

    key: str
    amounts: tuple[Mapping[str, int], ...]
    """What each candidate adds, place by place."""
    least: int
    most: int

    def holds(self, paper: Sequence[Candidate]) -> bool:
        """Return whether the paper comes to enough, and not to too much."""
        told = zip(self.amounts, paper, strict=True)
        return self.least <= sum(place[one.name] for place, one in told) <= self.most

    def holds_always(self) -> bool:
        """Return whether it holds whatever stands at the places."""
        low = sum(min(place.values()) for place in self.amounts)
        high = sum(max(place.values()) for place in self.amounts)
        return self.least <= low and high <= self.most


def _scale_demands(demands: Sequence[Demand], places: Places) -> list[_ScaledDemand]:
    """Return the demands that may be missed, in one unit, so that what is missed can be added."""
    found = [
        [{one.name: demand.measure(one) for one in place} for place in places] for demand in demands
    ]
    parts = (amount for told in found for place in told for amount in place.values())
    unit = math.lcm(1, *(amount.denominator for amount in parts))
    scaled = (
        _ScaledDemand(
            demand.key,
            tuple({name: int(amount * unit) for name, amount in place.items()} for place in told),
            math.ceil(demand.least * unit),
            math.floor(demand.most * unit),
        )
        for demand, told in zip(demands, found, strict=True)
    )
    return [one for one in scaled if not one.holds_always()]


def _explain_none(blueprint: Blueprint, places: Places, missed: Counter[str]) -> BlueprintError:
    """Return the error that names the demand out of reach, else the one that is missed most."""
    for one in list_demands(blueprint):
        low, high = one.span(places)
        if high < one.least or low > one.most:
            what = f"cannot be met: the slots together make {float(low):g} to {float(high):g}"
            return _make_error(blueprint, one.key, what)
    if not missed:
        what = "the slots leave no choice of templates that may stand together"
        return BlueprintError(what, rule="QG323", file=blueprint.file)
    (key, count), *_ = missed.most_common(1)
    what = f"was missed by {count} of {missed.total()} papers tried, other demands by the rest"
    return _make_error(blueprint, key, what)


def _make_error(blueprint: Blueprint, key: str, what: str) -> BlueprintError:
    """Return an error at a key of the blueprint."""
    place = tuple(key.split(".", 2))
    return BlueprintError(f"{key} {what}", rule="QG323", file=blueprint.file, place=place)


def _hash_number(text: str) -> int:
    """Return the number that a text stands for: the same everywhere, and hard to guess."""
    return int.from_bytes(hashlib.sha256(f"quota/{text}".encode()).digest()[:8], "big")
