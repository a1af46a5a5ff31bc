"""Reading ``key.json`` and filled-in answer forms; whatever is wrong is one located line."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec

from quizgen.errors import KeyFileError
from quizgen.marking.options import DECIMALS, Context
from quizgen.marking.reading.scalars import exact_value
from quizgen.maths.chain import Chain, ChainStep

FORMAT = "quizgen-key/1"
LARGEST_FILE = 20_000_000


class KeyGiven(msgspec.Struct):
    """A drawn number in base units, and the unit it is shown in."""

    value: str
    unit: str = ""


class KeyChain(msgspec.Struct):
    """The chain of a question as plain formulas."""

    given: dict[str, KeyGiven]
    steps: list[tuple[str, str, str]]

    def units(self) -> dict[str, str]:
        """Step name to the unit it is shown in."""
        return {name: unit for name, _, unit in self.steps}

    def context(self, earlier: Mapping[str, Any]) -> Context:
        """Return the question around a part, with the student's earlier values.

        Raises
        ------
        FormulaError
            If a formula cannot be read.
        """
        units = tuple((name, given.unit) for name, given in self.given.items())
        chain = _chain(units, tuple(map(tuple, self.steps)))
        values = {name: exact_value(given.value) for name, given in self.given.items()}
        return Context(chain, values, earlier)


@lru_cache(maxsize=512)
def _chain(units: tuple[tuple[str, str], ...], steps: tuple[tuple[str, str, str], ...]) -> Chain:
    """Build a chain once for all students of a paper."""
    from quizgen.maths.notation import parse

    built = tuple(ChainStep(name, parse(formula), unit) for name, formula, unit in steps)
    return Chain(dict(units), built)


class KeyPart(msgspec.Struct):
    """One answer field."""

    id: str
    points: str
    spec: dict[str, Any]

    def worth(self) -> Fraction:
        """Points as an exact number."""
        return Fraction(self.points)


class KeyQuestion(msgspec.Struct):
    """One question of the key."""

    number: str
    parts: list[KeyPart]
    template: str = ""
    topic: str = ""
    tier: str = ""
    title: dict[str, str] = {}
    chain: KeyChain | None = None


class Key(msgspec.Struct):
    """A paper's answer key."""

    format: str
    questions: list[KeyQuestion]
    code: str = ""
    title: dict[str, str] = {}
    langs: tuple[str, ...] = ("en",)


class Student(msgspec.Struct):
    """Who filled in the form, and how they write."""

    name: str = ""
    lang: str = ""
    decimal: str = "auto"


class Answers(msgspec.Struct):
    """A filled-in form: part to typed text."""

    answers: dict[str, str | int | float | bool | None] = {}
    student: Student = msgspec.field(default_factory=Student)
    code: str = ""

    def typed(self) -> dict[str, str]:
        """Texts as typed; a number written without quotes counts as its text."""
        return {
            part: "" if text is None else str(text).lower() if isinstance(text, bool) else str(text)
            for part, text in self.answers.items()
        }


def load_key(table: Mapping[str, Any], place: str = "key") -> Key:
    """Validate a key table.

    Raises
    ------
    KeyFileError
        Naming file and field.
    """
    if table.get("format") != FORMAT:
        raise KeyFileError(f"{place}: format is {table.get('format')!r}, not {FORMAT!r}")
    try:
        key = msgspec.convert(table, Key)
        for question in key.questions:
            for part in question.parts:
                part.worth()
    except msgspec.ValidationError as error:
        raise KeyFileError(f"{place}: {error}") from None
    except (ValueError, ZeroDivisionError):
        raise KeyFileError(
            f"{place}: part {part.id}: points {part.points!r} is no number"
        ) from None
    return key


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise KeyFileError(f"{path}: larger than {LARGEST_FILE // 10**6} MB")
        return path.read_text("utf-8")
    except OSError as error:
        raise KeyFileError(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise KeyFileError(f"{path}: not UTF-8 text (byte {error.start})") from None


def _table(path: Path) -> Mapping[str, Any]:
    text = _text(path)
    try:
        if path.suffix == ".toml":
            return tomllib.loads(text, parse_float=str)
        table = json.loads(text, parse_float=str)
    except json.JSONDecodeError as error:
        raise KeyFileError(f"{path}: line {error.lineno}: {error.msg}") from None
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise KeyFileError(f"{path}: {error}") from None
    if not isinstance(table, dict):
        raise KeyFileError(f"{path}: a table is expected, not {type(table).__name__}")
    return table


def read_key(path: Path) -> Key:
    """Read ``key.json``.

    Raises
    ------
    KeyFileError
        Naming file and field or line.
    """
    return load_key(_table(path), str(path))


def read_answers(path: Path) -> Answers:
    """Read ``answers.toml`` or ``answers.json``.

    Raises
    ------
    KeyFileError
        Naming file and field or line.
    """
    table = _table(path)
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
