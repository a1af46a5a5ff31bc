"""What learners did, kept in a database: SQLite in a file, or PostgreSQL.

In: plain values. Out: plain values. Must never know: requests, pages, questions.
"""

from quizgen.web.store.base import Store
from quizgen.web.store.rows import Attempt, Invitation, Learner, Person, Seen, Sitting, Which

__all__ = ["Attempt", "Invitation", "Learner", "Person", "Seen", "Sitting", "Store", "Which"]
