"""A quiz that was taken in a learning management system, as a class.

There are no papers to print. All that follows - marks, decisions, rulings, grades, the analysis -
is that of a class, since each attempt becomes a line of the keys and a filled form.
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
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import error_context
from quizgen.lms import MANIFEST_SUFFIX
from quizgen.lms.attempts import QuizAttempt, ReportLoss
from quizgen.lms.grading import SortedResponses, sort_responses
from quizgen.lms.manifest import ExportManifest, ManifestItem, read_manifest
from quizgen.lms.response_files import read_attempts
from quizgen.paper.answer_key import FORMAT, AnswerKey, KeyQuestion, answer_key_digest


class ImportedQuiz(NamedTuple):
    """How many people an import added, and how many the class has now."""

    new: int
    people: int


class _ImportedPaper(NamedTuple):
    """The questions that one person was asked, and the typed responses by part."""

    student: RosterStudent
    lang: str
    questions: list[KeyQuestion]
    answers: dict[str, str]


def import_quiz(
    folder: ClassFolder, keys: Path, reports: Iterable[Path], tell: ReportLoss
) -> ImportedQuiz:
    """Make a class of a quiz, or add new people to it, and return how many there are.

    People who are there keep their questions and answers.

    Parameters
    ----------
    folder : ClassFolder
    keys : pathlib.Path
        The manifest of the export.
    reports : iterable of pathlib.Path
    tell : callable
        Called with what cannot be read, and what does not count.

    Raises
    ------
    ClassError
        If the folder holds something else, or nobody is in the reports.
    KeyFileError
        If the manifest cannot be read.
    """
    known, name = read_manifest(keys), keys.name.removesuffix(MANIFEST_SUFFIX)
    people = _last_attempts(read_attempts(reports, known.found, tell), tell)
    with error_context(keys, KeyFileError):
        papers = [*_make_papers(people, known, tell)]
    if folder.is_new and not papers:
        raise ClassError(f"{keys}: nobody has responded to a question of these keys")
    if folder.is_new:
        _begin_class(folder, name, [student for student, _ in people], papers)
    elif folder.settings.digest:
        raise ClassError(f"{folder.path}: holds a class with papers; name another folder (--out)")
    new = _write_papers(folder, name, papers, tell)
    students = {one.id: one for one in (*folder.students(), *(student for student, _ in people))}
    folder.write_roster([*students.values()])
    return ImportedQuiz(new, len(students))


def _last_attempts(
    found: Iterable[QuizAttempt], tell: ReportLoss
) -> list[tuple[RosterStudent, QuizAttempt]]:
    """Return everybody in the reports, each with the last attempt that is not empty."""
    tries: dict[str, list[QuizAttempt]] = {}
    for attempt in found:
        who = clean_cell(attempt.person_key[0] or attempt.name)
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
            (RosterStudent(clean_cell(one.person_key[0] or one.name), clean_cell(one.name)), one)
        )
    return people


def _make_papers(
    people: Iterable[tuple[RosterStudent, QuizAttempt]], manifest: ExportManifest, tell: ReportLoss
) -> Iterator[_ImportedPaper]:
    """Yield the paper of everybody who responded; report questions that the keys lack."""
    for student, attempt in people:
        found = sort_responses(manifest, attempt)
        for number in found.foreign:
            tell(f"{attempt.where}: {student.name}: question {number} is not in the keys")
        if found.items:
            yield _make_paper(student, found)


def _make_paper(student: RosterStudent, found: SortedResponses) -> _ImportedPaper:
    """Return a person's questions, renumbered as the quiz asked them, with the responses."""
    questions, answers, asked = [], dict[str, str](), Counter[str]()
    for place, (item, typed) in enumerate(found.items, 1):
        first = next(iter(typed.values()))[0]
        number = first if first.isdecimal() else str(place)
        asked[item.key.template] += 1
        again = asked[item.key.template]
        template = item.key.template + (f":{again}" if again > 1 else "")
        questions.append(_renumber_question(item, typed, number, template))
        answers |= {
            number + _part_label(item, part): text if isinstance(text, str) else text.found
            for part, (_, text) in typed.items()
        }
    return _ImportedPaper(student, found.items[0][0].lang, questions, answers)


def _part_label(item: ManifestItem, part: str) -> str:
    """Return the letter of a part; empty if it is the only one."""
    return part.removeprefix(item.key.number)


def _renumber_question(
    item: ManifestItem, asked: Iterable[str], number: str, template: str
) -> KeyQuestion:
    """Return the key of the parts that were asked, under their number in the quiz."""
    parts = [
        msgspec.structs.replace(part, id=number + _part_label(item, part.id))
        for part in item.key.parts
        if part.id in {*asked}
    ]
    points = sum((part.points_exact() for part in parts), Fraction(0))
    return msgspec.structs.replace(
        item.key, number=number, template=template, parts=parts, points=str(points)
    )


def _begin_class(
    folder: ClassFolder,
    name: str,
    people: Sequence[RosterStudent],
    papers: Sequence[_ImportedPaper],
) -> None:
    """Create the class folder.

    No papers can be generated for it, so its settings have no digest and no templates.
    """
    own = folder.path.resolve().name
    lang = papers[0].lang
    settings = ClassSettings(own, new_secret(), name, (), lang=lang, digest="", templates=())
    folder.create(settings, people)


def _write_papers(
    folder: ClassFolder, name: str, papers: Iterable[_ImportedPaper], tell: ReportLoss
) -> int:
    """Add keys and filled forms of new people; return how many these are."""
    there, place = folder.heads(), folder.path / ANSWERS
    lines: list[bytes] = []
    forms: dict[str, bytes] = {}
    for one in papers:
        key = AnswerKey(FORMAT, one.questions, title={one.lang: name}, langs=(one.lang,))
        code = student_code(folder.settings.secret, one.student.id, answer_key_digest(key, name))
        file, form = f"{one.student.file}.json", _filled_form(one, code)
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


def _filled_form(paper: _ImportedPaper, code: str) -> bytes:
    """Return the responses as a filled form (JSON)."""
    student = {
        "name": paper.student.name,
        "matriculation": paper.student.id,
        "lang": paper.lang,
    }
    return msgspec.json.encode({"code": code, "student": student, "answers": paper.answers})


def _has_content(path: Path, content: bytes) -> bool:
    """Return whether a file exists with exactly this content."""
    return path.exists() and path.read_bytes() == content
