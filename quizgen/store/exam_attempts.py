"""Exams: begun, answered, rested, handed in. Nothing changes in one that was handed in."""

from __future__ import annotations

import secrets
import time
from collections.abc import Mapping

import msgspec
from sqlalchemy import Connection, bindparam, delete, insert, select, update

from quizgen.store.database import Database, upsert
from quizgen.store.records import ExamRecord, OutcomeRecord
from quizgen.store.schema import ANSWER, FLAG, SEEN, SITTING
from quizgen.store.values import row_to_record

GRACE = 5.0
"""Seconds after the end in which what was typed before it may still arrive."""


_OWN = select(SITTING).where(
    SITTING.c.id == bindparam("name"), SITTING.c.learner == bindparam("whose")
)
"""Built once: it is asked with every answer that is saved."""


class ExamStore:
    """Exams in a database.

    Parameters
    ----------
    database : Database
    """

    def __init__(self, database: Database) -> None:
        self.database = database

    def begin(self, learner: int, code: str, limit: float | None, *, pauses: bool) -> ExamRecord:
        """Begin an exam."""
        made = ExamRecord(secrets.token_urlsafe(12), learner, code, time.time(), limit, pauses)
        with self.database.writing(learner) as connection:
            connection.execute(insert(SITTING).values(msgspec.to_builtins(made)))
        return made

    def find(self, learner: int, name: str) -> ExamRecord | None:
        """A learner's own exam; None if there is none of this name, or it is another's."""
        with self.database.reading() as connection:
            return _find_sitting(connection, learner, name)

    def latest(self, learner: int, most: int = 30) -> list[ExamRecord]:
        """A learner's exams, the latest first."""
        query = select(SITTING).where(SITTING.c.learner == learner)
        query = query.order_by(SITTING.c.begun.desc()).limit(most)
        with self.database.reading() as connection:
            return [row_to_record(row, ExamRecord) for row in connection.execute(query).mappings()]

    def answers(self, sitting: ExamRecord) -> dict[str, list[str]]:
        """Part to what stands in its fields."""
        query = select(ANSWER.c.part, ANSWER.c.fields).where(ANSWER.c.sitting == sitting.id)
        with self.database.reading() as connection:
            return {str(part): list(fields) for part, fields in connection.execute(query)}

    def flags(self, sitting: ExamRecord) -> frozenset[str]:
        """Questions to come back to."""
        query = select(FLAG.c.number).where(FLAG.c.sitting == sitting.id)
        with self.database.reading() as connection:
            return frozenset(map(str, connection.execute(query).scalars()))

    def save(
        self, learner: int, name: str, answers: Mapping[str, list[str]]
    ) -> tuple[ExamRecord | None, bool]:
        """Keep what stands in the fields of parts.

        Returns
        -------
        sitting : Sitting or None
            The learner's exam; None if there is none of this name, or it is another's.
        kept : bool
            False if the exam is over.
        """
        now = time.time()
        with self.database.writing(learner) as connection:
            known = _find_sitting(connection, learner, name)
            if known is None or known.resting is not None or known.is_over(now - GRACE):
                return known, False
            for part, fields in answers.items():
                row = {"sitting": name, "part": part, "fields": fields, "at": now}
                upsert(connection, ANSWER, row, ["sitting", "part"], ["fields", "at"])
        return known, True

    def flag(self, sitting: ExamRecord, number: str) -> None:
        """Mark a question to come back to, or take the mark away."""
        place = (FLAG.c.sitting == sitting.id, FLAG.c.number == number)
        with self.database.writing(sitting.learner) as connection:
            if not connection.execute(delete(FLAG).where(*place)).rowcount:
                connection.execute(insert(FLAG).values(sitting=sitting.id, number=number))

    def set_pause(self, sitting: ExamRecord, *, on: bool) -> None:
        """Begin or end a pause, where pauses are allowed."""
        now = time.time()
        with self.database.writing(sitting.learner) as connection:
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is None or not known.pauses or known.is_over(now):
                return
            if on and known.resting is None:
                _update_sitting(connection, sitting, resting=now)
            elif not on and known.resting is not None:
                _update_sitting(
                    connection, sitting, resting=None, rested=known.rested + now - known.resting
                )

    def hand_in(self, sitting: ExamRecord, seen: tuple[OutcomeRecord, ...]) -> bool:
        """Hand an exam in, once; False if it was."""
        with self.database.writing(sitting.learner) as connection:
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is None or known.handed is not None:
                return False
            _update_sitting(connection, sitting, handed=time.time())
            for one in seen:
                row = {"learner": sitting.learner, **msgspec.to_builtins(one)}
                connection.execute(insert(SEEN).values(row))
        return True

    def save_self_mark(self, sitting: ExamRecord, part: str, share: float) -> None:
        """Keep the share of the points that a learner gave to a sentence."""
        with self.database.writing(sitting.learner) as connection:
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is not None and known.handed is not None:
                _update_sitting(connection, sitting, marks={**known.marks, part: share})


def _find_sitting(connection: Connection, learner: int, name: str) -> ExamRecord | None:
    row = connection.execute(_OWN, {"name": name, "whose": learner}).mappings().first()
    return row_to_record(row, ExamRecord) if row else None


def _update_sitting(connection: Connection, sitting: ExamRecord, **values: object) -> None:
    connection.execute(update(SITTING).where(SITTING.c.id == sitting.id).values(values))
