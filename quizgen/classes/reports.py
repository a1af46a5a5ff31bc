"""What a student gets back: answers, marks, mistakes by name, what to revise; HTML and PDF."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import jinja2
from markupsafe import Markup

from quizgen.classes.grades import Graded
from quizgen.classes.mark import DROPPED, Marks, PartMark, item_of
from quizgen.figures.inks import write_theme_css
from quizgen.locale import FIRST, amount, known, numbers_in, styles, table
from quizgen.marking.mark import show
from quizgen.marking.options import Options
from quizgen.outside import visible
from quizgen.paper.key import Key, KeyPart, KeyQuestion
from quizgen.paper.marking import Marker
from quizgen.render.fonts import bangla_faces
from quizgen.render.layouts import environment
from quizgen.render.typ import compiled, document, printable, string

MOST_TO_REVISE = 5
NOT_TYPED = frozenset({"text", "sketch"})
"""Kinds whose key nobody types."""
PACKAGE = "quizgen.classes"


@dataclass(frozen=True)
class Row:
    """One part: what was typed, what is right, what it got, and why.

    Parameters
    ----------
    label, typed, right : str
    marks : str
        As they are printed; a dash while nobody has decided.
    message : str
        What the checker says of the answer.
    said : str
        What people decided of it.
    """

    label: str
    typed: str
    right: str
    marks: str
    message: str
    said: str


@dataclass(frozen=True)
class Section:
    """One question."""

    number: str
    title: str
    marks: float
    points: float
    undecided: float
    rows: tuple[Row, ...]
    topic: str
    lang: str

    @property
    def name(self) -> str:
        """Number and title."""
        return f"{self.number}. {self.title}"

    @property
    def worth(self) -> str:
        """Points that were reached, of those that could be."""
        return numbers_in(self.lang, f"{self.marks:g} / {self.points:g}")

    @property
    def practise(self) -> str:
        """The command that asks more of the same."""
        own = "" if self.lang == FIRST else f" --lang {self.lang}"
        return f"quizgen practice --topic {self.topic}{own}"

    def told(self, words: Mapping[str, str]) -> str:
        """How much was lost."""
        return words["lost"].format(
            lost=amount(self.lost, self.lang), points=amount(self.points, self.lang)
        )

    @property
    def lost(self) -> float:
        """Points that were not reached."""
        return self.points - self.marks - self.undecided


@dataclass(frozen=True)
class Report:
    """All of it, in the student's language.

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
    marks: Marks
    sections: tuple[Section, ...]

    @property
    def words(self) -> Mapping[str, str]:
        """The sentences around."""
        found: dict[str, str] = table(self.lang, "classes")["report"]
        return found

    @property
    def head(self) -> str:
        """What it is a report of."""
        return f"{self.words['title']} - {self.title}"

    @property
    def total(self) -> str:
        """Points that were reached, of those that could be."""
        marks, points = (amount(one, self.lang) for one in (self.marks.marks, self.marks.points))
        return self.words["total"].format(marks=marks, points=points)

    @property
    def revise(self) -> list[Section]:
        """Where points were lost; most first."""
        lost = [section for section in self.sections if section.lost > 0]
        return sorted(lost, key=lambda section: -section.lost)[:MOST_TO_REVISE]

    @property
    def nothing(self) -> str:
        """That all points were reached; empty while that is still to be decided."""
        return "" if self.marks.undecided else self.words["nothing"]

    @property
    def provisional(self) -> str:
        """That something is still to be decided; empty if nothing is."""
        count = self.marks.undecided
        name = "provisional_one" if count == 1 else "provisional"
        return self.words[name].format(count=count) if count else ""


def report_of(line: Graded, key: Key, *, anonymous: bool = False) -> Report:
    """What a student is told.

    Parameters
    ----------
    line : Graded
        Somebody whose answers came back.
    key : Key
        Of the student's paper.
    anonymous : bool
        Leave name and id out.
    """
    assert line.marks is not None  # noqa: S101 - see above
    marks = line.marks
    lang = known(marks.lang)
    who = "" if anonymous else ", ".join(filter(None, (line.student.name, line.student.id)))
    sections = tuple(_section(question, marks) for question in key.questions)
    title = key.title.get(lang) or next(iter(key.title.values()), "")
    return Report(lang, title, visible(who, ""), line.code, line.grade, marks, sections)


def _section(question: KeyQuestion, marks: Marks) -> Section:
    given = {part.id: part for part in marks.parts}
    mine = [given[part.id] for part in question.parts if part.id in given]
    rows = tuple(_rows(question, marks))
    title = question.title.get(marks.lang) or next(iter(question.title.values()), "")
    return Section(
        question.number,
        title,
        sum(part.marks or 0.0 for part in mine),
        sum(part.points for part in mine),
        sum(part.points for part in mine if part.undecided),
        rows,
        question.topic,
        known(marks.lang),
    )


