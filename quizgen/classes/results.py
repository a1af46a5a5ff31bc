"""From marks to what is handed out: grades, and a report for each student."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.grade_scale import read_grade_scale
from quizgen.classes.gradebook import FOLDER, GradedStudent, grade_students, write_grades
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import locked
from quizgen.classes.student_reports import make_report, report_to_html, report_to_pdf
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import error_context

REPORTS, ANONYMOUS = "reports", "anonymous"
"""Apart, for who hands out the one must not hand out the other."""
CHUNK = 50
"""Reports that are written at once."""


def write_grades_and_reports(
    folder: ClassFolder, formats: Sequence[str], *, anonymous: bool = False
) -> tuple[list[GradedStudent], list[str], list[Path]]:
    """Write grades and reports; the lines, who is marked and not on the roster, and the files.

    Parameters
    ----------
    folder : ClassFolder
    formats : sequence of str
        ``html``, ``pdf``: of the reports.
    anonymous : bool
        Reports bear the code instead of the name, also as the name of their file,
        in a folder of their own.

    Raises
    ------
    ClassError
        If nothing has been marked, or another command writes there.
    RenderError
        If something cannot be written.
    """
    with locked(folder.path):
        return _grade(folder, formats, anonymous=anonymous)


def _grade(
    folder: ClassFolder, formats: Sequence[str], *, anonymous: bool
) -> tuple[list[GradedStudent], list[str], list[Path]]:
    marked = {one.student: one for one in GradingHistory(folder.path).current()}
    if not marked:
        raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
    scale = read_grade_scale(folder.path)
    lines = grade_students(folder.students(), folder.heads(), marked, scale)
    files = write_grades(folder.path, lines, scale)
    keys, place = KeyIndex(folder), folder.path / FOLDER / (ANONYMOUS if anonymous else REPORTS)
    for chunk in _iter_chunks([one for one in lines if one.marks] if formats else []):
        write_all(place, _render_reports(keys, chunk, formats, anonymous), PRIVATE)
    left = marked.keys() - {one.student.id for one in lines}
    return lines, sorted(left), [*files, *([place] if formats else [])]


def _iter_chunks(lines: Sequence[GradedStudent]) -> Iterator[Sequence[GradedStudent]]:
    for at in range(0, len(lines), CHUNK):
        yield lines[at : at + CHUNK]


def _render_reports(
    keys: KeyIndex, lines: Sequence[GradedStudent], formats: Sequence[str], anonymous: bool
) -> dict[str, bytes]:
    """Name of each file and its bytes."""
    render = {"html": report_to_html, "pdf": report_to_pdf}
    made: dict[str, bytes] = {}
    for line in lines:
        with error_context(keys.path, KeyFileError):
            report = make_report(line, keys.key(line.student.id), anonymous=anonymous)
        name = line.code if anonymous else line.student.file
        made |= {f"{name}.{form}": render[form](report) for form in formats}
    return made
