"""Forgetting a class: names, ids, codes and free text go, what the questions taught stays.

What stays is built whole in a folder of its own before anything is deleted, so that a run that is
killed can be run again. Pseudonyms are dealt out in an order that nothing else tells.
"""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path

import msgspec

from quizgen.classes.agreement import is_settlement
from quizgen.classes.class_folder import (
    KEYS,
    ROSTER,
    SETTINGS,
    ClassFolder,
    PrintedHead,
    format_record,
    format_settings,
)
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.grade_scale import FILE as SCALE
from quizgen.classes.grading import GradedClassPart, StudentMarks
from quizgen.classes.grading_history import FOLDER as MARKS
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import FILE as LOCK
from quizgen.classes.lock import lock_folder
from quizgen.classes.pseudonyms import new_secret
from quizgen.classes.roster import RosterStudent, write_roster
from quizgen.classes.rulings import COLUMNS, DECIDE, SECOND, read_rulings
from quizgen.classes.rulings import FILE as RULINGS
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import format_csv, parse_toml, read_text

STAGE = ".forgotten"
"""Holds what stays, from when it is whole until everything else is gone."""
JUDGED = frozenset({"right", "wrong", "partial"})
"""Answers that are numbers, ticks and the like, which name nobody."""


def forget_class(folder: ClassFolder) -> int:
    """Delete whatever names or tells a student, and keep points and questions; return of how many.

    Raises
    ------
    ClassError
        If something is not what a class holds, or another command writes there.
    """
    stage = folder.path / STAGE
    if not stage.exists():
        folder.settings  # noqa: B018 - nothing is deleted in a folder that is none of a class
    with lock_folder(folder.path):
        if not stage.exists():
            write_all(stage, _build_remains(folder), PRIVATE)
        for path in folder.path.iterdir():
            if path.name not in {STAGE, LOCK}:
                delete_path(path)
        for path in stage.iterdir():
            path.rename(folder.path / path.name)
        stage.rmdir()
    return len(ClassFolder(folder.path).students())


def delete_path(path: Path) -> None:
    """Delete a file, a link, or a folder with all that is in it."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink()


def _build_remains(folder: ClassFolder) -> dict[str, bytes]:
    """Return the files that stay, by name."""
    keys = KeyIndex(folder)
    if changed := keys.find_changed():
        raise ClassError(f"{folder.path}: the keys of {len(changed)} students have been changed")
    names = _deal_pseudonyms({*keys.places, *(one.id for one in folder.students())})
    marks = sorted(
        (_strip_marks(one, names) for one in GradingHistory(folder.path).current()),
        key=lambda one: one.student,
    )
    settings = msgspec.structs.replace(folder.settings, secret=new_secret(), digest="")
    remains = {
        SETTINGS: format_settings(settings),
        ROSTER: write_roster([RosterStudent(one) for one in sorted(names.values())]),
        KEYS: b"".join(_iter_stripped_keys(keys, names)),
        RULINGS: _format_agreement(folder.path),
        f"{MARKS}/001.jsonl": b"".join(msgspec.json.encode(one) + b"\n" for one in marks),
    }
    for name in (SCALE, EXAM):
        if (folder.path / name).exists():
            remains[name] = (folder.path / name).read_bytes()
    if EXAM in remains:
        remains[EXAM] = _strip_date(folder.path / EXAM)
    return remains


def _deal_pseudonyms(ids: set[str]) -> dict[str, str]:
    """Return a pseudonym for each id, in an order that is drawn and kept nowhere."""
    order = sorted(ids)
    secrets.SystemRandom().shuffle(order)
    width = len(str(len(order)))
    return {one: f"S{number:0{width}}" for number, one in enumerate(order, 1)}


def _strip_marks(marks: StudentMarks, names: Mapping[str, str]) -> StudentMarks:
    """Return marks without whose they are, free text, and who gave them."""
    parts = tuple(_strip_part(part) for part in marks.parts)
    return msgspec.structs.replace(marks, student=names[marks.student], parts=parts, file="")


def _strip_part(part: GradedClassPart) -> GradedClassPart:
    """Return a part's mark without free text, and without who decided."""
    typed = part.typed if part.status in JUDGED else ""
    by = part.by.partition(" ")[0].rstrip(",")
    return msgspec.structs.replace(part, typed=typed, by=by, remark="")


def _iter_stripped_keys(keys: KeyIndex, names: Mapping[str, str]) -> list[bytes]:
    """Return the keys as lines of the file, each under the pseudonym and without a code."""
    lines = []
    for student, name in sorted(names.items(), key=lambda pair: pair[1]):
        if student in keys.places:
            key = msgspec.structs.replace(keys.key(student), code="", paper="")
            lines.append(format_record(PrintedHead(name, "", "", ""), key))
    return lines


def _format_agreement(folder: Path) -> bytes:
    """Return the decisions of two markers without answers, comments and names."""
    rows = [
        [
            getattr(one, name) if name in {"what", "item", "value", "group"} else ""
            for name in COLUMNS
        ]
        for one in read_rulings(folder)
        if one.what in {DECIDE, SECOND} and one.group and not (one.student or is_settlement(one))
    ]
    return format_csv([COLUMNS, *rows]).encode()


def _strip_date(path: Path) -> bytes:
    """Return ``exam.toml`` without the date on which the class was to be forgotten."""
    text = read_text(path, ClassError)
    lines = [line for line in text.splitlines() if not line.strip().startswith("keep_until")]
    parse_toml("\n".join(lines), path, ClassError)
    return ("\n".join(lines) + "\n").encode()
