"""``answers.toml``: the blank form that is printed, and the filled one that comes back."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from quizgen.errors import KeyFileError
from quizgen.files import read_table
from quizgen.marking.options import DECIMALS

if TYPE_CHECKING:
    from quizgen.paper.paper import Item, Paper


class Student(msgspec.Struct):
    """Who filled in the form, and how they write."""

    name: str = ""
    matriculation: str = ""
    lang: str = ""
    decimal: str = "auto"


class Answers(msgspec.Struct):
    """A filled-in form: part to typed text."""

    answers: dict[str, str | int | float | bool | None] = {}
    student: Student = msgspec.field(default_factory=Student)
    code: str = ""
    paper: str = ""

    @property
    def blank(self) -> bool:
        """Whether nobody has written anything into the form."""
        return not self.student.name and not any(text.strip() for text in self.typed().values())

    def typed(self) -> dict[str, str]:
        """Texts as typed; a number written without quotes counts as its text."""
        return {
            part: "" if text is None else str(text).lower() if isinstance(text, bool) else str(text)
            for part, text in self.answers.items()
        }


def form_bytes(paper: Paper) -> bytes:
    """``answers.toml``: a blank form."""
    lines = [
        f"# {paper.title(paper.langs[0])} - {paper.code}",
        f"code = {json.dumps(paper.code)}",
        f'paper = "{paper.digest}"',
        "",
        "[student]",
        'name = ""',
        'matriculation = ""',
        f'lang = "{paper.langs[0]}"',
        'decimal = "auto"   # auto, point or comma',
        "",
        "[answers]",
        *(line for item in paper.items for line in _question_lines(item)),
    ]
    return ("\n".join(lines) + "\n").encode()


def _question_lines(item: Item) -> Iterator[str]:
    question = item.questions[0]
    yield f"# {item.number}. {question.title}"
    for part in question.parts:
        hint = " ".join(part.field.hints)
        yield f'"{part.field.id}" = ""' + (f"   # {hint}" if hint else "")


def read_answers(path: Path) -> Answers:
    """Read ``answers.toml`` or ``answers.json``.

    Raises
    ------
    KeyFileError
        Naming file and field or line.
    """
    table = read_table(path)
    if "answers" not in table:
        raise KeyFileError(f"{path}: has no table [answers]")
    try:
        found = msgspec.convert(table, Answers)
    except msgspec.ValidationError as error:
        raise KeyFileError(f"{path}: {error}") from None
    if found.student.decimal not in DECIMALS:
        wrong = found.student.decimal
        raise KeyFileError(f"{path}: student.decimal {wrong!r} is not {', '.join(DECIMALS)}")
    return found


def code_of_answers(path: Path) -> str:
    """The code of a form that holds answers; empty for any other file."""
    try:
        form = read_answers(path)
    except KeyFileError:
        return ""
    return "" if form.blank else form.code


def holds_answers(path: Path) -> bool:
    """Whether a form holds anything that a student typed (or cannot be read, so might)."""
    if not path.exists():
        return False
    try:
        return not read_answers(path).blank
    except KeyFileError:
        return True
