"""How sessions went by topic, and which topic to practise next."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence

import msgspec

from quizgen.practice.session_state import PartOutcome

RECENT = 30
"""Parts of a topic that say how well it is known now."""
MOST = 3
"""Topics that are named to practise next."""


class TopicResult(msgspec.Struct, frozen=True):
    """Parts of one topic.

    Parameters
    ----------
    topic : str
    count : int
        Parts that were answered or given up.
    right, later : int
        Of these, right at once, and right after help or another try.
    skipped : int
        Parts that were skipped.
    """

    topic: str
    count: int
    right: int
    later: int
    skipped: int = 0


def summarise_by_topic(
    outcomes: Sequence[PartOutcome], latest: int = sys.maxsize
) -> tuple[TopicResult, ...]:
    """Return the results of each topic, in alphabetical order.

    Parameters
    ----------
    outcomes : sequence of PartOutcome
        In the order in which they came.
    latest : int
        How many parts of each topic count: ``RECENT`` says how well it is known now.
    """
    topics = sorted({outcome.topic for outcome in outcomes})
    return tuple(
        _summarise_topic(topic, [o for o in outcomes if o.topic == topic][-latest:])
        for topic in topics
    )


def weak_topics(results: Iterable[TopicResult]) -> tuple[str, ...]:
    """Return up to ``MOST`` topics in which not all was right at once, the weakest first."""
    weak = [row for row in results if row.right < row.count or row.skipped]
    weak.sort(key=lambda row: row.right / (row.count + row.skipped))
    return tuple(row.topic for row in weak[:MOST])


def _summarise_topic(topic: str, outcomes: list[PartOutcome]) -> TopicResult:
    """Return the counts of one topic; all outcomes are of that topic."""
    tried = [outcome for outcome in outcomes if not outcome.skipped]
    right = sum(outcome.first for outcome in tried)
    later = sum(outcome.right and not outcome.first for outcome in tried)
    return TopicResult(topic, len(tried), right, later, len(outcomes) - len(tried))
