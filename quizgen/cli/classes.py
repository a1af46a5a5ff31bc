"""``quizgen class``."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click
import msgspec

from quizgen.cli import class_exam, class_grading, class_scan
from quizgen.cli.options import (
    BankOptions,
    LanguageParam,
    bank_options,
    jobs_option,
    open_bank,
    open_sound_bank,
    split_names,
    worthwhile_processes,
)
from quizgen.cli.terminal import (
    ProgressLine,
    format_count,
    print_sentence,
    print_table,
    to_one_line,
)
from quizgen.core.errors import ClassError, require_extra
from quizgen.core.files import PRIVATE, write_all
from quizgen.locale import FIRST, default_language

if TYPE_CHECKING:
    from collections.abc import Mapping

    from quizgen.bank.bank import Bank
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.generation import GenerationReport
    from quizgen.classes.roster import RosterStudent
    from quizgen.paper.blueprint import Blueprint

A_PAPER = 0.5
"""Seconds that one takes, about."""


@click.group("class")
def class_() -> None:
    """Examine a class: one folder from the roster to the grades."""
    require_extra("class", "quizgen class")


class ClassMakeOptions(BankOptions):
    """Options of ``quizgen class make``."""

    roster: Path
    out: Path
    blueprint: str | None
    columns: str | None
    lang: str | None
    vary: bool
    one_file: bool
    sheet: bool
    scan: bool
    about: Path | None
    preview: bool
    not_from: tuple[Path, ...]
    jobs: int | None
    scheduler: str


@class_.command()
@click.argument("roster", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), required=True, help="Folder of the class.")
@click.option("--blueprint", help="A blueprint's name or TOML file. [default: mock, else all.90]")
@click.option("--columns", help="What columns are called: id=Matrikel,name=Name.")
@click.option("--lang", type=LanguageParam(both=True),
              help="Of who has none in the roster; English if the bank has it.")  # fmt: skip
@click.option("--vary", is_flag=True, help="Other templates of the same kind, too.")
@click.option(
    "--about",
    type=click.Path(path_type=Path),
    help="TOML file: course, date, room, rules, for the covers.",
)
@click.option("--preview", is_flag=True, help="One sample and the list of questions, no papers.")
@click.option("--not-from", type=click.Path(path_type=Path), multiple=True,
              help="Folder of an earlier class, none of whose questions is asked.")  # fmt: skip
@click.option("--sheet", is_flag=True, help="Compact answer sheets, too, for a scanner.")
@click.option("--scan", is_flag=True, help="Papers that a scanner reads, page by page.")
@click.option("--one-file", is_flag=True, help="Write print.pdf, too: all papers, for the printer.")
@jobs_option
@click.option("--scheduler", default="", help="Dask scheduler that makes them: tcp://HOST:8786.")
@bank_options
def make(**options: Unpack[ClassMakeOptions]) -> None:
    """Make a paper for each student of ROSTER, a CSV or XLSX file with a column id.

    All papers have the same questions with other numbers. A second run makes only what is missing
    or whose row has changed.
    """
    from quizgen.classes.class_folder import SHEETS, ClassFolder
    from quizgen.classes.exam_details import FILE as EXAM
    from quizgen.classes.generation import generate_papers
    from quizgen.classes.print_file import write_print_file
    from quizgen.classes.roster import read_roster
    from quizgen.core.executor import open_executor

    if options["one_file"]:
        require_extra("print", "quizgen class make --one-file")
    if options["sheet"] and options["scan"]:
        raise click.UsageError("--scan prints whole papers to be read, --sheet a sheet: take one")
    about = _read_about(options["about"])
    unread: list[str] = []
    students = read_roster(options["roster"], _parse_columns(options["columns"]), unread.append)
    _report_roster(options["roster"], unread)
    folder = ClassFolder(options["out"])
    count = worthwhile_processes(options["jobs"], len(students) * A_PAPER)
    with open_executor(count, options["scheduler"]) as (executor, ahead):  # before any folder
        blueprint = _open_class_blueprint(folder, students, options)
        if about:
            write_all(folder.path, {EXAM: about}, PRIVATE)
        if options["sheet"] and folder.settings.scan:
            raise ClassError(f"{folder.path}: its papers are read whole; they need no sheets")
        if options["preview"]:
            _write_preview(folder, blueprint)
            return
        if options["sheet"]:  # a later run finds it, and makes sheets, too
            (folder.path / SHEETS).mkdir(mode=0o700, exist_ok=True)
        with ProgressLine("paper", len(students)) as progress:
            report = generate_papers(folder, students, blueprint, executor, ahead, progress)
    if options["one_file"]:
        write_print_file(folder, students)
    _report_papers(folder, report)
    _report_unprintable_names(students)


@class_.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.argument("printed")
def code(folder: Path, printed: str) -> None:
    """Say whose paper of the class in FOLDER has the PRINTED code, and that it is unaltered.

    What the square code on a page says is taken, too.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.sheet_codes import find_sheet_page

    if ":" in printed:
        head, page = find_sheet_page(ClassFolder(folder), printed)
        click.echo(f"{head.code}: {to_one_line(head.id)}, page {page}")
        return
    found = ClassFolder(folder).find_by_code(printed)
    click.echo(f"{found.head.code}: {to_one_line(found.head.id)}")


