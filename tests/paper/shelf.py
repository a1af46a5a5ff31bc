"""A bank without files."""

from __future__ import annotations

from fractions import Fraction

from quizgen.bank.bank import builtin_bank
from quizgen.bank.candidate import Candidate

DEFAULT = {"tier": "A", "topic": "optics", "pool": None, "minutes": 5, "apart": (), "beyond": False,
           "points": 5, "figure": ""}  # fmt: skip
PHOTOGRAPHS = builtin_bank().metadata.photographs


class Shelf:
    """Candidates alone: name to tier, topic, pool, minutes, points, figure, what is apart."""

    def __init__(self, table=(), **named):
        self.table = dict(table, **named)

    def candidates(self, names=None):
        return [self._candidate(name) for name in (self.table if names is None else names)]

    def _candidate(self, name):
        given = {**DEFAULT, **self.table[name]}
        given |= {key: Fraction(str(given[key])) for key in ("points", "minutes")}
        given["apart"] = frozenset(given["apart"])
        points = given.pop("points")
        given["parts"] = given.get("parts") or (("compute", points),)
        photograph = given["figure"] in PHOTOGRAPHS
        return Candidate(name=name, origin=name, member=0, photograph=photograph, **given)

    def folder_of(self, name):
        return self.table[name]
