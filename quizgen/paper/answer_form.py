"""The blank form that is printed, ``answers.toml`` or ``answers.csv``, and what comes back filled.

A blank form bears a seal, a digest of what is printed in it. So a form in which someone has written
anything, be it a note in a comment, is told from one that nobody has touched.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from quizgen.core.decoding import convert
from quizgen.core.errors import KeyFileError
from quizgen.core.files import read_table
from quizgen.core.untrusted import escape_csv_formula, parse_csv, read_text
from quizgen.grading.options import DECIMALS
from quizgen.locale import translate

if TYPE_CHECKING:
    from quizgen.paper.paper import Paper, PaperItem
    from quizgen.question.compose import AnswerField

FORMS = ("toml", "csv")
"""What a form can be printed as; the page ``exam.html`` saves JSON."""
HEAD = ("part", "question", "hint", "answer")
"""Columns of the form for spreadsheets; the answer comes last, so no comma in it can get lost."""
SEALED = "tells quizgen whether anything was written here"

_SEAL = re.compile(r'^"?seal\b.*\n?', re.MULTILINE)
_LAYOUT = re.compile(r"[\s\",;]+")
"""What an editor or a spreadsheet may change by itself."""

_TYPED = re.compile(r'^(\s*(?:"[^"\n]*"|[\w-]+)\s*=\s*)"(?!"")(.*)$', re.MULTILINE)
"""A line of a form with a text in double quotes."""
_COMMANDS = (
    "begin beta bar big bigl bigr binom bmod boldsymbol boxed bullet nabla ne neq not notin nu "
    "forall frac rangle rbrace rceil rfloor rho right rightarrow rm tan tanh tau text textbf "
    "textit tfrac theta tilde times to top"
)
"""Of LaTeX, those that begin as an escape of TOML does: ``\\t`` of ``\\times`` is no tab."""
_BACKSLASH = re.compile(
    rf"(\\\\)|\\(?=(?:{'|'.join(_COMMANDS.split())})(?![A-Za-z])|[^btnfr\"\\uU]"
    r"|u(?![0-9A-Fa-f]{4})|U(?![0-9A-Fa-f]{8}))"
)


class FormStudent(msgspec.Struct):
    """The person who filled in the form, and how they write numbers."""

    name: str | int = ""
    matriculation: str | int = ""
    lang: str = ""
    decimal: str = "auto"


class FilledForm(msgspec.Struct):
    """A filled-in form: part to typed text."""

    answers: dict[str, str | int | float | bool | None] = {}
    student: FormStudent = msgspec.field(default_factory=FormStudent)
    code: str = ""
    paper: str = ""
    seal: str = ""
    minutes: str | float = ""
    """Time that was taken, where a browser has measured it."""
    seconds: dict[str, str | float] = {}
    """Number of a question to the time for which a browser showed it."""

    @property
    def is_blank(self) -> bool:
        """Return whether the form has neither an answer nor a name."""
        known = self.student.name or self.student.matriculation
        return not known and not any(text.strip() for text in self.list_typed_texts().values())

    def list_typed_texts(self) -> dict[str, str]:
        """Return the texts as typed; a number written without quotes counts as its text."""
        return {
            part: "" if text is None else str(text).lower() if isinstance(text, bool) else str(text)
            for part, text in self.answers.items()
        }


def write_blank_form(paper: Paper, form: str = "toml") -> bytes:
    """Return a blank form, as TOML or as CSV for a spreadsheet; writes no file."""
    return (
        _format_toml_form(paper).encode()
        if form == "toml"
        else _format_csv_form(paper).encode("utf-8-sig")
    )


def _format_toml_form(paper: Paper) -> str:
    """Return a blank form as TOML."""
    name, matriculation = _get_holder_details(paper)
    before = [
        f"# {paper.title(paper.langs[0])} - {paper.code}",
        f"code = {json.dumps(paper.code)}",
        f'paper = "{paper.digest}"',
    ]
    after = [
        "",
        "[student]",
        f"name = {json.dumps(name, ensure_ascii=False)}",
        f"matriculation = {json.dumps(matriculation, ensure_ascii=False)}",
        f'lang = "{paper.langs[0]}"',
        'decimal = "auto"   # auto, point or comma',
        "",
        "[answers]",
        *(line for item in paper.items for line in _iter_question_lines(item)),
    ]
    seal = _compute_seal("\n".join([*before, *after]))
    return "\n".join([*before, f'seal = "{seal}"   # {SEALED}', *after]) + "\n"


def _get_holder_details(paper: Paper) -> tuple[str, str]:
    """Return name and matriculation number, empty where it is not known whose paper it is."""
    return (paper.holder.name, paper.holder.id) if paper.holder else ("", "")


def _compute_seal(text: str) -> str:
    """Return the digest of a form's text, whatever its layout."""
    return hashlib.sha256(_LAYOUT.sub("", _SEAL.sub("", text)).encode()).hexdigest()[:12]


def _iter_question_lines(item: PaperItem) -> Iterator[str]:
    """Yield the lines of one question: its title, then one for each part with its hint."""
    question = item.questions[0]
    yield f"# {item.number}. {question.title}"
    for part in question.parts:
        hint = _get_hint(part.field)
        yield f'"{part.field.id}" = ""' + (f"   # {hint}" if hint else "")


