"""Exams: begun, answered, rested, handed in. Nothing changes in one that was handed in."""

from __future__ import annotations

import secrets
from collections.abc import Mapping

import msgspec
from sqlalchemy import Connection, bindparam, delete, insert, select, update

from quizgen.core.errors import PaperCodeError
from quizgen.paper.code import parse_code
from quizgen.store.clock import Clock
from quizgen.store.database import Database, upsert
from quizgen.store.records import ExamRecord, OutcomeRecord, Packed, row_to_record
from quizgen.store.schema import ANSWER, FLAG, PAPER, SEEN, SITTING

GRACE = 5.0
"""Seconds after the end in which what was typed before it may still arrive."""
MOST_PARTS = 1000


_OWN = select(SITTING).where(
    SITTING.c.id == bindparam("name"), SITTING.c.learner == bindparam("whose")
)
"""Built once: it is asked with every answer that is saved."""


class ExamStore:
    """Exams that learners sit, with answers, flags, pauses and self-marks.

    Parameters
    ----------
    database : Database
    clock : Clock
        The time of exams.
    """

    def __init__(self, database: Database, clock: Clock) -> None:
        self.database, self.clock = database, clock

    def begin(  # noqa: PLR0913 - what an exam is begun with
        self,
        learner: int,
        code: str,
        limit: float | None,
        *,
        pauses: bool,
        paper: Packed | None = None,
        practice: bool = False,
        decimal: str = "auto",
    ) -> ExamRecord | None:
        """Return a new exam, or the open one of this learner with the same numbers.

        Parameters
        ----------
        learner : int
        code : str
        limit : float or None
            Seconds it may take.
        pauses : bool
        paper : Packed, optional
            What it shows.
        practice : bool
            Begin it also where its key was shown to the learner.
        decimal : str
            The decimal sign by which its answers are read.

        Returns
        -------
        Sitting or None
            None if its key was shown, and it is not for practice.
        """
        name, now = paper.id if paper else None, self.clock.now()

        def work(connection: Connection) -> ExamRecord | None:
            """Insert the exam unless an open one exists; None if its key was shown."""
            known = find_exams_with_numbers(connection, learner, code)
            for one in known:
                if one.handed is None:
                    return one
            if known and not practice:
                return None
            if paper:
                insert_paper(connection, paper)
            made = ExamRecord(secrets.token_urlsafe(12), learner, code, now, limit, pauses,
                           paper=name, practice=bool(known), decimal=decimal)  # fmt: skip
            connection.execute(insert(SITTING).values(msgspec.to_builtins(made)))
            return made

        return self.database.write(learner, work)

    def paper(self, name: str) -> bytes:
        """Return the packed paper of an id, as `Packed.data`."""
        with self.database.reading() as connection:
            query = select(PAPER.c.data).where(PAPER.c.id == name)
            return bytes(connection.execute(query).scalar_one())

    def attach(self, sitting: ExamRecord, paper: Packed) -> None:
        """Store the paper of an exam that has none."""

        def work(connection: Connection) -> None:
            """Insert the paper and link it."""
            insert_paper(connection, paper)
            _update_sitting(connection, sitting, paper=paper.id)

        self.database.write(sitting.learner, work)

    def without_paper(self) -> list[ExamRecord]:
        """Return the exams that have no stored paper, of any learner."""
        with self.database.reading() as connection:
            rows = connection.execute(select(SITTING).where(SITTING.c.paper.is_(None)))
            return [row_to_record(row, ExamRecord) for row in rows.mappings()]

    def find(self, learner: int, name: str) -> ExamRecord | None:
        """Return a learner's own exam; None if there is none of this id, or it is another's."""
        with self.database.reading() as connection:
            return _find_sitting(connection, learner, name)

    def latest(self, learner: int, most: int = 30) -> list[ExamRecord]:
        """Return a learner's exams, the latest first, ``most`` at most."""
        query = select(SITTING).where(SITTING.c.learner == learner)
        query = query.order_by(SITTING.c.begun.desc()).limit(most)
        with self.database.reading() as connection:
            return [row_to_record(row, ExamRecord) for row in connection.execute(query).mappings()]

    def answers(self, sitting: ExamRecord) -> dict[str, list[str]]:
        """Return what stands in the fields of each answered part."""
        query = select(ANSWER.c.part, ANSWER.c.fields).where(ANSWER.c.sitting == sitting.id)
        with self.database.reading() as connection:
            return {str(part): list(fields) for part, fields in connection.execute(query)}

    def flags(self, sitting: ExamRecord) -> frozenset[str]:
        """Return the numbers of the questions that the learner flagged to come back to."""
        query = select(FLAG.c.number).where(FLAG.c.sitting == sitting.id)
        with self.database.reading() as connection:
            return frozenset(map(str, connection.execute(query).scalars()))

    def save(
        self,
        learner: int,
        name: str,
        answers: Mapping[str, list[str]],
        spent: Mapping[str, float] | None = None,
    ) -> tuple[ExamRecord | None, bool]:
        """Store what stands in the fields of some parts, while the exam runs.

        Parameters
        ----------
        learner : int
        name : str
        answers : mapping
        spent : mapping, optional
            Number of a question to the seconds for which it was looked at since the last time.

        Returns
        -------
        sitting : ExamRecord or None
            The learner's exam; None if there is none of this name, or it is another's.
        kept : bool
            False if the exam is over, or its paper has no such part.
        """
        now = self.clock.now()

        def work(connection: Connection) -> tuple[ExamRecord | None, bool]:
            """Write the answers if the exam is the learner's, runs and has these parts."""
            known = _find_sitting(connection, learner, name)
            if known is None or known.resting is not None or known.is_over(now - GRACE):
                return known, False
            if not _has_parts(connection, known, answers):
                return known, False
            for part, fields in answers.items():
                row = {"sitting": name, "part": part, "fields": fields, "at": now}
                upsert(connection, ANSWER, row, ["sitting", "part"], ["fields", "at"])
            if spent:
                _update_sitting(connection, known, spent=_add_times(known, spent, now))
            return known, True

        return self.database.write(learner, work)

    def flag(self, sitting: ExamRecord, number: str) -> None:
        """Flag a question to come back to, or remove its flag."""
        place = (FLAG.c.sitting == sitting.id, FLAG.c.number == number)
        with self.database.writing(sitting.learner) as connection:
            if not connection.execute(delete(FLAG).where(*place)).rowcount:
                connection.execute(insert(FLAG).values(sitting=sitting.id, number=number))

    def declare_decimal(self, sitting: ExamRecord, decimal: str) -> None:
        """Read all answers of an exam by a decimal sign, until it is handed in."""
        with self.database.writing(sitting.learner) as connection:
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is not None and known.handed is None:
                _update_sitting(connection, sitting, decimal=decimal)

    def set_pause(self, sitting: ExamRecord, *, on: bool) -> None:
        """Begin or end a pause; nothing happens where pauses are not allowed."""
        now = self.clock.now()
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

    def hand_in(self, sitting: ExamRecord) -> bool:
        """Hand an exam in; return False if it had been handed in."""
        now = self.clock.now()

        def work(connection: Connection) -> bool:
            """Write the time, ending a pause."""
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is None or known.handed is not None:
                return False
            _update_sitting(connection, sitting, handed=now)
            return True

        return self.database.write(sitting.learner, work)

    def count(self, sitting: ExamRecord, seen: tuple[OutcomeRecord, ...]) -> bool:
        """Record how the parts of an exam went, once; return False if that was done before."""

        def work(connection: Connection) -> bool:
            """Insert the outcomes and mark the exam as counted."""
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is None or known.handed is None or known.counted:
                return False
            _update_sitting(connection, sitting, counted=True)
            for one in seen:
                row = {"learner": sitting.learner, **msgspec.to_builtins(one)}
                connection.execute(insert(SEEN).values(row))
            return True

        return self.database.write(sitting.learner, work)

    def save_self_mark(
        self, sitting: ExamRecord, part: str, share: float, criteria: Mapping[str, float]
    ) -> None:
        """Store the share of the points (0 to 1) that a learner gave to an own sentence.

        ``criteria`` are those that were ticked, each with its share.
        """
        with self.database.writing(sitting.learner) as connection:
            known = _find_sitting(connection, sitting.learner, sitting.id)
            if known is not None and known.handed is not None:
                others = {n: v for n, v in known.marks.items() if not n.startswith(f"{part}/")}
                ticked = {f"{part}/{name}": value for name, value in criteria.items()}
                _update_sitting(connection, sitting, marks={**others, part: share, **ticked})


