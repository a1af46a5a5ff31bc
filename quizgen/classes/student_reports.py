"""What a student gets back: answers, marks, mistakes by name, what to revise; HTML and PDF."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

import jinja2
from markupsafe import Markup

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.exam_details import FILE as EXAM
from quizgen.classes.exam_details import ExamDetails, read_exam_details
from quizgen.classes.grade_scale import GradeScale, read_grade_scale
from quizgen.classes.gradebook import (
    FOLDER,
    KEY_CHANGED,
    GradeBasis,
    GradedStudent,
    grade_students,
    write_grades,
)
from quizgen.classes.grading import (
    DROPPED,
    TO_DECIDE,
    GradedClassPart,
    StudentMarks,
    item_name,
)
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.lock import lock_folder
from quizgen.classes.objections import Objection, read_objections
from quizgen.classes.office_tables import build_office_tables
from quizgen.classes.rulings import DROP, TOLERANCE
from quizgen.classes.statuses import PRESENT, read_statuses
from quizgen.classes.submissions import has_problems, read_rivals
from quizgen.core.errors import ClassError, KeyFileError
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import error_context, escape_control_characters
from quizgen.grading.feedback import name_truth
from quizgen.grading.options import GradingOptions
from quizgen.kinds.grade import show_key
from quizgen.locale import (
    fallback_language,
    format_amount,
    language_css,
    load_words,
    localise_numbers,
)
from quizgen.paper.answer_key import AnswerKey, KeyPart, KeyQuestion
from quizgen.paper.grading import QuestionGrader
from quizgen.render.fonts import bangla_faces
from quizgen.render.layouts import jinja_environment
from quizgen.render.page_look import write_page_look
from quizgen.render.typst_document import (
    compile_pdf,
    document_files,
    replace_unprintable,
    typst_literal,
)

MOST_TO_REVISE = 5
NOT_TYPED = frozenset({"program", "sketch"})
"""Kinds whose key nobody types."""
PACKAGE = "quizgen.classes"
WIDEST, TALLEST, DOTS = 165.0, 200.0, 4.0
"""Millimetres of a picture on a page, and its dots for one of them at least."""


@dataclass(frozen=True)
class ReportPart:
    """A row of a report: what was typed, what is right, the marks and why.

    Parameters
    ----------
    label, typed, right : str
    marks : str
        As they are printed; a dash while nobody has decided.
    message : str
        What the checker says of the answer.
    said : str
        What people decided of it, and what was said about that.
    """

    label: str
    typed: str
    right: str
    marks: str
    message: str
    said: str


@dataclass(frozen=True)
class ReportQuestion:
    """A question in a report, with its points in sum."""

    number: str
    title: str
    marks: float
    points: float
    undecided: float
    rows: tuple[ReportPart, ...]
    topic: str
    lang: str

    @property
    def name(self) -> str:
        """Return number and title."""
        return f"{self.number}. {self.title}"

    @property
    def worth(self) -> str:
        """Return marks and points, such as ``2.5 / 4``."""
        return localise_numbers(self.lang, f"{self.marks:g} / {self.points:g}")

    def format_loss(self, words: Mapping[str, str]) -> str:
        """Return the sentence on how many points were lost."""
        return words["lost"].format(
            lost=format_amount(self.lost_points, self.lang),
            points=format_amount(self.points, self.lang),
        )

    @property
    def lost_points(self) -> float:
        """Return the points that were decided and not reached."""
        return self.points - self.marks - self.undecided


@dataclass(frozen=True)
class StudentReport:
    """What a student gets back, in the student's language.

    Parameters
    ----------
    who : str
        Name and id; empty where the code alone says whose it is.
    """

    lang: str
    title: str
    who: str
    code: str
    grade: str
    marks: StudentMarks
    sections: tuple[ReportQuestion, ...]

    @property
    def words(self) -> Mapping[str, str]:
        """Return the fixed sentences of a report, by name."""
        found: dict[str, str] = load_words(self.lang, "classes")["report"]
        return found

    @property
    def head(self) -> str:
        """Return the title of the report."""
        return f"{self.words['title']} - {self.title}"

    @property
    def total(self) -> str:
        """Return the sentence with all marks and points."""
        marks, points = (
            format_amount(one, self.lang) for one in (self.marks.marks, self.marks.points)
        )
        return self.words["total"].format(marks=marks, points=points)

    @property
    def revise(self) -> list[ReportQuestion]:
        """Return the questions that lost points, the most first, at most ``MOST_TO_REVISE``."""
        lost = [section for section in self.sections if section.lost_points > 0]
        return sorted(lost, key=lambda section: -section.lost_points)[:MOST_TO_REVISE]

    @property
    def nothing(self) -> str:
        """Return the sentence that all points were reached; empty while any is undecided."""
        return "" if self.marks.undecided_count else self.words["nothing"]

    @property
    def provisional(self) -> str:
        """Return the sentence that parts are undecided; empty if none is."""
        count = self.marks.undecided_count
        name = "provisional_one" if count == 1 else "provisional"
        return self.words[name].format(count=count) if count else ""


def make_report(
    line: GradedStudent,
    key: AnswerKey,
    objections: Sequence[Objection] = (),
    *,
    anonymous: bool = False,
) -> StudentReport:
    """Return the report of a student whose answers came back.

    Parameters
    ----------
    line : GradedStudent
        Somebody whose answers came back.
    key : AnswerKey
        Of the student's paper.
    objections : sequence of Objection
        Those of the student, with what was replied.
    anonymous : bool
        Leave name and id out.
    """
    assert line.marks is not None  # noqa: S101 - see above
    marks = line.marks
    lang = fallback_language(marks.lang)
    who = "" if anonymous else ", ".join(filter(None, (line.student.name, line.student.id)))
    sections = tuple(_build_section(one, marks, objections) for one in key.questions)
    title = key.title.get(lang) or next(iter(key.title.values()), "")
    return StudentReport(
        lang, title, escape_control_characters(who, ""), line.code, line.grade, marks, sections
    )


def _build_section(
    question: KeyQuestion,
    marks: StudentMarks,
    objections: Sequence[Objection],
) -> ReportQuestion:
    """Return one question of a student's report: its parts, and its points in sum.

    ``marks`` are all of the student's; title and topic come from the key.
    """
    given = {part.id: part for part in marks.parts}
    mine = [given[part.id] for part in question.parts if part.id in given]
    rows = tuple(_iter_report_rows(question, marks, objections))
    title = question.title.get(marks.lang) or next(iter(question.title.values()), "")
    return ReportQuestion(
        question.number,
        title,
        sum(part.marks or 0.0 for part in mine),
        sum(part.points for part in mine),
        sum(part.points for part in mine if part.needs_decision),
        rows,
        question.topic,
        fallback_language(marks.lang),
    )


def _iter_report_rows(
    question: KeyQuestion,
    marks: StudentMarks,
    objections: Sequence[Objection],
) -> Iterator[ReportPart]:
    """Yield each part with its feedback in the student's language.

    Where a person decides, only what that person says stands there.
    """
    lang = fallback_language(marks.lang)
    words = load_words(lang, "classes")["report"]
    given = {part.item: part for part in marks.parts}
    pairs = [
        (part, found)
        for part in question.parts
        if (found := given.get(item_name(question, part))) is not None
    ]
    messages = _explain_parts(question, pairs, GradingOptions(lang, marks.decimal))
    for part, found in pairs:
        said = [_format_remark(found, words), *_iter_objection_lines(part.id, objections, words)]
        yield ReportPart(
            part.id.removeprefix(question.number),
            _format_typed_answer(found.typed, part.spec["kind"], words, lang),
            _format_right_answer(part, lang),
            _format_points(found, lang),
            messages.get(part.id, ""),
            "\n".join(filter(None, said)),
        )


def _explain_parts(
    question: KeyQuestion,
    pairs: Sequence[tuple[KeyPart, GradedClassPart]],
    options: GradingOptions,
) -> dict[str, str]:
    """Return what the machine says of those answers for which it took points, by part.

    Nothing after the last of them is judged again; what stands before may be carried forward.
    """
    marker = QuestionGrader(question, options, proven=True)
    asked = [part.id for part, found in pairs if _lost_points_by_machine(found)]
    messages: dict[str, str] = {}
    for part, found in pairs:
        if len(messages) == len(asked):
            break
        if part.id in asked:
            messages[part.id] = marker.grade_part(part, found.typed).verdict.message
        elif question.chain is not None:
            marker.judge_part(part, found.typed)
    return messages


def _lost_points_by_machine(part: GradedClassPart) -> bool:
    """Return whether something was typed that is not worth all points, which no person said."""
    return bool(part.typed.strip()) and part.marks != part.points and not _is_persons(part)


def _is_persons(part: GradedClassPart) -> bool:
    """Return whether a person decides, or has decided, what an answer is worth."""
    by_rule = part.by.startswith((TOLERANCE, DROP))  # these leave judging to the machine
    return part.needs_decision or part.status in TO_DECIDE or bool(part.by and not by_rule)


def _format_right_answer(part: KeyPart, lang: str) -> str:
    """Return the key as a person writes it; a program's output as it is printed."""
    kind = part.spec["kind"]
    if kind in NOT_TYPED:
        return str(load_words(lang, "classes")["report"]["solution"])
    right = show_key(part.parse_spec(), lang)
    return right if kind == "code" else localise_numbers(lang, right)


