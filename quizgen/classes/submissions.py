"""What came back: forms (TOML, JSON, CSV), and tables with a row for each student or each answer.

A file or a row that cannot be read, is of another paper, or contradicts itself becomes a problem
with its place and reason; it never stops the others, and nothing of it is marked.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from quizgen.classes.class_folder import ANSWERS
from quizgen.classes.grading import Submission
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.roster import clean_cell
from quizgen.core.errors import KeyFileError, QuizgenError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import (
    LARGEST_PICTURE,
    detect_encoding,
    escape_control_characters,
    iter_csv_rows,
    read_bytes,
    unescape_csv_formula,
)
from quizgen.grading.echo import safe_echo
from quizgen.grading.options import DECIMALS
from quizgen.locale import list_languages
from quizgen.paper.answer_form import read_filled_form

FORMS = (".toml", ".json", ".csv")
ABOUT = ("id", "name", "lang", "decimal", "minutes", "code")
"""Columns of a table that are no answers."""


def store_submissions(folder: Path, paths: Iterable[Path]) -> list[str]:
    """Copy files into the class's folder of answers; return what could not be read.

    A file of the same name is never overwritten, not by another command at the same time either.

    Raises
    ------
    ClassError
        If another command still writes there.
    """
    problems = []
    for path in paths:
        try:
            data = read_bytes(path, KeyFileError, LARGEST_PICTURE)
        except KeyFileError as error:
            problems.append(str(error))
            continue
        with lock_folder(folder):
            name = _find_free_name(folder / ANSWERS, path, data)
            if name:
                write_all(folder / ANSWERS, {name: data}, PRIVATE)
    return problems


def _find_free_name(folder: Path, path: Path, data: bytes) -> str:
    """Return a file name that is free; empty if the same file is already there."""
    name, number = path.name, 1
    while (folder / name).exists():
        if (folder / name).read_bytes() == data:
            return ""
        number += 1
        name = f"{path.stem}-{number}{path.suffix}"
    return name


class Submissions:
    """Iterates over what a class handed in; problems are listed as they are met.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    keys : KeyIndex
    """

    def __init__(self, folder: Path, keys: KeyIndex) -> None:
        self.folder, self.keys = folder / ANSWERS, keys
        self.problems: list[str] = []
        self._seen: dict[str, tuple[bytes, str]] = {}
        self._codes = {code: head.id for head, _ in keys.places.values() for code in head.codes}
        self._ids = {one.casefold(): one for one in keys.places}

    def __iter__(self) -> Iterator[Submission]:
        for path in sorted(self.folder.rglob("*"), key=lambda one: (one.stem, one.suffix)):
            if path.is_dir() or path.name.startswith("."):
                continue
            for sheet in self._iter_sheets(path):
                if self._is_first_submission(sheet):
                    yield sheet

    def _iter_sheets(self, path: Path) -> Iterator[Submission]:
        """Yield the submissions in a file: one of a form, several of a table."""
        if path.suffix.lower() not in FORMS:
            self._add_problem(path, f"no form ({', '.join(FORMS)})")
            return
        try:
            table = _Table.find_in_file(path)
            if table is None:
                yield self._read_form_sheet(path)
            else:
                yield from self._iter_table_sheets(table)
        except QuizgenError as error:
            self._add_problem(path, str(error).removeprefix(f"{path}: "))
        except (UnicodeError, OSError) as error:
            self._add_problem(path, str(error))

    def _read_form_sheet(self, path: Path) -> Submission:
        """Return the submission of a form; ``KeyFileError`` if it is of another paper."""
        form = read_filled_form(path)
        about = form.student
        student = self._identify_student(form.code, str(about.matriculation))
        paper = self.keys.key(student).paper
        former = form.code.strip().upper() in self.keys.places[student][0].former
        if form.paper and form.paper != paper and not former:
            raise KeyFileError(f"is for other questions than the paper of {safe_echo(student)}")
        return Submission(student, form.list_typed_texts(), about.lang, about.decimal, path.name)

    def _identify_student(self, code: str, student: str) -> str:
        """Return the student's id by the code or the typed id, which must agree."""
        student = unescape_csv_formula(clean_cell(student))
        owner = self._codes.get(code.strip().upper(), "")
        if code and not owner:
            raise KeyFileError(f"code {safe_echo(code)} is of no paper of this class")
        if owner and student and _simplify_student_id(student) != _simplify_student_id(owner):
            raise KeyFileError(
                f"has the code of {safe_echo(owner)}'s paper, "
                f"but the number of {safe_echo(student)}"
            )
        return owner or self._resolve_student_id(student)

    def _resolve_student_id(self, student: str) -> str:
        """Return the id as the roster writes it; capitals do not matter."""
        if student in self.keys.places:
            return student
        found = self._ids.get(student.casefold())
        if found is None:
            near = [
                one
                for one in self.keys.places
                if _simplify_student_id(one) == _simplify_student_id(student)
            ]
            hint = f" ({safe_echo(near[0])} has it but for zeros in front)" if near else ""
            raise KeyFileError(f"nobody of this class has the number {safe_echo(student)!r}{hint}")
        return found

    def _iter_table_sheets(self, table: _Table) -> Iterator[Submission]:
        """Yield the submissions in a table; a wrong row becomes a problem."""
        for line, cells, answers in table.students():
            try:
                student = self._identify_student(cells.get("code", ""), cells.get("id", ""))
                yield Submission(
                    student,
                    answers,
                    *_read_language_and_decimal(cells),
                    table.path.name,
                    _parse_minutes(cells),
                )
            except KeyFileError as error:
                self._add_problem(table.path, f"line {line}: {error}")

    def _is_first_submission(self, sheet: Submission) -> bool:
        """Return whether it is the student's first; note a second that differs."""
        answers = sorted((part, text) for part, text in sheet.answers.items() if text.strip())
        digest = hashlib.sha256(repr(answers).encode()).digest()[:8]
        before = self._seen.get(sheet.student)
        if before is None:
            self._seen[sheet.student] = digest, sheet.file
            return True
        if before[0] != digest:
            self.problems.append(
                f"{safe_echo(sheet.student)} handed in twice, {safe_echo(before[1])} and "
                f"{safe_echo(sheet.file)}: the first counts; remove the one that shall not"
            )
        return False

    def _add_problem(self, path: Path, reason: str) -> None:
        """Note why a file or row was not read, without control characters."""
        self.problems.append(escape_control_characters(f"{path.name}: {reason}", ""))


