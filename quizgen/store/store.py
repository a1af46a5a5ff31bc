"""Opening the database, and everything that is read from it and written to it."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Mapping
from typing import Any

import msgspec
from sqlalchemy import Connection, insert, select, update

from quizgen.store.accounts import ALONE, Accounts
from quizgen.store.archive import ArchiveStore
from quizgen.store.clock import Clock, since_boot
from quizgen.store.database import Database, upsert
from quizgen.store.exam_attempts import ExamStore
from quizgen.store.paper_stock import PaperStock
from quizgen.store.records import AttemptRecord, Learner, OutcomeRecord, QuestionRef, row_to_record
from quizgen.store.review_cards import ReviewCardStore
from quizgen.store.schema import ATTEMPT, LEARNER, SEEN, SERVER
from quizgen.store.seats import SeatStore


class SharedValues:
    """Short texts by name, which outlive the server that wrote them.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def find(self, name: str) -> str:
        """Return what stands under a name; "" if nothing."""
        query = select(SERVER.c.value).where(SERVER.c.name == name)
        with self.database.reading() as connection:
            return str(connection.execute(query).scalar() or "")

    def settle(self, name: str, value: str) -> str:
        """Return what stands under a name; ``value``, which then stays, if nothing did.

        Of servers that ask at once, all get that of the first.
        """
        query = select(SERVER.c.value).where(SERVER.c.name == name)
        with self.database.writing() as connection:
            upsert(connection, SERVER, {"name": name, "value": value}, ["name"])
            return str(connection.execute(query).scalar_one())

    def replace(self, name: str, value: str) -> None:
        """Write a text under a name, whatever stood there."""
        with self.database.writing() as connection:
            upsert(connection, SERVER, {"name": name, "value": value}, ["name"], ["value"])


