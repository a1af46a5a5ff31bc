"""Where a typed matrix has its rows and entries, however it is written."""

from __future__ import annotations

import re

from quizgen.grading.reading.normalise import apply_rewrite
from quizgen.maths.notation import FormulaReadError

LONGEST = 2000
"""Characters of a typed matrix."""
_LATEX = re.compile(r"\\(?:begin|end) ?\{[a-zA-Z]*matrix\}|\\left[(\[]|\\right[)\]]|\\[()]|\$")
_ARRAY = re.compile(r"^(?:\w+\.)?(?:array|[mM]atrix)\((\[.*\])\)$", re.DOTALL)
"""A matrix as NumPy and SymPy print it."""
_ROWS = re.compile(r"\]\s*[,;]?\s*\[|\\\\|[;\n]")
_NESTED = re.compile(
    r"[({\[]?\s*(?:\([^()]*\)\s*,?\s*){2,}[)}\]]?|\{\s*(?:\{[^{}]*\}\s*,?\s*)+\}|(?:\|[^|]+\|\s*){2,}",
)
"""Rows in round or curly brackets, or between bars."""
_ROWS_IN_BRACKETS = re.compile(r"(?:[(\[][^()\[\]]*[;|][^()\[\]]*[)\]]\s*[,;]?\s*){2,}")
"""Rows whose entries are parted by what parts rows elsewhere: ``(12; -14), (14; 27)``."""
_BRACKETS_BETWEEN = re.compile(r"(?<=[)\]])\s*[,;]?\s*(?=[(\[])")
_NAME = re.compile(r"^\s*[^\W\d_]\w{0,9}\s*=\s*(?=\S)")
_DECIMAL_COMMAS = re.compile(r"[-+−]?\d+(?:,\d+)?(?: +[-+−]?\d+(?:,\d+)?)+")
"""Entries with decimal commas between blanks, ``22,5 -19,4``."""
_ENTRIES = re.compile(r"\s*&\s*|,\s+|\t+")


def split_matrix(typed: str, decimal: str = "auto") -> list[list[str]]:
    """Return the entries of a typed matrix, row by row.

    Raises
    ------
    FormulaReadError
        If it is too long, or its rows differ in length.
    """
    if len(typed) > LONGEST:
        raise FormulaReadError("too-long", 1, str(LONGEST))
    text = apply_rewrite("about", _LATEX.sub("", _NAME.sub("", typed)).strip()).rstrip(".")
    text = _ARRAY.sub(r"\1", text)
    text = _NESTED.sub(_square_rows, text)
    in_brackets = _ROWS_IN_BRACKETS.fullmatch(text)
    while not in_brackets and text[:1] in {"[", "("} and text[-1:] in {"]", ")"}:
        text = text[1:-1].strip()
        in_brackets = _ROWS_IN_BRACKETS.fullmatch(text)
    cut = _BRACKETS_BETWEEN if in_brackets else _ROWS
    if cut is _BRACKETS_BETWEEN:
        text = re.sub(r"[;|]", "&", text)
    rows = [_split_row(row, decimal) for row in map(_strip_row, cut.split(text)) if row]
    if not rows or len({len(row) for row in rows}) != 1:
        raise FormulaReadError("matrix-expected", 1, typed.strip()[:60])
    return rows


def _square_rows(match: re.Match[str]) -> str:
    """Return rows in brackets of any sort as rows in square ones: ``{{6, -9}, {8, 8}}``."""
    return match[0].translate(str.maketrans("({|)}", "[[[]]"))


def _strip_row(row: str) -> str:
    """Return a row without its own brackets, of which one may have gone with the rows around it.

    Brackets of an entry stay: ``0, sqrt(2)``.
    """
    row = row.strip(" [],")
    opened = row.count("(") - row.count(")")
    if opened > 0:
        row = row.removeprefix("(")
    elif opened < 0:
        row = row.removesuffix(")")
    elif row[:1] == "(" and row[-1:] == ")" and "(" not in row[1:]:
        row = row[1:-1]
    return row.strip(" ,")


def _split_row(row: str, decimal: str) -> list[str]:
    """Cut a row at ``&``, at commas before a blank, else at blanks and separating commas."""
    if _ENTRIES.search(row):
        return _ENTRIES.split(row)
    if _DECIMAL_COMMAS.fullmatch(row):
        return row.split()
    if "," in row and (decimal != "comma" or " " not in row):
        return row.split(",")
    return row.split()
