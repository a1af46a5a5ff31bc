"""What students say against their marks: ``objections.csv``, a line each, only added to.

A line without a reply is an objection, one with a reply answers what stood open of that part.
"""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import msgspec

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.part_names import PartNames
from quizgen.classes.rulings import LONGEST, read_filled_rows
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import format_csv

FILE = "objections.csv"
COLUMNS = ("when", "who", "student", "part", "objection", "reply")


class Objection(msgspec.Struct, frozen=True):
    """A line of ``objections.csv``.

    Parameters
    ----------
    student : str
        The id.
    part : str
        As it is printed on that student's paper.
    objection, reply : str
        One of them is empty.
    who, when : str
    """

    student: str
    part: str
    objection: str = ""
    reply: str = ""
    who: str = ""
    when: str = ""


def read_objections(folder: Path) -> list[Objection]:
    """Return all lines, in order.

    Raises
    ------
    ClassError
        Naming the file and the column.
    """
    rows = read_filled_rows(folder / FILE, {"student", "part", "objection", "reply"})
    return [
        Objection(**{name: cells.get(name, "").strip()[:LONGEST] for name in COLUMNS})
        for _, cells in rows
    ]


def list_open(lines: list[Objection]) -> list[Objection]:
    """Return the objections to which nobody has replied yet."""
    found: dict[tuple[str, str], list[Objection]] = {}
    for one in lines:
        if one.reply:
            found.pop((one.student, one.part), None)
        else:
            found.setdefault((one.student, one.part), []).append(one)
    return [one for own in found.values() for one in own]


def append_objection(folder: ClassFolder, said: Objection) -> Objection:
    """Append a line with the current time; return it as it was written.

    Raises
    ------
    ClassError
        If nothing is said, student or part are unknown, there is nothing to reply to, or another
        command writes there.
    """
    if not (said.objection or said.reply).strip():
        raise ClassError("nothing is said")
    keys = KeyIndex(folder)
    student = keys.find_student(said.student)
    part = PartNames(keys.outline(student).items).find(said.part)
    if not part:
        raise ClassError(f"the paper of {student} has no part {said.part!r}")
    with lock_folder(folder.path):
        lines = read_objections(folder.path)
        is_open = any((one.student, one.part) == (student, part) for one in list_open(lines))
        if said.reply and not is_open:
            raise ClassError(f"{student} has said nothing about {part} that is open")
        now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S")
        added = msgspec.structs.replace(said, student=student, part=part, when=said.when or now)
        rows = [[getattr(one, name) for name in COLUMNS] for one in [*lines, added]]
        write_all(folder.path, {FILE: format_csv([COLUMNS, *rows]).encode()}, PRIVATE)
    return added
