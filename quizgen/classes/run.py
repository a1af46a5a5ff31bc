"""Marking a class: what came back, marked in chunks, kept in the history, the queue written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from quizgen.classes.collect import Collected
from quizgen.classes.decide import cases, grouped, read_queue, waiting, write_queue
from quizgen.classes.folder import ClassFolder
from quizgen.classes.history import History, Outcome
from quizgen.classes.keys import Keys, key_at
from quizgen.classes.mark import Marks, Sheet, mark_sheet
from quizgen.classes.rulings import FILE, Book, Ruling, append_rulings, read_rulings
from quizgen.errors import ClassError, KeyFileError
from quizgen.executors import in_order
from quizgen.locale import FIRST
from quizgen.outside import located

CHUNK = 50
"""Students of a job."""


@dataclass(frozen=True)
class Job:
    """Sheets to be marked together.

    Parameters
    ----------
    keys : pathlib.Path
        The file of the keys.
    rulings : tuple of Ruling
    sheets : tuple of (Sheet, int)
        Each with where its key begins.
    """

    keys: Path
    rulings: tuple[Ruling, ...]
    sheets: tuple[tuple[Sheet, int], ...]


@dataclass(frozen=True)
class Run:
    """What marking a class did.

    Parameters
    ----------
    outcome : Outcome
    decided : int
        Decisions that were read from the queue.
    groups : int
        Of answers that are still to be decided.
    problems : tuple of str
        What was not marked, and why.
    """

    outcome: Outcome
    decided: int
    groups: int
    problems: tuple[str, ...]


def mark_class(folder: ClassFolder, executor: Executor, ahead: int) -> Run:
    """Mark all that came back, with all that was decided.

    Raises
    ------
    ClassError
        If rulings, the queue or the folder cannot be read; nothing is changed then.
    """
    filled, kept = read_queue(folder.path)
    before = read_rulings(folder.path)
    rulings = (*before, *filled)
    keys, history = Keys(folder), History(folder.path)
    _check_items(rulings, keys)
    collected = Collected(folder.path, keys)
    jobs = _jobs(collected, keys, rulings)
    chunks = in_order(executor, marked, jobs, ahead)
    outcome = history.write(one for chunk in chunks for one in chunk)
    if filled:  # now: a run that ends before this one does reads the same queue again
        append_rulings(folder.path, filled)
    groups = grouped(cases(waiting(history.current()), keys.key, FIRST))
    write_queue(folder.path, groups, kept)
    return Run(outcome, len(filled), len(groups), tuple(collected.problems))


def _check_items(rulings: Iterable[Ruling], keys: Keys) -> None:
    """Refuse rulings about what nobody was asked."""
    named = {one.item for one in rulings}
    unknown = named - keys.items() if named else ()
    if unknown:
        raise ClassError(f"{FILE}: item {min(unknown)!r} is in no paper of this class")


def _jobs(sheets: Iterable[Sheet], keys: Keys, rulings: tuple[Ruling, ...]) -> Iterator[Job]:
    found = iter(sheets)
    while chunk := tuple((sheet, keys.places[sheet.student][1]) for sheet in islice(found, CHUNK)):
        yield Job(keys.path, rulings, chunk)


def marked(job: Job) -> list[Marks]:
    """Mark the sheets of a job."""
    book = Book(job.rulings)
    with located(job.keys, KeyFileError):
        return [mark_sheet(key_at(job.keys, at), sheet, book) for sheet, at in job.sheets]
