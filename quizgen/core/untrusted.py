"""Reading what comes from outside - banks, papers, forms, scenes - and believing none of it.

A file is read only if it is a regular one (a pipe or a device would hang or never end) and not
larger than expected; a table only if it is not too deep, too long, or made of numbers that nobody
means. The caller says which error is raised, so that it names the file by its kind.
"""

from __future__ import annotations

import codecs
import csv
import io
import json
import os
import re
import stat
import tomllib
import unicodedata
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import chain, islice
from pathlib import Path
from typing import TypeAlias

from quizgen.core.errors import QuizgenError
from quizgen.core.positions import Place

ErrorType: TypeAlias = type[QuizgenError]
"""The kind of error that a reader raises."""

LARGEST_FILE = 20_000_000
"""Bytes of the largest text that is read."""
LARGEST_PICTURE = 100_000_000
"""Bytes of the largest picture that is read."""
DEEPEST = 30
"""Tables and lists within each other."""
MOST_VALUES = 500_000
"""Values of one file."""
MOST_DIGITS = 400
"""Digits of one whole number."""
LONGEST_NAME = 100

_STRING = re.compile(r'"(?:[^"\\]|\\.)*+(?:"|\\?\Z)', re.DOTALL)
"""A text in JSON, up to its quotation mark or the end of all."""
_MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
"""What a text in UTF-16 begins with, as some editors and shells of Windows write it."""
_TOML_LINE = re.compile(r"\(at line (\d+), column \d+\)$")
"""Where tomllib stopped; before Python 3.14 its error says so in words alone."""
_SEPARATORS = ",;\t"
_NAME = re.compile(rf"(?!\.+$)[A-Za-z0-9_.-]{{1,{LONGEST_NAME}}}")
_TOO_LARGE = 10**MOST_DIGITS
_STARTS_FORMULA = frozenset({"=", "+", "-", "@", "\u2212", "\t"})
_JOINERS = frozenset("\u200c\u200d")
"""Bangla needs them."""
CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
"""What steers terminals and stands in no text; tabs and ends of lines do."""
_BREAKS = frozenset({"Zl", "Zp"})
"""Separators of lines and paragraphs: readers of JSON Lines would cut there."""
NAMES = "letters A-Z, digits, '_', '.' and '-'"
"""What a name may consist of, for messages."""


def is_identifier(text: str) -> bool:
    """Return whether a text can name a template, a topic, a figure or a solver in any output."""
    return _NAME.fullmatch(text) is not None


def require_identifier(text: str, what: str, error: ErrorType) -> str:
    """Return a text if it is an identifier; ``what`` names it in the message of the error.

    Raises
    ------
    QuizgenError
        Of class ``error``, if it is none.
    """
    if is_identifier(text):
        return text
    said = f"{what}: {text[:LONGEST_NAME]!r} is no name (allowed: {NAMES})"
    raise error(said, rule="QG108")


@contextmanager
def error_context(file: Path | None, kind: ErrorType = QuizgenError) -> Iterator[None]:
    """Add the file to errors that are raised inside the block and name none.

    An error whose message names this file already, or another of its folder, stays as it is.

    Parameters
    ----------
    file : pathlib.Path or None
        None where there is no file.
    kind : type
        The errors that are about it.
    """
    try:
        yield
    except kind as error:
        if file and not error.file and not _has_file_name(str(error), file):
            error.file = file
        raise


def _has_file_name(message: str, file: Path) -> bool:
    """Return whether a message names a file or another one of its folder."""
    return str(file) in message or f"{file.parent}{os.sep}" in message


def escape_csv_formula(cell: str) -> str:
    """Return a cell that no spreadsheet runs as a formula: with an apostrophe in front if needed.

    Spreadsheets skip blanks, line breaks and invisible marks before the sign, and some read the
    full-width signs, too.
    """
    return f"'{cell}" if _find_visible_character(cell) in _STARTS_FORMULA else cell


