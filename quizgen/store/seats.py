"""Students of a class that sits its exam here: who has come in, whose paper is whose.

A student comes in by a code that is good once. ``issue`` counts the codes of a student: what the
code of an issue is follows from the secret of the class, which no database holds.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
from sqlalchemy import Connection, Row, Select, delete, func, insert, select, update

from quizgen.core.decoding import convert
from quizgen.store.clock import Clock
from quizgen.store.database import Database, upsert
from quizgen.store.exam_attempts import GRACE, insert_paper
from quizgen.store.records import ExamRecord, Learner, Packed
from quizgen.store.schema import ANSWER, LEARNER, PAPER, SEAT, SESSION, SITTING

NAMES = "seat "
"""Before the id of a student in the names of learners, which no account can be called."""


class Seat(msgspec.Struct, frozen=True):
    """A student of the class; times in seconds since 1970.

    Parameters
    ----------
    student : str
        The id.
    learner : int
    lang : str
        Of the pages.
    issue : int
        How many codes were made for the student before the latest.
    used : float, optional
        When the latest code let somebody in.
    more : float
        Seconds that supervisors gave, over the extra time of the roster.
    paper : str, optional
        Id of the paper; None until it is made.
    sitting : ExamRecord, optional
        None until the exam is begun.
    stored : float, optional
        When what the class's folder has was handed in.
    filled : int
        Parts in which something stands.
    saved : float, optional
        When an answer was saved last.
    """

    student: str
    learner: int
    lang: str
    issue: int
    used: float | None
    more: float
    paper: str | None
    sitting: ExamRecord | None = None
    stored: float | None = None
    filled: int = 0
    saved: float | None = None

    def is_to_be_closed(self, now: float) -> bool:
        """Return whether the time was over `GRACE` ago, and nobody has handed the exam in.

        ``now`` is a time of `Clock`, s.
        """
        one = self.sitting
        return one is not None and one.handed is None and one.is_over(now - GRACE)

    @property
    def is_to_be_stored(self) -> bool:
        """Whether the class's folder has not what was handed in last."""
        return (
            self.sitting is not None
            and self.sitting.handed is not None
            and self.stored != self.sitting.handed
        )


