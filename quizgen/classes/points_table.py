"""Points that a person gave for what was written on paper: a row a student, a column a part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec

from quizgen.classes.key_index import KeyIndex
from quizgen.classes.part_names import PartNames
from quizgen.classes.rulings import POINTS, Ruling
from quizgen.classes.submissions import AnswerTable
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.untrusted import error_context


def read_points_table(path: Path, keys: KeyIndex, who: str, comment: str) -> list[Ruling]:
    """Return a ruling for each cell with points.

    Parameters
    ----------
    path : pathlib.Path
        CSV or XLSX with a column ``id`` or ``code``, and one for each part as it is printed.
    keys : KeyIndex
    who, comment : str
        Of all of them.

    Raises
    ------
    ClassError
        If a student, a part or points are not possible; nothing of it counts then.
    KeyFileError
        If the table cannot be read.
    """
    with error_context(path, KeyFileError):
        table = AnswerTable.find_in_file(path)
    if table is None or table.is_long:
        raise ClassError(f"{path}: the first row names a column 'id', and parts: id,1a,1b")
    found: list[Ruling] = []
    lines: dict[str, int] = {}
    for line, cells, typed in table.students():
        try:
            code = cells.get("code", "").strip()
            student = keys.find_by_code(code) if code else keys.find_student(cells.get("id", ""))
            _require_once(student, line, lines)
            found += _iter_row_points(student, typed, keys)
        except (ClassError, KeyFileError) as error:
            raise ClassError(f"{path}: line {line}: {error}") from None
    if not found:
        raise ClassError(f"{path}: has no points")
    return [msgspec.structs.replace(one, who=who, comment=comment) for one in found]


def _require_once(student: str, line: int, lines: dict[str, int]) -> None:
    """Raise ``ClassError`` if a student stands in an earlier line; ``lines`` are those so far."""
    before = lines.setdefault(student, line)
    if before != line:
        raise ClassError(f"{student} stands in line {before}, too")


def _iter_row_points(student: str, typed: Mapping[str, str], keys: KeyIndex) -> Iterator[Ruling]:
    """Yield a ruling for each cell of a student's row that is not empty.

    Raises ``ClassError`` if part or points are not possible.
    """
    outline = keys.outline(student)
    given, unknown = PartNames(outline.items).sort_answers(typed)
    if odd := next((name for name in unknown if typed[name].strip()), ""):
        raise ClassError(f"the paper of {student} has no part {odd!r}")
    for part, text in given.items():
        if text.strip():
            item, points = outline.items[part], text.strip().replace(",", ".")
            one = Ruling(POINTS, item, value=points, student=student)
            one.check()
            one.check_worth(outline.worth[item])
            yield one
