"""Tables as offices keep them: CSV in UTF-8, UTF-16 or Windows-1252, and the first sheet of XLSX.

Of a workbook only what stands in its cells is read: no formula, no other sheet. What a spreadsheet
has made a date of, and a formula whose result is not in the file, are errors like its own.
"""

from __future__ import annotations

import contextlib
import io
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from quizgen.core.untrusted import (
    LARGEST_FILE,
    LARGEST_PICTURE,
    MOST_VALUES,
    ErrorType,
    decode_text,
    detect_encoding,
    iter_csv_rows,
    read_bytes,
)

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

OLD_ENCODING = "cp1252"
"""What German and Western European Windows writes where nobody asks for UTF-8."""
MOST_COLUMNS = 16_384
"""Of a worksheet."""
_ARCHIVE = b"PK\x03\x04"
_OLD_WORKBOOK = b"\xd0\xcf\x11\xe0"
_CELL = re.compile(r"([A-Z]{1,3})(\d+)")
_POINTED = re.compile(r"-?\d*\.?\d+(?:[eE][+-]?\d+)?")
"""A number that may be stored with more digits than it was typed with."""
DATE, FORMULA = "#DATE!", "#FORMULA!"
"""What a cell says that was made a date, as that is stored as a number, or was not computed."""
_ERROR = re.compile(r"#(DATE!|FORMULA!|REF!|NAME\?|VALUE!|N/A|NUM!|DIV/0!|NULL!|SPILL!|CALC!)")
_DATE_FORMATS = frozenset((*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)))
"""Numbers of the formats for dates and times that no workbook spells out."""
_NO_DATE = re.compile(r'"[^"]*"|\[[^]]*]|\\.|_.|\*.')
"""What of a format is shown as it stands, or is a colour or currency."""
_TYPE_DECLARATION = b"<!DOCTYPE"


def iter_spreadsheet_rows(path: Path, error: ErrorType) -> Iterator[tuple[int, list[str]]]:
    """Yield (line number, cells) of each row of a table that is not blank.

    Parameters
    ----------
    path : pathlib.Path
        CSV as any spreadsheet writes it, or XLSX, told by its first bytes.
    error : type
        Class of the error that is raised.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file and if possible the line.
    """
    data = read_bytes(path, error, LARGEST_PICTURE)
    if data.startswith(_OLD_WORKBOOK):
        raise error(f"{path}: is an old workbook (.xls), or has a password; save it as XLSX or CSV")
    if data.startswith(_ARCHIVE):
        yield from _iter_workbook_rows(data, path, error)
    else:
        text = decode_spreadsheet(data, path, error)
        yield from iter_csv_rows(io.StringIO(text, newline=""), path, error)


def is_cell_error(text: str) -> bool:
    """Return whether a cell holds no longer what was typed into it: ``#NAME?``, or a date."""
    return _ERROR.fullmatch(text.strip()) is not None


def is_old_encoding(data: bytes) -> bool:
    """Return whether a text is neither UTF-8 nor UTF-16, so that its letters are a guess."""
    try:
        data.decode(detect_encoding(data))
    except UnicodeDecodeError:
        return not data.startswith(_ARCHIVE)
    return False


def decode_spreadsheet(data: bytes, where: object, error: ErrorType) -> str:
    """Return the text of a CSV file: in Windows-1252 if it is neither UTF-8 nor UTF-16.

    ``where`` is the file, or what messages call it. Lines end in LF.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file.
    """
    if is_old_encoding(data):
        with contextlib.suppress(UnicodeDecodeError):  # no text at all: UTF-8 says where it ends
            data = data.decode(OLD_ENCODING).encode()
    return decode_text(data, where, error)


