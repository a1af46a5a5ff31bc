"""What came back: forms (TOML, JSON, CSV), and tables with a row for each student or each answer.

A file or a row that cannot be read, is of another paper, names a part that there is not, or
contradicts itself becomes a problem with its place and reason; it never stops the others, and
nothing of it is marked. Where a student's answers came twice and differ, those that were marked
stay until a person says which of them count.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from quizgen.classes.class_folder import ANSWERS
from quizgen.classes.grading import Submission
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.part_names import PartNames
from quizgen.classes.roster import clean_cell, find_roster_column
from quizgen.classes.rulings import read_filled_rows
from quizgen.core.errors import KeyFileError, QuizgenError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.spreadsheets import is_cell_error, iter_spreadsheet_rows
from quizgen.core.untrusted import (
    LARGEST_PICTURE,
    escape_control_characters,
    format_csv,
    read_bytes,
    unescape_csv_formula,
)
from quizgen.grading.echo import safe_echo
from quizgen.grading.options import DECIMALS
from quizgen.locale import list_languages
from quizgen.paper.answer_form import FilledForm, read_filled_form

TABLES = (".csv", ".xlsx")
FORMS = (".toml", ".json", *TABLES)
ABOUT = ("decimal", "minutes", "code")
"""Columns of a table that are no answers, apart from those of a roster."""
CONFLICTS, PROBLEMS = "conflicts.csv", "problems.csv"
LONGEST = 1e6
"""Seconds for a question that can be meant."""
NOTE = "#"
"""What the name of a column begins with that is nobody's answer."""


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


class RivalAnswers(NamedTuple):
    """One of several differing answers of a student: where it stands, and whether it counts."""

    student: str
    file: str
    filled: int
    counts: bool


