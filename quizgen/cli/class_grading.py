"""``quizgen class mark``, ``rule``, ``history``, ``grade`` and ``analyse``."""

from __future__ import annotations

import getpass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from quizgen.cli.options import MOST_JOBS, IntRangeParam, LanguageParam, match_choice, split_names
from quizgen.cli.terminal import format_count, print_sentence, to_one_line
from quizgen.locale import FIRST

if TYPE_CHECKING:
    from quizgen.classes.grading import GradedClassPart
    from quizgen.classes.grading_history import MarkChange
    from quizgen.classes.grading_run import GradingRun

SHOWN = 20
"""Lines of a list that the terminal shows; the files have all."""
REPORTS = ("html", "pdf")

_folder = click.argument("folder", type=click.Path(path_type=Path))


@click.command()
@_folder
@click.argument("files", type=click.Path(path_type=Path), nargs=-1)
@click.option("--jobs", type=IntRangeParam(1, MOST_JOBS), default=1, help="Processes. [default: 1]")
@click.option("--scheduler", default="", help="Dask scheduler that marks: tcp://HOST:8786.")
def mark(folder: Path, files: tuple[Path, ...], jobs: int, scheduler: str) -> None:
    """Mark what came back to the class in FOLDER: its folder answers, and FILES, copied there.

    Takes what was filled in decisions.csv and rulings.csv into account, says whose marks change,
    and writes what is still to be decided into decisions.csv.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.grading_run import grade_class
    from quizgen.classes.submissions import store_submissions
    from quizgen.core.executor import open_executor

    found = ClassFolder(folder)
    found.settings  # noqa: B018 - no answers are copied into a folder that is none of a class
    with open_executor(jobs, scheduler) as (executor, ahead):
        lost = store_submissions(folder, files)
        run = grade_class(found, executor, ahead)
    _report_run(folder, run, lost)


def _report_run(folder: Path, run: GradingRun, lost: list[str]) -> None:
    """Print what was graded, what was not, which marks changed, what is to be decided."""
    outcome = run.outcome
    print_sentence(
        f"{folder}: {format_count(outcome.students, 'student')}"
        f" marked, {outcome.new} for the first time"
    )
    problems = [*lost, *run.problems]
    _print_list(f"{len(problems)} not marked", problems)
    if run.decided:
        print_sentence(f"{format_count(run.decided, 'decision')} taken from decisions.csv")
    changes = [_format_change(one) for one in outcome.changes]
    _print_list(f"{format_count(len(changes), 'mark')} changed", changes)
    if run.groups:
        print_sentence(
            f"To be decided: {format_count(outcome.undecided, 'answer')}"
            f" in {format_count(run.groups, 'group')}. "
            f"Fill in points in {folder}/decisions.csv and mark again, "
            f"or: quizgen serve --class {folder}"
        )
    else:
        print_sentence(f"Nothing is to be decided. Next: quizgen class grade {folder}")


def _print_list(head: str, lines: list[str]) -> None:
    """Print a heading and at most ``SHOWN`` lines; nothing without lines."""
    if not lines:
        return
    print_sentence(f"{head}:")
    for line in lines[:SHOWN]:
        print_sentence(to_one_line(line))
    if len(lines) > SHOWN:
        print_sentence(f"... and {len(lines) - SHOWN} more")


def _format_change(change: MarkChange) -> str:
    """Return a changed mark in one line."""
    before, after = (("–" if m is None else f"{m:g}") for m in (change.before, change.after))
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
    """Add a line to rulings.csv of the class in FOLDER: drop, give, accept, tolerance, restore.

    ITEM is the name of a template and the letter of its part, as in decisions.csv. Marks change
    with the next quizgen class mark.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.key_index import KeyIndex
    from quizgen.classes.rulings import Ruling, append_rulings

    known = KeyIndex(ClassFolder(folder)).items()
    if item not in known:
        raise click.UsageError(f"no part {item!r} (there are {', '.join(sorted(known))})")
    said["who"] = said["who"] or getpass.getuser()
    append_rulings(folder, [Ruling(what, item, **said)])
    print_sentence(f"{folder}/rulings.csv: {what} {item}. Next: quizgen class mark {folder}")


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
def grade(folder: Path, reports: str, *, anonymous: bool) -> None:
    """Write grades, and a report for each student, into results of the class in FOLDER.

    grades.csv and grades.xlsx are for the office, posted.csv has codes and grades without names.
    Grades follow scale.toml, else the usual German scale.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.student_reports import write_grades_and_reports

    wished = [
        match_choice("reports", name, REPORTS) for name in split_names(reports) if name != "none"
    ]
    lines, left, files = write_grades_and_reports(ClassFolder(folder), wished, anonymous=anonymous)
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
    for path in files:
        print_sentence(str(path))


@click.command()
@_folder
@click.option("--lang", type=LanguageParam(), default=FIRST, help="Of the page.")
def analyse(folder: Path, lang: str) -> None:
    """Write the item analysis of the class in FOLDER: results/analysis.html."""
    from quizgen.classes.analysis_page import write_analysis_page
    from quizgen.classes.class_folder import ClassFolder

    found, path = write_analysis_page(ClassFolder(folder), lang)
    print_sentence(
        f"{format_count(found.students, 'student')}, {format_count(len(found.items), 'item')}"
    )
    if found.alpha is not None and found.interval is not None:
        low, high = found.interval
        print_sentence(f"Cronbach's alpha {found.alpha:.2f} (95 % {low:.2f} to {high:.2f})")
    print_sentence(str(path))


COMMANDS = (mark, rule, history, grade, analyse)
