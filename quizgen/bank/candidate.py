"""What choosing the questions of a paper needs to know of a template, as one plain value."""

from __future__ import annotations

from fractions import Fraction

import msgspec
from msgspec.structs import replace

from quizgen.core.shares import rescale_points


class Candidate(msgspec.Struct, frozen=True):
    """A template that may fill a place of a paper, and what it adds to the paper.

    Parameters
    ----------
    name, origin : str
        What it is called in the bank, and the name that its numbers are drawn under.
    member : int
        Place of its bank among those that are mixed, from 0.
    tier, topic : str
    beyond : bool
        Whether it lies past the syllabus.
    parts : tuple of (str, Fraction)
        What each part asks for, by the verbs of answer kinds, and its points.
    minutes : Fraction
        Working time; more points make a question no longer.
    figure : str
        Kind of figure that the question shows; empty for none.
    photograph : bool
        Whether that figure holds a photograph.
    apart : frozenset of str
        Templates that may not stand in the same paper.
    pool : int or None
        How many different questions it has, where they are counted.
    """

    name: str
    origin: str
    member: int
    tier: str
    topic: str
    beyond: bool
    parts: tuple[tuple[str, Fraction], ...]
    minutes: Fraction
    figure: str
    photograph: bool
    apart: frozenset[str]
    pool: int | None

    @property
    def points(self) -> Fraction:
        """Return the marks of all parts."""
        return sum((worth for _, worth in self.parts), Fraction(0))

    def scale_to(self, points: float | None) -> Candidate:
        """Return the same candidate worth so many points; None leaves its own."""
        if points is None:
            return self
        shares = rescale_points([worth for _, worth in self.parts], Fraction(str(points)))
        verbs = (verb for verb, _ in self.parts)
        return replace(self, parts=tuple(zip(verbs, shares, strict=True)))

    def excludes(self, other: Candidate) -> bool:
        """Return whether one of the two says that they may not stand in one paper."""
        return self.name in other.apart or other.name in self.apart
