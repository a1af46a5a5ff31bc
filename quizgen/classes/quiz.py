"""A quiz that a system for courses played, as a class: who took it, what was asked and responded.

There are no papers to print. All that follows - marks, decisions, rulings, grades, the analysis -
is that of a class, for a line of the keys and a filled form are made of each attempt.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import msgspec

from quizgen.classes.class_folder import (
    ANSWERS,
    ClassFolder,
    ClassSettings,
    PrintedHead,
    format_record,
)
from quizgen.classes.pseudonyms import new_secret, student_code
from quizgen.classes.roster import RosterStudent, clean_cell
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all
from quizgen.paper.answer_key import FORMAT, AnswerKey, KeyQuestion, answer_key_digest
from quizgen.responses import SUFFIX
from quizgen.responses.attempts import Attempt, Lost
from quizgen.responses.files import attempts
from quizgen.responses.keys import Kept, Keys, read
from quizgen.responses.marks import Given, given


class ImportedQuiz(NamedTuple):
    """How many people are new, and how many there are."""

    new: int
    people: int


class _Paper(NamedTuple):
    """What somebody was asked, and responded."""

    student: RosterStudent
    lang: str
    questions: list[KeyQuestion]
    answers: dict[str, str]


def import_quiz(
    folder: ClassFolder, keys: Path, reports: Iterable[Path], tell: Lost
) -> ImportedQuiz:
    """Make a class of a quiz, or add to it who is new; who is there keeps questions and answers.

    Parameters
    ----------
    folder : ClassFolder
    keys : pathlib.Path
        Left behind by the export.
    reports : iterable of pathlib.Path
    tell : callable
        Told what cannot be read, and what does not count.

    Raises
    ------
    ClassError
        If the folder holds something else, or nobody is in the reports.
    KeyFileError
        If the keys cannot be read.
    """
    known, name = read(keys), keys.name.removesuffix(SUFFIX)
    people = _list_last_attempts(attempts(reports, known.found, tell), tell)
    papers = [*_iter_papers(people, known, tell)]
    if folder.is_new:
        _begin_class(folder, name, [student for student, _ in people], papers)
    elif folder.settings.digest:
        raise ClassError(f"{folder.path}: holds a class with papers; name another folder (--out)")
    new = _write_new_papers(folder, name, papers, tell)
    students = {one.id: one for one in (*folder.students(), *(student for student, _ in people))}
    folder.write_roster([*students.values()])
    return ImportedQuiz(new, len(students))


def _list_last_attempts(
    found: Iterable[Attempt], tell: Lost
) -> list[tuple[RosterStudent, Attempt]]:
    """Everybody in the reports, with the last attempt in which there is something."""
    tries: dict[str, list[Attempt]] = {}
    for attempt in found:
        who = clean_cell(attempt.who[0] or attempt.name)
        if who:
            tries.setdefault(who.casefold(), []).append(attempt)
        else:
            tell(f"{attempt.where}: names nobody")
    people = []
    for all_tries in tries.values():
        real = [one for one in all_tries if one.responses] or all_tries
        if len(real) > 1:
            tell(f"{real[-1].name}: {len(real)} attempts, the last one counts")
        one = real[-1]
        people.append(
            (RosterStudent(clean_cell(one.who[0] or one.name), clean_cell(one.name)), one)
        )
    return people


def _iter_papers(
    people: Iterable[tuple[RosterStudent, Attempt]], keys: Keys, tell: Lost
) -> Iterator[_Paper]:
    for student, attempt in people:
        found = given(keys, attempt)
        for number in found.foreign:
            tell(f"{attempt.where}: {student.name}: question {number} is not in the keys")
        if found.questions:
            yield _build_paper(student, found)


def _build_paper(student: RosterStudent, found: Given) -> _Paper:
    questions, answers, asked = [], dict[str, str](), Counter[str]()
    for place, (kept, typed) in enumerate(found.questions, 1):
        first = next(iter(typed.values()))[0]
        number = first if first.isdecimal() else str(place)
        asked[kept.key.template] += 1
        again = asked[kept.key.template]
        template = kept.key.template + (f":{again}" if again > 1 else "")
        questions.append(_renumber_question(kept, typed, number, template))
        answers |= {
            number + _get_part_label(kept, part): text if isinstance(text, str) else text.found
            for part, (_, text) in typed.items()
        }
    return _Paper(student, found.questions[0][0].lang, questions, answers)


def _get_part_label(kept: Kept, part: str) -> str:
    return part.removeprefix(kept.key.number)


def _renumber_question(kept: Kept, asked: Iterable[str], number: str, template: str) -> KeyQuestion:
    """The key of what was asked of a question, under the number that it had."""
    parts = [
        msgspec.structs.replace(part, id=number + _get_part_label(kept, part.id))
        for part in kept.key.parts
        if part.id in {*asked}
    ]
    points = sum((part.points_exact() for part in parts), Fraction(0))
    return msgspec.structs.replace(
        kept.key, number=number, template=template, parts=parts, points=str(points)
    )


def _begin_class(
    folder: ClassFolder, name: str, people: Sequence[RosterStudent], papers: Sequence[_Paper]
) -> None:
    """Begin the class; its papers follow from nothing, so there is no digest, and no template."""
    if not papers:
        raise ClassError("nobody has responded to a question of these keys")
    own = folder.path.resolve().name
    lang = papers[0].lang
    settings = ClassSettings(own, new_secret(), name, (), lang=lang, digest="", templates=())
    folder.create(settings, people)


def _write_new_papers(folder: ClassFolder, name: str, papers: Iterable[_Paper], tell: Lost) -> int:
    """Add keys and forms of who is new; how many these are."""
    there, place = folder.heads(), folder.path / ANSWERS
    lines: list[bytes] = []
    forms: dict[str, bytes] = {}
    for one in papers:
        key = AnswerKey(FORMAT, one.questions, title={one.lang: name}, langs=(one.lang,))
        code = student_code(folder.settings.secret, one.student.id, answer_key_digest(key, name))
        file, form = f"{one.student.file}.json", _encode_answer_form(one, code)
        if one.student.id not in there:
            head = PrintedHead(one.student.id, code, name, "")
            lines.append(format_record(head, msgspec.structs.replace(key, code=code)))
            forms[file] = form
        elif there[one.student.id].code != code or not _has_content(place / file, form):
            tell(
                f"{one.student.name}: has other answers there than in this report; those there stay"
            )
    write_all(place, forms, PRIVATE)
    folder.append(lines)
    return len(lines)


def _encode_answer_form(paper: _Paper, code: str) -> bytes:
    """What was responded, as a filled form."""
    student = {
        "name": paper.student.name,
        "matriculation": paper.student.id,
        "lang": paper.lang,
    }
    return msgspec.json.encode({"code": code, "student": student, "answers": paper.answers})


def _has_content(path: Path, content: bytes) -> bool:
    return path.exists() and path.read_bytes() == content