class Store:
    """All records of a server or of one learner, in one database.

    Parameters
    ----------
    address : str
        ``sqlite:///file`` or ``postgresql+psycopg://...``.

    Raises
    ------
    StoreError
        If it cannot be opened, or was written by a newer version.
    """

    def __init__(self, address: str) -> None:
        self.database = Database(address)
        self._learners: dict[str, Learner] = {}
        self._one = threading.Lock()
        self.shared = SharedValues(self.database)
        """What all servers of the database have in common."""
        self.clock = self._begin_clock()
        """The time of exams."""
        self.sittings = ExamStore(self.database, self.clock)
        """Exams that are sat."""
        self.stock = PaperStock(self.database, self.clock)
        """Papers that were made ahead."""
        self.seats = SeatStore(self.database, self.clock)
        """Students of a class that sits its exam."""
        self.cards = ReviewCardStore(self.database)
        """What is asked again, and when."""
        self.accounts = Accounts(self.database)
        """People who sign in."""
        self.archives = ArchiveStore(self.database)
        """Everything of a learner, as a file."""

    def close(self) -> None:
        """Close all connections."""
        self.database.close()

    def check(self) -> None:
        """Raise an error if the database does not answer.

        Raises
        ------
        sqlalchemy.exc.SQLAlchemyError
            If it does not answer.
        """
        with self.database.reading() as connection:
            connection.execute(select(LEARNER.c.id).limit(1))

    def _begin_clock(self) -> Clock:
        """Return a clock that all servers of this database share until the machine restarts."""
        began, name = Clock(), since_boot()
        if not name:
            return began
        kept = self.shared.settle(name, " ".join(map(repr, began.anchor)))
        at, then = map(float, kept.split())
        return Clock((at, then))

    def cached_learner(self, name: str = ALONE) -> Learner | None:
        """Return a learner who has asked before, without the database; None if it must be asked."""
        return self._learners.get(name)

    def learner(self, name: str = ALONE) -> Learner:
        """Return the learner of a name; a new one if nobody has it yet."""
        with self._one:
            with self.database.writing() as connection:
                row = {"name": name, "settings": {}, "since": time.time()}
                upsert(connection, LEARNER, row, ["name"])
                found = _get_learner(connection, name)
            self._learners[name] = found
        return found

    def update_settings(self, learner: int, changed: Mapping[str, Any]) -> None:
        """Change some settings of a learner; the others stay."""
        with self._one, self.database.writing(learner) as connection:
            self._learners.clear()
            query = select(LEARNER.c.settings).where(LEARNER.c.id == learner)
            known = connection.execute(query).scalar_one()
            connection.execute(
                update(LEARNER).where(LEARNER.c.id == learner).values(settings={**known, **changed})
            )

    def start_attempt(
        self, learner: int, which: QuestionRef, wish: Mapping[str, Any]
    ) -> AttemptRecord:
        """Return a new attempt at a question; ``wish`` is the request that it was chosen by."""
        attempt = AttemptRecord(
            secrets.token_urlsafe(12), learner, which.template, which.seed, which.level,
            dict(wish), {}, time.time(),
        )  # fmt: skip
        with self.database.writing(learner) as connection:
            connection.execute(insert(ATTEMPT).values(msgspec.to_builtins(attempt)))
        return attempt

    def attempt(self, learner: int, name: str) -> AttemptRecord | None:
        """Return a learner's own attempt; None if there is none of this id, or it is another's."""
        query = select(ATTEMPT).where(ATTEMPT.c.id == name, ATTEMPT.c.learner == learner)
        with self.database.reading() as connection:
            row = connection.execute(query).mappings().first()
        return row_to_record(row, AttemptRecord) if row else None

    def latest(self, learner: int, most: int = 50) -> list[AttemptRecord]:
        """Return a learner's attempts, the latest first, ``most`` at most."""
        query = (
            select(ATTEMPT)
            .where(ATTEMPT.c.learner == learner)
            .order_by(ATTEMPT.c.begun.desc())
            .limit(most)
        )
        with self.database.reading() as connection:
            rows = connection.execute(query).mappings().all()
        return [row_to_record(row, AttemptRecord) for row in rows]

    def save_attempt(self, attempt: AttemptRecord, seen: tuple[OutcomeRecord, ...] = ()) -> None:
        """Store how far an attempt has got, and how parts of it went."""
        values = {"state": attempt.state, "ended": attempt.ended}
        with self.database.writing(attempt.learner) as connection:
            connection.execute(update(ATTEMPT).where(ATTEMPT.c.id == attempt.id).values(values))
            for one in seen:
                row = {"learner": attempt.learner, **msgspec.to_builtins(one)}
                connection.execute(insert(SEEN).values(row))

    def list_outcomes(self, learner: int, most: int = 2000) -> list[OutcomeRecord]:
        """Return how a learner's finished parts went, the latest last, ``most`` at most."""
        names = [SEEN.c[name] for name in OutcomeRecord.__struct_fields__]
        query = select(*names).where(SEEN.c.learner == learner)
        query = query.order_by(SEEN.c.at.desc(), SEEN.c.id.desc()).limit(most)
        with self.database.reading() as connection:
            rows = connection.execute(query).all()
        return [OutcomeRecord(*row) for row in reversed(rows)]

    def list_repeated(self, learner: int) -> set[str]:
        """Return the ids of attempts at numbers that the learner had been asked before."""
        query = select(ATTEMPT.c.id, ATTEMPT.c.template, ATTEMPT.c.seed)
        query = query.where(ATTEMPT.c.learner == learner).order_by(ATTEMPT.c.begun)
        with self.database.reading() as connection:
            rows = connection.execute(query).all()
        first: dict[tuple[str, str], str] = {}
        for name, template, seed in rows:
            first.setdefault((template, seed), name)
        return {str(name) for name, _, _ in rows} - {*first.values()}

    def was_finished(self, attempt: AttemptRecord) -> bool:
        """Return whether a learner has finished the same question with the same numbers before."""
        query = select(ATTEMPT.c.id).where(
            ATTEMPT.c.learner == attempt.learner,
            ATTEMPT.c.template == attempt.template,
            ATTEMPT.c.seed == attempt.seed,
            ATTEMPT.c.id != attempt.id,
            ATTEMPT.c.ended.is_not(None),
        )
        with self.database.reading() as connection:
            return connection.execute(query.limit(1)).first() is not None


def _get_learner(connection: Connection, name: str) -> Learner:
    """Return the learner of a name, who must exist."""
    query = select(LEARNER.c.id, LEARNER.c.name, LEARNER.c.settings).where(LEARNER.c.name == name)
    return row_to_record(connection.execute(query).mappings().one(), Learner)