class Submissions:
    """What a class handed in; problems and rivals are listed as they are met.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    keys : KeyIndex
    marked : mapping of str to str
        The file that each student's marks are made from.
    ruled : mapping of str to str
        The file that a person said shall count, by student.
    blank : container of str
        Students who are known to have handed in nothing but blank paper.
    """

    def __init__(
        self,
        folder: Path,
        keys: KeyIndex,
        marked: Mapping[str, str] | None = None,
        ruled: Mapping[str, str] | None = None,
        blank: Iterable[str] = (),
    ) -> None:
        self.folder, self.keys = folder / ANSWERS, keys
        self.marked, self.ruled, self.blank = marked or {}, ruled or {}, frozenset(blank)
        self.problems: list[str] = []
        self.rivals: list[RivalAnswers] = []
        self._codes = {code: head.id for head, _ in keys.places.values() for code in head.codes}
        self._ids = {one.casefold(): one for one in keys.places}

    def collect(self) -> Iterator[Submission]:
        """Yield the answers of each student that count, in the order of their files."""
        found: dict[str, list[Submission]] = {}
        for path in sorted(self.folder.rglob("*"), key=lambda one: (one.stem, one.suffix)):
            if not path.is_dir() and not path.name.startswith("."):
                for sheet in self._iter_sheets(path):
                    found.setdefault(sheet.student, []).append(sheet)
        for student, sheets in found.items():
            chosen = self._choose_sheet(student, sheets)
            if chosen is not None:
                yield chosen

    def _choose_sheet(self, student: str, sheets: list[Submission]) -> Submission | None:
        """Return the answers of a student that count; None if a person has to say which."""
        written = [one for one in sheets if count_filled(one)]
        if not written and student not in self.blank:
            who = safe_echo(student)
            self.problems.append(
                f"{who}: nothing is filled in {safe_echo(sheets[0].file)}; if blank paper was "
                f"handed in: quizgen class status {self.folder.parent} {who} present"
            )
            return None
        known = [self.ruled.get(student), self.marked.get(student)]
        by_file = {one.file: one for one in reversed(written or sheets)}
        chosen = next((by_file[file] for file in known if file in by_file), None)
        if len({*map(_sort_answers, written)}) < 2:
            return chosen or next(iter(written or sheets))
        if known[0] not in by_file:
            self.rivals += [
                RivalAnswers(student, one.file, count_filled(one), one is chosen) for one in written
            ]
        return chosen

    def _iter_sheets(self, path: Path) -> Iterator[Submission]:
        """Yield the submissions in a file: one of a form, several of a table."""
        if path.suffix.lower() not in FORMS:
            self._add_problem(path, f"no form ({', '.join(FORMS)})")
            return
        try:
            table = AnswerTable.find_in_file(path)
            if table is None:
                yield self._read_form_sheet(path)
            else:
                yield from self._iter_table_sheets(table)
        except QuizgenError as error:
            self._add_problem(path, str(error).removeprefix(f"{path}: "))
        except OSError as error:
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
        answers, unknown = self._name_parts(student).sort_answers(form.list_typed_texts())
        typed = form.list_typed_texts()
        if odd := [name for name in unknown if typed[name].strip()]:
            raise KeyFileError(self._describe_unknown_parts(student, odd))
        where, minutes = self._name_file(path), _parse_time(str(form.minutes))
        times = minutes, _read_seconds(form)
        return Submission(student, answers, about.lang, about.decimal, where, *times)

    def _name_parts(self, student: str) -> PartNames:
        """Return the names of the parts of a student's paper."""
        return PartNames(self.keys.outline(student).items)

    def _name_file(self, path: Path) -> str:
        """Return what a file is called in the folder of answers."""
        return path.relative_to(self.folder).as_posix()

    def _describe_unknown_parts(self, student: str, names: Sequence[str]) -> str:
        """Return that the paper of a student has no parts of these names, and which it has."""
        said = ", ".join(map(safe_echo, names[:5])) + (" ..." if len(names) > 5 else "")
        parts = [*self.keys.outline(student).items]
        return (
            f"the paper of {safe_echo(student)} has no part {said} (it has {parts[0]} to "
            f"{parts[-1]})"
        )

    def _identify_student(self, code: str, student: str) -> str:
        """Return the student's id by the code or the typed id, which must agree."""
        student = unescape_csv_formula(clean_cell(student))
        owner = self._codes.get(code.strip().upper(), "")
        if code.strip() and not owner:
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

    def _iter_table_sheets(self, table: AnswerTable) -> Iterator[Submission]:
        """Yield the submissions in a table; a wrong row becomes a problem.

        Raises ``KeyFileError`` if a column is a part of nobody's paper, or two are the same.
        """
        read: list[tuple[int, Submission, dict[str, str]]] = []
        for line, cells, typed in table.students():
            try:
                student = self._identify_student(cells.get("code", ""), cells.get("id", ""))
                parts = self._name_parts(student)
                answers, unknown = parts.sort_answers(typed)
                _check_cells(answers)
            except QuizgenError as error:
                self._add_problem(table.path, f"line {line}: {error}")
                continue
            about = *_read_language_and_decimal(cells), self._name_file(table.path)
            sheet = Submission(student, answers, *about, _parse_time(cells.get("minutes", "")))
            read.append((line, sheet, {name: typed[name].strip() for name in unknown}))
        if odd := "" if table.is_long else _find_foreign_column([one for *_, one in read]):
            raise KeyFileError(
                f"column {safe_echo(odd)!r} is no part of the papers; rename it, or begin its "
                f"name with {NOTE} if it holds no answers"
            )
        yield from self._iter_sound_rows(read, table.path)

    def _iter_sound_rows(
        self, read: Iterable[tuple[int, Submission, Mapping[str, str]]], path: Path
    ) -> Iterator[Submission]:
        """Yield rows of a table whose parts are all known, of students who stand there once."""
        lines: dict[str, tuple[int, Submission]] = {}
        for line, sheet, unknown in read:
            before, first = lines.setdefault(sheet.student, (line, sheet))
            if filled := [name for name, text in unknown.items() if text]:
                said = self._describe_unknown_parts(sheet.student, filled)
                self._add_problem(path, f"line {line}: {said}")
            elif before == line:
                yield sheet
            elif _sort_answers(first) != _sort_answers(sheet):
                self._add_problem(
                    path,
                    f"line {line}: {safe_echo(sheet.student)} has other answers in line {before}, "
                    "which count",
                )

    def _add_problem(self, path: Path, reason: str) -> None:
        """Note why a file or row was not read, without control characters."""
        self.problems.append(escape_control_characters(f"{path.name}: {reason}", ""))


