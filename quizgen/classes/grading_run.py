"""Marking a class: what came back, marked in chunks, kept in the history, the queue written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.grading import StudentMarks, Submission, grade_submission
from quizgen.classes.grading_history import GradingHistory, GradingOutcome
from quizgen.classes.key_index import KeyIndex, read_key_at
from quizgen.classes.lock import lock_folder
from quizgen.classes.manual_grading import (
    decision_cases,
    group_cases,
    read_queue,
    undecided_answers,
    write_queue,
)
from quizgen.classes.rulings import FILE, Ruling, RulingBook, note_rulings, read_rulings
from quizgen.classes.submissions import Submissions
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.executor import map_ordered
from quizgen.core.untrusted import error_context
from quizgen.locale import FIRST

CHUNK = 50
"""Students of a job."""


@dataclass(frozen=True)
class GradingJob:
    """Submissions that one worker grades together.

    Parameters
    ----------
    keys : pathlib.Path
        The file of the keys.
    rulings : tuple of Ruling
    sheets : tuple of (Submission, int)
        Each with where its key begins.
    """

    keys: Path
    rulings: tuple[Ruling, ...]
    sheets: tuple[tuple[Submission, int], ...]


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
    """

    outcome: GradingOutcome
    decided: int
    groups: int
    problems: tuple[str, ...]


def grade_class(folder: ClassFolder, executor: Executor, ahead: int) -> GradingRun:
    """Grade every submission of a class with all rulings; record marks and open decisions.

    Raises
    ------
    ClassError
        If rulings, the queue or the folder cannot be read, or another command writes there;
        nothing is changed then.
    """
    with lock_folder(folder.path):
        return _grade_locked_folder(folder, executor, ahead)


def _grade_locked_folder(folder: ClassFolder, executor: Executor, ahead: int) -> GradingRun:
    """Grade the class while its folder is locked."""
    filled, kept = read_queue(folder.path)
    before = read_rulings(folder.path)
    rulings = (*before, *filled)
    keys, history = KeyIndex(folder), GradingHistory(folder.path)
    _check_items(rulings, keys)
    collected = Submissions(folder.path, keys)
    jobs = _iter_jobs(collected, keys, rulings)
    chunks = map_ordered(executor, run_grading_job, jobs, ahead)
    outcome = history.write(one for chunk in chunks for one in chunk)
    if filled:  # now: a run that ends before this one does reads the same queue again
        note_rulings(folder.path, filled)
    groups = group_cases(decision_cases(undecided_answers(history.current()), keys.key, FIRST))
    write_queue(folder.path, groups, kept)
    return GradingRun(outcome, len(filled), len(groups), tuple(collected.problems))


def _check_items(rulings: Iterable[Ruling], keys: KeyIndex) -> None:
    """Raise ``ClassError`` for a ruling about an item that no paper has."""
    named = {one.item for one in rulings}
    unknown = named - keys.items() if named else ()
    if unknown:
        file = keys.folder.path / FILE
        raise ClassError(f"{file}: item {min(unknown)!r} is in no paper of this class")


def _iter_jobs(
    sheets: Iterable[Submission], keys: KeyIndex, rulings: tuple[Ruling, ...]
) -> Iterator[GradingJob]:
    """Yield jobs of ``CHUNK`` submissions, each with the byte offset of its key."""
    found = iter(sheets)
    while chunk := tuple((sheet, keys.places[sheet.student][1]) for sheet in islice(found, CHUNK)):
        yield GradingJob(keys.path, rulings, chunk)


def run_grading_job(job: GradingJob) -> list[StudentMarks]:
    """Return the marks of the submissions of a job."""
    book = RulingBook(job.rulings)
    with error_context(job.keys, KeyFileError):
        return [
            grade_submission(read_key_at(job.keys, at), sheet, book) for sheet, at in job.sheets
        ]
