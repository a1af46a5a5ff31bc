"""From marks to what is handed out: grades, and a report for each student."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from quizgen.classes.folder import ClassFolder
from quizgen.classes.grades import FOLDER, Graded, graded, write_grades
from quizgen.classes.history import History
from quizgen.classes.keys import Keys
from quizgen.classes.reports import report_html, report_of, report_pdf
from quizgen.classes.scale import read_scale
from quizgen.errors import ClassError, KeyFileError
from quizgen.files import PRIVATE, write_all
from quizgen.outside import located

REPORTS, ANONYMOUS = "reports", "anonymous"
"""Apart, for who hands out the one must not hand out the other."""
CHUNK = 50
"""Reports that are written at once."""


def grade(
    folder: ClassFolder, formats: Sequence[str], *, anonymous: bool = False
) -> tuple[list[Graded], list[str], list[Path]]:
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
        If nothing has been marked.
    RenderError
        If something cannot be written.
    """
    marked = {one.student: one for one in History(folder.path).current()}
    if not marked:
        raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
    scale = read_scale(folder.path)
    lines = graded(folder.students(), folder.heads(), marked, scale)
    files = write_grades(folder.path, lines, scale)
    keys, place = Keys(folder), folder.path / FOLDER / (ANONYMOUS if anonymous else REPORTS)
    for chunk in _chunks([one for one in lines if one.marks] if formats else []):
        write_all(place, _reports(keys, chunk, formats, anonymous), PRIVATE)
    left = marked.keys() - {one.student.id for one in lines}
    return lines, sorted(left), [*files, *([place] if formats else [])]


def _chunks(lines: Sequence[Graded]) -> Iterator[Sequence[Graded]]:
    for at in range(0, len(lines), CHUNK):
        yield lines[at : at + CHUNK]


def _reports(
    keys: Keys, lines: Sequence[Graded], formats: Sequence[str], anonymous: bool
) -> dict[str, bytes]:
    """Name of each file and its bytes."""
    render = {"html": report_html, "pdf": report_pdf}
    made: dict[str, bytes] = {}
    for line in lines:
        with located(keys.path, KeyFileError):
            report = report_of(line, keys.key(line.student.id), anonymous=anonymous)
        name = line.code if anonymous else line.student.file
        made |= {f"{name}.{form}": render[form](report) for form in formats}
    return made