class SeatStore:
    """The students of a class in the database of a server.

    Parameters
    ----------
    database : Database
    clock : Clock
        The time of exams.
    """

    def __init__(self, database: Database, clock: Clock) -> None:
        self.database, self.clock = database, clock

    def add_students(self, langs: Mapping[str, str]) -> None:
        """Add students who are not there yet.

        Parameters
        ----------
        langs : mapping of str to str
            Id to the language of the pages.
        """
        with self.database.writing() as connection:
            known = {str(one) for one in connection.execute(select(SEAT.c.student)).scalars()}
            for student, lang in langs.items():
                if student in known:
                    continue
                row = {"name": NAMES + student, "settings": {"lang": lang}, "since": time.time()}
                upsert(connection, LEARNER, row, ["name"])
                mine = select(LEARNER.c.id).where(LEARNER.c.name == row["name"])
                learner = connection.execute(mine).scalar_one()
                seat = {"student": student, "learner": learner, "issue": 0, "more": 0.0}
                upsert(connection, SEAT, seat, ["student"])

    def signed_in(self, token_hash: str) -> tuple[Learner, Seat] | None:
        """Return whose session the hash of a token names; None if it is no student's.

        Parameters
        ----------
        token_hash : str
            As ``accounts.hash_token`` makes it.
        """
        query = _select_seats(LEARNER.c.name)
        query = query.join(SESSION, SESSION.c.learner == SEAT.c.learner)
        query = query.where(SESSION.c.hash == token_hash, SESSION.c.until > time.time())
        with self.database.reading() as connection:
            row = connection.execute(query).first()
        if row is None:
            return None
        return Learner(row.learner, row.name, row.settings), _row_to_seat(row)

    def list_seats(self) -> list[Seat]:
        """Return all students, without what each has saved."""
        with self.database.reading() as connection:
            return [*map(_row_to_seat, connection.execute(_select_seats()))]

    def list_progress(self) -> list[Seat]:
        """Return all students with how far each has got."""
        counts = (
            select(
                ANSWER.c.sitting, func.count().label("filled"), func.max(ANSWER.c.at).label("at")
            )
            .group_by(ANSWER.c.sitting)
            .subquery()
        )
        query = _select_seats(counts.c.filled, counts.c.at).join(
            counts, counts.c.sitting == SEAT.c.sitting, isouter=True
        )
        with self.database.reading() as connection:
            return [
                msgspec.structs.replace(_row_to_seat(row), filled=row.filled or 0, saved=row.at)
                for row in connection.execute(query)
            ]

    def find(self, learner: int) -> Seat | None:
        """Return the seat of a learner; None if it is no student."""
        with self.database.reading() as connection:
            return _find_seat(connection, learner)

    def list_issues(self) -> dict[str, tuple[int, int, float | None]]:
        """Return learner, number of the latest code and when it was used, by student."""
        query = select(SEAT.c.student, SEAT.c.learner, SEAT.c.issue, SEAT.c.used)
        with self.database.reading() as connection:
            return {
                str(student): (learner, issue, used)
                for student, learner, issue, used in connection.execute(query)
            }

    def use_code(self, learner: int, issue: int) -> bool:
        """Use up a code; False if it was used before: of two at once only one gets in."""
        fresh = (SEAT.c.learner == learner, SEAT.c.issue == issue, SEAT.c.used.is_(None))
        new = {"used": self.clock.now()}
        with self.database.writing(learner) as connection:
            return bool(connection.execute(update(SEAT).where(*fresh).values(new)).rowcount)

    def issue_code(self, learner: int) -> int:
        """Return the number of a new code; the one before ends, and so does its browser's session.

        What was answered stays.
        """
        with self.database.writing(learner) as connection:
            connection.execute(delete(SESSION).where(SESSION.c.learner == learner))
            new = {"issue": SEAT.c.issue + 1, "used": None}
            _update_seat(connection, learner, **new)
            query = select(SEAT.c.issue).where(SEAT.c.learner == learner)
            return int(connection.execute(query).scalar_one())

    def set_paper(self, learner: int, paper: Packed) -> None:
        """Store the paper of a student who has not begun."""

        def work(connection: Connection) -> None:
            """Insert the paper and link it."""
            insert_paper(connection, paper)
            mine = (SEAT.c.learner == learner, SEAT.c.sitting.is_(None))
            connection.execute(update(SEAT).where(*mine).values(paper=paper.id))

        self.database.write(learner, work)

    def begin(self, learner: int, limit: float) -> ExamRecord | None:
        """Return the student's exam: begun now, or the one that there is.

        Parameters
        ----------
        learner : int
        limit : float
            Seconds it may take.

        Returns
        -------
        ExamRecord or None
            None if there is no paper yet.
        """
        now = self.clock.now()

        def work(connection: Connection) -> ExamRecord | None:
            """Insert the exam unless there is one."""
            seat = _find_seat(connection, learner)
            if seat is None or seat.paper is None:
                return None
            if seat.sitting is not None:
                return seat.sitting
            code = connection.execute(select(PAPER.c.code).where(PAPER.c.id == seat.paper))
            made = ExamRecord(secrets.token_urlsafe(12), learner, str(code.scalar_one()), now,
                              limit, pauses=False, paper=seat.paper)  # fmt: skip
            connection.execute(insert(SITTING).values(msgspec.to_builtins(made)))
            _update_seat(connection, learner, sitting=made.id)
            return made

        return self.database.write(learner, work)

    def give_time(self, learners: Sequence[int], seconds: float) -> None:
        """Give more time to students who have not handed in, whether they have begun or not."""

        def work(connection: Connection, seat: Seat) -> None:
            """Lengthen the exam, and what one that is begun later may take."""
            if seat.sitting is None or seat.sitting.handed is None:
                _update_seat(connection, seat.learner, more=SEAT.c.more + seconds)
                _update_sitting(connection, seat, limit=SITTING.c.limit + seconds)

        self._change(learners, work)

    def set_pause(self, learners: Sequence[int], *, on: bool) -> None:
        """Stop the clocks of exams that are going on, or let them go on."""
        now = self.clock.now()

        def work(connection: Connection, seat: Seat) -> None:
            """Begin or end a pause."""
            one = seat.sitting
            if one is None or one.is_over(now):
                return
            if on and one.resting is None:
                _update_sitting(connection, seat, resting=now)
            elif not on and one.resting is not None:
                rested = one.rested + now - one.resting
                _update_sitting(connection, seat, resting=None, rested=rested)

        self._change(learners, work)

    def hand_in(self, learners: Sequence[int]) -> None:
        """Hand in the exams that are going on; what was saved counts."""
        now = self.clock.now()

        def work(connection: Connection, seat: Seat) -> None:
            """Write the time: the end of the exam, if that is over."""
            one = seat.sitting
            if one is not None and one.handed is None:
                _update_sitting(connection, seat, handed=min(now, one.ends or now))

        self._change(learners, work)

    def reopen(self, learner: int, seconds: float) -> None:
        """Let a student who has handed in go on for some seconds."""
        now = self.clock.now()

        def work(connection: Connection, seat: Seat) -> None:
            """Take the handing-in back."""
            one = seat.sitting
            if one is not None and one.handed is not None:
                limit = now - one.begun - one.rested + seconds
                _update_sitting(connection, seat, handed=None, resting=None, limit=limit)

        self._change([learner], work)

    def note_stored(self, handed: Mapping[int, float]) -> None:
        """Note when what the class's folder has was handed in, by learner."""
        with self.database.writing() as connection:
            for learner, at in handed.items():
                _update_seat(connection, learner, stored=at)

    def _change(self, learners: Sequence[int], work: Any) -> None:
        """Do something with the seats of learners, all or nothing."""
        with self.database.writing() as connection:
            for learner in learners:
                seat = _find_seat(connection, learner)
                if seat is not None:
                    work(connection, seat)


