"""All papers in one file for the printer: in the order of seats, each from a right-hand page."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from quizgen.classes.class_folder import PAPERS, SHEETS, ClassFolder
from quizgen.classes.roster import RosterStudent
from quizgen.core.errors import ClassError, require_extra
from quizgen.core.files import PRIVATE, write_all

PRINT = "print.pdf"


def write_print_file(folder: ClassFolder, students: Sequence[RosterStudent]) -> None:
    """Write all papers and answer sheets to ``print.pdf``, each from a right-hand page.

    A blank page follows where needed, so that in two-sided print no sheet has pages of two
    students.

    Raises
    ------
    MissingExtraError
        If pikepdf is not installed.
    ClassError
        If a paper is damaged; it names the file.
    """
    require_extra("print", "one file for the printer")
    import pikepdf

    out = io.BytesIO()
    with ExitStack() as opened:
        whole = opened.enter_context(pikepdf.new())
        for file in (file for one in students for file in _list_printed_files(folder, one)):
            source = file.read_bytes()
            try:
                paper = opened.enter_context(pikepdf.open(io.BytesIO(source)))
                whole.pages.extend(paper.pages)
                if len(whole.pages) % 2:
                    _, _, width, height = whole.pages[-1].mediabox
                    whole.add_blank_page(page_size=(float(width), float(height)))
            except (
                pikepdf.PdfError,
                pikepdf.PasswordError,
                RuntimeError,
                ValueError,
                TypeError,
                KeyError,
                AttributeError,
            ) as error:  # what is missing or of another type in a damaged page
                raise ClassError(
                    f"{file}: is damaged ({error}); delete it and run quizgen class make again"
                ) from None
        whole.save(out, deterministic_id=True)
    write_all(folder.path, {PRINT: out.getvalue()}, PRIVATE)


def _list_printed_files(folder: ClassFolder, one: RosterStudent) -> list[Path]:
    """Return the files of a student that are printed: the paper, and the answer sheet if any."""
    sheet = folder.path / SHEETS / f"{one.file}.pdf"
    return [folder.path / PAPERS / f"{one.file}.pdf", *([sheet] if sheet.exists() else [])]