@class_.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.argument("number", type=int)
@click.option("--template", default="", help="Which. [default: any that fits]")
@click.option(
    "--like",
    type=click.Path(path_type=Path),
    help="templates.csv of earlier classes: what fits and was about as difficult there.",
)
def redraw(folder: Path, number: int, template: str, like: Path | None) -> None:
    """Ask something else as question NUMBER of the class in FOLDER, which has no papers yet.

    What is asked instead fits the same slot and is worth as many points, and what the blueprint
    asks of the whole paper still holds. Writes the preview again.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.generation import (
        open_class_bank,
        replace_by_comparable,
        replace_template,
    )
    from quizgen.classes.lock import lock_folder
    from quizgen.classes.template_history import read_difficulties
    from quizgen.paper.blueprint import load_blueprint

    found = ClassFolder(folder)
    settings = found.settings
    bank = open_class_bank(settings)
    blueprint = load_blueprint(settings.blueprint, bank)
    if template and like:
        raise click.UsageError("--template says which; --like looks for one")
    known = read_difficulties(like) if like else {}
    with lock_folder(folder):
        found.change_settings(
            replace_by_comparable(settings, bank, blueprint, number, known)
            if like
            else replace_template(settings, bank, blueprint, number, template)
        )
        _write_preview(found, blueprint)


@class_.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--lang", type=LanguageParam(), default=FIRST, help="Of the lists.")
def lists(folder: Path, lang: str) -> None:
    """Write the lists for the rooms of the class in FOLDER.

    lists/attendance.pdf has names and is signed; lists/seats.pdf has ids alone, to hang at the
    door; lists/more-time.pdf is for those who watch.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.room_lists import write_room_lists

    for path in write_room_lists(ClassFolder(folder), lang):
        print_sentence(str(path))