def _simplify_student_id(student: str) -> str:
    """Return an id without capitals and leading zeros, as spreadsheets mangle it."""
    return student.casefold().lstrip("0")


def _read_language_and_decimal(cells: Mapping[str, str]) -> tuple[str, str]:
    """Return language and decimal sign of a row; the defaults if they are not valid."""
    lang, decimal = cells.get("lang", "").strip(), cells.get("decimal", "").strip()
    return lang if lang in list_languages() else "", decimal if decimal in DECIMALS else DECIMALS[0]


def _parse_minutes(cells: Mapping[str, str]) -> float | None:
    """Return the minutes in a row; None if there is no number."""
    text = cells.get("minutes", "").strip().replace(",", ".")
    return float(text) if text.replace(".", "", 1).isdecimal() and text.isascii() else None


class _Table:
    """A CSV file with a row for each student, or for each answer; read as it goes.

    Parameters
    ----------
    path : pathlib.Path
    encoding : str
    head : list of str
    """

    def __init__(self, path: Path, encoding: str, head: list[str]) -> None:
        self.path, self.encoding, self.head = path, encoding, head

    @classmethod
    def find_in_file(cls, path: Path) -> _Table | None:
        """Return the table in a file; None if it has no column of ids or codes."""
        if path.suffix.lower() != ".csv":
            return None
        with path.open("rb") as stream:
            encoding = detect_encoding(stream.read(2))
        with path.open(encoding=encoding, newline="") as text:
            _, cells = next(iter_csv_rows(text, path, KeyFileError), (0, []))
        head = [cell.strip() for cell in cells]
        known = [
            cell.lower() if cell.lower() in (*ABOUT, "part", "answer") else cell for cell in head
        ]
        if not {"id", "code"} & {*known}:
            return None
        return cls(path, encoding, known)

    def students(self) -> Iterator[tuple[int, dict[str, str], dict[str, str]]]:
        """Yield line number, cells by column, and answers by part of each student."""
        long = {"part", "answer"} <= {*self.head}
        yield from self._iter_long_rows() if long else self._iter_wide_rows()

    def _iter_cells(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Yield line number and cells by column of each row."""
        with self.path.open(encoding=self.encoding, newline="") as stream:
            rows = iter_csv_rows(stream, self.path, KeyFileError)
            next(rows)
            for line, row in rows:
                if len(row) > len(self.head):
                    raise KeyFileError(f"line {line}: more cells than columns")
                yield line, dict(zip(self.head, row, strict=False))

    def _iter_wide_rows(self) -> Iterator[tuple[int, dict[str, str], dict[str, str]]]:
        """Yield the students of a table with one column for each part."""
        for line, cells in self._iter_cells():
            answers = {name: text for name, text in cells.items() if name not in ABOUT}
            yield line, cells, answers

    def _iter_long_rows(self) -> Iterator[tuple[int, dict[str, str], dict[str, str]]]:
        """Yield the students of a table with one row for each answer, in any order."""
        found: dict[tuple[str, str], tuple[int, dict[str, str], dict[str, str]]] = {}
        for line, cells in self._iter_cells():
            who = cells.get("id", ""), cells.get("code", "")
            _, _, answers = found.setdefault(who, (line, cells, {}))
            if cells["part"].strip() in answers:
                raise KeyFileError(f"line {line}: {safe_echo(cells['part'])} stands there twice")
            answers[cells["part"].strip()] = cells.get("answer", "")
        yield from found.values()
