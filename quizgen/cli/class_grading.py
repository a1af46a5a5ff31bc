"""``quizgen class mark``, ``rule``, ``points``, ``status``, ``history``, ``grade``, ``analyse``."""

from __future__ import annotations

import datetime as dt
import getpass
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import click

from quizgen.cli.options import (
    LanguageParam,
    jobs_option,
    match_choice,
    split_names,
    worthwhile_processes,
)
from quizgen.cli.terminal import format_count, print_list, print_sentence, to_one_line
from quizgen.core.errors import require_extra
from quizgen.grading.echo import safe_echo
from quizgen.locale import FIRST

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from quizgen.classes.grading import GradedClassPart
    from quizgen.classes.grading_history import MarkChange
    from quizgen.classes.grading_run import GradeChange, GradingRun
    from quizgen.classes.submissions import RivalAnswers

REPORTS = ("html", "pdf")
A_SUBMISSION = 0.04
"""Seconds that one takes, about, the first time that a class is marked."""

_folder = click.argument("folder", type=click.Path(path_type=Path))


@click.command()
@_folder
@click.argument("files", type=click.Path(path_type=Path), nargs=-1)
@jobs_option
@click.option("--scheduler", default="", help="Dask scheduler that marks: tcp://HOST:8786.")
@click.option("--try", "trial", is_flag=True, help="Say what would change, and change nothing.")
def mark(
    folder: Path, files: tuple[Path, ...], jobs: int | None, scheduler: str, *, trial: bool
) -> None:
    """Mark what came back to the class in FOLDER: its folder answers, and FILES, copied there.

    Takes what was filled in decisions.csv and rulings.csv into account, says whose marks change,
    and writes what is still to be decided into decisions.csv.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.grading_run import grade_class
    from quizgen.classes.judged_answers import FILE
    from quizgen.classes.submissions import store_submissions
    from quizgen.core.executor import open_executor

    found = ClassFolder(folder)
    found.settings  # noqa: B018 - no answers are copied into a folder that is none of a class
    if trial and files:
        raise click.UsageError("with --try no files are copied into the folder")
    unknown = 0 if (folder / FILE).exists() else len(found.students())
    count = worthwhile_processes(jobs, unknown * A_SUBMISSION)
    with open_executor(count, scheduler) as (executor, ahead):
        lost = store_submissions(folder, files)
        run = grade_class(found, executor, ahead, keep=not trial)
    _remind_to_forget(folder)
    if trial:
        print_sentence("Tried only; without --try this would be:")
    _report_run(folder, run, lost)


def _report_run(folder: Path, run: GradingRun, lost: list[str]) -> None:
    """Print what was graded, what was not, which grades and marks changed, what is to be decided.

    What changes grades stands before what changes marks.
    """
    from quizgen.classes.class_folder import ANSWERS

    outcome = run.outcome
    print_sentence(
        f"{folder}: {format_count(outcome.students, 'student')}"
        f" marked, {outcome.new} for the first time"
    )
    problems = [*lost, *run.problems]
    where = f" (mend or remove the file in {folder}/{ANSWERS}, then mark again)"
    print_list(f"{len(problems)} not marked{where if run.problems else ''}", problems)
    print_list("Answers that came twice and differ", [*_iter_rival_lines(folder, run.rivals)])
    print_list("Parts filled in, the fewest first", [*_iter_filled_lines(run.filled)])
    if run.decided:
        print_sentence(f"{format_count(run.decided, 'decision')} taken from decisions.csv")
    print_list(
        f"{format_count(len(run.grades), 'grade')} changed", [*map(_format_grade, run.grades)]
    )
    changes = outcome.changes
    if changes and not run.grades:
        print_sentence("No grade changed")
    print_list(f"{format_count(len(changes), 'mark')} changed", _list_change_lines(changes))
    if run.groups:
        print_sentence(
            f"To be decided: {format_count(outcome.undecided, 'answer')}"
            f" in {format_count(run.groups, 'group')}. "
            f"Fill in points in {folder}/decisions.csv and mark again, "
            f"or: quizgen serve --class {folder}"
        )
    elif not (problems or run.rivals):
        print_sentence(f"Nothing is to be decided. Next: quizgen class grade {folder}")
    if problems or run.rivals:
        raise SystemExit(1)


def _iter_rival_lines(folder: Path, rivals: Sequence[RivalAnswers]) -> Iterator[str]:
    """Yield each of several answers of a student, and after them how to say which count."""
    for one in rivals:
        counts = "counts" if one.counts else "does not count"
        parts = format_count(one.filled, "part")
        yield f"{safe_echo(one.student)}: {safe_echo(one.file)} ({parts} filled) {counts}"
    if rivals:
        one = rivals[-1]
        yield (
            f"Which shall count? quizgen class rule {folder} use {safe_echo(one.file)} --student "
            f"{safe_echo(one.student)}"
        )


def _iter_filled_lines(filled: Mapping[str, tuple[int, int]]) -> Iterator[str]:
    """Yield how many parts of each student were filled in; one line if it is all of them."""
    order = sorted(filled.items(), key=lambda pair: pair[1][0] - pair[1][1])
    for student, (count, parts) in order:
        if count < parts:
            yield f"{safe_echo(student)}: {count} of {parts} parts filled"
    whole = sum(count == parts for count, parts in filled.values())
    if whole:
        yield f"{format_count(whole, 'student')}: all parts filled"


def _format_grade(change: GradeChange) -> str:
    """Return a changed grade in one line."""
    return (
        f"{change.student}: {change.before} -> {change.after} "
        f"({100 * change.share_before:.1f} % -> {100 * change.share_after:.1f} %)"
    )


def _list_change_lines(changes: Sequence[MarkChange]) -> list[str]:
    """Return changed marks in lines: those that are fewer or more, then what no longer counts."""
    same = Counter((one.item, one.why) for one in changes if one.before == one.after)
    lines = [_format_change(one) for one in changes if one.before != one.after]
    for (item, why), count in same.items():
        what = "counts again for" if why.startswith("without") else "out of the points of"
        lines.append(f"{item}: {what} {format_count(count, 'student')}, {why}")
    return lines


def _remind_to_forget(folder: Path) -> None:
    """Print that the folder is kept longer than it should be, if it is."""
    from quizgen.classes.exam_details import describe_overdue

    overdue = describe_overdue(folder, dt.datetime.now(tz=dt.UTC).date())
    if overdue:
        print_sentence(overdue)


def _format_change(change: MarkChange) -> str:
    """Return a changed mark in one line."""
    before, after = (("–" if m is None else f"{m:g}") for m in (change.before, change.after))
    if change.why.startswith("drop") and not change.after:
        after = "does not count"
    return f"{change.student} {change.part} ({change.item}): {before} -> {after}, {change.why}"


@click.command()
@_folder
@click.argument("what")
@click.argument("item")
@click.option("--answer", default="", help="The answer it is about, or trap:NAME.")
@click.option("--value", default="", help="Points, or a tolerance: rel=0.05.")
@click.option("--student", default="", help="Id of the one whom it is about. [default: all]")
@click.option("--who", default="", help="Who says so. [default: the name of the account]")
@click.option("--comment", default="", help="Why; students read it.")
def rule(folder: Path, what: str, item: str, **said: str) -> None:
    """Add a line to rulings.csv of the class in FOLDER.

    WHAT is drop, give, accept, tolerance, points, decide, restore or use. ITEM is the name of a
    template and the letter of its part, as in decisions.csv, or a part as it is printed, such as
    7b; with use it is a file of the folder answers. Marks change with the next quizgen class mark.
    """
    from quizgen.classes.class_folder import ANSWERS, ClassFolder
    from quizgen.classes.grading_run import check_rulings, check_tolerance
    from quizgen.classes.key_index import KeyIndex
    from quizgen.classes.rulings import TOLERANCE, USE, Ruling, append_rulings

    keys = KeyIndex(ClassFolder(folder))
    said["who"] = said["who"] or getpass.getuser()
    if said["student"]:
        said["student"] = keys.find_student(said["student"])
    inside = (folder / ANSWERS).resolve()
    if what == USE and not (
        (inside / item).resolve().is_relative_to(inside) and (inside / item).is_file()
    ):
        raise click.UsageError(f"no file {item!r} in {folder / ANSWERS}")
    found = item if what == USE else keys.find_item(item, said["student"])
    made = Ruling(what, found, **said)
    made.check()
    check_rulings([made], keys)
    if what == TOLERANCE:
        check_tolerance(made, keys)
    append_rulings(folder, [made])
    print_sentence(f"{folder}/rulings.csv: {what} {found}. Next: quizgen class mark {folder}")


@click.command()
@_folder
@click.argument("out", type=click.Path(path_type=Path))
def table(folder: Path, out: Path) -> None:
    """Write OUT (XLSX), a table to type answers or points into, for the class in FOLDER.

    It has a row for each student and a column for each part. Filled in, quizgen class mark takes
    it as answers, quizgen class points as points.
    """
    from quizgen.classes.blank_table import build_blank_table
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.core.files import PRIVATE, write_all

    if out.suffix.lower() != ".xlsx" or out.exists():
        raise click.UsageError(f"{out}: name a file that ends in .xlsx and is not there yet")
    for path in write_all(out.parent, {out.name: build_blank_table(ClassFolder(folder))}, PRIVATE):
        print_sentence(str(path))


@click.command()
@_folder
@click.argument("filled", metavar="TABLE", type=click.Path(path_type=Path))
@click.option("--who", default="", help="Who gives them. [default: the name of the account]")
@click.option("--comment", default="", help="Why; students read it.")
def points(folder: Path, filled: Path, who: str, comment: str) -> None:
    """Give points for what was written on paper: TABLE has a row for each student.

    Its columns are id or code, and parts as they are printed (1a, 1b, ...), its cells the points;
    a cell that is empty says nothing. They hold whatever was typed, or if nothing was.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.grading_run import check_rulings
    from quizgen.classes.key_index import KeyIndex
    from quizgen.classes.points_table import read_points_table
    from quizgen.classes.rulings import append_rulings

    keys = KeyIndex(ClassFolder(folder))
    made = read_points_table(filled, keys, who or getpass.getuser(), comment)
    check_rulings(made, keys)
    append_rulings(folder, made)
    students = len({one.student for one in made})
    print_sentence(
        f"{folder}/rulings.csv: points for {format_count(len(made), 'part')} of "
        f"{format_count(students, 'student')}. Next: quizgen class mark {folder}"
    )


