"""What learners did, kept in a database: SQLite in a file, or PostgreSQL.

In: plain values. Out: plain values. Must never know: requests, pages, questions.
"""

from quizgen.store.records import (
    AttemptRecord,
    ExamRecord,
    Invitation,
    Learner,
    OutcomeRecord,
    Packed,
    Person,
    QuestionRef,
)
from quizgen.store.seats import Seat
from quizgen.store.store import Store

__all__ = [
    "AttemptRecord",
    "ExamRecord",
    "Invitation",
    "Learner",
    "OutcomeRecord",
    "Packed",
    "Person",
    "QuestionRef",
    "Seat",
    "Store",
]