def _format_typed_answer(typed: str, kind: str, words: Mapping[str, str], lang: str) -> str:
    """Return the student's answer for a cell: a blank, a tick or a drawing in words."""
    if not typed.strip():
        return words["blank"]
    if kind == "sketch":
        return words["drawn"]
    return escape_control_characters(name_truth(kind, typed, lang), "")


def _format_points(part: GradedClassPart, lang: str) -> str:
    """Return marks and points, or that the part was dropped or is undecided."""
    words = load_words(lang, "classes")["report"]
    if part.status == DROPPED:
        return str(words["dropped"])
    if part.marks is None:
        return str(words["undecided"])
    return localise_numbers(lang, f"{part.marks:g} / {part.points:g}")


def _format_remark(part: GradedClassPart, words: Mapping[str, str]) -> str:
    """Return that a person decided, with the remark if any; empty if nobody did."""
    if not part.by or part.status == DROPPED:
        return ""
    remark = escape_control_characters(part.remark, "")
    return f"{words['remark']}: {remark}" if remark else words["decided"]


def _iter_objection_lines(
    part: str, objections: Iterable[Objection], words: Mapping[str, str]
) -> Iterator[str]:
    """Yield what the student said against the marks of a part, and what was replied."""
    for one in objections:
        if one.part == part:
            name, text = ("reply", one.reply) if one.reply else ("objection", one.objection)
            yield f"{words[name]}: {escape_control_characters(text, '')}"


