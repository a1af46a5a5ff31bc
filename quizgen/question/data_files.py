"""Files of drawn data that a learner downloads: ``[files]`` of a template."""

from __future__ import annotations

import base64
import csv
import io
from collections.abc import Iterator
from itertools import zip_longest

from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.core.untrusted import escape_csv_formula
from quizgen.maths.numbers import MINUS
from quizgen.typeset.prose import InlineCode, Paragraph, translate_inlines


class DataFileLink(InlineCode, frozen=True):
    """The name of a data file; pages link it to its content, other outputs print the name."""

    content: bytes = b""

    @property
    def address(self) -> str:
        """The file as an address that needs no server."""
        return f"data:text/csv;base64,{base64.b64encode(self.content).decode()}"


def iter_data_files(drawn: Variant, number: str) -> Iterator[tuple[str, bytes]]:
    """Yield the data files of a question, each with its content: CSV, headed by the quantities.

    Parameters
    ----------
    drawn : Variant
    number : str
        Of the question: the name of a file begins with it, so that a paper has each name once.

    Raises
    ------
    BankError
        If a column is not a drawn list.
    """
    units = drawn.template.units
    for name, columns in drawn.template.rules.files.items():
        for column in columns:
            if not drawn.list_texts(column):
                what = f"files: {column!r} is not a drawn list"
                file, place = drawn.template.file, ("files", name)
                raise BankError(what, rule="QG116", file=file, place=place)
        heads = [f"{c} / {units[c]}" if units.get(c) else c for c in columns]
        cells = [list(_iter_cells(drawn, column)) for column in columns]
        out = io.StringIO()
        rows = zip_longest(*cells, fillvalue="")
        csv.writer(out, lineterminator="\n").writerows((heads, *rows))
        yield f"{number}-{name}", out.getvalue().encode()


def _iter_cells(drawn: Variant, name: str) -> Iterator[str]:
    """Return the cells of a list, as a spreadsheet reads them: no text is a formula there.

    The minus sign of a number must not be guarded from spreadsheets.
    """
    if name in drawn.lists:
        return (text.replace(MINUS, "-") for text in drawn.format_list(name))
    return map(escape_csv_formula, drawn.text_list(name))


def build_file_paragraphs(drawn: Variant, lang: str, number: str) -> tuple[Paragraph, ...]:
    """Return a sentence for each data file of a question that says what it is called."""
    return tuple(
        Paragraph(translate_inlines(lang, "data.file", file=(DataFileLink(name, content),)))
        for name, content in iter_data_files(drawn, number)
    )