def _rows(question: KeyQuestion, marks: Marks) -> Iterator[Row]:
    """The parts, each said of in the student's language what the checker says of it."""
    words = table(known(marks.lang), "classes")["report"]
    marker = Marker(question, Options(known(marks.lang), marks.decimal))
    given = {part.item: part for part in marks.parts}
    for part in question.parts:
        found = given.get(item_of(question, part))
        if found is None:
            continue
        again = marker.mark(part, found.typed)
        message = "" if again.blank or found.marks == found.points else again.verdict.message
        yield Row(
            part.id.removeprefix(question.number),
            _typed(found.typed, part.spec["kind"], words),
            _right(part, known(marks.lang)),
            _points(found, known(marks.lang)),
            message,
            _said(found, words),
        )


def _right(part: KeyPart, lang: str) -> str:
    """The key as a person writes it; a program's output stays as it is printed."""
    kind = part.spec["kind"]
    if kind in NOT_TYPED:
        return str(table(lang, "classes")["report"]["solution"])
    right = show(part.in_order(), lang)
    return right if kind == "code" else numbers_in(lang, right)


def _typed(typed: str, kind: str, words: Mapping[str, str]) -> str:
    """An answer as it stands in a cell."""
    if not typed.strip():
        return words["blank"]
    return words["drawn"] if kind == "sketch" else visible(typed, "")


def _points(part: PartMark, lang: str) -> str:
    words = table(lang, "classes")["report"]
    if part.status == DROPPED:
        return str(words["dropped"])
    if part.marks is None:
        return str(words["undecided"])
    return numbers_in(lang, f"{part.marks:g} / {part.points:g}")


def _said(part: PartMark, words: Mapping[str, str]) -> str:
    """That a person decided, and the remark that goes with it."""
    if not part.by or part.status == DROPPED:
        return ""
    remark = visible(part.remark, "")
    return f"{words['remark']}: {remark}" if remark else words["decided"]


def report_html(report: Report) -> bytes:
    """A report as one self-contained page."""
    made = (
        layouts()
        .get_template("report.html.j2")
        .render(
            report=report,
            words=report.words,
            style=Markup(styles(":lang({})")) + style(),
            bangla_fonts=bangla_faces([report.lang], str(report)),
        )
    )
    return made.encode()


@cache
def layouts() -> jinja2.Environment:
    """The layouts of pages of a class."""
    return environment(PACKAGE, "quizgen.render")


@cache
def style() -> Markup:
    """How they look."""
    page = (files(PACKAGE) / "pages" / "report.css").read_text(encoding="utf-8")
    return Markup(write_theme_css() + page)


def report_pdf(report: Report) -> bytes:
    """A report as a tagged PDF.

    Raises
    ------
    RenderError
        If it cannot be typeset.
    """
    words = report.words
    head = (
        f"#show: report.with(title: {string(report.head)}, lang: {string(report.lang)}, "
        f"who: {_shown(report.who)}, code: {string(words['code'] + ': ' + report.code)}, "
        f"grade: {string(words['grade'] + ': ' + report.grade)}, total: {string(report.total)}, "
        f"provisional: {string(report.provisional)})"
    )
    heads = ", ".join(string(words[name]) for name in ("part", "yours", "right", "points"))
    body = "\n".join(_question(section, heads) for section in report.sections)
    return compiled(document("report.typ", f"{head}\n{_revise(report)}\n{body}\n", PACKAGE))


def _revise(report: Report) -> str:
    words = report.words
    if not report.revise:
        return f"#block({string(report.nothing)})" if report.nothing else ""
    rows = ", ".join(
        f"({string(one.name)}, {string(one.told(words))}, {string(one.practise)})"
        for one in report.revise
    )
    sentences = (words["revise"], words["revise_about"], words["practise"])
    return f"#revise({', '.join(map(string, sentences))}, ({rows},))"


def _question(section: Section, heads: str) -> str:
    rows = "".join(_typst(row) for row in section.rows)
    return f"#answered({string(section.name)}, {string(section.worth)}, ({heads}), ({rows}))"


def _typst(row: Row) -> str:
    """A row of the table: four cells, and what is said below them."""
    cells = ", ".join(map(_shown, (row.label, row.typed, row.right, row.marks)))
    below = "".join(f"{_shown(text)}, " for text in (row.message, row.said) if text)
    return f"({cells}, ({below})), "


def _shown(text: str) -> str:
    """What somebody may have written, with what no font has as ``?``."""
    return string(printable(text))