def report_to_html(report: StudentReport) -> bytes:
    """Return the report as one self-contained page in UTF-8."""
    made = (
        report_environment()
        .get_template("report.html.j2")
        .render(
            report=report,
            words=report.words,
            style=Markup(language_css(":lang({})")) + report_css(),
            bangla_fonts=bangla_faces([report.lang], str(report)),
        )
    )
    return made.encode()


@cache
def report_environment() -> jinja2.Environment:
    """Return the Jinja environment with the page layouts of classes."""
    return jinja_environment(PACKAGE, "quizgen.render")


@cache
def report_css() -> Markup:
    """Return the style sheet of those pages, in the look that all pages share."""
    page = (files(PACKAGE) / "pages" / "report.css").read_text(encoding="utf-8")
    return Markup(write_page_look() + page)


def report_to_pdf(
    report: StudentReport, *, room: bool = False, crops: Mapping[str, Path] | None = None
) -> bytes:
    """Return the report as a tagged PDF.

    Parameters
    ----------
    report : StudentReport
    room : bool
        Whether lines follow on which the student may object, and sign for having seen it.
    crops : mapping of str to pathlib.Path, optional
        Pictures of what stands on paper, by part; the marks are put on them.

    Raises
    ------
    RenderError
        If it cannot be typeset.
    """
    words = report.words
    head = (
        f"#show: report.with(title: {typst_literal(report.head)}"
        f", lang: {typst_literal(report.lang)}, "
        f"who: {_typeset_text(report.who)}, code: "
        f"{typst_literal(words['code'] + ': ' + report.code)}, "
        f"grade: {typst_literal(words['grade'] + ': ' + report.grade)}"
        f", total: {typst_literal(report.total)}, "
        f"provisional: {typst_literal(report.provisional)})"
    )
    heads = ", ".join(typst_literal(words[name]) for name in ("part", "yours", "right", "points"))
    body = "\n".join(_typeset_question(section, heads) for section in report.sections)
    pictures = {part: _Picture.read(path) for part, path in (crops or {}).items()}
    if pictures:
        body += f"\n{_typeset_pictures(report, pictures)}"
    if room:
        names = ("objections", "part", "objection", "objections_about", "signature")
        body += f"\n#object({', '.join(typst_literal(words[name]) for name in names)})"
    whole = f"{head}\n{_typeset_revision_list(report)}\n{body}\n"
    files = {f"{part}.svg": picture.svg for part, picture in pictures.items()}
    return compile_pdf({**document_files("report.typ", whole, PACKAGE), **files})


