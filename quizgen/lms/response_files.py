"""Files of responses: tables, result reports, and archives of them."""

from __future__ import annotations

import lzma
import re
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import decode_text, error_context, parse_csv, parse_json, read_bytes
from quizgen.grading.echo import safe_echo
from quizgen.lms.attempts import LONGEST_RESPONSE, QuizAttempt, ReportLoss, Response
from quizgen.lms.manifest import TOKEN_PATTERN
from quizgen.lms.moodle_summaries import NO_RESPONSE
from quizgen.lms.qti.results import attempts_from_qti

# Bytes of the largest report that is read, unpacked.
LARGEST_REPORT = 60_000_000
MOST_FILES = 20_000
# What reading an archive raises if it is damaged, locked or packed in an unknown way.
ARCHIVE_ERRORS = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, RuntimeError, ValueError, EOFError, OSError,
)  # fmt: skip

ResponseReader = Callable[[str, Path, Collection[str], ReportLoss], Iterator[QuizAttempt]]


def read_attempts(
    paths: Iterable[Path], known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield the attempts in files.

    Parameters
    ----------
    paths : iterable of pathlib.Path
    known : collection of str
        Tokens and ids of the questions of the manifest.
    lost : callable
        Called with the file and line of all that cannot be read; the rest is read.
    """
    for path in paths:
        try:
            for name, data in _read_files(path):
                yield from _read_report(name, data, known, lost)
        except KeyFileError as error:
            lost(str(error))


def _read_files(path: Path) -> Iterator[tuple[Path, bytes]]:
    """Yield path and bytes of a file, or of each file in an archive."""
    data = read_bytes(path, KeyFileError, LARGEST_REPORT)
    return _unpack(path, data) if path.suffix.lower() == ".zip" else iter([(path, data)])


def _read_report(
    path: Path, data: bytes, known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield the attempts in one file; report it as lost if it cannot be read."""
    try:
        yield from _reader_for(path)(decode_text(data, path, KeyFileError), path, known, lost)
    except KeyFileError as error:
        lost(str(error))


def _reader_for(path: Path) -> ResponseReader:
    """Return the reader for the suffix of a file; ``KeyFileError`` if there is none."""
    found = RESPONSE_READERS.get(path.suffix.lower())
    if found is None:
        raise KeyFileError(f"{path}: no file of responses (known: {KNOWN_SUFFIXES} and .zip)")
    return found


def _unpack(path: Path, data: bytes) -> Iterator[tuple[Path, bytes]]:
    """Yield the readable files of an archive; ``KeyFileError`` if they are too large together."""
    left = LARGEST_REPORT
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            inside = [one for one in archive.infolist() if not one.is_dir()]
            if len(inside) > MOST_FILES:
                raise KeyFileError(f"{path}: more than {MOST_FILES} files")
            readable = [
                one for one in inside if Path(one.filename).suffix.lower() in RESPONSE_READERS
            ]
            if not readable:
                raise KeyFileError(f"{path}: no file of responses in it (known: {KNOWN_SUFFIXES})")
            for one in readable:
                with archive.open(one) as stream:
                    content = stream.read(left + 1)
                left -= len(content)
                if left < 0:
                    raise KeyFileError(f"{path}: larger than {LARGEST_REPORT // 10**6} MB unpacked")
                yield path / one.filename, content
    except ARCHIVE_ERRORS as error:
        raise KeyFileError(f"{path}: not an archive that can be read ({error})") from None


# Where a row stands, for messages, and its cells.
TableRow = tuple[str, list[str]]

_TOKEN = re.compile(TOKEN_PATTERN)
# ``Response 2b``, and as JSON has it: ``response2b``.
_COLUMN_NAMES = (re.compile(r"(.*)\s(\S{1,16})"), re.compile(r"(.*?)(\d+\w{0,3})"))
_RIGHT_ANSWER = re.compile(
    r"right|richtig|correct|bonne|juste|giust|goed|সঠিক|правил", re.IGNORECASE
)
_EMAIL = re.compile(r"mail|ইমেইল|ই-মেইল", re.IGNORECASE)
_ID = re.compile(r"\bid\b|^id|identif|matri|আইডি", re.IGNORECASE)
_GIVEN_NAME = re.compile(r"^(first|given|vor|pr[ée]nom|nombre|nome|প্রথম)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ResponseColumn:
    """The columns of a question and of the response to it, and its number in the quiz."""

    number: str
    question: int
    response: int


def attempts_from_csv(
    text: str, where: Path, known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield the attempts in a table, one from each row.

    Parameters
    ----------
    text : str
    where : pathlib.Path
        The file, for messages.
    known : collection of str
        Tokens of the questions of the manifest.
    lost : callable
        Called with rows that cannot be read.

    Raises
    ------
    KeyFileError
        If the table cannot be read, naming the file and the line.
    """
    rows = parse_csv(text, where, KeyFileError)
    return _read_rows(
        [(f"{where}: line {line}", cells) for line, cells in rows], where, known, lost
    )


def attempts_from_json(
    text: str, where: Path, known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield the attempts in a list of objects with the same names, as Moodle writes JSON.

    Raises
    ------
    KeyFileError
        Naming the file and the place.
    """
    table = parse_json(text, where, KeyFileError)
    while isinstance(table, list) and len(table) == 1 and isinstance(table[0], list):
        (table,) = table
    if not isinstance(table, list) or not all(isinstance(row, dict) for row in table):
        raise KeyFileError(f"{where}: a list of attempts is expected")
    head = list(table[0]) if table else []
    rows: list[TableRow] = [(str(where), head)]
    for number, row in enumerate(table, 1):
        place = f"{where}: attempt {number}"
        if list(row) != head:
            lost(f"{place}: other names than in the first")
            continue
        rows.append((place, ["" if cell is None else str(cell) for cell in row.values()]))
    return _read_rows(rows, where, known, lost)


def _read_rows(
    rows: Sequence[TableRow], where: Path, known: Collection[str], lost: ReportLoss
) -> Iterator[QuizAttempt]:
    """Yield an attempt for each row of a table; report rows that cannot be read."""
    head = [cell.strip() for cell in rows[0][1]] if rows else []
    with error_context(where, KeyFileError):
        columns = _find_columns(rows, head, known)
    if not columns:
        raise KeyFileError(
            f"{where}: no column has the text of a question of these keys; tick 'question text' "
            "and 'response' above the report in Moodle"
        )
    people = head[: min(column.question for column in columns)]
    for place, cells in rows[1:]:
        if len(cells) != len(head):
            lost(f"{place}: {len(cells)} cells, but {len(head)} columns")
        elif any(len(cell) > LONGEST_RESPONSE for cell in cells):
            lost(f"{place}: a text of more than {LONGEST_RESPONSE} characters")
        else:
            yield _read_attempt(place, cells, columns, people)


def _find_columns(
    rows: Sequence[TableRow], head: Sequence[str], known: Collection[str]
) -> list[ResponseColumn]:
    """Return the columns of the quiz's questions, in their order.

    Their columns have one name, that of most tokens: somebody may type a token.
    """
    named = [_split_number(cell) for cell in head]
    marks = Counter(
        name
        for _, cells in rows[1:]
        for place, (name, _) in enumerate(named)
        if _find_token(cells, place) in known
    )
    if not marks:
        return []
    ((usual, _),) = marks.most_common(1)
    return [
        ResponseColumn(number, place, _response_column(named, place))
        for place, (name, number) in enumerate(named)
        if name == usual
    ]


def _split_number(cell: str) -> tuple[str, str]:
    """Return the name of a column, and the number of the question that it belongs to."""
    found = next(filter(None, (shape.fullmatch(cell) for shape in _COLUMN_NAMES)), None)
    return (found[1].strip(), found[2]) if found else (cell, "")


def _find_token(cells: Sequence[str], place: int) -> str:
    """Return the last token in a cell (a story may have brackets, too); empty if it has none."""
    marks = _TOKEN.findall(cells[place]) if place < len(cells) else []
    return str(marks[-1]) if marks else ""


def _response_column(named: Sequence[tuple[str, str]], question: int) -> int:
    """Return the index of the response column, which follows that of its question.

    Raises
    ------
    KeyFileError
        If there is none, or it holds right answers.
    """
    title, number = named[question]
    follows = named[question + 1 : question + 2]
    if not any(other == number and not _RIGHT_ANSWER.search(name) for name, other in follows):
        raise KeyFileError(
            f"no responses behind the column '{safe_echo(title)}"
            f" {safe_echo(number)}'; tick 'response' above "
            "the report in Moodle"
        )
    return question + 1


def _read_attempt(
    where: str, cells: Sequence[str], columns: Sequence[ResponseColumn], people: Sequence[str]
) -> QuizAttempt:
    """Return the attempt in a row; ``people`` are the names of the columns about the person."""
    responses = tuple(
        Response(column.number, _find_token(cells, column.question), cells[column.response])
        for column in columns
        if cells[column.question].strip() not in {"", NO_RESPONSE}
    )
    names = [place for place, name in enumerate(people) if not _is_id_or_email(name)][:2]
    if len(names) == 2 and not _GIVEN_NAME.match(people[names[0]]):
        names.reverse()
    name = " ".join(filter(None, (cells[place].strip() for place in names)))
    return QuizAttempt(
        where, name, _find_cell(_ID, people, cells), _find_cell(_EMAIL, people, cells), responses
    )


def _is_id_or_email(name: str) -> bool:
    """Return whether a column holds an id or an address rather than a name."""
    return bool(_ID.search(name) or _EMAIL.search(name))


def _find_cell(wanted: re.Pattern[str], people: Sequence[str], cells: Sequence[str]) -> str:
    """Return the cell of the first column whose name matches; empty if none does."""
    found = (cells[place].strip() for place, name in enumerate(people) if wanted.search(name))
    return next(found, "")


# Here, as it names the functions above.
RESPONSE_READERS: dict[str, ResponseReader] = {
    ".csv": attempts_from_csv,
    ".tsv": attempts_from_csv,
    ".txt": attempts_from_csv,
    ".json": attempts_from_json,
    ".xml": attempts_from_qti,
}
KNOWN_SUFFIXES = ", ".join(RESPONSE_READERS)