@click.command()
@_folder
@click.argument("student")
@click.argument("what", metavar="STATUS")
@click.option("--who", default="", help="Who says so. [default: the name of the account]")
@click.option("--comment", default="", help="Why.")
def status(folder: Path, student: str, what: str, who: str, comment: str) -> None:
    """Say of STUDENT: present (blank paper), absent, sick, withdrawn or deception.

    It stands in statuses.csv of the class in FOLDER and in the tables of grades; the last one
    counts.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.statuses import StudentStatus, append_status

    said = StudentStatus(student, what, who or getpass.getuser(), comment)
    added = append_status(ClassFolder(folder), said)
    print_sentence(f"{to_one_line(added.student)}: {added.status}")


@click.command()
@_folder
@click.argument("student")
def history(folder: Path, student: str) -> None:
    """Show all marks that STUDENT ever had in the class in FOLDER, and who gave them."""
    from quizgen.classes.grading_history import GradingHistory

    before: dict[str, GradedClassPart] = {}
    for run, marks in GradingHistory(folder).marks_of(student):
        print_sentence(
            f"Run {run}: {marks.marks:g} of {marks.points:g} points, from {to_one_line(marks.file)}"
        )
        for part in marks.parts:
            if part.id not in before or before[part.id] != part:
                print_sentence(f"{part.id} ({part.item}): {_format_part_mark(part)}")
            before[part.id] = part
    if not before:
        print_sentence(f"{to_one_line(student)}: nothing has been marked")


def _format_part_mark(part: GradedClassPart) -> str:
    """Return a mark with its answer, its remark and who gave it, in one line."""
    marks = "–" if part.marks is None else f"{part.marks:g}"
    told = [
        f"{marks} / {part.points:g}",
        part.status,
        part.note,
        part.by,
        to_one_line(part.typed)[:60],
    ]
    return ", ".join(filter(None, told))


@click.command()
@_folder
@click.option("--reports", default="html", help="Reports for students: html, pdf, or none.")
@click.option("--anonymous", is_flag=True, help="Reports bear the code instead of the name.")
@click.option("--office", type=LanguageParam(), help="Language of office.csv.")
def grade(folder: Path, reports: str, *, anonymous: bool, office: str | None) -> None:
    """Write grades, and a report for each student, into results of the class in FOLDER.

    grades.csv and grades.xlsx have every item, office.csv and office.xlsx what an examination
    office takes, posted.csv codes and grades without names. Grades follow scale.toml, else the
    usual German scale.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.student_reports import write_grades_and_reports

    wished = [
        match_choice("reports", name, REPORTS) for name in split_names(reports) if name != "none"
    ]
    lines, left, files = write_grades_and_reports(
        ClassFolder(folder), wished, anonymous=anonymous, office=office or ""
    )
    there = [one for one in lines if one.marks]
    passed = sum(one.passed for one in there)
    print_sentence(
        f"{len(there)} of {format_count(len(lines), 'student')} handed in, {passed} passed"
    )
    for student in left:
        print_sentence(f"{to_one_line(student)} handed in, but is not on the roster: no grade")
    open_still = sum(one.marks.undecided_count for one in there if one.marks)
    if open_still:
        print_sentence(f"Provisional: {format_count(open_still, 'answer')} still to be decided")
    held = [f"{one.student.id}: {one.held}" for one in lines if one.held]
    print_list("Before these are final, somebody has to see to it", held)
    for path in files:
        print_sentence(str(path))
    _remind_to_forget(folder)
    if held:
        raise SystemExit(1)


