"""Who was there: ``statuses.csv``, a line for each time that somebody said so, only added to.

``present`` is said of those who handed in blank paper; ``absent``, ``sick`` and ``withdrawn`` leave
a student without a grade, ``deception`` with the one that fails, whatever the points.
"""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import msgspec

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.rulings import read_filled_rows
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import format_csv

FILE = "statuses.csv"
PRESENT, ABSENT, SICK, WITHDRAWN, DECEPTION = STATUSES = (
    "present", "absent", "sick", "withdrawn", "deception"
)  # fmt: skip
COLUMNS = ("when", "who", "student", "status", "comment")
LONGEST = 10_000
"""Characters of a comment."""


class StudentStatus(msgspec.Struct, frozen=True):
    """What somebody said of a student: a line of ``statuses.csv``."""

    student: str
    status: str
    who: str = ""
    comment: str = ""
    when: str = ""

    def check(self) -> None:
        """Raise ``ClassError`` naming the column if it says nothing.

        Raises
        ------
        ClassError
            Naming the column.
        """
        if self.status not in STATUSES:
            raise ClassError(f"status: {self.status[:40]!r} (there are {', '.join(STATUSES)})")
        if not self.student:
            raise ClassError("student: missing")


def read_statuses(folder: Path) -> dict[str, StudentStatus]:
    """Return what was said last of each student, by id.

    Raises
    ------
    ClassError
        Naming file, line and column.
    """
    return {one.student: one for one in _read_lines(folder)}


def _read_lines(folder: Path) -> list[StudentStatus]:
    """Return all lines of the file, in order."""
    path, found = folder / FILE, []
    for at, cells in read_filled_rows(path, {"student", "status"}):
        one = StudentStatus(**{name: cells.get(name, "").strip()[:LONGEST] for name in COLUMNS})
        try:
            one.check()
        except ClassError as error:
            raise ClassError(f"{path}: line {at}: {error}") from None
        found.append(one)
    return found


def append_status(folder: ClassFolder, status: StudentStatus) -> StudentStatus:
    """Append a line with the current time; return it with the id as the roster writes it.

    Raises
    ------
    ClassError
        If it says nothing, the student is unknown, or another command writes there.
    """
    status.check()
    student = KeyIndex(folder).find_student(status.student)
    with lock_folder(folder.path):
        now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        added = msgspec.structs.replace(status, student=student, when=status.when or now)
        rows = [
            [getattr(one, name) for name in COLUMNS] for one in [*_read_lines(folder.path), added]
        ]
        write_all(folder.path, {FILE: format_csv([COLUMNS, *rows]).encode()}, PRIVATE)
    return added


def find_blank_students(folder: ClassFolder, keys: KeyIndex) -> set[str]:
    """Return the students from whom blank answers count: said to be present, or of a quiz."""
    if not folder.settings.digest:  # an attempt at a quiz tells that somebody was there
        return {*keys.places}
    return {who for who, one in read_statuses(folder.path).items() if one.status == PRESENT}
