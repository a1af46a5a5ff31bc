"""Tables of responses: Moodle's report "Responses", as CSV or JSON.

The columns have names in the language of the site. What is asked is known by the marks in the texts
of the questions, and its response stands in the column behind it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import error_context, parse_csv, parse_json
from quizgen.grading.echo import safe_echo
from quizgen.responses.attempts import LONGEST, Attempt, Lost, Response
from quizgen.responses.keys import MARK
from quizgen.responses.summaries import NOTHING

Row = tuple[str, list[str]]
"""Where it stands, and its cells."""

_MARK = re.compile(MARK)
_NUMBERED = (re.compile(r"(.*)\s(\S{1,16})"), re.compile(r"(.*?)(\d+\w{0,3})"))
"""``Response 2b``, and as JSON has it: ``response2b``."""
_RIGHT = re.compile(r"right|richtig|correct|bonne|juste|giust|goed|সঠিক|правил", re.IGNORECASE)
_EMAIL = re.compile(r"mail|ইমেইল|ই-মেইল", re.IGNORECASE)
_ID = re.compile(r"\bid\b|^id|identif|matri|আইডি", re.IGNORECASE)
_GIVEN = re.compile(r"^(first|given|vor|pr[ée]nom|nombre|nome|প্রথম)", re.IGNORECASE)
"""What a column of the name that is written first is called."""


@dataclass(frozen=True, slots=True)
class Column:
    """Where a question and the response to it stand, and the question's number in the quiz."""

    number: str
    question: int
    response: int


def from_csv(text: str, where: Path, known: Collection[str], lost: Lost) -> Iterator[Attempt]:
    """Attempts in a table, a row for each.

    Parameters
    ----------
    text : str
    where : pathlib.Path
        The file, for messages.
    known : collection of str
        Marks of the questions there are.
    lost : callable
        Told of rows that cannot be read.

    Raises
    ------
    KeyFileError
        If the table cannot be read, naming the file and the line.
    """
    rows = parse_csv(text, where, KeyFileError)
    return _attempts([(f"{where}: line {line}", cells) for line, cells in rows], where, known, lost)


def from_json(text: str, where: Path, known: Collection[str], lost: Lost) -> Iterator[Attempt]:
    """Attempts in a list of tables that have the same names, as Moodle writes JSON.

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
    rows: list[Row] = [(str(where), head)]
    for number, row in enumerate(table, 1):
        place = f"{where}: attempt {number}"
        if list(row) != head:
            lost(f"{place}: other names than in the first")
            continue
        rows.append((place, ["" if cell is None else str(cell) for cell in row.values()]))
    return _attempts(rows, where, known, lost)


def _attempts(
    rows: Sequence[Row], where: Path, known: Collection[str], lost: Lost
) -> Iterator[Attempt]:
    head = [cell.strip() for cell in rows[0][1]] if rows else []
    with error_context(where, KeyFileError):
        columns = _columns(rows, head, known)
    if not columns:
        raise KeyFileError(
            f"{where}: no column has the text of a question of these keys; tick 'question text' "
            "and 'response' above the report in Moodle"
        )
    people = head[: min(column.question for column in columns)]
    for place, cells in rows[1:]:
        if len(cells) != len(head):
            lost(f"{place}: {len(cells)} cells, but {len(head)} columns")
        elif any(len(cell) > LONGEST for cell in cells):
            lost(f"{place}: a text of more than {LONGEST} characters")
        else:
            yield _attempt(place, cells, columns, people)


def _columns(rows: Sequence[Row], head: Sequence[str], known: Collection[str]) -> list[Column]:
    """The questions of the quiz, in their order.

    Their columns have one name, that under which most marks are: somebody may type a mark.
    """
    named = [_numbered(cell) for cell in head]
    marks = Counter(
        name
        for _, cells in rows[1:]
        for place, (name, _) in enumerate(named)
        if _mark(cells, place) in known
    )
    if not marks:
        return []
    ((usual, _),) = marks.most_common(1)
    return [
        Column(number, place, _response(named, place))
        for place, (name, number) in enumerate(named)
        if name == usual
    ]


def _numbered(cell: str) -> tuple[str, str]:
    """What a column is called, and the number of the question that it belongs to."""
    found = next(filter(None, (shape.fullmatch(cell) for shape in _NUMBERED)), None)
    return (found[1].strip(), found[2]) if found else (cell, "")


def _mark(cells: Sequence[str], place: int) -> str:
    """The last mark in a cell, since a story may hold brackets, too."""
    marks = _MARK.findall(cells[place]) if place < len(cells) else []
    return str(marks[-1]) if marks else ""


def _response(named: Sequence[tuple[str, str]], question: int) -> int:
    """The column behind that of a question, if it has the same number.

    Raises
    ------
    KeyFileError
        If there is none, or it holds right answers.
    """
    title, number = named[question]
    name, other = named[question + 1] if question + 1 < len(named) else ("", "")
    if other != number or _RIGHT.search(name):
        raise KeyFileError(
            f"no responses behind the column '{safe_echo(title)} {safe_echo(number)}'; tick 'response' above "
            "the report in Moodle"
        )
    return question + 1


def _attempt(
    where: str, cells: Sequence[str], columns: Sequence[Column], people: Sequence[str]
) -> Attempt:
    responses = tuple(
        Response(column.number, _mark(cells, column.question), cells[column.response])
        for column in columns
        if cells[column.question].strip() not in {"", NOTHING}
    )
    names = [place for place, name in enumerate(people) if not _other(name)][:2]
    if len(names) == 2 and not _GIVEN.match(people[names[0]]):
        names.reverse()
    name = " ".join(filter(None, (cells[place].strip() for place in names)))
    return Attempt(where, name, _cell(_ID, people, cells), _cell(_EMAIL, people, cells), responses)


def _other(name: str) -> bool:
    return bool(_ID.search(name) or _EMAIL.search(name))


def _cell(wanted: re.Pattern[str], people: Sequence[str], cells: Sequence[str]) -> str:
    """The cell of the first column of that name."""
    found = (cells[place].strip() for place, name in enumerate(people) if wanted.search(name))
    return next(found, "")