@click.command()
@_folder
@click.argument("students", nargs=-1)
def inspect(folder: Path, students: tuple[str, ...]) -> None:
    """Write what STUDENTS look at when marked papers are shown; all who handed in, if none.

    One PDF file each in results/inspection: answers, marks and remarks, what was objected and
    replied, lines for objections and a signature, and the worked solutions of the own paper.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.inspection import write_inspection

    require_extra("print", "quizgen class inspect")
    for path in write_inspection(ClassFolder(folder), students):
        print_sentence(str(path))


@click.command("object")
@_folder
@click.argument("student", required=False)
@click.argument("part", required=False)
@click.argument("text", required=False)
@click.option("--reply", is_flag=True, help="TEXT is what the examiner replies.")
@click.option("--who", default="", help="Who writes it down. [default: the name of the account]")
def object_(
    folder: Path, student: str | None, part: str | None, text: str | None, who: str, *, reply: bool
) -> None:
    """Record what STUDENT says against the marks of PART (7b); without them, list what is open.

    It stands in objections.csv, and in the student's next report. Marks are changed by rulings:
    quizgen class rule FOLDER points PART --student STUDENT --value POINTS.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.objections import Objection, append_objection, list_open, read_objections

    found = ClassFolder(folder)
    found.settings  # noqa: B018 - in a folder that is none of a class nobody has objected
    if student is None:
        waiting = [f"{one.student} {one.part}: {one.objection}"
                   for one in list_open(read_objections(found.path))]  # fmt: skip
        print_list(f"{format_count(len(waiting), 'objection')} without a reply", waiting)
        return
    if part is None or not text:
        raise click.UsageError("a student, a part and a text belong together")
    said = {"reply": text} if reply else {"objection": text}
    added = append_objection(found, Objection(student, part, **said, who=who or getpass.getuser()))
    print_sentence(f"{folder}/objections.csv: {added.student} {added.part}")


