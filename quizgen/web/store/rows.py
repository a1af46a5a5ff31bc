"""What the database holds, as values."""

from __future__ import annotations

from typing import Any

import msgspec


class Learner(msgspec.Struct, frozen=True):
    """Who learns."""

    id: int
    name: str
    settings: dict[str, Any]


class Which(msgspec.Struct, frozen=True):
    """Which question: its template, the seed of its numbers, how it is asked."""

    template: str
    seed: str
    level: str = "exam"


class Attempt(msgspec.Struct):
    """One question that somebody practises.

    Parameters
    ----------
    id : str
        Nobody can guess it.
    learner : int
    template, seed, level : str
        Which question it is.
    wish : mapping
        What it was chosen by.
    state : mapping
        How far it has got.
    begun : float
    ended : float, optional
    """

    id: str
    learner: int
    template: str
    seed: str
    level: str
    wish: dict[str, Any]
    state: dict[str, Any]
    begun: float
    ended: float | None = None

    @property
    def which(self) -> Which:
        """Which question it is."""
        return Which(self.template, self.seed, self.level)


class Seen(msgspec.Struct, frozen=True):
    """How a part went."""

    template: str
    topic: str
    part: str
    note: str
    right: bool
    first: bool
    at: float