def write_rivals(folder: Path, rivals: Sequence[RivalAnswers]) -> None:
    """Write answers that differ to ``conflicts.csv``; delete the file if there are none."""
    if not rivals:
        (folder / CONFLICTS).unlink(missing_ok=True)
        return
    rows = [
        (one.student, one.file, str(one.filled), "yes" if one.counts else "no") for one in rivals
    ]
    text = format_csv([("student", "file", "filled", "counts"), *rows])
    write_all(folder, {CONFLICTS: text.encode("utf-8-sig")}, PRIVATE)


def write_problems(folder: Path, problems: Sequence[str]) -> None:
    """Write what could not be marked to ``problems.csv``; delete the file if there is nothing."""
    if not problems:
        (folder / PROBLEMS).unlink(missing_ok=True)
        return
    text = format_csv([("problem",), *((one,) for one in problems)])
    write_all(folder, {PROBLEMS: text.encode("utf-8-sig")}, PRIVATE)


def has_problems(folder: Path) -> bool:
    """Return whether something that came back could not be marked."""
    return (folder / PROBLEMS).exists()


def read_rivals(folder: Path) -> set[str]:
    """Return the students whose answers came twice and differ, none of which counts yet."""
    path = folder / CONFLICTS
    rows = [cells for _, cells in read_filled_rows(path, {"student", "counts"})]
    settled = {cells["student"] for cells in rows if cells["counts"] == "yes"}
    return {cells["student"] for cells in rows} - settled


def count_filled(sheet: Submission) -> int:
    """Return the number of parts in which something was written."""
    return sum(bool(text.strip()) for text in sheet.answers.values())


def _sort_answers(sheet: Submission) -> tuple[tuple[str, str], ...]:
    """Return the answers that are not blank, to be compared."""
    return tuple(
        sorted((part, text.strip()) for part, text in sheet.answers.items() if text.strip())
    )


def _check_cells(typed: Mapping[str, str]) -> None:
    """Raise ``KeyFileError`` if a spreadsheet has changed what was typed."""
    for name, text in typed.items():
        if is_cell_error(text):
            raise KeyFileError(
                f"{safe_echo(name)} is {text.strip()}: a spreadsheet has made something else of "
                "what was typed; format the column as text and type it again"
            )


def _simplify_student_id(student: str) -> str:
    """Return an id without capitals and leading zeros, as spreadsheets mangle it."""
    return student.casefold().lstrip("0")


def _read_language_and_decimal(cells: Mapping[str, str]) -> tuple[str, str]:
    """Return language and decimal sign of a row; the defaults if they are not valid."""
    lang, decimal = cells.get("lang", "").strip(), cells.get("decimal", "").strip()
    return lang if lang in list_languages() else "", decimal if decimal in DECIMALS else DECIMALS[0]


def _read_seconds(form: FilledForm) -> dict[str, float]:
    """Return the time of each question in a form; what can be no time is left out."""
    times = {name: _parse_time(str(text)) for name, text in form.seconds.items()}
    return {name: time for name, time in times.items() if time is not None and time <= LONGEST}


def _parse_time(text: str) -> float | None:
    """Return a number of minutes or seconds; None if there is none."""
    text = text.strip().replace(",", ".")
    return float(text) if text.replace(".", "", 1).isdecimal() and text.isascii() else None


