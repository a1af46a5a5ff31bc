"""A class that sits its exam in the browser: codes to come in with, what is handed in, a record.

In: who may come in, what was typed. Out: codes, files that ``class mark`` reads, lines of a record.
Must never know: HTTP, a database.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import lru_cache
from pathlib import Path

import msgspec

from quizgen.classes.class_folder import ANSWERS, ClassFolder
from quizgen.classes.lock import lock_folder
from quizgen.classes.pseudonyms import student_mac
from quizgen.classes.roster import RosterStudent
from quizgen.classes.rulings import read_filled_rows
from quizgen.classes.statuses import PRESENT, StudentStatus, append_status, read_statuses
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, open_private, write_all
from quizgen.core.untrusted import format_csv
from quizgen.grading.echo import safe_echo
from quizgen.paper.answer_form import FilledForm, FormStudent
from quizgen.paper.code import SIGNS

DATABASE = "browser.sqlite3"
"""What is answered in the browser, until and after it is handed in."""
BROWSER = "browser"
"""Below the folder of answers, and who says in statuses that somebody was there."""
RECORD = "browser-record.csv"
COLUMNS = ("when", "who", "student", "what", "more")
WHEN = "%Y-%m-%d %H:%M:%S"
CODE_SIGNS = 10
"""Of 32 each: 50 bits, of which a class of 300 takes fewer than 9."""
_LOOKS_LIKE = str.maketrans("OIL", "011")


@dataclass(frozen=True)
class HandedPaper:
    """What a student handed in.

    Parameters
    ----------
    student : RosterStudent
    code, lang : str
        Of the paper.
    answers : mapping of str to str
        Part to what was typed, in one line.
    minutes : float
        Working time.
    seconds : mapping of str to float
        Number of a question to the time for which it was on the screen.
    decimal : str
        The decimal sign that the student declared, or ``auto``.
    """

    student: RosterStudent
    code: str
    lang: str
    answers: Mapping[str, str]
    minutes: float
    seconds: Mapping[str, float] = field(default_factory=dict)
    decimal: str = "auto"

    @property
    def is_blank(self) -> bool:
        """Whether nothing was filled in."""
        return not any(text.strip() for text in self.answers.values())


@lru_cache(maxsize=1 << 13)
def entry_code(secret: str, student: str, issue: int) -> str:
    """Return a code that lets a student in once, such as ``7K2MX-9QD4T``.

    Parameters
    ----------
    secret : str
        Of the class.
    student : str
        The id.
    issue : int
        How many codes were made for the student before.
    """
    number = int.from_bytes(student_mac(secret, "entry", student, str(issue)), "big")
    signs = "".join(SIGNS[(number >> 5 * place) % len(SIGNS)] for place in range(CODE_SIGNS))
    return f"{signs[: CODE_SIGNS // 2]}-{signs[CODE_SIGNS // 2 :]}"


def normalise_entry_code(typed: str) -> str:
    """Return a typed code as it is printed, whatever stands between its signs; "" if it is none."""
    signs = re.sub("[^0-9A-Z]", "", typed[:100].upper()).translate(_LOOKS_LIKE)
    half = CODE_SIGNS // 2
    return f"{signs[:half]}-{signs[half:]}" if len(signs) == CODE_SIGNS else ""


def store_handed_papers(folder: ClassFolder, papers: Iterable[HandedPaper]) -> None:
    """Write what was handed in as forms into the folder of answers.

    Who handed in nothing but blank fields is said to have been present.

    Raises
    ------
    ClassError
        If another command writes there for long.
    """
    papers = list(papers)
    forms = {f"{BROWSER}/{one.student.file}.json": _build_form(one) for one in papers}
    with lock_folder(folder.path):
        write_all(folder.path / ANSWERS, forms, PRIVATE)
    for one in papers:
        if one.is_blank and one.student.id not in read_statuses(folder.path):
            append_status(folder, StudentStatus(one.student.id, PRESENT, who=BROWSER))


def _build_form(paper: HandedPaper) -> bytes:
    """Return a filled form as JSON."""
    student = paper.student
    about = FormStudent(student.name, student.id, paper.lang, paper.decimal)
    form = FilledForm(
        dict(paper.answers), about, paper.code,
        minutes=round(paper.minutes, 1), seconds=dict(paper.seconds),
    )  # fmt: skip
    return msgspec.json.format(msgspec.json.encode(form)) + b"\n"


def read_record(folder: ClassFolder) -> list[tuple[float, str, str, str]]:
    """Return what happened in the exam so far: seconds since 1970, student, what, and what more.

    Raises
    ------
    ClassError
        Naming the line whose time is none.
    """
    path = folder.path / RECORD
    if not path.exists():
        return []
    return [
        (_parse_time(path, line, row["when"]), row["student"], row["what"], row["more"])
        for line, row in read_filled_rows(path, {*COLUMNS})
    ]


def _parse_time(path: Path, line: int, text: str) -> float:
    """Return a time of the record in seconds since 1970."""
    try:
        return datetime.strptime(text, WHEN).replace(tzinfo=UTC).timestamp()
    except ValueError:
        raise ClassError(f"{path}: line {line}: {safe_echo(text)!r} is no time") from None


def append_record(folder: ClassFolder, who: str, student: str, what: str, more: str = "") -> None:
    """Append a line to the record of the exam: what happened when, and who did it.

    It is only added to.
    """
    path = folder.path / RECORD
    when = datetime.now(UTC).strftime(WHEN)
    rows = [(when, who, student, what, more)]
    with open_private(path) as stream:
        stream.write(format_csv(rows if path.stat().st_size else [COLUMNS, *rows]).encode())
        stream.flush()