def unescape_csv_formula(cell: str) -> str:
    """Return a cell without the apostrophe that ``escape_csv_formula`` put in front of it."""
    bare = cell.removeprefix("'")
    return bare if bare != cell and escape_csv_formula(bare) == cell else cell


def _find_visible_character(cell: str) -> str:
    """Return the first visible character, full-width forms as usual ones; "" if there is none.

    A control character counts as visible.
    """
    hidden = {"Zs", "Zl", "Zp", "Cf"}
    seen = (c for c in cell if c not in "\n\r\v\f" and unicodedata.category(c) not in hidden)
    return unicodedata.normalize("NFKC", next(seen, ""))


def escape_control_characters(text: str, kept: str = "\n") -> str:
    """Return a text with its control characters written as names, such as ``[U+001B ESCAPE]``.

    Raw, they could steer a terminal or hide text.

    Parameters
    ----------
    text : str
    kept : str
        Control characters that stay as they are.
    """
    if text.isprintable():
        return text
    return "".join(
        _format_character_name(c) if _is_control(c) and c not in kept else c for c in text
    )


def _is_control(character: str) -> bool:
    """Return whether a character controls output or breaks lines; the joiners of Bangla do not."""
    kind = unicodedata.category(character)
    return (kind[0] == "C" or kind in _BREAKS) and character not in _JOINERS


def _format_character_name(character: str) -> str:
    """Return code point and Unicode name of a character: ``[U+200B ZERO WIDTH SPACE]``."""
    name = unicodedata.name(character, "control character")
    return f"[U+{ord(character):04X} {name}]"


def read_bytes(path: Path, error: ErrorType, most: int = LARGEST_FILE) -> bytes:
    """Return the bytes of a regular file.

    Parameters
    ----------
    path : pathlib.Path
    error : type
        Class of the error that is raised.
    most : int
        The largest size allowed, in bytes.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file, if it is missing, larger, or no regular file.
    """
    try:
        _refuse_special(path.stat(), path, error)
        number = os.open(
            path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        )
        with os.fdopen(number, "rb") as stream:
            _refuse_special(os.fstat(number), path, error)
            data = stream.read(most + 1)
    except (OSError, ValueError) as found:
        what = getattr(found, "strerror", None) or found
        raise error(f"{what}", rule="QG101", file=path) from None
    if len(data) > most:
        raise error(f"larger than {most // 10**6} MB", rule="QG101", file=path)
    return data


def _refuse_special(found: os.stat_result, path: Path, error: ErrorType) -> None:
    """Raise an error if a path is a folder, a pipe or a device, which may have no end.

    Checked before opening, which may hang, and once more for what was opened.
    """
    if not stat.S_ISREG(found.st_mode):
        what = "not a file that can be read (a folder, a pipe or a device)"
        raise error(what, rule="QG101", file=path)


def read_text(path: Path, error: ErrorType, most: int = LARGEST_FILE) -> str:
    """Return the text of a regular file, UTF-8 unless a byte order mark says UTF-16.

    Lines end in LF.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file.
    """
    return decode_text(read_bytes(path, error, most), path, error)


def decode_text(data: bytes, where: object, error: ErrorType) -> str:
    """Return bytes as text, UTF-8 unless a byte order mark says UTF-16; lines end in LF.

    ``where`` is the file, or what messages call the text.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file.
    """
    try:
        text = data.decode(detect_encoding(data))
    except UnicodeDecodeError as found:
        what = f"not UTF-8 text (byte {found.start}); save it as UTF-8"
        raise _error_at(where, what, error, "QG101") from None
    if "\0" in text:
        what = "not UTF-8 text (a zero byte); save it as UTF-8"
        raise _error_at(where, what, error, "QG101")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _error_at(
    where: object, what: str, error: ErrorType, rule: str, place: Place = (), line: int = 0
) -> QuizgenError:
    """Return an error of class ``error`` about a file, or about a text by its name."""
    if isinstance(where, Path):
        return error(what, rule=rule, file=where, place=place, line=line)
    return error(f"{where}: {what}", rule=rule)


