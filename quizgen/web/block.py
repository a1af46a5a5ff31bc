"""A block of questions in one go: how far it has got, and what it brought."""

from __future__ import annotations

import re
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from quizgen.core.decoding import convert
from quizgen.practice.session_state import PartState
from quizgen.store import AttemptRecord, OutcomeRecord, Store

MOST = 60
"""Attempts that are looked through for those of a block; none is as long."""


_NUMBER, _POINTS = re.compile("[0-9]{1,3}"), re.compile(r"[0-9]{1,4}\.[0-9]{3}")
# An archive that was taken in may hold any text.


@dataclass(frozen=True)
class PracticeBlockView:
    """The questions of a block, as a line of progress shows them.

    Parameters
    ----------
    id : str
    size : int
        Questions that were planned.
    before : float, optional
        Points of the exam that were expected when it began.
    attempts : tuple of AttemptRecord
        The earliest first; the last may still be open.
    """

    id: str
    size: int
    before: float | None
    attempts: tuple[AttemptRecord, ...]

    @property
    def position(self) -> int:
        """Return the number of the latest question, from 1."""
        return max(1, len(self.attempts))

    @property
    def is_over(self) -> bool:
        """Whether as many questions as were planned have ended."""
        return sum(one.ended is not None for one in self.attempts) >= self.size

    @property
    def states(self) -> list[str]:
        """Return for each question ``full``, ``hollow``, ``here`` or an empty text."""
        seen = [_name_state(one) for one in self.attempts]
        return [*seen, *[""] * (self.size - len(seen))]

    def count_mended(self, outcomes: Iterable[OutcomeRecord]) -> int:
        """Return how many questions are right now that had gone wrong before.

        Parameters
        ----------
        outcomes : iterable of OutcomeRecord
            How the learner's parts went, of any time.
        """
        went_wrong = [(one.template, one.at) for one in outcomes if not one.right]
        right = [one for one in self.attempts if _name_state(one) == "full"]
        return sum(
            any(t == one.template and at < one.begun for t, at in went_wrong) for one in right
        )

    def weak_attempts(self) -> list[AttemptRecord]:
        """Return the attempts with a part that was not right, one of each template."""
        weak = {one.template: one for one in self.attempts if _name_state(one) == "hollow"}
        return list(weak.values())


def begin_block(size: int, before: float | None) -> dict[str, str]:
    """Return the wish of a new block: it travels with each of its attempts."""
    told = "" if before is None else f"{before:.3f}"
    return {"block": secrets.token_urlsafe(9), "size": str(size), "before": told}


def find_block(store: Store, learner: int, wish: Mapping[str, Any]) -> PracticeBlockView | None:
    """Return the block that an attempt was begun in; None if there is none."""
    name = wish.get("block")
    if not name:
        return None
    found = [one for one in store.latest(learner, MOST) if one.wish.get("block") == name]
    size, before = wish.get("size", ""), wish.get("before", "")
    return PracticeBlockView(
        str(name),
        min(int(size), MOST) if _NUMBER.fullmatch(size) else 1,
        float(before) if _POINTS.fullmatch(before) else None,
        tuple(reversed(found)),
    )


def list_part_states(attempt: AttemptRecord) -> list[PartState]:
    """Return how each part of an attempt went."""
    parts: Iterable[Any] = attempt.state.get("parts", {}).values()
    return [convert(part.get("state", {}), PartState) for part in parts]


def _name_state(attempt: AttemptRecord) -> str:
    """Return how a question went, as the line of progress names it."""
    if attempt.ended is None:
        return "here"
    outcomes = [state.outcome for state in list_part_states(attempt)]
    return "full" if all(one is not None and one.right for one in outcomes) else "hollow"
