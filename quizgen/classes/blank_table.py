"""A table to type into: a row a student, a column a part, for answers or for points."""

from __future__ import annotations

import io

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.gradebook import TEXT
from quizgen.classes.key_index import KeyIndex
from quizgen.core.errors import ClassError
from quizgen.core.untrusted import escape_control_characters

ABOUT = ("id", "name", "seat")
WIDE = 14


def build_blank_table(folder: ClassFolder) -> bytes:
    """Return an XLSX file whose cells are text, so that no spreadsheet makes a date of 1/2.

    Raises
    ------
    ClassError
        If the class has no papers.
    """
    import xlsxwriter

    keys, students = KeyIndex(folder), folder.students()
    parts = dict.fromkeys(
        part for one in students if one.id in keys.places for part in keys.outline(one.id).items
    )
    if not parts:
        raise ClassError(f"{folder.path}: has no papers")
    out = io.BytesIO()
    with xlsxwriter.Workbook(out, {"in_memory": True}) as book:
        bold, text = book.add_format({"bold": True}), book.add_format({"num_format": TEXT})
        table = book.add_worksheet("class")
        table.set_column(0, len(ABOUT) + len(parts) - 1, WIDE, text)
        table.freeze_panes(1, len(ABOUT))
        for column, name in enumerate((*ABOUT, *parts)):
            table.write_string(0, column, name, bold)
        for row, one in enumerate(students, 1):
            for column, name in enumerate(ABOUT):
                cell = escape_control_characters(getattr(one, name))
                table.write_string(row, column, cell, text)
    return out.getvalue()