def _get_hint(field: AnswerField) -> str:
    """Return what to type in a field, after the words around it if it stands in a text."""
    return ": ".join(filter(None, [field.near, " ".join(field.hints)]))


def _format_csv_form(paper: Paper) -> str:
    """Return a blank form as CSV; its last row seals the others."""
    rows = [HEAD, *_iter_csv_rows(paper)]
    return _format_csv_rows(
        [*rows, ("seal", "", SEALED, f"#{_compute_seal(_format_csv_rows(rows))}")]
    )


def _format_csv_rows(rows: list[tuple[str, ...]]) -> str:
    """Return rows as CSV, no cell of which a spreadsheet takes for a formula."""
    out = io.StringIO()
    csv.writer(out).writerows([escape_csv_formula(cell) for cell in row] for row in rows)
    return out.getvalue()


def _iter_csv_rows(paper: Paper) -> Iterator[tuple[str, ...]]:
    """Yield what the form asks, one row for each part.

    Digests begin with a sign: a spreadsheet takes some of them for numbers.
    """
    lang = paper.langs[0]
    yield "code", paper.title(lang), "", paper.code
    yield "paper", "", "", f"#{paper.digest}"
    for name, value in zip(("name", "matriculation"), _get_holder_details(paper), strict=True):
        yield name, translate(lang, f"paper.{name}"), "", value
    yield "lang", "", "", lang
    yield "decimal", "", ", ".join(DECIMALS), DECIMALS[0]
    for item in paper.items:
        question = item.questions[0]
        for part in question.parts:
            title = f"{item.number}. {question.title}"
            yield part.field.id, title, _get_hint(part.field), ""


def read_filled_form(path: Path) -> FilledForm:
    """Return a filled-in form, read from TOML, CSV (by its suffix) or JSON.

    Raises
    ------
    KeyFileError
        Naming file and field or line.
    """
    table = _read_csv(path) if path.suffix.lower() == ".csv" else _read_table(path)
    if "answers" not in table:
        raise KeyFileError(f"{path}: has no table [answers]")
    try:
        found = convert(table, FilledForm)
    except msgspec.ValidationError as error:
        raise KeyFileError(f"{path}: {error}") from None
    if found.student.decimal not in DECIMALS:
        wrong = found.student.decimal
        raise KeyFileError(f"{path}: student.decimal {wrong!r} is not {', '.join(DECIMALS)}")
    return found


def _read_table(path: Path) -> Mapping[str, Any]:
    """Return the content of a form in TOML.

    Raises ``KeyFileError``; on a syntax error it adds the quotes that are forgotten most.
    """
    try:
        return read_table(path, _double_backslashes)
    except KeyFileError as error:
        if "not valid TOML" not in str(error):
            raise
        raise KeyFileError(
            f'{error}; an answer stands between straight quotes: "1a" = "6,67"'
        ) from (None)


def _double_backslashes(text: str) -> str:
    r"""Return a form with the backslashes of LaTeX doubled, as TOML needs: ``"\frac{1}{2}"``."""
    return _TYPED.sub(lambda line: line[1] + '"' + _BACKSLASH.sub(r"\\\\", line[2]), text)


def _read_csv(path: Path) -> dict[str, object]:
    """Return the table that the rows of a form stand for."""
    rows = parse_csv(read_text(path, KeyFileError), path, KeyFileError)
    head = [cell.strip().lower() for cell in rows[0][1]] if rows else []
    while head and not head[-1]:
        head.pop()
    if "part" not in head or head[-1] != "answer":
        raise KeyFileError(f"{path}: the first row must name the columns, 'part' among them and "
                           "'answer' as the last")  # fmt: skip
    found: dict[str, str] = {}
    for line, row in rows[1:]:
        part, answer = _parse_csv_row(row, head, f"{path}: line {line}")
        if part in found:
            raise KeyFileError(f"{path}: line {line}: part {part!r} stands there twice")
        if part:
            found[part] = answer
    student = {name: found.pop(name) for name in FormStudent.__struct_fields__ if found.get(name)}
    marks = {name: found.pop(name, "").removeprefix("#") for name in ("code", "paper", "seal")}
    return {**marks, "student": student, "answers": found}


def _parse_csv_row(row: list[str], head: list[str], where: str) -> tuple[str, str]:
    """Return part and answer of a row.

    Raises
    ------
    KeyFileError
        If it has an answer without a part, or more cells than the first row.
    """
    if any(cell.strip() for cell in row[len(head) :]):
        raise KeyFileError(f"{where}: more cells than columns (an answer with the separator in it "
                           "needs double quotes)")  # fmt: skip
    cells = dict(zip(head, row, strict=False))
    part, answer = cells.get("part", "").strip(), cells.get("answer", "").strip()
    if answer and not part:
        raise KeyFileError(f"{where}: an answer without its part")
    return part, answer


def has_answers(path: Path) -> bool:
    """Return whether someone has written into a form; True also if it cannot be read."""
    if not path.exists():
        return False
    try:
        form = read_filled_form(path)
        if not form.seal:
            return not form.is_blank
        return form.seal != _compute_seal(read_text(path, KeyFileError))
    except KeyFileError:
        return True


def read_form_code(path: Path) -> str:
    """Return the code of a form in which someone has written; empty for any other file."""
    try:
        return read_filled_form(path).code if has_answers(path) else ""
    except KeyFileError:
        return ""
