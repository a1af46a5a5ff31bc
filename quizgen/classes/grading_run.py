"""Marking a class: what came back, marked in chunks, kept in the history, the queue written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import msgspec

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.grade_scale import GradeScale, read_grade_scale
from quizgen.classes.grading import (
    JudgedSubmission,
    StudentMarks,
    Submission,
    apply_rulings,
    item_name,
    judge_submission,
    replace_tolerance,
)
from quizgen.classes.grading_history import GradingHistory, GradingOutcome, TotalChange
from quizgen.classes.judged_answers import PASSING, JudgedAnswers, compute_judging_digest
from quizgen.classes.key_index import KeyIndex, read_key_at, read_line_at
from quizgen.classes.lock import lock_folder
from quizgen.classes.manual_grading import (
    DecisionCase,
    decision_cases,
    group_cases,
    prepare_cases,
    read_queue,
    undecided_answers,
    write_queue,
)
from quizgen.classes.rulings import (
    ACCEPT,
    FILE,
    RESTORE,
    TOLERANCE,
    TRAP,
    USE,
    Ruling,
    RulingBook,
    find_files_in_use,
    note_rulings,
    read_rulings,
)
from quizgen.classes.statuses import find_blank_students
from quizgen.classes.submissions import RivalAnswers, Submissions, write_problems, write_rivals
from quizgen.core.cache import compute_digest
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.executor import map_ordered
from quizgen.core.untrusted import error_context
from quizgen.locale import FIRST

CHUNK = 50
"""Students of a job."""


class SubmissionToGrade(NamedTuple):
    """A submission with where its key begins, its name among those judged, and what is known."""

    sheet: Submission
    at: int
    name: str
    judged: JudgedSubmission | None


class GradedSubmission(NamedTuple):
    """Marks of a submission, and if it was judged anew what the machine says, under its name.

    So it does of the answers that a person is to decide on, each under a name of its own.
    """

    marks: StudentMarks
    name: str
    judged: JudgedSubmission | None
    cases: tuple[tuple[str, DecisionCase], ...] = ()


@dataclass(frozen=True)
class GradingJob:
    """Submissions that one worker grades together.

    Parameters
    ----------
    keys : pathlib.Path
        The file of the keys.
    rulings : tuple of Ruling
    sheets : tuple of SubmissionToGrade
    scale : GradeScale
    """

    keys: Path
    rulings: tuple[Ruling, ...]
    sheets: tuple[SubmissionToGrade, ...]
    scale: GradeScale


class GradeChange(NamedTuple):
    """A student whose grade is another one after a run, with the share of the points (0 to 1)."""

    student: str
    before: str
    after: str
    share_before: float
    share_after: float


@dataclass(frozen=True)
class GradingRun:
    """What grading a class did.

    Parameters
    ----------
    outcome : GradingOutcome
    decided : int
        Decisions that were read from the queue.
    groups : int
        Of answers that are still to be decided.
    problems : tuple of str
        What was not marked, and why.
    rivals : tuple of RivalAnswers
        Answers of one student that differ, until a person says which of them count.
    grades : tuple of GradeChange
    filled : mapping of str to (int, int)
        Of each student, how many parts were filled in, and how many there are.
    """

    outcome: GradingOutcome
    decided: int
    groups: int
    problems: tuple[str, ...]
    rivals: tuple[RivalAnswers, ...]
    grades: tuple[GradeChange, ...]
    filled: Mapping[str, tuple[int, int]]


def grade_class(
    folder: ClassFolder, executor: Executor, ahead: int, *, keep: bool = True
) -> GradingRun:
    """Grade every submission of a class with all rulings; record marks and open decisions.

    With ``keep`` false nothing is recorded: the run says what would change.

    Raises
    ------
    ClassError
        If rulings, the queue or the folder cannot be read, or another command writes there;
        nothing is changed then.
    """
    with lock_folder(folder.path):
        return _grade_locked_folder(folder, executor, ahead, keep=keep)


def _grade_locked_folder(
    folder: ClassFolder, executor: Executor, ahead: int, *, keep: bool
) -> GradingRun:
    """Grade the class while its folder is locked."""
    filled, kept = read_queue(folder.path)
    before = read_rulings(folder.path)
    rulings = (*before, *filled)
    keys, history = KeyIndex(folder), GradingHistory(folder.path)
    check_rulings(rulings, keys)
    scale = read_grade_scale(folder.path)
    marked = {one.student: one.file for one in history.current()}
    collected = Submissions(
        folder.path,
        keys,
        marked,
        find_files_in_use(rulings),
        find_blank_students(folder, keys),
    )
    known = JudgedAnswers(folder.path, folder.settings.secret)
    jobs = _iter_jobs(collected.collect(), keys, rulings, scale, known)
    chunks = map_ordered(executor, run_grading_job, jobs, ahead)
    counts: dict[str, tuple[int, int]] = {}
    outcome = history.write(_iter_marks(chunks, counts, known), keep=keep)
    if filled and keep:  # now: a run that ends before this one does reads the same queue again
        note_rulings(folder.path, filled)
    asked = undecided_answers(history.current())
    groups = group_cases(decision_cases(asked, keys.key, FIRST, known))
    if keep:
        known.write()
        write_queue(folder.path, groups, kept)
        write_rivals(folder.path, collected.rivals)
        write_problems(folder.path, collected.problems)
    return GradingRun(
        outcome,
        len(filled),
        len(groups),
        tuple(collected.problems),
        tuple(collected.rivals),
        tuple(_iter_grade_changes(outcome.totals, folder, scale)),
        counts,
    )


def _iter_marks(
    chunks: Iterable[Iterable[GradedSubmission]],
    counts: dict[str, tuple[int, int]],
    known: JudgedAnswers,
) -> Iterator[StudentMarks]:
    """Yield the marks of all chunks, noting how many parts of each student were filled in.

    What was judged anew is kept for the next run.
    """
    for chunk in chunks:
        for one in chunk:
            marks = one.marks
            counts[marks.student] = marks.filled_count, len(marks.parts)
            if one.judged and all(part.plain.note not in PASSING for part in one.judged.parts):
                known.keep(one.name, one.judged)
            for name, case in one.cases:
                known.keep(name, case)
            yield marks


def _iter_grade_changes(
    totals: Iterable[TotalChange], folder: ClassFolder, scale: GradeScale
) -> Iterator[GradeChange]:
    """Yield the students whose grade is another one than before."""
    bonus = {one.id: one.bonus_points for one in folder.students()} if totals else {}
    for one in totals:
        own = bonus.get(one.student, Fraction(0))
        (before, had), (after, has) = (
            (scale.grade_with_bonus(own, Fraction(marks), Fraction(points)), marks / (points or 1))
            for marks, points in (one.before, one.after)
        )
        if before != after:
            yield GradeChange(one.student, before, after, had, has)


def check_rulings(rulings: Iterable[Ruling], keys: KeyIndex) -> None:
    """Raise ``ClassError`` for a ruling about an item or a student that there is not.

    Raises
    ------
    ClassError
        Naming the file, also if one gives more points than its item is worth, or accepts a
        mistake that no key knows.
    """
    stated = [one for one in rulings if one.what != USE]
    worth = keys.worth() if stated else {}
    file = keys.folder.path / FILE
    for one in stated:
        if one.item not in worth:
            raise ClassError(f"{file}: item {one.item!r} is in no paper of this class")
        try:
            one.check_worth(worth[one.item])
            if one.what == ACCEPT and one.answer.startswith(TRAP):
                keys.check_trap(one.item, one.answer.removeprefix(TRAP))
        except ClassError as error:
            raise ClassError(f"{file}: {one.what} {one.item}: {error}") from None
    for one in rulings:
        if one.student and one.student not in keys.places:
            raise ClassError(f"{file}: {one.what} {one.item}: student: nobody of this class has "
                             f"the number {one.student!r}")  # fmt: skip


def check_tolerance(ruling: Ruling, keys: KeyIndex) -> None:
    """Raise ``ClassError`` if a ruling about a tolerance is about an item that has none.

    Raises
    ------
    ClassError
        Before marking would end with it.
    """
    for student in keys.places:
        for question in keys.key(student).questions:
            for part in question.parts:
                if item_name(question, part) == ruling.item:
                    replace_tolerance(part, ruling.item, [ruling])
                    return


def _iter_jobs(
    sheets: Iterable[Submission],
    keys: KeyIndex,
    rulings: tuple[Ruling, ...],
    scale: GradeScale,
    known: JudgedAnswers,
) -> Iterator[GradingJob]:
    """Yield jobs of ``CHUNK`` submissions, each with what is known of it."""
    read = msgspec.json.encode([one for one in rulings if one.what in {TOLERANCE, RESTORE}])
    found = (_look_up(sheet, keys, read, known) for sheet in sheets)
    while chunk := tuple(islice(found, CHUNK)):
        yield GradingJob(keys.path, rulings, chunk, scale)


def _look_up(
    sheet: Submission, keys: KeyIndex, read: bytes, known: JudgedAnswers
) -> SubmissionToGrade:
    """Return a submission with what an earlier run said of it, if all is as it was then."""
    at = keys.places[sheet.student][1]
    said = msgspec.json.encode((sheet.student, dict(sheet.answers), sheet.lang, sheet.decimal))
    line = read_line_at(keys.path, at)
    name = compute_digest(compute_judging_digest(), line, said, read)
    return SubmissionToGrade(sheet, at, name, known.get(name, JudgedSubmission))


def run_grading_job(job: GradingJob) -> list[GradedSubmission]:
    """Return the marks of the submissions of a job."""
    book, done = RulingBook(job.rulings), set[str]()
    with error_context(job.keys, KeyFileError):
        return [_grade_one(one, job, book, done) for one in job.sheets]


def _grade_one(
    one: SubmissionToGrade, job: GradingJob, book: RulingBook, done: set[str]
) -> GradedSubmission:
    """Return the marks of one submission, which is judged only if that is not known."""
    if one.judged:
        marks = apply_rulings(one.judged, one.sheet, book, job.scale)
        return GradedSubmission(marks, one.name, None)
    key = read_key_at(job.keys, one.at)
    judged = judge_submission(key, one.sheet, book)
    marks = apply_rulings(judged, one.sheet, book, job.scale)
    return GradedSubmission(marks, one.name, judged, (*prepare_cases(key, marks, FIRST, done),))
