"""The room in which a class sits its exam: who is in it, the time of each, what is handed in.

Everything that matters stands in the database or in the folder of the class; only when who was seen
last is kept in memory. So a server that was killed goes on where it was.
"""

from __future__ import annotations

import asyncio
import hashlib
import logging
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool

from quizgen.bank.bank import Bank
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.exam_details import ExamDetails, read_exam_details
from quizgen.classes.generation import (
    GenerationJob,
    compose_paper_again,
    list_paper_jobs,
    open_class_bank,
)
from quizgen.classes.gradebook import GradedStudent
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.room_lists import FOLDER as LISTS
from quizgen.classes.room_lists import number_seats
from quizgen.classes.safe_exam_browser import FILE as SETTINGS_FILE
from quizgen.classes.safe_exam_browser import read_config_key
from quizgen.classes.seats import (
    HandedPaper,
    append_record,
    entry_code,
    read_record,
    store_handed_papers,
)
from quizgen.classes.student_reports import grade_folder
from quizgen.core.decoding import convert
from quizgen.core.errors import ClassError, QuizgenError
from quizgen.paper.blueprint import load_blueprint
from quizgen.practice.input_fields import join_fields
from quizgen.store import ExamRecord, Packed, Seat, Store
from quizgen.web.event_log import find_cause, log_event
from quizgen.web.fairness import Allowance
from quizgen.web.job_cache import WorkerPool
from quizgen.web.papers import Papers, pack
from quizgen.web.question_view import paper_views

LOOK = 2.0
"""Seconds after which exams whose time is over are handed in."""
LOST = 40.0
"""Seconds without a sign of a browser that is writing, after which it is taken to be gone."""
AT_ONCE = 20
"""Papers that are written into the folder of the class together."""
WRONG_CODES = (20, 2.0)
"""Wrong codes from one address at once, and seconds until one more is looked at."""
MOST_WARNINGS = 20
"""Of one student that are remembered; the latest."""
CAME_IN = "came in"
WARNINGS = {"reused": "code tried again", "address": "another computer"}
"""What supervisors should look at, and what it is called in the record."""
OPENED, HELD, RELEASED = "exam-opened", "exam-held", "exam-released"
"""What all servers of a database know of the exam."""
MINUTE = 60.0


@dataclass(frozen=True)
class SeatPaperJob:
    """Composes a student's paper once more, as it was printed, and packs it.

    Parameters
    ----------
    code : str
        Of the paper, by which two jobs are equal.
    job : GenerationJob
    """

    code: str
    job: GenerationJob = field(compare=False)

    def run(self, bank: Bank) -> bytes:
        """Return the paper in all its languages, packed for storage.

        Raises
        ------
        ClassError
            If another paper would be composed now.
        """
        del bank  # that of the class, which its settings name
        return msgspec.msgpack.encode(pack(paper_views(compose_paper_again(self.job, self.code))))


@dataclass
class Presence:
    """What is known of a student's browser."""

    seen: float = 0.0
    address: str = ""
    warnings: list[tuple[float, str, str]] = field(default_factory=list)
    """When, the key of its word, and what more is to be said."""

    def warn(self, now: float, what: str, more: str = "") -> bool:
        """Remember something that supervisors should know; False if it was said a moment ago."""
        if any(now - at < MINUTE for at, *same in self.warnings if same == [what, more]):
            return False
        self.warnings = [*self.warnings, (now, what, more)][-MOST_WARNINGS:]
        return True


