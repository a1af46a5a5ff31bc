"""``exam.toml``: what a class's papers say on their covers, and how long its folder may be kept.

Every text is one for all languages, or a table of one for each: ``course.en``, ``course.de``.
"""

from __future__ import annotations

import datetime as dt
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from quizgen.bank.metadata import pick_language
from quizgen.classes.roster import RosterStudent
from quizgen.core.decoding import convert
from quizgen.core.errors import ClassError
from quizgen.core.untrusted import parse_toml, read_text
from quizgen.grading.echo import safe_echo
from quizgen.locale import FIRST, list_languages
from quizgen.paper.paper import PaperCover

FILE = "exam.toml"
LONGEST = 500
"""Characters of a text."""
MOST_MINUTES = 24 * 60
_KEY = re.compile("[0-9a-f]{64}")
Text = str | dict[str, str]
Rules = list[str] | dict[str, list[str]]


class BrowserExam(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """When and how a class sits its exam in the browser: the table ``[browser]``.

    Parameters
    ----------
    begins, ends : datetime.datetime, optional
        Nobody begins before the one or writes after the other, but for the own extra time. Without
        an offset they are in the time of the machine. Without ``begins`` a person opens the exam.
    minutes : int, optional
        Of each from the own beginning; without it, those of the paper.
    safe_exam_browser : bool
        Whether a settings file of Safe Exam Browser is made, with which alone students come in.
    quit_password : str
        Which ends Safe Exam Browser before the exam is handed in.
    config_keys, exam_keys : sequence of str
        Of Safe Exam Browser, in hexadecimal digits: if there are any, no other browser is let in.
    """

    begins: dt.datetime | None = None
    ends: dt.datetime | None = None
    minutes: int | None = None
    safe_exam_browser: bool = False
    quit_password: str = ""
    config_keys: list[str] = []
    exam_keys: list[str] = []

    def check(self) -> None:
        """Raise ``ClassError`` for what cannot be meant.

        Raises
        ------
        ClassError
            Naming the key.
        """
        if self.begins and self.ends and self.begins.timestamp() >= self.ends.timestamp():
            raise ClassError("browser: ends before it begins")
        if self.minutes is not None and not 1 <= self.minutes <= MOST_MINUTES:
            raise ClassError(f"browser.minutes: {self.minutes} (1 to {MOST_MINUTES})")
        if self.quit_password and not self.safe_exam_browser:
            raise ClassError("browser.quit_password: is for safe_exam_browser = true")
        for name in ("config_keys", "exam_keys"):
            for key in getattr(self, name):
                if not _KEY.fullmatch(key.lower()):
                    shown = safe_echo(key)[:20]
                    raise ClassError(f"browser.{name}: {shown!r} is not of 64 hexadecimal digits")


class ExamDetails(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What stands on the covers of a class's papers besides the questions.

    Parameters
    ----------
    title : str or mapping
        In place of that of the blueprint.
    course, date, room, examiner : str or mapping
        A student's room is the group of the roster, where it names one.
    rules : list of str, or mapping
        What holds in the room.
    signature : bool
        Whether there is a line to sign on.
    keep_until : datetime.date, optional
        When the folder is to be forgotten.
    office : str
        Language of the tables for the examination office.
    pseudonyms : bool
        Whether names stand on covers alone, so that who marks the pages reads codes.
    browser : BrowserExam
        What holds where the class sits the exam in the browser.
    """

    title: Text = ""
    course: Text = ""
    date: Text = ""
    room: Text = ""
    examiner: Text = ""
    rules: Rules = []
    signature: bool = False
    keep_until: dt.date | None = None
    office: str = FIRST
    pseudonyms: bool = False
    browser: BrowserExam = BrowserExam()

    def build_cover(self, student: RosterStudent) -> PaperCover:
        """Return what a student's cover says."""
        facts = {"course": self.course, "date": self.date, "room": student.group or self.room,
                 "seat": student.seat, "examiner": self.examiner}  # fmt: skip
        rules = self.rules if isinstance(self.rules, dict) else {FIRST: self.rules}
        return PaperCover(
            {name: _name_languages(text) for name, text in facts.items() if text},
            {lang: tuple(said) for lang, said in rules.items()},
            self.signature,
        )

    @property
    def titles(self) -> Mapping[str, str]:
        """Return the title in each language that it has; none if the blueprint's is meant."""
        return _name_languages(self.title) if self.title else {}

    def pick(self, name: str, lang: str) -> str:
        """Return a text in a language, else in another one; empty if there is none."""
        text = getattr(self, name)
        return pick_language(_name_languages(text), lang, "") if text else ""

    def check(self) -> None:
        """Raise ``ClassError`` for a text that no cover has room for, or an unknown language.

        Raises
        ------
        ClassError
            Naming the key.
        """
        if self.office not in list_languages():
            known = ", ".join(list_languages())
            raise ClassError(f"office: {self.office[:40]!r} (there are {known})")
        self.browser.check()
        for name in ("title", "course", "date", "room", "examiner", "rules"):
            found = getattr(self, name)
            texts = [*found.values()] if isinstance(found, dict) else [found]
            for text in texts:
                if any(
                    len(str(one)) > LONGEST for one in (text if isinstance(text, list) else [text])
                ):
                    raise ClassError(f"{name}: longer than {LONGEST} characters")


def describe_overdue(folder: Path, today: dt.date) -> str:
    """Return that the folder of a class is kept longer than its ``exam.toml`` says; else empty."""
    found = read_exam_details(folder / FILE)
    if found is None or found.keep_until is None or found.keep_until >= today:
        return ""
    return (
        f"{folder}: was to be kept until {found.keep_until}; "
        f"names and answers go with: quizgen class forget {folder}"
    )


def _name_languages(text: Text) -> dict[str, str]:
    """Return a text by language; one for all languages as that of the first."""
    return text if isinstance(text, dict) else {FIRST: text}


def read_exam_details(path: Path) -> ExamDetails | None:
    """Return what a file says of the exam; None if there is no such file.

    Raises
    ------
    ClassError
        Naming the file and the key.
    """
    if not path.exists():
        return None
    table = parse_toml(read_text(path, ClassError), path, ClassError)
    try:
        found = convert(_spell_dates(table), ExamDetails)
        found.check()
    except (msgspec.ValidationError, ClassError) as error:
        raise ClassError(f"{path}: {error}") from None
    return found


def _spell_dates(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table in which dates and times are texts, as JSON has them."""
    return {
        name: _spell_dates(value)
        if isinstance(value, dict)
        else value.isoformat()
        if isinstance(value, dt.date | dt.time)
        else value
        for name, value in table.items()
    }
