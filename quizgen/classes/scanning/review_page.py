"""The page on which a person sees what was read, and types what was not."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from markupsafe import Markup

from quizgen.classes.scanning.pages import NO_CODE, PAGE, PageReading
from quizgen.classes.scanning.scan_folder import (
    DIFFERS,
    NO_FIELD,
    NOT_SCANNED,
    ReadSheet,
    ScanFolder,
    name_picture,
    name_stray,
)
from quizgen.classes.student_reports import report_css, report_environment
from quizgen.core.files import PRIVATE, write_all
from quizgen.locale import FIRST, language_css, load_words
from quizgen.render.fonts import bangla_faces

FILE = "scans.html"


def write_review_page(
    scans: ScanFolder,
    sheets: Sequence[ReadSheet],
    strays: Sequence[PageReading],
    absent: Sequence[str],
    lang: str = FIRST,
) -> Path:
    """Write the page of what was read so far; return its path."""
    words = load_words(lang, "classes")["scan"]
    boxes, doubtful = scans.count_boxes()
    asked = _group_asked_parts(sheets)

    def say(student: str, page: int, why: str = "") -> str:
        """Return whose page something is about, and why."""
        told = f"{student}, {words['page'].format(page=page)}"
        return f"{told}: {words['why'][why]}" if why else told

    page = (
        report_environment()
        .get_template("scans.html.j2")
        .render(
            name=scans.folder.settings.name,
            lang=lang,
            words=words,
            bangla_fonts=bangla_faces([lang], scans.folder.settings.name),
            style=Markup(language_css(":lang({})")) + report_css(),
            read=boxes - doubtful,
            boxes=boxes,
            left=sum(len(rows) for _, rows in asked),
            command=f"quizgen class scan {scans.folder.path} typed.csv",
            missing=[say(one.student, page) for one in sheets for page in one.missing],
            twice=[say(one.student, page) for one in sheets for page in one.twice],
            faults=[say(one.student, *pair) for one in sheets for pair in one.faults.items()],
            absent=absent,
            students=[*scans.folder.places()],
            assigned=[
                {
                    "picture": name_stray(one),
                    "file": one.file,
                    "number": one.number,
                    "student": one.student,
                    "page": one.page,
                }
                for one in scans.list_assigned()
            ],
            strays=[
                {
                    "file": one.file,
                    "number": one.number,
                    "fault": one.fault,
                    "said": one.said,
                    "picture": _find_picture(scans, one),
                    "name": name_stray(one) if one.fault == NO_CODE else "",
                }
                for one in strays
            ],
            asked=asked,
            sheets=sheets,
        )
    )
    return write_all(scans.path, {FILE: page.encode()}, PRIVATE)[0]


def _find_picture(scans: ScanFolder, one: PageReading) -> str:
    """Return the picture of a page that is of no sheet; empty if there is none."""
    name = name_picture(one, PAGE)
    return name if (scans.path / name).exists() else ""


def _group_asked_parts(
    sheets: Sequence[ReadSheet],
) -> list[tuple[str, list[dict[str, str]]]]:
    """Return what a person is asked, by part: the same thing is typed in one go."""
    found: dict[str, list[dict[str, str]]] = {}
    for sheet in sheets:
        for part, one in sheet.open_parts.items():
            read = one.reading
            if read.why not in {NO_FIELD, NOT_SCANNED}:
                taken = "" if read.why == DIFFERS else read.proposal
                found.setdefault(part, []).append(
                    {"student": sheet.student, "crop": one.crop, "why": read.why,
                     "proposal": read.proposal, "taken": taken}
                )  # fmt: skip
    return [*found.items()]