class ClassRoom:
    """A class that sits its exam on this server.

    Parameters
    ----------
    folder : pathlib.Path
    store : Store
    workers : WorkerPool
    papers : Papers

    Raises
    ------
    ClassError
        If it is no class with papers, its bank has changed, or the database is of another class.
    """

    def __init__(self, folder: Path, store: Store, workers: WorkerPool, papers: Papers) -> None:
        self.folder, self.store = ClassFolder(folder), store
        self._workers, self._papers = workers, papers
        settings = self.folder.settings
        self._heads = self.folder.heads()
        own = [pair for pair in number_seats(self.folder.students()) if pair[0].id in self._heads]
        if not own or not settings.digest:
            raise ClassError(f"{folder}: has no papers (quizgen class make)")
        self.students = {one.id: one for one, _ in own}
        self.places = {one.id: seat for one, seat in own}
        self.exam = read_exam_details(folder / EXAM) or ExamDetails()
        self.config_keys = self._list_config_keys()
        self.presence = self._recall_presence()
        self.wrong_codes = Allowance(*WRONG_CODES)
        mark = hashlib.sha256(settings.secret.encode()).hexdigest()[:40]
        if store.shared.settle("class", mark) != mark:
            raise ClassError(f"{folder}: the database is of another class; name another one")
        langs = {one.id: one.lang or settings.lang for one in self.students.values()}
        store.seats.add_students({who: self._first_language(lang) for who, lang in langs.items()})
        self._jobs = self._list_jobs()
        self._marks: dict[str, GradedStudent] | None = None
        self._stored = asyncio.Lock()

    def _recall_presence(self) -> dict[str, Presence]:
        """Return what the record of the exam tells of students' browsers."""
        found = {student: Presence(self.now()) for student in self.students}
        keys = {said: key for key, said in WARNINGS.items()}
        for when, student, what, more in read_record(self.folder):
            here = found.get(student)
            if here and what in keys:
                here.warn(when, keys[what], more)
            if here and what in {CAME_IN, WARNINGS["address"]}:
                here.address = more
        return found

    @property
    def settings_file(self) -> Path:
        """Return where the settings file of Safe Exam Browser stands."""
        return self.folder.path / LISTS / SETTINGS_FILE

    def _list_config_keys(self) -> list[str]:
        """Return the settings of Safe Exam Browser with which students come in, by their keys."""
        rules = self.exam.browser
        own = [read_config_key(self.settings_file)] if rules.safe_exam_browser else []
        return [*rules.config_keys, *own]

    def _list_jobs(self) -> dict[str, GenerationJob]:
        """Return what makes the papers; nothing once all are there, whatever the bank is now."""
        seats = [one for one in self.store.seats.list_seats() if one.student in self.students]
        if all(one.paper for one in seats):
            return {}
        settings = self.folder.settings
        blueprint = load_blueprint(settings.blueprint, open_class_bank(settings))
        return list_paper_jobs(self.folder, blueprint)

    def _first_language(self, lang: str) -> str:
        """Return a language of pages: for papers in several the first of the bank."""
        spoken = open_class_bank(self.folder.settings).languages
        return lang if lang in spoken else spoken[0]

    def now(self) -> float:
        """Return the time of exams in seconds since 1970."""
        return self.store.clock.now()

    def code_of(self, student: str, issue: int) -> str:
        """Return the code that lets a student in."""
        return entry_code(self.folder.settings.secret, student, issue)

    def minutes_of(self, student: str) -> int:
        """Return the working time of a student's paper in minutes, without extra time."""
        return self.exam.browser.minutes or self._heads[student].minutes

    def extra_of(self, seat: Seat) -> float:
        """Return the seconds that a student has beyond the others."""
        own = self.students[seat.student].extra_minutes(self.minutes_of(seat.student))
        return own * MINUTE + seat.more

    def opens(self) -> float | None:
        """Return from when on students may begin; None until a person says so."""
        opened = self.store.shared.find(OPENED)
        begins = self.exam.browser.begins
        return float(opened) if opened else begins.timestamp() if begins else None

    def is_held(self) -> bool:
        """Return whether everybody is paused, so that nobody begins either."""
        return bool(self.store.shared.find(HELD))

    def is_released(self) -> bool:
        """Return whether students may see their marks."""
        return bool(self.store.shared.find(RELEASED))

    def time_left(self, seat: Seat, now: float) -> float:
        """Return the seconds that a student has who begins now; negative if it is too late."""
        extra, ends = self.extra_of(seat), self.exam.browser.ends
        left = self.minutes_of(seat.student) * MINUTE + extra
        return min(left, ends.timestamp() + extra - now) if ends else left

    def status(self, seat: Seat) -> str:
        """Return where a student is.

        ``early``, ``ready``, ``missed`` (too late to begin), ``writing``, ``paused`` or ``handed``.
        """
        one, now = seat.sitting, self.now()
        if one is not None:
            if one.handed is not None:
                return "handed"
            return "writing" if one.resting is None else "paused"
        opens = self.opens()
        if opens is None or now < opens or self.is_held():
            return "early"
        return "ready" if self.time_left(seat, now) > 0 else "missed"

    def state_tag(self, seat: Seat) -> str:
        """Return a text that changes when a student's page is to be read again."""
        one = seat.sitting
        status = self.status(seat)
        state = status, one and (one.limit, one.rested, one.handed)
        shown = status == "handed" and self.is_released()
        return hashlib.sha256(repr((state, shown)).encode()).hexdigest()[:12]

    def note_seen(self, student: str, address: str) -> bool:
        """Note that a student's browser has asked for something; return whether it is another."""
        here = self.presence[student]
        is_other = bool(here.address) and here.address != address
        here.seen, here.address = self.now(), address
        return is_other

    def warn(self, student: str, what: str, address: str) -> None:
        """Tell supervisors what they should look at, and write it down."""
        if self.presence[student].warn(self.now(), what, address):
            self.record("server", student, WARNINGS[what], address)

    def is_lost(self, seat: Seat) -> bool:
        """Return whether a browser that was writing has not been heard of for a while."""
        return (
            self.status(seat) == "writing" and self.now() - self.presence[seat.student].seen > LOST
        )

    def record(self, who: str, student: str, what: str, more: str = "") -> None:
        """Write down what happened, for an office that asks later."""
        append_record(self.folder, who, student, what, more)

    async def begin(self, seat: Seat) -> ExamRecord | None:
        """Return a student's exam, begun now if there is none; None if it may not be begun."""
        if seat.sitting is not None:
            return seat.sitting
        if await run_in_threadpool(self.status, seat) != "ready":
            return None
        if seat.paper is None:
            await self.make_paper(seat)
        limit = self.time_left(seat, self.now())
        begun = await run_in_threadpool(self.store.seats.begin, seat.learner, limit)
        await run_in_threadpool(self.record, seat.student, seat.student, "begun")
        return begun

    async def make_paper(self, seat: Seat, asker: object = None) -> None:
        """Compose and store a student's paper; two who ask at once wait for the same one."""
        job = SeatPaperJob(self._heads[seat.student].code, self._jobs[seat.student])
        data = await self._workers.get_result(job, asker or seat.learner, is_kept=False)
        paper = convert(msgspec.msgpack.decode(data), Packed)
        await run_in_threadpool(self.store.seats.set_paper, seat.learner, paper)

    async def make_all_papers(self) -> None:
        """Make the papers that are missing, as many at once as there are workers."""
        seats = await run_in_threadpool(self.store.seats.list_seats)
        todo = iter([one for one in seats if one.paper is None and one.student in self._jobs])

        async def make_some(asker: object) -> None:
            """Make one paper after the other."""
            for seat in todo:
                try:
                    await self.make_paper(seat, asker)
                except (QuizgenError, SQLAlchemyError) as error:
                    log_event("no paper made ahead", logging.WARNING, **find_cause(error))

        await asyncio.gather(
            *(make_some(f"ahead {n}") for n in range(self._workers.settings.workers))
        )

    async def watch(self) -> None:
        """Hand in what is over and bring it into the folder of the class, until cancelled."""
        while True:
            try:
                await self.close_and_store()
            except (QuizgenError, SQLAlchemyError, OSError) as error:
                log_event("not stored yet", logging.WARNING, **find_cause(error))
            await asyncio.sleep(LOOK)

    async def close_and_store(self) -> None:
        """Hand in the exams whose time is over; write what was handed in as forms."""
        async with self._stored:
            seats = await run_in_threadpool(self._close_seats)
            todo = [one for one in seats if one.is_to_be_stored and one.student in self.students]
            for at in range(0, len(todo), AT_ONCE):
                await self._store_seats(todo[at : at + AT_ONCE])

    def _close_seats(self) -> list[Seat]:
        """Hand in what is over; return all seats as they are then."""
        store, now = self.store.seats, self.now()
        seats = store.list_seats()
        over = [one for one in seats if one.is_to_be_closed(now)]
        if not over:
            return seats
        store.hand_in([one.learner for one in over])
        for one in over:
            self.record("clock", one.student, "handed in")
        return store.list_seats()

    async def _store_seats(self, seats: Sequence[Seat]) -> None:
        """Write what some students handed in, and note that it is there."""
        papers = [await self._build_handed_paper(one) for one in seats]
        await run_in_threadpool(store_handed_papers, self.folder, papers)
        handed = {one.learner: one.sitting.handed for one in seats if one.sitting}
        known = {learner: at for learner, at in handed.items() if at is not None}
        await run_in_threadpool(self.store.seats.note_stored, known)
        for paper in papers:
            filled = sum(bool(text.strip()) for text in paper.answers.values())
            more = f"{filled} parts filled, {paper.minutes:.0f} min"
            self.record(paper.student.id, paper.student.id, "stored", more)

    async def _build_handed_paper(self, seat: Seat) -> HandedPaper:
        """Return what a student handed in, each part in one line."""
        one = seat.sitting
        assert one is not None  # noqa: S101 - it was handed in
        paper = await self._papers.of(one, seat.lang)
        answers = await run_in_threadpool(self.store.sittings.answers, one)
        fields = [part.field for item in paper.items for part in item.parts]
        typed = {
            one.id: join_fields(one.control, answers[one.id], one.marks)
            for one in fields
            if one.id in answers
        }
        taken = max(0.0, (one.handed or one.begun) - one.begun - one.rested)
        lang = paper.items[0].wanted.lang
        times = taken / MINUTE, one.spent
        return HandedPaper(self.students[seat.student], one.code, lang, typed, *times, one.decimal)

    def release(self, *, on: bool) -> None:
        """Let students see their marks, or not any more.

        Raises
        ------
        ClassError
            If nothing has been marked yet.
        """
        self._marks = None
        if on and not self._read_marks():
            raise ClassError(
                f"{self.folder.path}: nothing has been marked yet (quizgen class mark)"
            )
        self.store.shared.replace(RELEASED, str(time.time()) if on else "")

    def marks_of(self, student: str) -> GradedStudent | None:
        """Return marks and grade of a student as they were when they were first asked for."""
        if self._marks is None:
            self._marks = self._read_marks()
        return self._marks.get(student)

    def _read_marks(self) -> dict[str, GradedStudent]:
        """Return marks and grades of all who were marked."""
        marked = {one.student: one for one in GradingHistory(self.folder.path).current()}
        if not marked:
            return {}
        _, lines = grade_folder(self.folder, KeyIndex(self.folder), marked)
        return {one.student.id: one for one in lines}

    def find_code(self, code: str) -> tuple[str, int, int, float | None] | None:
        """Return student, learner, issue and time of use of a code; None if nobody has it."""
        for student, (learner, issue, used) in self.store.seats.list_issues().items():
            if student in self.students and self.code_of(student, issue) == code:
                return student, learner, issue, used
        return None


def list_learners(seats: Iterable[Seat]) -> list[int]:
    """Return the learners of some seats."""
    return [one.learner for one in seats]