def _add_times(sitting: ExamRecord, more: Mapping[str, float], now: float) -> dict[str, float]:
    """Return the seconds of each question with more added: together no more than have passed."""
    total = dict(sitting.spent)
    left = now - sitting.begun - sitting.rested - sum(total.values())
    for number, seconds in more.items():
        added = min(max(seconds, 0.0), max(left, 0.0))
        total[number] = round(total.get(number, 0.0) + added, 1)
        left -= added
    return total


def _find_sitting(connection: Connection, learner: int, name: str) -> ExamRecord | None:
    """Return a learner's own exam of an id, or None."""
    row = connection.execute(_OWN, {"name": name, "whose": learner}).mappings().first()
    return row_to_record(row, ExamRecord) if row else None


def insert_paper(connection: Connection, paper: Packed) -> None:
    """Insert a packed paper unless it is stored already."""
    row = {"id": paper.id, "code": paper.code, "parts": paper.parts, "data": paper.data}
    upsert(connection, PAPER, row, ["id"])


def _has_parts(connection: Connection, sitting: ExamRecord, answers: Mapping[str, object]) -> bool:
    """Return whether the paper of an exam has all these parts.

    An exam without a stored paper takes any, up to more parts than any paper has.
    """
    if sitting.paper is not None:
        query = select(PAPER.c.parts).where(PAPER.c.id == sitting.paper)
        return answers.keys() <= set(connection.execute(query).scalar_one())
    query = select(ANSWER.c.part).where(ANSWER.c.sitting == sitting.id)
    return len(answers.keys() | set(connection.execute(query).scalars())) <= MOST_PARTS


def _update_sitting(connection: Connection, sitting: ExamRecord, **values: object) -> None:
    """Set some columns of an exam."""
    connection.execute(update(SITTING).where(SITTING.c.id == sitting.id).values(values))


def find_exams_with_numbers(connection: Connection, learner: int, code: str) -> list[ExamRecord]:
    """Return a learner's exams with the same numbers as a code, in whatever language."""
    start = numbers_of(code)
    query = select(SITTING).where(
        SITTING.c.learner == learner, SITTING.c.code.startswith(start, autoescape=True)
    )
    found = (row_to_record(row, ExamRecord) for row in connection.execute(query).mappings())
    return [one for one in found if numbers_of(one.code) == start]


def numbers_of(code: str) -> str:
    """Return blueprint and seed of a paper's code, which papers with the same numbers share.

    What is no code is returned as it is.
    """
    try:
        found = parse_code(code)
    except PaperCodeError:
        return code
    return f"{found.blueprint}-{found.seed}-"
