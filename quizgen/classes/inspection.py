"""What a student looks at when the marked papers are shown: one PDF file for each.

Where paper was scanned, its pages are in it, with what was read of them and what it earned.
"""

from __future__ import annotations

import io
from collections.abc import Collection, Sequence
from contextlib import ExitStack
from pathlib import Path

from quizgen.classes.class_folder import SOLUTIONS, ClassFolder, PrintedHead
from quizgen.classes.gradebook import FOLDER, KEY_CHANGED, GradedStudent
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.objections import read_objections
from quizgen.classes.scanning.marked_pages import draw_marked_pages
from quizgen.classes.scanning.pages import WHOLE
from quizgen.classes.scanning.scan_folder import find_crop
from quizgen.classes.student_reports import grade_folder, make_report, report_to_pdf
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import error_context

INSPECTION = "inspection"


def write_inspection(folder: ClassFolder, wanted: Collection[str]) -> list[Path]:
    """Write marks, room for objections, and the own solutions of each student; return the paths.

    Parameters
    ----------
    folder : ClassFolder
    wanted : collection of str
        Ids; all who handed in, if there are none.

    Raises
    ------
    ClassError
        If a student is unknown, or handed in nothing that was marked.
    MissingExtraError
        If pikepdf is not installed.
    """
    folder.settings  # noqa: B018 - a folder that is none of a class says so
    with lock_folder(folder.path):
        keys, marked = KeyIndex(folder), {}
        for one in GradingHistory(folder.path).current():
            marked[one.student] = one
        if not marked:
            raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
        ids = {keys.find_student(one) for one in wanted}
        if missing := ids - marked.keys():
            raise ClassError(f"{min(missing)}: nothing has been marked")
        _, lines = grade_folder(folder, keys, marked)
        objections, paths = read_objections(folder.path), list[Path]()
        for line in lines:
            who = line.student.id
            if not line.marks or line.held == KEY_CHANGED or (ids and who not in ids):
                continue
            own = [one for one in objections if one.student == who]
            with error_context(keys.path, KeyFileError):
                report = make_report(line, keys.key(who), own)
            solved = folder.path / SOLUTIONS / f"{line.student.file}.pdf"
            head, at = keys.places[who]
            crops = _find_crops(folder, head, line)
            read = draw_marked_pages(folder, head, at, line.marks)
            whole = _join_pdfs(report_to_pdf(report, room=True, crops=crops), solved, read)
            name = f"{line.student.file}.pdf"
            paths += write_all(folder.path / FOLDER / INSPECTION, {name: whole}, PRIVATE)
    return paths


def _find_crops(folder: ClassFolder, head: PrintedHead, line: GradedStudent) -> dict[str, Path]:
    """Return the pictures of what a student wrote and a person marks, by part."""
    own = line.marks.parts if line.marks else ()
    found = {one.id: find_crop(folder.path, head, one.id) for one in own
             if one.by or one.needs_decision}  # fmt: skip
    return {part: path for part, path in found.items() if path is not None}


def _join_pdfs(first: bytes, second: Path, pictures: Sequence[bytes]) -> bytes:
    """Return a PDF file with pictures, and the pages of another one if it is there, behind its own.

    Raises ``ClassError`` if something is damaged.
    """
    import pikepdf
    from PIL import Image

    out = io.BytesIO()
    try:
        with ExitStack() as opened:
            whole = opened.enter_context(pikepdf.open(io.BytesIO(first)))
            for one in pictures:
                page = io.BytesIO()
                with Image.open(io.BytesIO(one), formats=("JPEG",)) as picture:
                    picture.save(page, "PDF", resolution=WHOLE * 25.4)
                whole.pages.extend(opened.enter_context(pikepdf.open(page)).pages)
            if second.exists():  # a quiz that was played has none
                whole.pages.extend(opened.enter_context(pikepdf.open(second)).pages)
            whole.save(out, deterministic_id=True)
    except (pikepdf.PdfError, OSError, RuntimeError, ValueError) as error:
        raise ClassError(f"{second}: is damaged ({error})") from None
    return out.getvalue()