@click.command()
@_folder
@click.option("--lang", type=LanguageParam(), default=FIRST, help="Of the page.")
@click.option(
    "--earlier",
    type=click.Path(path_type=Path),
    multiple=True,
    help="A class of another year, for results/templates.csv; may be repeated.",
)
def analyse(folder: Path, lang: str, earlier: tuple[Path, ...]) -> None:
    """Write the item analysis of the class in FOLDER: results/analysis.html.

    results/items.csv has its figures, results/templates.csv those of each part of a template, over
    all classes that are named.
    """
    from quizgen.classes.analysis_page import TABLE, write_analysis_page
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.template_history import write_template_history

    found, path = write_analysis_page(ClassFolder(folder), lang)
    print_sentence(
        f"{format_count(found.students, 'student')}, {format_count(len(found.items), 'item')}"
    )
    if found.alpha is not None and found.interval is not None:
        low, high = found.interval
        print_sentence(f"Cronbach's alpha {found.alpha:.2f} (95 % {low:.2f} to {high:.2f})")
    print_sentence(str(path))
    print_sentence(str(path.with_name(TABLE)))
    others = [ClassFolder(one) for one in earlier]
    print_sentence(str(write_template_history(ClassFolder(folder), others)))


COMMANDS = (mark, table, rule, points, status, history, grade, inspect, object_, analyse)
