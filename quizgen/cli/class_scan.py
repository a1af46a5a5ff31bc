"""``quizgen class scan``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from quizgen.cli.options import LanguageParam, jobs_option, worthwhile_processes
from quizgen.cli.terminal import ProgressLine, format_count, print_list, print_sentence
from quizgen.core.errors import require_extra
from quizgen.grading.echo import safe_echo
from quizgen.locale import FIRST, load_words

if TYPE_CHECKING:
    from quizgen.classes.scanning.pages import PageReading
    from quizgen.classes.scanning.scan_run import ScanReport

A_PICTURE = 0.25
"""Seconds that one takes, about."""


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.argument("files", type=click.Path(path_type=Path), nargs=-1)
@click.option("--lang", type=LanguageParam(), default=FIRST, help="Of the page of pictures.")
@jobs_option
@click.option("--scheduler", default="", help="Dask scheduler that reads: tcp://HOST:8786.")
def scan(
    folder: Path, files: tuple[Path, ...], lang: str, jobs: int | None, scheduler: str
) -> None:
    """Read answer sheets that came back to the class in FOLDER on paper.

    FILES are what a scanner or a phone made: PDF, JPEG, PNG or TIFF, pages in any order. A table
    (CSV, XLSX) with id, part and answer is what somebody typed beside the pictures. What has been
    read is not read again; without FILES it says where things stand.
    """
    require_extra("scan", "quizgen class scan")
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.scanning.scan_run import count_new_pictures, scan_class
    from quizgen.core.executor import open_executor

    found = ClassFolder(folder)
    found.settings  # noqa: B018 - a folder that is none of a class says so
    count = count_new_pictures(found, files)
    processes = worthwhile_processes(jobs, count * A_PICTURE)
    with (
        open_executor(processes, scheduler) as (executor, ahead),
        ProgressLine("page", count) as progress,
    ):
        report = scan_class(found, files, executor, ahead, progress, lang)
    _report_scan(folder, report)


def _report_scan(folder: Path, report: ScanReport) -> None:
    """Print what was read, what is missing, and what a person is to see to."""
    why = load_words(FIRST, "classes")["scan"]["why"]
    read = format_count(report.read, "page")
    before = f", {report.known} had been read before" if report.known else ""
    empty = f", {report.empty} with nothing on them" if report.empty else ""
    print_sentence(f"{folder}: {read} read{before}{empty}")
    if report.typed:
        print_sentence(f"{format_count(report.typed, 'answer')} taken from what was typed")
    print_list("Not read", [*report.problems])
    print_list("Of no sheet of this class", [_describe_stray(one, why) for one in report.strays])
    print_list("Pages missing", [*_iter_page_lines(report, "missing")])
    print_list("Pages that came twice", [*_iter_page_lines(report, "twice")])
    print_list("Pages that are asked whole", [
        f"{safe_echo(one.student)}, page {page}: {why[fault]}"
        for one in report.sheets
        for page, fault in one.faults.items()
    ])  # fmt: skip
    print_list("No sheet came of", [*map(safe_echo, report.absent)])
    if report.boxes:
        share = 100 * (report.boxes - report.doubtful) / report.boxes
        print_sentence(
            f"{report.boxes - report.doubtful} of {report.boxes} boxes read ({share:.1f} %)"
        )
    left = report.open_count
    if left:
        print_sentence(
            f"To be typed or decided: {format_count(left, 'answer')}. Open "
            f"{folder}/scans/scans.html, then: quizgen class scan {folder} typed.csv"
        )
    if report.sheets:
        print_sentence(
            f"{folder}/answers/scan.csv: {format_count(len(report.sheets), 'student')}. "
            f"Next: quizgen class mark {folder}"
        )
    if report.problems or report.strays or any(one.missing or one.faults for one in report.sheets):
        raise SystemExit(1)


def _describe_stray(one: PageReading, why: Mapping[str, str]) -> str:
    """Return in a line which picture is of no sheet of the class, and why."""
    place = f"{safe_echo(one.file)}, page {one.number}"
    if one.fault == "unreadable":
        return f"{place}: {one.said}"
    return f"{place}: {why[one.fault]}" + (f" ({safe_echo(one.said)})" if one.said else "")


def _iter_page_lines(report: ScanReport, which: str) -> Iterator[str]:
    """Yield whose pages are missing, or came twice."""
    for one in report.sheets:
        for page in getattr(one, which):
            yield f"{safe_echo(one.student)}, page {page}"
