"""What the database holds, as values."""

from __future__ import annotations

from typing import Any, TypeVar

import msgspec
from sqlalchemy import RowMapping

from quizgen.core.decoding import convert


class Learner(msgspec.Struct, frozen=True):
    """One learner: id, name and settings."""

    id: int
    name: str
    settings: dict[str, Any]
    manages: bool = False


class Person(msgspec.Struct, frozen=True):
    """A learner with an account, as managers see it."""

    id: int
    name: str
    manages: bool
    since: float


class Invitation(msgspec.Struct, frozen=True):
    """An invitation that is good once: to a new account, or to a new password.

    Parameters
    ----------
    hash : str
        Of its token.
    learner : int or None
        Who may choose a new password; None for somebody new.
    manages : bool
        Whether somebody new is to manage.
    until : float
    """

    hash: str
    learner: int | None
    manages: bool
    until: float


class QuestionRef(msgspec.Struct, frozen=True):
    """Which question: its template, the seed of its numbers, the level it is asked at."""

    template: str
    seed: str
    level: str = "exam"


class AttemptRecord(msgspec.Struct):
    """One attempt at a question in practice, as a row of the database.

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
    def which(self) -> QuestionRef:
        """Which question it is."""
        return QuestionRef(self.template, self.seed, self.level)


class OutcomeRecord(msgspec.Struct, frozen=True):
    """How one part went, as a row of the database.

    Parameters
    ----------
    template, topic, part : str
        ``part`` is its label.
    note : str
        The last mistake.
    right, first : bool
        Whether it went right at all, and right at once.
    at : float
        Seconds since 1970.
    credit : float or None
        Share of its points that the first try was worth; None if an earlier version wrote the row.
    helped : bool or None
        Whether help came before that try.
    attempt : str or None
        What the parts of one attempt have in common.
    """

    template: str
    topic: str
    part: str
    note: str
    right: bool
    first: bool
    at: float
    credit: float | None = None
    helped: bool | None = None
    attempt: str | None = None


class Packed(msgspec.Struct, frozen=True):
    """A packed paper as it is stored once for all who sit it, see ``web.papers``.

    Parameters
    ----------
    id : str
        Digest of what it shows and what marks it.
    code : str
    data : bytes
    minutes : int
    pauses : bool or None
    parts : tuple of str
        Their names.
    """

    id: str
    code: str
    data: bytes
    minutes: int
    pauses: bool | None
    parts: tuple[str, ...]


class ExamRecord(msgspec.Struct, frozen=True):
    """One exam of a learner, as a row of the database; times in seconds since 1970.

    Parameters
    ----------
    id : str
        Nobody can guess it.
    learner : int
    code : str
        Of its paper.
    begun : float
    limit : float or None
        Seconds it may take.
    pauses : bool
        Whether it may rest.
    rested : float
        Seconds of its pauses.
    resting : float, optional
        Since when it rests.
    handed : float, optional
        When it was handed in.
    marks : mapping
        Part to the share of its points that the learner gave to a sentence; part and criterion,
        ``1a/eye``, to the share of those of a criterion.
    paper : str or None
        Id of what it shows; None for one of before papers were kept.
    practice : bool
        Whether its key had been shown to the learner before.
    counted : bool
        Whether it is counted in what the learner has done.
    spent : mapping
        Number of a question to the seconds for which it was on the screen.
    decimal : str
        The decimal sign by which its answers are read: ``auto``, ``point`` or ``comma``.
    """

    id: str
    learner: int
    code: str
    begun: float
    limit: float | None
    pauses: bool
    rested: float = 0.0
    resting: float | None = None
    handed: float | None = None
    marks: dict[str, float] = {}
    paper: str | None = None
    practice: bool = False
    counted: bool = False
    spent: dict[str, float] = {}
    decimal: str = "auto"

    @property
    def ends(self) -> float | None:
        """When its time is over; None without a limit, or during a pause."""
        if self.limit is None or self.resting is not None:
            return None
        return self.begun + self.limit + self.rested

    @property
    def ran_out(self) -> bool:
        """Whether it was handed in because its time was over."""
        return self.handed is not None and self.ends is not None and self.handed >= self.ends

    def is_over(self, now: float) -> bool:
        """Return whether it was handed in, or its time is over; ``now`` is of `Clock`, s."""
        return self.handed is not None or (self.ends is not None and now > self.ends)


T = TypeVar("T")


def row_to_record(row: RowMapping, kind: type[T]) -> T:
    """Return a row of the database as a checked record of a type."""
    return convert({str(name): cell for name, cell in row.items()}, kind)
