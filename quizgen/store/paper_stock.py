"""Papers that were made ahead: each is begun by one learner, or goes when its version does."""

from __future__ import annotations

import secrets
from typing import Any

import msgspec
from sqlalchemy import ColumnElement, Connection, Row, delete, func, insert, select

from quizgen.store.clock import Clock
from quizgen.store.database import Database
from quizgen.store.exam_attempts import find_exams_with_numbers, insert_paper
from quizgen.store.records import ExamRecord, Packed
from quizgen.store.schema import PAPER, SEAT, SITTING, STOCK

AGAIN = 3600.0
"""Seconds after which a learner may take another paper of a blueprint from the stock.

So nobody empties it for the others: who begins one after the other waits until they are made.
"""


class PaperStock:
    """Papers in a database that nobody has begun.

    Parameters
    ----------
    database : Database
    clock : Clock
        The time of exams.
    """

    def __init__(self, database: Database, clock: Clock) -> None:
        self.database, self.clock = database, clock

    def count_papers(self, blueprint: str, version: str) -> int:
        """Return how many papers of a blueprint there are.

        Parameters
        ----------
        blueprint : str
        version : str
            Digest of all that papers follow from besides their seed.
        """
        query = select(func.count()).select_from(STOCK).where(*_match_stock(blueprint, version))
        with self.database.reading() as connection:
            return int(connection.execute(query).scalar_one())

    def is_empty(self) -> bool:
        """Whether there is no paper of any blueprint and version."""
        with self.database.reading() as connection:
            return connection.execute(select(STOCK.c.paper).limit(1)).first() is None

    def add_paper(self, blueprint: str, version: str, paper: Packed) -> bool:
        """Put a paper into the stock; False if somebody sits it, or it is there already.

        Parameters
        ----------
        blueprint, version : str
            As of ``count_papers``.
        paper : Packed
        """
        row = {"paper": paper.id, "blueprint": blueprint, "version": version,
               "minutes": paper.minutes, "pauses": paper.pauses}  # fmt: skip
        same = select(PAPER.c.id).where(PAPER.c.id == paper.id)
        with self.database.writing() as connection:
            if connection.execute(same).first() is not None:
                return False
            insert_paper(connection, paper)
            connection.execute(insert(STOCK).values(row))
            return True

    def drop_other_versions(self, version: str) -> int:
        """Remove papers of other versions; how many there were.

        Parameters
        ----------
        version : str
            As of ``count_papers``.
        """
        with self.database.writing() as connection:
            found = connection.execute(delete(STOCK).where(STOCK.c.version != version)).rowcount
            if found:
                delete_unused_papers(connection)
        return found

    def begin_exam(
        self, learner: int, blueprint: str, version: str, *, has_clock: bool, pauses: bool
    ) -> ExamRecord | None:
        """Begin an exam with a paper of the stock, which is then nobody else's.

        Parameters
        ----------
        learner : int
        blueprint, version : str
            As of ``count_papers``.
        has_clock : bool
            Whether it takes only the minutes of its paper.
        pauses : bool
            Whether its clock may be stopped where the paper does not say.

        Returns
        -------
        ExamRecord or None
            None where there is no paper, or the learner has begun one within ``AGAIN`` seconds.
        """
        now = self.clock.now()

        def work(connection: Connection) -> ExamRecord | None:
            """Take a paper out of the stock and begin an exam with it, in one transaction.

            None if the learner began one just now, if none is left, or if they have had its
            numbers.
            """
            if _began_since(connection, learner, blueprint, now - AGAIN):
                return None
            found = _find_paper(connection, blueprint, version)
            if found is None or find_exams_with_numbers(connection, learner, found.code):
                return None
            connection.execute(delete(STOCK).where(STOCK.c.paper == found.paper))
            made = ExamRecord(
                secrets.token_urlsafe(12), learner, found.code, now,
                found.minutes * 60.0 if has_clock else None,
                pauses if found.pauses is None else found.pauses, paper=found.paper,
            )  # fmt: skip
            connection.execute(insert(SITTING).values(msgspec.to_builtins(made)))
            return made

        return self.database.write(learner, work)


def delete_unused_papers(connection: Connection) -> None:
    """Remove the papers that nobody sits and that wait for nobody."""
    sat = select(SITTING.c.paper).where(SITTING.c.paper.is_not(None))
    waiting = select(STOCK.c.paper)
    seated = select(SEAT.c.paper).where(SEAT.c.paper.is_not(None))
    unused = [PAPER.c.id.not_in(found) for found in (sat, waiting, seated)]
    connection.execute(delete(PAPER).where(*unused))


def _match_stock(blueprint: str, version: str) -> tuple[ColumnElement[bool], ...]:
    """Return the conditions that select the stock of a blueprint in one version."""
    return STOCK.c.blueprint == blueprint, STOCK.c.version == version


def _began_since(connection: Connection, learner: int, blueprint: str, since: float) -> bool:
    """Return whether a learner began an exam of a blueprint after a time (Unix, s)."""
    query = select(SITTING.c.id).where(
        SITTING.c.learner == learner,
        SITTING.c.begun > since,
        SITTING.c.code.startswith(f"{blueprint}-", autoescape=True),
    )
    return connection.execute(query.limit(1)).first() is not None


def _find_paper(
    connection: Connection, blueprint: str, version: str
) -> Row[Any, Any, Any, Any] | None:
    """Return a paper no other server is about to give away: PostgreSQL has several writers."""
    query = select(STOCK.c.paper, STOCK.c.minutes, STOCK.c.pauses, PAPER.c.code).join(
        PAPER, PAPER.c.id == STOCK.c.paper
    )
    query = query.where(*_match_stock(blueprint, version)).limit(1)
    return connection.execute(query.with_for_update(of=STOCK, skip_locked=True)).first()
