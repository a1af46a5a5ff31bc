"""A run over what a scanner or a phone made: files in, answers and pictures in the class out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from quizgen.classes.class_folder import KEYS, ClassFolder
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.scanning.pages import (
    EMPTY_PAGE,
    PAGE,
    PageReading,
    ReadingJob,
    read_job,
    read_student_sheet,
)
from quizgen.classes.scanning.pictures import (
    ScanFileError,
    compute_file_digest,
    count_pictures,
)
from quizgen.classes.scanning.review_page import write_review_page
from quizgen.classes.scanning.scan_folder import (
    NO_FIELD,
    NOT_SCANNED,
    ReadSheet,
    ScanFolder,
    read_typed_rows,
)
from quizgen.classes.submissions import TABLES
from quizgen.core.executor import map_ordered
from quizgen.locale import FIRST

CHUNK = 4
"""Pictures of a job: what a killed worker costs."""


class ScanFile(NamedTuple):
    """A file of a scanner: its digest, and its pictures that are still to be read, from 0."""

    path: Path
    digest: str
    numbers: tuple[int, ...]


@dataclass(frozen=True)
class ScanReport:
    """What a run did, and what came back so far.

    Parameters
    ----------
    read : int
        Pictures that were read now.
    known : int
        Pictures of the files that had been read before.
    empty : int
        Pictures of those read now that have nothing on them: backs of sheets.
    typed : int
        Answers that people typed, and that are new.
    problems : tuple of str
        Files that could not be read.
    strays : tuple of PageReading
        Pictures that are of no sheet.
    sheets : tuple of ReadSheet
    absent : tuple of str
        Students of whom no page came.
    boxes, doubtful : int
        Boxes on all pages, and how many of them were not read.
    """

    read: int
    known: int
    empty: int
    typed: int
    problems: tuple[str, ...]
    strays: tuple[PageReading, ...]
    sheets: tuple[ReadSheet, ...]
    absent: tuple[str, ...]
    boxes: int
    doubtful: int

    @property
    def open_count(self) -> int:
        """Return how many parts are to be typed or decided by their pictures."""
        elsewhere = {NO_FIELD, NOT_SCANNED}
        return sum(count for why, count in self.reasons.items() if why not in elsewhere)

    @property
    def reasons(self) -> Counter[str]:
        """Return how many parts a person is asked about, by the reason."""
        return Counter(
            one.reading.why for sheet in self.sheets for one in sheet.open_parts.values()
        )


def scan_class(
    folder: ClassFolder,
    paths: Sequence[Path],
    executor: Executor,
    ahead: int,
    tell: Callable[[str], None],
    lang: str = FIRST,
) -> ScanReport:
    """Read files of a scanner, and tables that people typed beside the pictures, into a class.

    What has been read before is not read again.

    Raises
    ------
    ClassError
        If the class has no answer sheets, a table is wrong, or another command writes there.
    """
    keys = KeyIndex(folder)
    for _, at in [*keys.places.values()][:1]:
        read_student_sheet(folder.path / KEYS, at)
    tables = [path for path in paths if path.suffix.lower() in TABLES]
    rows = [row for path in tables for row in read_typed_rows(path, keys)]
    with lock_folder(folder.path):
        scans = ScanFolder(folder)
        scans.path.mkdir(mode=0o700, exist_ok=True)
        done = scans.find_done()
        problems: list[str] = []
        files = [*_find_files([path for path in paths if path not in tables], done, problems)]
        read = empty = 0
        for found in map_ordered(executor, read_job, _iter_jobs(folder.path, files), ahead):
            scans.add_pages(found)
            read += len({one.reading.number for one in found})
            empty += sum(one.reading.fault == EMPTY_PAGE for one in found)
            for one in {(one.reading.number, one.reading.file) for one in found}:
                tell(one[1])
        for student, part, picture in (row for row in rows if row[1].startswith(PAGE)):
            scans.assign_picture(picture, student, int(part.split()[1]))
        typed = scans.add_typed(row for row in rows if not row[1].startswith(PAGE))
        known = sum(len(done.get(one.digest, ())) for one in files)
        report = _describe_run(scans, (read, known, empty, typed), problems)
        if report.sheets:
            scans.write_results(report.sheets)
        write_review_page(scans, report.sheets, report.strays, report.absent, lang)
        return report


def count_new_pictures(folder: ClassFolder, paths: Sequence[Path]) -> int:
    """Return how many pictures a run would read, as far as files can be opened."""
    done = ScanFolder(folder).find_done()
    return sum(len(one.numbers) for one in _find_files(paths, done, []))


def _find_files(
    paths: Iterable[Path], done: dict[str, set[int]], problems: list[str]
) -> Iterator[ScanFile]:
    """Yield each file once, with what is still to be read of it; add to ``problems`` why not."""
    seen = set()
    for path in paths:
        try:
            digest = compute_file_digest(path)
            count = count_pictures(path)
        except ScanFileError as error:
            problems.append(str(error))
            continue
        if digest not in seen:
            seen.add(digest)
            left = sorted({*range(count)} - done.get(digest, set()))
            yield ScanFile(path, digest, tuple(left))


def _iter_jobs(folder: Path, files: Sequence[ScanFile]) -> Iterator[ReadingJob]:
    """Yield jobs of ``CHUNK`` pictures."""
    for one in files:
        for at in range(0, len(one.numbers), CHUNK):
            yield ReadingJob(folder, one.path, one.digest, one.numbers[at : at + CHUNK])


def _describe_run(
    scans: ScanFolder, counts: tuple[int, int, int, int], problems: Sequence[str]
) -> ScanReport:
    """Return what a run did, after all that has been read so far."""
    sheets = scans.join_sheets()
    here = {one.student for one in sheets}
    boxes, doubtful = scans.count_boxes()
    return ScanReport(
        *counts,
        tuple(problems),
        tuple(scans.list_strays()),
        tuple(sheets),
        tuple(one for one in scans.folder.places() if one not in here),
        boxes,
        doubtful,
    )