def _select_seats(*more: Any) -> Select[Any]:
    """Return the query of seats with their exams, and more columns."""
    columns = [SITTING.c[name].label(f"sitting_{name}") for name in ExamRecord.__struct_fields__]
    own = [one for one in SEAT.c if one.name != "sitting"]
    query = select(*own, LEARNER.c.settings, *columns, *more).select_from(SEAT)
    query = query.join(LEARNER, LEARNER.c.id == SEAT.c.learner)
    return query.join(SITTING, SITTING.c.id == SEAT.c.sitting, isouter=True)


def _find_seat(connection: Connection, learner: int) -> Seat | None:
    """Return the seat of a learner, or None."""
    row = connection.execute(_select_seats().where(SEAT.c.learner == learner)).first()
    return _row_to_seat(row) if row else None


def _row_to_seat(row: Row[Any]) -> Seat:
    """Return the seat of a row of ``_select_seats``."""
    cells = row._mapping  # noqa: SLF001 - the public name of SQLAlchemy for it
    exam = {name: cells[f"sitting_{name}"] for name in ExamRecord.__struct_fields__}
    return Seat(
        row.student, row.learner, str(row.settings.get("lang", "")), row.issue, row.used, row.more,
        row.paper, convert(exam, ExamRecord) if exam["id"] else None, row.stored,
    )  # fmt: skip


def _update_seat(connection: Connection, learner: int, **values: object) -> None:
    """Set some columns of a seat."""
    connection.execute(update(SEAT).where(SEAT.c.learner == learner).values(values))


def _update_sitting(connection: Connection, seat: Seat, **values: object) -> None:
    """Set some columns of a student's exam, if there is one."""
    if seat.sitting is not None:
        connection.execute(update(SITTING).where(SITTING.c.id == seat.sitting.id).values(values))