def detect_encoding(data: bytes) -> str:
    """Return the codec of a text that begins with these bytes: UTF-16 by its mark, else UTF-8."""
    return "utf-16" if data.startswith(_MARKS) else "utf-8-sig"


def iter_csv_rows(
    lines: Iterable[str], where: object, error: ErrorType
) -> Iterator[tuple[int, list[str]]]:
    """Yield (line number, cells) of each row of CSV as any spreadsheet writes it.

    The separator is the comma, semicolon or tab that the first row has most of, unless a line
    ``sep=;`` above it names one. ``where`` is the file or its name in messages.

    Blank rows are left out.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file and the line.
    """
    rest, above = iter(lines), [""]
    for line in islice(rest, MOST_VALUES):
        above.append(line)
        if line.strip("\r\n"):
            break
    said = re.fullmatch(r"sep=([^\"\r\n])\s*", above[-1])
    separator = said[1] if said else max(_SEPARATORS, key=above[-1].count)
    start = [*above[1:-1], "\n"] if said else above[1:]
    reader = csv.reader(chain(start, rest), delimiter=separator, strict=True)
    blank = 0
    try:
        for row in reader:
            if any(map(str.strip, row)):
                yield reader.line_num, row
            elif (blank := blank + 1) > MOST_VALUES:
                raise error(f"{where}: more than {MOST_VALUES} empty rows")
    except csv.Error as found:
        raise error(f"{where}: line {reader.line_num}: {_shorten_text(found)}") from None


def parse_csv(text: str, where: object, error: ErrorType) -> list[tuple[int, list[str]]]:
    """Return all rows of CSV as (line number, cells), as ``iter_csv_rows`` reads them.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file and the line.
    """
    rows: list[tuple[int, list[str]]] = []
    count = 0
    for line, row in iter_csv_rows(io.StringIO(text, newline=""), where, error):
        count += 1 + len(row)
        if count > MOST_VALUES:
            raise error(f"{where}: more than {MOST_VALUES} values")
        rows.append((line, row))
    return rows