class _Picture(NamedTuple):
    """A picture of what stands on paper, as SVG, for documents hold no other files."""

    svg: bytes
    width: float
    """How wide it is printed, in millimetres, so that it fits on a page."""

    @classmethod
    def read(cls, path: Path) -> _Picture:
        """Return the picture in a file; ``ClassError`` if it is none."""
        from PIL import Image

        try:
            data = path.read_bytes()
            with Image.open(io.BytesIO(data)) as opened:
                opened.verify()
                wide, tall = opened.size
        except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
            raise ClassError(f"{path}: is no picture ({error})") from None
        svg = (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}" height="{tall}">'
            f'<image width="{wide}" height="{tall}" '
            f'href="data:image/png;base64,{base64.b64encode(data).decode()}"/></svg>'
        )
        return cls(svg.encode(), min(WIDEST, TALLEST * wide / max(1, tall), wide / DOTS))


def _typeset_pictures(report: StudentReport, pictures: Mapping[str, _Picture]) -> str:
    """Return Typst source of what stands on paper, with the marks on it and the remark below."""
    rows = "".join(
        f"({typst_literal(part)}, {typst_literal(part + '.svg')}, "
        f"{pictures[part].width:.1f} * 1mm, "
        f"{typst_literal(row.marks)}, {_typeset_text(row.said)}), "
        for section in report.sections
        for row in section.rows
        if (part := section.number + row.label) in pictures
    )
    return f"#on-paper({typst_literal(report.words['on_paper'])}, ({rows}))"


def _typeset_revision_list(report: StudentReport) -> str:
    """Return Typst source of what to revise, or that nothing is to be revised."""
    words = report.words
    if not report.revise:
        return f"#block({typst_literal(report.nothing)})" if report.nothing else ""
    rows = ", ".join(
        f"({typst_literal(one.name)}, {typst_literal(one.format_loss(words))})"
        for one in report.revise
    )
    sentences = (words["revise"], words["revise_about"])
    return f"#revise({', '.join(map(typst_literal, sentences))}, ({rows},))"


def _typeset_question(section: ReportQuestion, heads: str) -> str:
    """Return Typst source of a question's table; ``heads`` are its typeset column names."""
    rows = "".join(_typeset_row(row) for row in section.rows)
    return (
        f"#answered({typst_literal(section.name)}, "
        f"{typst_literal(section.worth)}, ({heads}), ({rows}))"
    )


def _typeset_row(row: ReportPart) -> str:
    """Return Typst source of a row: four cells, and the remarks below them."""
    cells = ", ".join(map(_typeset_text, (row.label, row.typed, row.right, row.marks)))
    below = "".join(f"{_typeset_text(text)}, " for text in (row.message, row.said) if text)
    return f"({cells}, ({below})), "


def _typeset_text(text: str) -> str:
    """Return a student's text as a Typst literal, with ``?`` for what no font has."""
    return typst_literal(replace_unprintable(text))