def _iter_workbook_rows(
    data: bytes, path: Path, error: ErrorType
) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows of the first sheet that a workbook shows."""
    from xml.etree.ElementTree import ParseError

    try:
        with zipfile.ZipFile(io.BytesIO(data)) as book:
            shared = _read_shared_texts(book, path, error)
            dated = _find_date_styles(book, path, error)
            sheet = _parse_member(book, _find_first_sheet(book, path, error), path, error)
            count = 0
            for row in (node for node in sheet.iter() if node.tag.endswith("}row")):
                line, cells = _parse_row(row, shared, dated)
                count += 1 + len(cells)
                if count > MOST_VALUES:
                    raise error(f"{path}: more than {MOST_VALUES} values")
                if any(map(str.strip, cells)):
                    yield line, cells
    except (
        zipfile.BadZipFile, KeyError, IndexError, ValueError, ParseError, RuntimeError,
        EOFError, OSError,
    ) as found:  # fmt: skip
        raise error(f"{path}: not a workbook that can be read ({found}); save it as CSV") from None


def _find_first_sheet(book: zipfile.ZipFile, path: Path, error: ErrorType) -> str:
    """Return the name of the first sheet's file: by the workbook's own list, in its order."""
    listed = _parse_member(book, "xl/workbook.xml", path, error)
    links = _parse_member(book, "xl/_rels/workbook.xml.rels", path, error)
    targets = {link.get("Id"): link.get("Target", "") for link in links}
    (first, *_) = (node for node in listed.iter() if node.tag.endswith("}sheet"))
    (name,) = (value for key, value in first.attrib.items() if key.endswith("}id"))
    target = targets[name]
    return target.lstrip("/") if target.startswith("/") else f"xl/{target}"


def _parse_member(book: zipfile.ZipFile, name: str, path: Path, error: ErrorType) -> Element:
    """Return a file of the archive, unless it is larger than any table or declares entities."""
    from xml.etree.ElementTree import fromstring

    with book.open(name) as stream:
        found = stream.read(LARGEST_FILE + 1)
    if len(found) > LARGEST_FILE or _TYPE_DECLARATION in found:
        raise error(f"{path}: {name} is larger than {LARGEST_FILE // 10**6} MB or declares types")
    return fromstring(found)  # noqa: S314 - no entities


def _read_shared_texts(book: zipfile.ZipFile, path: Path, error: ErrorType) -> list[str]:
    """Return the texts that cells refer to by number."""
    name = "xl/sharedStrings.xml"
    if name not in book.namelist():
        return []
    return [_join_text(node) for node in _parse_member(book, name, path, error)]


def _join_text(node: Element) -> str:
    """Return the text below a node, without the reading aids of Japanese."""
    aids = {id(t) for one in node.iter() if one.tag.endswith("}rPh") for t in one.iter()}
    return "".join(t.text or "" for t in node.iter() if t.tag.endswith("}t") and id(t) not in aids)


def _find_date_styles(book: zipfile.ZipFile, path: Path, error: ErrorType) -> set[str]:
    """Return the numbers of the styles in which cells are shown as dates or times."""
    name = "xl/styles.xml"
    if name not in book.namelist():
        return set()
    styles = _parse_member(book, name, path, error)
    own = {node.get("numFmtId", ""): node.get("formatCode", "") for node in styles.iter()
           if node.tag.endswith("}numFmt")}  # fmt: skip
    listed = next((node for node in styles if node.tag.endswith("}cellXfs")), ())
    formats = [node.get("numFmtId", "0") for node in listed]
    return {str(place) for place, one in enumerate(formats) if _is_date_format(one, own)}


def _is_date_format(number: str, own: dict[str, str]) -> bool:
    """Return whether a format shows numbers as dates or times; ``own`` are the workbook's."""
    if number in own:
        return re.search("[dmyhs]", _NO_DATE.sub("", own[number]), re.IGNORECASE) is not None
    return number.isdecimal() and int(number) in _DATE_FORMATS


def _parse_row(row: Element, shared: list[str], dated: set[str]) -> tuple[int, list[str]]:
    """Return the number of a row and its cells, blank ones in between included."""
    cells: dict[int, str] = {}
    for place, cell in enumerate(row):
        found = _CELL.fullmatch(cell.get("r", ""))
        column = _parse_column(found[1]) if found else place
        cells[column] = _parse_cell(cell, shared, dated)
    last = max(cells, default=-1)
    if last >= MOST_COLUMNS:
        raise ValueError(f"column {last + 1}")
    return int(row.get("r", "0")), [cells.get(at, "") for at in range(last + 1)]


def _parse_column(letters: str) -> int:
    """Return the index of a column from its letters: 0 for ``A``, 26 for ``AA``."""
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1


def _parse_cell(cell: Element, shared: list[str], dated: set[str]) -> str:
    """Return what a cell shows, a whole number without a point.

    ``shared`` are the texts of the workbook, ``dated`` its styles for dates.
    """
    kind = cell.get("t", "n")
    if kind == "inlineStr":
        return _join_text(cell)
    parts = {node.tag.rpartition("}")[2]: node.text or "" for node in cell}
    text = parts.get("v", "")
    if "f" in parts and not text and (kind, "v" in parts) != ("str", True):
        return FORMULA
    if kind == "n" and text and cell.get("s", "0") in dated:
        return DATE
    if kind == "s" and text:
        return shared[int(text)]
    return _format_cell(text, kind)


def _format_cell(text: str, kind: str) -> str:
    """Return what a cell that is no shared text shows."""
    if kind == "b":
        return "true" if text == "1" else "false"
    if kind == "n" and not text.isdecimal() and _POINTED.fullmatch(text):
        return format(float(text), ".15g")
    return text
