"""All papers in one file for the printer: in the order of seats, each from a right-hand page."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import ExitStack

from quizgen.classes.class_folder import PAPERS, ClassFolder
from quizgen.classes.roster import RosterStudent
from quizgen.core.errors import require_extra
from quizgen.core.files import PRIVATE, write_all

PRINT = "print.pdf"


def write_print_file(folder: ClassFolder, students: Sequence[RosterStudent]) -> None:
    """Write all papers to ``print.pdf``, each from a right-hand page.

    A blank page follows where needed, so that in two-sided print no sheet has pages of two
    students.

    Raises
    ------
    MissingExtraError
        If pikepdf is not installed.
    """
    require_extra("print", "one file for the printer")
    import pikepdf

    out = io.BytesIO()
    with ExitStack() as opened:
        whole = opened.enter_context(pikepdf.new())
        for one in students:
            source = (folder.path / PAPERS / f"{one.file}.pdf").read_bytes()
            paper = opened.enter_context(pikepdf.open(io.BytesIO(source)))
            whole.pages.extend(paper.pages)
            if len(whole.pages) % 2:
                _, _, width, height = whole.pages[-1].mediabox
                whole.add_blank_page(page_size=(float(width), float(height)))
        whole.save(out, deterministic_id=True)
    write_all(folder.path, {PRINT: out.getvalue()}, PRIVATE)
