"""When to ask again: a card for each template and each mistake, scheduled by FSRS.

A card is never fixed numbers: a learner who knows a template knows it with any. Source of the
model: Ye, Su, Cao, "A Stochastic Shortest Path Algorithm for Optimizing Spaced Repetition
Scheduling", KDD 2022, as the package ``fsrs`` has it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from datetime import UTC, date, datetime
from enum import IntEnum
from functools import cache
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

import msgspec

from quizgen.bank.levels import GUIDED
from quizgen.practice.session_state import PartOutcome, PartState

if TYPE_CHECKING:
    import fsrs

DAY = 86400.0
NAMED = "trap:"
"""How the note of a mistake begins that a template gives a name to; slips of the pen have none."""
Kind: TypeAlias = Literal["template", "mistake"]
Name: TypeAlias = tuple[Kind, str]
Moment: TypeAlias = Annotated[float, msgspec.Meta(ge=0, le=2.0**33)]
"""Seconds since 1970, in UTC."""


class ReviewRating(IntEnum):
    """How a question went, with the numbers that FSRS counts by."""

    AGAIN = 1
    """Wrong, or given up."""
    HARD = 2
    """Right with help, or at a later try."""
    GOOD = 3
    """Right at once."""


class ReviewCard(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How well a template is known, or how far a mistake is overcome, as FSRS models it.

    Parameters
    ----------
    kind : str
    name : str
        The template's origin; for a mistake, its note behind that.
    state, step, stability, difficulty
        As FSRS has them.
    last, due : float
        When it was asked, and when it is to be asked again.
    """

    kind: Kind
    name: Annotated[str, msgspec.Meta(max_length=300, pattern="^[^\0]+$")]
    state: Annotated[int, msgspec.Meta(ge=1, le=3)]
    step: Annotated[int, msgspec.Meta(ge=0, le=9)] | None
    stability: Annotated[float, msgspec.Meta(gt=0, le=36500)]
    difficulty: Annotated[float, msgspec.Meta(ge=1, le=10)]
    last: Moment
    due: Moment

    @property
    def template(self) -> str:
        """Return the origin of the card's template."""
        return self.name.partition("/")[0]

    @property
    def note(self) -> str:
        """Return the note of the mistake, such as ``trap:swapped``; empty for a template."""
        return self.name.partition("/")[2]


def rate_outcomes(outcomes: Iterable[PartOutcome]) -> ReviewRating | None:
    """Return the rating of a question from its parts; None if all were skipped."""
    tried = [outcome for outcome in outcomes if not outcome.skipped]
    if not tried:
        return None
    if not all(outcome.right for outcome in tried):
        return ReviewRating.AGAIN
    return ReviewRating.GOOD if all(outcome.first for outcome in tried) else ReviewRating.HARD


def days_left(exam: date | None, today: date) -> int | None:
    """Return the days until an exam; None without one, or if it is today or over."""
    return (exam - today).days if exam is not None and exam > today else None


def local_date(now: float) -> date:
    """Return the date of a time (seconds since 1970) in this machine's time zone."""
    return datetime.fromtimestamp(now, UTC).astimezone().date()


def due_time(card: ReviewCard, now: float, left: int | None) -> float:
    """Return when a card should be reviewed, in seconds since 1970: before the exam.

    ``left`` is the days until the exam, None without one. The stored due time may lie after an exam
    whose date was set later, so it is limited here; one day passes between two reviews.
    """
    if left is None:
        return card.due
    return min(card.due, max(now + (left - 1) * DAY, card.last + DAY))


def review_card(
    card: ReviewCard | None, name: Name, grade: ReviewRating, now: float, left: int | None = None
) -> ReviewCard:
    """Return the card as FSRS leaves it after a review; a new one if there was none.

    Parameters
    ----------
    card : ReviewCard, optional
    name : (str, str)
        Kind and name of the card.
    grade : ReviewRating
    now : float
        Seconds since 1970.
    left : int, optional
        Days until the exam: no interval is longer.
    """
    import fsrs  # here, because a page that asks nothing does without

    at = datetime.fromtimestamp(now, UTC)
    known = fsrs.Card(card_id=0, due=at) if card is None else _to_fsrs_card(card)
    scheduler = _load_scheduler(left if left is not None else 36500)
    after, _ = scheduler.review_card(known, fsrs.Rating(int(grade)), at)
    assert after.stability is not None  # noqa: S101 - it was reviewed
    assert after.difficulty is not None  # noqa: S101 - it was reviewed
    return ReviewCard(
        name[0], name[1], int(after.state), after.step, after.stability, after.difficulty,
        now, after.due.timestamp(),
    )  # fmt: skip


@cache
def _load_scheduler(most: int) -> fsrs.Scheduler:
    """Return the FSRS scheduler with a longest interval in days.

    Without fuzz, so that equal reviews give equal due times.
    """
    import fsrs

    return fsrs.Scheduler(maximum_interval=most, enable_fuzzing=False)


def _to_fsrs_card(card: ReviewCard) -> fsrs.Card:
    """Return the card as the package ``fsrs`` takes it."""
    import fsrs

    return fsrs.Card(
        card_id=0,
        state=fsrs.State(card.state),
        step=card.step,
        stability=card.stability,
        difficulty=card.difficulty,
        due=datetime.fromtimestamp(card.due, UTC),
        last_review=datetime.fromtimestamp(card.last, UTC),
    )


class ReviewEvent(msgspec.Struct, frozen=True):
    """A finished question: its template's origin, the rating and the notes of its mistakes."""

    origin: str
    grade: ReviewRating
    notes: tuple[str, ...] = ()


def make_review_event(origin: str, parts: Sequence[PartState], level: str) -> ReviewEvent | None:
    """Return what a finished question means for its cards; None if all parts were skipped.

    Parameters
    ----------
    origin : str
    parts : sequence of PartState
    level : str
        At which it was asked; step by step is help throughout.
    """
    grade = rate_outcomes(part.outcome for part in parts if part.outcome is not None)
    if grade is None:
        return None
    helped = ReviewRating.HARD if level == GUIDED and grade is ReviewRating.GOOD else grade
    notes = (note for part in parts for note in (*part.mistakes, part.note))
    return ReviewEvent(origin, helped, tuple(dict.fromkeys(notes)))


def iter_reviewed_cards(
    cards: Mapping[Name, ReviewCard], asked: ReviewEvent, now: float, left: int | None = None
) -> Iterator[ReviewCard]:
    """Yield the cards that a question changes, as they are after it; nothing is stored.

    Its template's; those of the mistakes that were made; and, if it went right, those of mistakes
    that were made before and not now.
    """
    whole: Name = ("template", asked.origin)
    yield review_card(cards.get(whole), whole, asked.grade, now, left)
    made = {f"{asked.origin}/{note}" for note in asked.notes if note.startswith(NAMED)}
    for name in sorted(made):
        mistake: Name = ("mistake", name)
        yield review_card(cards.get(mistake), mistake, ReviewRating.AGAIN, now, left)
    if asked.grade is not ReviewRating.AGAIN:
        for card in _select_mistake_cards(cards.values(), asked.origin, made):
            yield review_card(card, (card.kind, card.name), asked.grade, now, left)


def _select_mistake_cards(
    cards: Iterable[ReviewCard], origin: str, but: Collection[str]
) -> list[ReviewCard]:
    """Return the cards of a template's mistakes but those named in ``but``."""
    return [
        card
        for card in cards
        if card.kind == "mistake" and card.template == origin and card.name not in but
    ]
