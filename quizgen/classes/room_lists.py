"""Lists for a room: seats by id, who signs for having been there, who has more time.

Whoever signs reads the lines around the own one, so more time has a list of its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path

from quizgen.classes.class_folder import ClassFolder, PrintedHead
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.exam_details import ExamDetails, read_exam_details
from quizgen.classes.roster import RosterStudent
from quizgen.core.files import PRIVATE, write_all
from quizgen.locale import load_words
from quizgen.render.typst_document import (
    compile_pdf,
    document_files,
    replace_unprintable,
    typst_literal,
)

FOLDER = "lists"
ATTENDANCE, SEATS, MORE_TIME = "attendance.pdf", "seats.pdf", "more-time.pdf"
PACKAGE = "quizgen.classes"


def write_room_lists(folder: ClassFolder, lang: str) -> list[Path]:
    """Write the list to be signed, seats by id, and who has more time; return their paths.

    The seats are without names, so that they can hang where everybody reads them. Who has more
    time is for those who watch, and is written only if anybody has.

    Parameters
    ----------
    folder : ClassFolder
    lang : str
    """
    title = folder.settings.name
    exam = read_exam_details(folder.path / EXAM) or ExamDetails()
    words: Mapping[str, str] = load_words(lang, "classes")["lists"]
    seated = number_seats(folder.students())
    head = replace_unprintable(
        " · ".join(filter(None, (exam.pick("course", lang), exam.pick("date", lang))))
    )
    title = exam.pick("title", lang) or title
    made = {
        ATTENDANCE: _typeset_attendance(seated, exam, words, lang),
        SEATS: _typeset_seats(seated, exam, words, lang),
    }
    if any(one.extra for one, _ in seated):
        made[MORE_TIME] = _typeset_more_time(seated, exam, folder.heads(), words, lang)
    opening = f"#heading(level: 1, {_typeset_text(title)})\n#{typst_literal(head)}\n"
    whole = {name: _compile_list(title, lang, opening + body) for name, body in made.items()}
    return write_all(folder.path / FOLDER, whole, PRIVATE)


def number_seats(students: Sequence[RosterStudent]) -> list[tuple[RosterStudent, str]]:
    """Return each student with a seat: that of the roster, else the place in the own room."""
    found = []
    for _, group in groupby(students, key=lambda one: one.group):
        found += [(one, one.seat or str(place)) for place, one in enumerate(group, 1)]
    return found


def _compile_list(title: str, lang: str, body: str) -> bytes:
    """Return a list as a PDF file."""
    head = f"#show: lists.with(title: {typst_literal(title)}, lang: {typst_literal(lang)})\n"
    return compile_pdf(document_files("lists.typ", f"{head}{body}\n", PACKAGE))


def _typeset_attendance(
    seated: Sequence[tuple[RosterStudent, str]],
    exam: ExamDetails,
    words: Mapping[str, str],
    lang: str,
) -> str:
    """Return Typst source of the list that students sign, room by room."""
    heads = [words[name] for name in ("seat", "id", "name", "sheets", "signature")]
    pages = []
    for group, members in groupby(seated, key=lambda pair: pair[0].group):
        rows = [[seat, one.id, one.name, "", ""] for one, seat in members]
        room = group or exam.pick("room", lang)
        about = f"{words['attendance']} · {words['room']} {room}" if room else words["attendance"]
        pages.append(
            f"#heading(level: 2, {_typeset_text(about)})\n"
            f"{_typeset_table('(auto, auto, 1fr, auto, 50mm)', heads, rows)}"
        )
    return "\n#pagebreak()\n".join(pages)


def _typeset_more_time(
    seated: Sequence[tuple[RosterStudent, str]],
    exam: ExamDetails,
    heads: Mapping[str, PrintedHead],
    words: Mapping[str, str],
    lang: str,
) -> str:
    """Return Typst source of the list of those who have more time, in minutes where it is known."""
    names = [words[name] for name in ("room", "seat", "id", "name", "extra", "minutes")]
    rows = []
    for one, seat in seated:
        minutes = heads[one.id].minutes if one.id in heads else 0
        whole = f"{minutes} + {one.extra_minutes(minutes)}" if minutes else ""
        if one.extra:
            room = one.group or exam.pick("room", lang)
            rows.append([room, seat, one.id, one.name, one.extra, whole])
    table = _typeset_table("(auto, auto, auto, 1fr, auto, auto)", names, rows)
    return f"#heading(level: 2, {_typeset_text(words['extra'])})\n{table}"


def _typeset_seats(
    seated: Sequence[tuple[RosterStudent, str]],
    exam: ExamDetails,
    words: Mapping[str, str],
    lang: str,
) -> str:
    """Return Typst source of the seats in the order of ids, without names."""
    heads = [words[name] for name in ("id", "room", "seat")]
    rows = sorted(
        ([one.id, one.group or exam.pick("room", lang), seat] for one, seat in seated),
        key=lambda row: (len(row[0]), row[0]),
    )
    table = _typeset_table("(1fr, 1fr, auto)", heads, rows, "6mm")
    return f"#heading(level: 2, {_typeset_text(words['seats'])})\n#columns(2)[{table}]"


def _typeset_table(
    columns: str, heads: Sequence[str], rows: Sequence[Sequence[str]], height: str = "9mm"
) -> str:
    """Return Typst source of a table with a row a student."""
    head = "".join(f"{_typeset_text(one)}, " for one in heads)
    body = "".join(f"({''.join(f'{_typeset_text(cell)}, ' for cell in row)}), " for row in rows)
    return f"#ruled({columns}, ({head}), ({body}), height: {height})"


def _typeset_text(text: str) -> str:
    """Return a text as a Typst literal, with ``?`` for what no font has."""
    return typst_literal(replace_unprintable(text))