class AnswerTable:
    """A table with a row for each student, or for each answer.

    Parameters
    ----------
    path : pathlib.Path
    head : list of str
        Names of the columns; those that are no answers by the names they have here.
    rows : iterator of (int, list of str)
    """

    def __init__(self, path: Path, head: list[str], rows: Iterator[tuple[int, list[str]]]) -> None:
        self.path, self.head, self.rows = path, head, rows
        self.is_long = {"part", "answer"} <= {*head}

    @classmethod
    def find_in_file(cls, path: Path) -> AnswerTable | None:
        """Return the table in a file; None if it is a form, or has no column of ids or codes.

        Raises
        ------
        KeyFileError
            If it is empty, or two columns have one name.
        """
        if path.suffix.lower() not in TABLES:
            return None
        rows = iter_spreadsheet_rows(path, KeyFileError)
        _, cells = next(rows, (0, []))
        if not cells:
            raise KeyFileError("is empty")
        head = [_name_column(cell) for cell in cells]
        if not {"id", "code"} & {*head}:
            if path.suffix.lower() == ".csv" and "part" in head:
                return None
            raise KeyFileError(
                "no column is called 'id' (or Matrikelnummer, student number, ...) or 'code'; "
                f"there are {safe_echo(', '.join(filter(None, head)), 80)}"
            )
        named = [name for name in head if name and not name.startswith(NOTE)]
        if twin := next((name for name in named if named.count(name) > 1), ""):
            raise KeyFileError(f"two columns are called {safe_echo(twin)!r}")
        return cls(path, head, rows)

    def students(self) -> Iterator[tuple[int, dict[str, str], dict[str, str]]]:
        """Yield line number, cells by column, and answers by part of each student."""
        yield from self._iter_long_rows() if self.is_long else self._iter_wide_rows()

    def _iter_cells(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Yield line number and cells by column of each row."""
        for line, row in self.rows:
            if any(map(str.strip, row[len(self.head) :])):
                raise KeyFileError(
                    f"line {line}: more cells than columns (an answer that holds the separator "
                    "stands in quotation marks)"
                )
            cells = list(zip(self.head, map(unescape_csv_formula, row), strict=False))
            if any(text.strip() for name, text in cells if not name):
                raise KeyFileError(f"line {line}: something stands in a column without a name")
            yield line, dict(cells)

    def _iter_wide_rows(self) -> Iterator[tuple[int, dict[str, str], dict[str, str]]]:
        """Yield the students of a table with one column for each part."""
        for line, cells in self._iter_cells():
            answers = {
                name: text
                for name, text in cells.items()
                if name and name not in ABOUT and not find_roster_column(name) and name[0] != NOTE
            }
            yield line, cells, answers

    def _iter_long_rows(self) -> Iterator[tuple[int, dict[str, str], dict[str, str]]]:
        """Yield the students of a table with one row for each answer, in any order."""
        found: dict[tuple[str, str], tuple[int, dict[str, str], dict[str, str]]] = {}
        for line, cells in self._iter_cells():
            who = cells.get("id", "").strip(), cells.get("code", "").strip()
            _, _, answers = found.setdefault(who, (line, cells, {}))
            part = cells["part"].strip()
            if part in answers:
                raise KeyFileError(f"line {line}: {safe_echo(part)} stands there twice")
            answers[part] = cells.get("answer", "")
        yield from found.values()


def _find_foreign_column(unknown: Sequence[Mapping[str, str]]) -> str:
    """Return a column with answers that is a part of nobody's paper; empty if there is none.

    ``unknown`` is what each student wrote under names that are no part of the own paper.
    """
    shared = set.intersection(*map(set, unknown)) if unknown else set()
    return next((name for one in unknown for name in one if one[name] and name in shared), "")


def _name_column(cell: str) -> str:
    """Return the name of a column: ours for one that is no answer, else as it stands there."""
    name = clean_cell(cell)
    ours = find_roster_column(name)
    if ours or name.casefold() in (*ABOUT, "part", "answer"):
        return ours or name.casefold()
    return name