@class_.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--yes", is_flag=True, help="Do it: nothing brings it back.")
def forget(folder: Path, *, yes: bool) -> None:
    """Delete names, ids, codes, papers and free text of the class in FOLDER; keep statistics.

    What stays are the questions, points under pseudonyms that nobody can undo, and answers that
    were numbers or ticks. No papers can be made of it any more.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.forgetting import forget_class

    if not yes:
        raise click.UsageError(f"this deletes the papers, answers and names in {folder}: add --yes")
    count = forget_class(ClassFolder(folder))
    print_sentence(f"{folder}: {format_count(count, 'student')} forgotten. "
                   f"What is left: quizgen class analyse {folder}")  # fmt: skip


@class_.command()
@click.argument("keys", type=click.Path(path_type=Path))
@click.argument("reports", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option("--out", type=click.Path(path_type=Path), required=True, help="Folder of the class.")
def take(keys: Path, reports: tuple[Path, ...], out: Path) -> None:
    """Make a class of a quiz that Moodle or a player of QTI has played.

    KEYS is what quizgen export left behind (.keys.jsonl), REPORTS are responses as quizgen check
    reads them. A later report adds who is new.
    """
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.lms.class_import import import_quiz

    lost: list[str] = []
    found = import_quiz(ClassFolder(out), keys, reports, lost.append)
    for line in lost:
        print_sentence(to_one_line(line))
    print_sentence(f"{out}: {found.people} on the roster, answers of {found.new} new. "
         f"Next: quizgen class mark {out}")  # fmt: skip


def _write_preview(folder: ClassFolder, blueprint: Blueprint) -> None:
    """Write a sample paper with its solutions, and print which questions it has."""
    from quizgen.classes.exam_details import FILE as EXAM
    from quizgen.classes.exam_details import ExamDetails, read_exam_details
    from quizgen.classes.generation import PREVIEW, make_preview
    from quizgen.render import KINDS, render_paper

    exam = read_exam_details(folder.path / EXAM) or ExamDetails()
    paper = make_preview(folder.settings, blueprint, exam)
    names = (f"{PREVIEW}.pdf", f"{PREVIEW}-solutions.pdf")
    sheets = [render_paper(paper, kind, "pdf") for kind in KINDS]
    write_all(folder.path, dict(zip(names, sheets, strict=True)), PRIVATE)
    rows = [
        (item.number, f"{float(item.points):g}", item.keys[0].template, item.questions[0].title)
        for item in paper.items
    ]
    print_table(("no.", "points", "template", "title"), rows)
    print_sentence(f"{float(paper.points):g} points, {paper.minutes} min. "
                   f"Look at {folder.path / names[0]} and {folder.path / names[1]}")  # fmt: skip
    print_sentence(f"Another question 1: quizgen class redraw {folder.path} 1")
    print_sentence(f"The papers: quizgen class make {folder.path}/roster.csv --out {folder.path}")


def _read_about(path: Path | None) -> bytes:
    """Return the bytes of the file on the exam, checked; none if no file was named."""
    from quizgen.classes.exam_details import read_exam_details

    if path is None:
        return b""
    if read_exam_details(path) is None:
        raise click.BadParameter(f"there is no file {path}", param_hint="--about")
    return path.read_bytes()


def _parse_columns(text: str | None) -> Mapping[str, str]:
    """Return the file's name of each roster column in ``id=Matrikel,name=Name``."""
    pairs = [name.partition("=") for name in split_names(text)]
    for ours, sign, theirs in pairs:
        if not (sign and theirs.strip()):
            raise click.BadParameter(f"{ours!r} (write id=Matrikel)", param_hint="--columns")
    return {ours.strip(): theirs.strip() for ours, _, theirs in pairs}


def _open_class_blueprint(
    folder: ClassFolder, students: list[RosterStudent], options: ClassMakeOptions
) -> Blueprint:
    """Return the blueprint of the class; create the class if there is none yet."""
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.generation import create_settings, open_class_bank
    from quizgen.paper.blueprint import default_blueprint_name, load_blueprint

    if folder.is_new:
        bank = open_sound_bank(options)
        blueprint = load_blueprint(options["blueprint"] or default_blueprint_name(bank), bank)
        name = folder.path.resolve().name
        lang = options["lang"] or default_language(bank.languages)
        without = {
            name
            for earlier in options["not_from"]
            for family in ClassFolder(earlier).settings.templates
            for name in family
        }
        settings = create_settings(
            name,
            bank,
            blueprint,
            lang,
            vary=options["vary"],
            without=sorted(without),
        )
        settings = msgspec.structs.replace(settings, scan=options["scan"])
        folder.create(settings, students)
        return blueprint
    settings = folder.settings
    if not settings.digest:
        raise ClassError(
            f"{folder.path}: is of a quiz that was played, or was forgotten: it has no papers"
        )
    _check_same_options(folder, options)
    if options["scan"] and not settings.scan:
        settings = msgspec.structs.replace(settings, scan=True)
        folder.change_settings(settings)
    return load_blueprint(options["blueprint"] or settings.blueprint, open_class_bank(settings))