def format_csv(rows: Iterable[Iterable[str]]) -> str:
    """Return rows of cells as CSV that runs in no spreadsheet and steers no terminal."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerows(
        [escape_csv_formula(escape_control_characters(cell)) for cell in row] for row in rows
    )
    return out.getvalue()


def parse_toml(
    text: str, where: object, error: ErrorType, parse_float: Callable[[str], object] = float
) -> dict[str, object]:
    """Return the table that TOML describes, within the limits of depth and size.

    Parameters
    ----------
    text : str
    where : object
        The file, or what messages call the text.
    error : type
        Class of the error that is raised.
    parse_float : callable
        Turns the digits of a number with a point into its value.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file and the line or the place.
    """
    try:
        table = tomllib.loads(text, parse_float=parse_float)
    except RecursionError:
        what = f"more than {DEEPEST} tables and lists within each other"
        raise _error_at(where, what, error, "QG110") from None
    except (tomllib.TOMLDecodeError, ValueError) as found:
        at = _TOML_LINE.search(str(found))
        what, line = f"not valid TOML: {_shorten_text(found)}", int(at[1]) if at else 0
        raise _error_at(where, what, error, "QG103", line=line) from None
    _check_table_limits(table, where, error)
    for place, value, _ in _iter_table_values(table if "\\" in text else ()):
        if isinstance(value, str) and (odd := CONTROLS.search(value)):
            what = (
                f"{escape_control_characters(_format_place(place)) or 'a name'}"
                f": {_format_character_name(odd[0])} in a text"
            )
            raise _error_at(where, what, error, "QG102", place)
    return table


def parse_json(text: str, where: object, error: ErrorType) -> object:
    """Return the value that JSON describes.

    A key that stands twice in a table is an error.

    Numbers with a point stay text, so that 0.50 keeps its digits.

    Raises
    ------
    QuizgenError
        Of class ``error``, naming the file and the line or the place.
    """
    if (
        _count_json_values(text) > MOST_VALUES
        and _count_json_values(_STRING.sub("", text)) > MOST_VALUES
    ):
        raise error(f"{where}: more than {MOST_VALUES} values")
    try:
        value = json.loads(
            text,
            parse_float=str,
            parse_constant=_reject_constant,
            object_pairs_hook=_build_unique_table,
        )
    except RecursionError:
        raise error(f"{where}: more than {DEEPEST} tables and lists within each other") from None
    except json.JSONDecodeError as found:
        raise error(f"{where}: line {found.lineno}: {found.msg}") from None
    except ValueError as found:
        raise error(f"{where}: {_shorten_text(found)}") from None
    _check_table_limits(value, where, error)
    return value


def _count_json_values(text: str) -> int:
    """Return an upper bound of the number of values.

    What is small in a file may be large in memory.
    """
    return sum(map(text.count, ",[{"))


def _reject_constant(text: str) -> object:
    """Raise ``ValueError`` for ``NaN`` and ``Infinity``, which ``json`` would accept."""
    raise ValueError(f"{text} is no number")


def _build_unique_table(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """Return the pairs of a JSON object as a dict; raise ``ValueError`` if a key stands twice."""
    table = dict(pairs)
    if len(table) < len(pairs):
        names = [name for name, _ in pairs]
        twin = next(name for place, name in enumerate(names) if name in names[:place])
        raise ValueError(f"{twin!r} stands twice in a table")
    return table


def _shorten_text(found: Exception) -> str:
    """Return the message of an error, at most 300 characters of it."""
    return str(found)[:300]


def _check_table_limits(table: object, where: object, error: ErrorType) -> None:
    """Raise an error if a table is too deep or large, or a number or text in it too odd.

    ``where`` is the file or its name in messages; the error is of class ``error``.
    """
    for count, (place, value, depth) in enumerate(_iter_table_values(table)):
        problem, said = _find_value_problem(value), escape_control_characters(_format_place(place))
        if problem:
            raise _error_at(where, f"{said or 'the file'}: {problem}", error, "QG102", place)
        if depth > DEEPEST:
            what = f"{said}: more than {DEEPEST} tables and lists within each other"
            raise _error_at(where, what, error, "QG110", place)
        if count > MOST_VALUES:
            raise _error_at(where, f"more than {MOST_VALUES} values", error, "QG110")


def _iter_table_values(table: object) -> Iterator[tuple[Place, object, int]]:
    """Yield every key and value with place and depth; no recursion, which depth could exhaust."""
    todo: list[tuple[Place, object, int]] = [((), table, 0)]
    while todo:
        place, value, depth = todo.pop()
        yield place, value, depth
        if depth > DEEPEST:
            continue
        if isinstance(value, dict):
            for key, inner in value.items():
                yield place, key, depth
                todo.append(((*place, key), inner, depth + 1))
        elif isinstance(value, list):
            todo += [((*place, i), inner, depth + 1) for i, inner in enumerate(value)]


def _format_place(place: Place) -> str:
    """Return a place as people write it: ``entry[0].term``."""
    steps = (f"[{key}]" if isinstance(key, int) else f".{key[:LONGEST_NAME]}" for key in place)
    return "".join(steps).removeprefix(".")


def _find_value_problem(value: object) -> str:
    """Return what is wrong with a number or text, or "": too many digits, half a surrogate pair."""
    if isinstance(value, int) and not -_TOO_LARGE < value < _TOO_LARGE:
        return f"a number of more than {MOST_DIGITS} digits"
    if isinstance(value, str):
        try:
            value.encode()
        except UnicodeEncodeError as found:
            return f"half a character (U+{ord(value[found.start]):04X}) in a text"
    return ""
