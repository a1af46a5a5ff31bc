"""Papers with quotas: so much of each verb, tier and topic, and no two papers much alike.

There is no search that goes back. Each place of a paper takes, of its list, a template that has
come seldom so far and tells no answer of those before it; where the sums are not what is asked for,
the paper is thrown away and another one is drawn. Papers of ``ROUND`` seeds in a row are made one
after the other, so that none shares more questions with an earlier one than is allowed.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import chain
from typing import NamedTuple

from quizgen.bank.candidate import Candidate
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import UNLIMITED, Blueprint, split_quota
from quizgen.paper.constraints import READING

ROUND = 20
"""Papers of a round: seeds in a row that know of each other."""
TRIES, MORE_TRIES = 400, 600
"""Papers that are tried until one meets all demands: apart from the others, and in any case."""

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
    papers = _open_round(demands, blueprint.shared, places, number // ROUND)
    paper = papers.get_paper(number % ROUND)
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
        self.demands = [_ScaledDemand(demand, places) for demand in demands]
        self.missed: Counter[str] = Counter()
        self.papers: list[tuple[Candidate, ...]] = []
        self.papers_with: dict[str, int] = dict.fromkeys(everyone, 0)
        """Papers so far that hold each template, as bits."""

    def get_paper(self, place: int) -> tuple[Candidate, ...] | None:
        """Return a paper of the round; None where no paper was found that meets all demands."""
        while len(self.papers) <= place:
            paper = self._make_paper()
            if paper is None:
                return None
            for one in paper:
                self.papers_with[one.name] |= 1 << len(self.papers)
            self.papers.append(paper)
        return self.papers[place]

    def _make_paper(self) -> tuple[Candidate, ...] | None:
        """Return the next paper; one that shares more where none is found that does not."""
        for attempt in range(TRIES + MORE_TRIES):
            paper = self._fill_places(attempt)
            if paper:
                key = next((one.key for one in self.demands if not one.holds(paper)), "")
                if not key:
                    return paper
                self.missed[key] += 1
        return None

    def _fill_places(self, attempt: int) -> tuple[Candidate, ...]:
        """Return a template for each place; none where nothing may stand at one of them.

        With every attempt it matters less how often a template has come.
        """
        left = max(0, TRIES - attempt)
        shared = self.shared if left else len(self.places)
        salt = f"quota/{self.number}/{len(self.papers)}/{attempt}".encode()
        drawn = hashlib.shake_128(salt).digest(2 * len(self.places))
        alike = [0] * (shared + 1)  # earlier papers that share so many questions or more, as bits
        taken, paper = 0, []
        for place, fitting in enumerate(self.places):
            start = int.from_bytes(drawn[2 * place : 2 * place + 2], "big")
            best = self._choose_template(
                fitting, start, taken, alike[shared], Fraction(left, TRIES)
            )
            if best is None:
                return ()
            earlier = self.papers_with[best.name]
            for count in range(shared, 0, -1):
                alike[count] |= earlier & alike[count - 1] if count > 1 else earlier
            taken |= self.bits[best.name]
            paper.append(best)
        return tuple(paper)

    def _choose_template(
        self,
        fitting: Sequence[Candidate],
        start: int,
        taken: int,
        full: int,
        care: Fraction,
    ) -> Candidate | None:
        """Return who comes first from ``start`` on, those that have come often so far set back.

        None of those taken may be near, and no paper that shares enough already may hold it.
        """
        count = len(fitting)
        weight = int(care * count * count / (3 * len(self.papers) + 1))
        ranked = (
            ((place - start) % count + weight * self.papers_with[one.name].bit_count(), place)
            for place, one in enumerate(fitting)
            if not (self.apart[one.name] & taken or self.papers_with[one.name] & full)
        )
        best = min(ranked, default=None)
        return fitting[best[1]] if best else None


@lru_cache(maxsize=16)
def _open_round(
    demands: tuple[Demand, ...], shared: int | None, places: Places, number: int
) -> _Round:
    """Return a round, of which every paper is made once."""
    ordered = tuple(
        tuple(sorted(place, key=lambda one: _hash_number(one.origin))) for place in places
    )
    return _Round(demands, shared, ordered, number)


class _ScaledDemand:
    """A demand in whole numbers."""

    def __init__(self, demand: Demand, places: Sequence[Sequence[Candidate]]) -> None:
        """Take the amounts of all candidates at all places."""
        amounts = [{one.name: demand.measure(one) for one in place} for place in places]
        unit = math.lcm(1, *(one.denominator for place in amounts for one in place.values()))
        self.key = demand.key
        self.amounts: list[Mapping[str, int]] = [
            {name: int(amount * unit) for name, amount in place.items()} for place in amounts
        ]
        self.least, self.most = demand.least * unit, demand.most * unit

    def holds(self, paper: Sequence[Candidate]) -> bool:
        """Return whether the paper comes to enough, and not to too much."""
        told = zip(self.amounts, paper, strict=True)
        return self.least <= sum(place[one.name] for place, one in told) <= self.most


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