def _check_same_options(folder: ClassFolder, options: ClassMakeOptions) -> None:
    """Raise an error for options that an existing class was not made with."""
    from quizgen.bank.combined import bank_sources
    from quizgen.classes.generation import open_class_bank

    def place(bank: Bank) -> str:
        """Return a bank's folders as one text, to be compared."""
        return " + ".join(root or "built-in" for root, _ in bank_sources(bank))

    settings = folder.settings
    made = {"bank": place(open_class_bank(settings)), "lang": settings.lang}
    wished = {
        "bank": place(open_bank(options)) if options["bank"] else None,
        "lang": options["lang"],
    }
    for name, value in wished.items():
        if value is not None and value != made[name]:
            raise ClassError(
                f"{folder.path}: was made with {name} {made[name]!r}, not {value!r}; "
                "a new class needs a new folder (--out)"
            )
    if options["vary"] and not any(len(family) > 1 for family in settings.templates):
        raise ClassError(f"{folder.path}: was made without --vary; name a new folder (--out)")


def _report_roster(roster: Path, unread: list[str]) -> None:
    """Print what was guessed of a roster, and the columns of it that were not read."""
    from quizgen.core.spreadsheets import is_old_encoding

    if is_old_encoding(roster.read_bytes()):
        print_sentence(f"{roster}: is not UTF-8, and was read as Windows-1252; "
                       "see that the names are right")  # fmt: skip
    if unread:
        print_sentence(
            f"Not read of the roster: {', '.join(unread)} (--columns names what a column is)"
        )


def _report_papers(folder: ClassFolder, report: GenerationReport) -> None:
    """Print how many papers were made, and how much they have in common."""
    print_sentence(
        f"{folder.path}: {format_count(len(report.made), 'paper')}"
        f" made, {report.kept} kept as they were"
    )
    if report.made:
        print_sentence(f"Each of them: {_describe_papers(report)}")
        few = sorted({number for one in report.made for number in one.alike})
        if few:
            print_sentence(f"Neighbours share a number in question {', '.join(map(str, few))}")
    for student in report.left:
        print_sentence(f"{student} is no longer on the roster; the paper and its key stay")
    print_sentence(
        "Nobody but you should read the folder: class.toml and keys.jsonl lead to every answer"
    )


def _report_unprintable_names(students: list[RosterStudent]) -> None:
    """Print each name that the fonts of a paper cannot print."""
    from quizgen.render.typst_document import replace_unprintable

    for one in students:
        if replace_unprintable(one.name + one.id) != one.name + one.id:
            print_sentence(
                f"{one.id}: no font here has all of {one.name}; the rest is printed as ?"
            )


def _describe_papers(report: GenerationReport) -> str:
    """Return tiers, points and minutes: one value each, or all that occur."""
    tiers = (
        ", ".join(f"{count} of tier {tier}" for tier, count in sorted(Counter(one.tiers).items()))
        for one in report.made
    )
    points = (f"{float(one.points):g} points" for one in report.made)
    minutes = (f"{one.minutes} min" for one in report.made)
    return "; ".join(" or ".join(sorted({*each})) for each in (tiers, points, minutes))


for _command in (*class_exam.COMMANDS, *class_grading.COMMANDS, class_scan.scan):
    class_.add_command(_command)