REPORTS, ANONYMOUS = "reports", "anonymous"
"""Apart, for who hands out the one must not hand out the other."""
CHUNK = 50
"""Reports that are written at once."""


def write_grades_and_reports(
    folder: ClassFolder, formats: Sequence[str], *, anonymous: bool = False, office: str = ""
) -> tuple[list[GradedStudent], list[str], list[Path]]:
    """Write grades and reports; return lines, ids not on the roster, and paths.

    Parameters
    ----------
    folder : ClassFolder
    formats : sequence of str
        ``html``, ``pdf``: of the reports.
    anonymous : bool
        Reports bear the code instead of the name, also as the name of their file,
        in a folder of their own.
    office : str
        Language of the tables for the examination office; by default as ``exam.toml`` says.

    Raises
    ------
    ClassError
        If nothing has been marked, or another command writes there.
    RenderError
        If something cannot be written.
    """
    folder.settings  # noqa: B018 - a folder that is none of a class says so
    with lock_folder(folder.path):
        return _write_locked_folder(folder, formats, anonymous=anonymous, office=office)


def _write_locked_folder(
    folder: ClassFolder, formats: Sequence[str], *, anonymous: bool, office: str
) -> tuple[list[GradedStudent], list[str], list[Path]]:
    """Write grades and reports while the folder is locked."""
    marked = {one.student: one for one in GradingHistory(folder.path).current()}
    if not marked:
        raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
    keys = KeyIndex(folder)
    scale, lines = grade_folder(folder, keys, marked)
    exam = read_exam_details(folder.path / EXAM) or ExamDetails()
    tables = build_office_tables(lines, scale, office or exam.office)
    files = write_grades(folder.path, lines, scale, tables)
    place = folder.path / FOLDER / (ANONYMOUS if anonymous else REPORTS)
    graded = [one for one in lines
              if one.marks and one.status == PRESENT and one.held != KEY_CHANGED]  # fmt: skip
    objections = read_objections(folder.path) if formats else []
    for chunk in _iter_chunks(graded if formats else []):
        made = _render_reports(keys, chunk, formats, objections, anonymous)
        write_all(place, made, PRIVATE)
    for line in lines:
        if line not in graded:  # a report from before must not be handed out
            name = line.code if anonymous else line.student.file
            for form in ("html", "pdf"):
                (place / f"{name}.{form}").unlink(missing_ok=True)
    left = marked.keys() - {one.student.id for one in lines}
    return lines, sorted(left), [*files, *([place] if formats else [])]


def grade_folder(
    folder: ClassFolder, keys: KeyIndex, marked: Mapping[str, StudentMarks]
) -> tuple[GradeScale, list[GradedStudent]]:
    """Return the scale of a class, and every student of its roster with marks and grade."""
    scale = read_grade_scale(folder.path)
    basis = GradeBasis(
        folder.heads(),
        marked,
        scale,
        {who: one.status for who, one in read_statuses(folder.path).items()},
        keys.find_changed(),
        read_rivals(folder.path),
        has_problems(folder.path),
    )
    return scale, grade_students(folder.students(), basis)


def _iter_chunks(lines: Sequence[GradedStudent]) -> Iterator[Sequence[GradedStudent]]:
    """Yield ``CHUNK`` students at a time: reports of all would fill the memory."""
    for at in range(0, len(lines), CHUNK):
        yield lines[at : at + CHUNK]


def _render_reports(
    keys: KeyIndex,
    lines: Sequence[GradedStudent],
    formats: Sequence[str],
    objections: Sequence[Objection],
    anonymous: bool,
) -> dict[str, bytes]:
    """Return the bytes of each report file by its name."""
    render = {"html": report_to_html, "pdf": report_to_pdf}
    made: dict[str, bytes] = {}
    for line in lines:
        with error_context(keys.path, KeyFileError):
            who = line.student.id
            own = [one for one in objections if one.student == who]
            report = make_report(line, keys.key(who), own, anonymous=anonymous)
        name = line.code if anonymous else line.student.file
        made |= {f"{name}.{form}": render[form](report) for form in formats}
    return made
