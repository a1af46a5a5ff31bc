"""``quizgen lint``."""

from __future__ import annotations

import json
import sys
import traceback
from contextlib import redirect_stdout
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import BankOptions, Whole, bank_options, jobs_option, open_bank, paying
from quizgen.cli.terminal import Progress, interrupted, print_table
from quizgen.errors import QuizgenError
from quizgen.executors import in_order, workers
from quizgen.outside import visible

if TYPE_CHECKING:
    from quizgen.audit.leaks import Heard
    from quizgen.audit.lint import Report
    from quizgen.audit.located import Problem
    from quizgen.bank.folder import Bank
    from quizgen.paper.blueprint import Blueprint

HEAD = ("template", "draws", "distinct", "kept", "ms/draw", "problems", "answers")
TEACH_HEAD = ("template", "part", "level", "finding")
NOTHING = ("0", "", "", "", "1", "")
"""Cells of a template that could not be examined."""

A_TEMPLATE, A_DRAW, A_PAPER = 0.02, 0.0003, 0.1
"""Seconds that one takes to be examined, about: what is done once, and what with each draw."""
FEW = 20
"""Draws that are examined while an author waits."""
ENOUGH, ENOUGH_A_DRAW = 20.0, 0.05
"""Seconds after which a template is given up: many times what the slowest ones take."""


class Options(BankOptions):
    """What to examine."""

    folder: Path | None
    seeds: int
    only: tuple[str, ...]
    teach: bool
    papers: int | None
    limit: int | None
    debug: bool
    json: bool
    jobs: int | None


@click.command()
@click.argument("folder", type=click.Path(path_type=Path), required=False)
@click.option("--seeds", type=Whole(1, 10**6), default=200, show_default=True,
              help="How many draws of each template to examine.")  # fmt: skip
@click.option("--only", multiple=True, help="Just this template (may be repeated).")
@click.option(
    "--teach",
    is_flag=True,
    help="Show only what stands between questions and teaching, with notes, and count pools.",
)
@click.option(
    "--papers",
    type=Whole(1, 10**5),
    help="Make so many papers of each blueprint, and name questions that tell another's answer.",
)
@click.option(
    "--limit",
    type=Whole(1, 10**6),
    help=f"Seconds of CPU after which a template is given up. "
    f"[default: {ENOUGH:g}, and {ENOUGH_A_DRAW:g} for each draw]",
)
@click.option("--json", is_flag=True, help="Print problems as JSON, one a line, for editors.")
@click.option("--debug", is_flag=True, help="Show where in Python an error came from.")
@jobs_option
@bank_options
def lint(**options: Unpack[Options]) -> None:
    """Prove templates sound over many seeds; exit code 1 if a problem is found.

    FOLDER is a bank, as in --bank; several are examined one by one. A broken template does not
    stop the others.
    """
    folders = (options["folder"],) if options["folder"] else ()
    given: BankOptions = {
        "bank": (*folders, *options["bank"]),
        "trust": options["trust"],
        "trust_bank": options["trust_bank"],
    }
    whole = open_bank(given)
    only = [whole.home(name) for name in options["only"]]
    asked = {part: tuple(own for home, own in only if home is part) for part in whole.parts}
    found = [
        _linted(part, names or tuple(part.paths), options)
        for part, names in asked.items()
        if names or not only
    ]
    sys.exit(max(found))


def _linted(bank: Bank, names: tuple[str, ...], options: Options) -> int:
    """Examine a bank by itself, whatever others it is named with; 1 if a problem is found."""
    if options["papers"]:
        return _told(bank, options["papers"], options["jobs"])
    if options["teach"]:
        return _taught(bank, names, options)
    rows, broken = _proved(bank, names, options)
    broken = list({str(problem): problem for problem in broken}.values())
    if options["json"]:
        for problem in broken:
            click.echo(json.dumps(problem.as_json(), ensure_ascii=False))
    else:
        print_table(HEAD, rows)
        for problem in broken:
            click.echo(visible(str(problem)), err=True)
        _advise(bank)
    return int(bool(broken))


def _advise(bank: Bank) -> None:
    """Say where to begin with words of a language; without them they are English, no problem."""
    from quizgen.bank.folder import LOCALE
    from quizgen.locale import unspoken

    try:
        langs = unspoken(bank.languages)
    except QuizgenError:  # it is told of by itself
        return
    for lang in langs:
        file = bank.folder / LOCALE / lang / "interface.toml"
        click.echo(
            visible(
                f"advice: what quizgen says around questions in {lang!r} is English; "
                f"begin with {file} "
                f"(quizgen new language {lang} --bank {bank.root} --all writes it)"
            ),
            err=True,
        )


def _proved(
    bank: Bank, names: tuple[str, ...], options: Options
) -> tuple[list[tuple[str, ...]], list[Problem]]:
    """Rows of the table of templates, and all problems."""
    from quizgen.audit.located import told_problems

    limit, seeds, debug = _limit(options), options["seeds"], options["debug"]
    rows, broken, heard = [], _of_bank(bank, limit), list["Heard"]()
    examine = partial(_examined, bank, seeds=seeds, limit=limit, debug=debug)
    with (
        Progress("lint", len(names)) as progress,
        workers(_count(options, names)) as (executor, ahead),
    ):
        results = in_order(executor, examine, progress.over(names), ahead)
        for name, (row, problems, said) in zip(names, results, strict=True):
            rows.append((name, *row))
            broken += problems
            heard += said
    broken += told_problems(bank, heard)
    return rows, broken


def _of_bank(bank: Bank, limit: float) -> list[Problem]:
    """What is wrong with the files that belong to no template."""
    from quizgen.audit.limit import TooLong, limited
    from quizgen.audit.located import bank_problems, located

    found: list[Problem] = []
    try:
        with limited(limit):
            found += bank_problems(bank)
    except TooLong as error:
        found.append(located(bank, "", _said(bank, error)))
    return found


def problems_of(bank: Bank, name: str) -> list[str]:
    """What is wrong with a template, over a few draws, as an author sees it while writing."""
    return [str(problem) for problem in _examined(bank, name, FEW, ENOUGH)[1]]


def _taught(bank: Bank, names: tuple[str, ...], options: Options) -> int:
    """Print what stands between questions and teaching; 1 if there are errors."""
    rows: list[tuple[str, ...]] = []
    with (
        Progress("lint", len(names)) as progress,
        workers(_count(options, names)) as (executor, ahead),
    ):
        findings = partial(_findings, bank, options["seeds"], _limit(options))
        for found in in_order(executor, findings, progress.over(names), ahead):
            rows += found
    if rows:
        print_table(TEACH_HEAD, rows)
    errors = {row[0] for row in rows if row[2] == "error"}
    click.echo(f"{len(errors)} of {len(names)} templates with errors")
    return int(bool(errors))


def _findings(bank: Bank, seeds: int, limit: float, name: str) -> list[tuple[str, ...]]:
    """Rows of a template's table: what stands between it and teaching."""
    from quizgen.audit.limit import TooLong, limited
    from quizgen.audit.teach import examine

    try:
        with limited(limit):
            found = examine(bank.template(name), seeds)
    except (QuizgenError, TooLong) as error:
        return [(name, "", "error", _said(bank, error))]
    return [(one.template, one.label, one.level, one.what) for one in found]


def _told(bank: Bank, count: int, jobs: int | None) -> int:
    """Print which questions of a paper tell what another one asks; 1 if any does."""
    from quizgen.paper.blueprint import load_blueprint

    found: dict[str, list[int]] = {}
    processes = paying(jobs, count * len(bank.blueprints) * A_PAPER)
    with workers(processes) as (executor, ahead):
        for name in bank.blueprints:
            tells = partial(_tells, bank, load_blueprint(name, bank))
            with Progress(f"lint {name}", count) as progress:
                asked = map(int, progress.over(map(str, range(count))))
                for seed, saying in enumerate(in_order(executor, tells, asked, ahead)):
                    for said in saying:
                        found.setdefault(said, []).append(seed)
    for said, seeds in found.items():
        rate = f"({len(seeds)} of {count} papers, first seed {seeds[0]})"
        click.echo(visible(f"{said} {rate}"), err=True)
    papers = count * len(bank.blueprints)
    told = f"{len(found)} answers told" if found else "none tells an answer of its own"
    click.echo(f"{papers} papers of {', '.join(bank.blueprints) or 'no blueprint'}: {told}")
    return int(bool(found))


def _tells(bank: Bank, blueprint: Blueprint, seed: int) -> list[str]:
    """Which questions of a paper tell what another one asks."""
    from quizgen.audit.leaks import leaks
    from quizgen.paper.paper import build

    return [
        f"{one.teller}: tells the answer of {' '.join(filter(None, (one.asker, one.label)))}: "
        f"{one.what}"
        for one in leaks(build(bank, blueprint, seed, "both", figures=False))
    ]


def _count(options: Options, names: tuple[str, ...]) -> int:
    """How many processes examine templates."""
    return paying(options["jobs"], len(names) * (A_TEMPLATE + options["seeds"] * A_DRAW))


def _limit(options: Options) -> float:
    """Seconds after which a template is given up."""
    return options["limit"] or ENOUGH + options["seeds"] * ENOUGH_A_DRAW


def _examined(
    bank: Bank, name: str, seeds: int, limit: float, *, debug: bool = False
) -> tuple[tuple[str, ...], list[Problem], list[Heard]]:
    """Cells of a template's row, its problems, and what it says and asks."""
    from quizgen.audit.limit import TooLong, limited
    from quizgen.audit.located import located

    try:  # an author's Python may print, and not into our JSON
        with limited(limit), redirect_stdout(sys.stderr):
            report = _report(bank, name, seeds)
    except (Exception, TooLong) as error:
        if interrupted():
            raise KeyboardInterrupt from error
        if debug:
            traceback.print_exception(error)
        return NOTHING, [located(bank, name, _said(bank, error))], []
    problems = [located(bank, name, problem) for problem in report.problems]
    return _cells(report), problems, report.heard


def _report(bank: Bank, name: str, seeds: int) -> Report:
    """What was found for a template and for the formulas of its solver."""
    from quizgen.audit.lint import lint_template
    from quizgen.bank.formulas import missing_formulas, unnamed_formulas

    report = lint_template(bank.template(name), seeds, bank.languages)
    report.problems += [
        f"solver: formula {formula!r}, which templates/cards/formulas.toml lacks"
        for formula in missing_formulas(bank, name)
    ]
    report.problems += [
        f"solver: step {step!r} has the form of {', '.join(forms)} and names no formula"
        for step, forms in unnamed_formulas(bank, name).items()
    ]
    return report


def _said(bank: Bank, error: BaseException) -> str:
    """What stopped the examination: the place in the bank, else in quizgen, and the last line."""
    from quizgen.audit.limit import TooLong

    if isinstance(error, QuizgenError):
        return str(error)
    root = bank.root.resolve()
    frames = [
        (Path(frame.f_code.co_filename), line)
        for frame, line in traceback.walk_tb(error.__traceback__)
    ]
    own = [(file, line) for file, line in frames if file.resolve().is_relative_to(root)]
    if isinstance(error, TooLong):  # in whatever of quizgen it was just then
        place = [f"{bank.root / one.resolve().relative_to(root)}:{line}: " for one, line in own]
        return f"{''.join(place[-1:])}{error}"
    file, line = (own or frames)[-1]
    return f"{type(error).__name__}: {error} (in {file}:{line}; --debug shows the way there)"


def _cells(report: Report) -> tuple[str, ...]:
    ranges = ", ".join(f"{n} {a:.4g}..{b:.4g}" for n, (a, b) in report.ranges.items())
    per_draw = 1e3 * report.seconds / report.seeds if report.seeds else 0
    return (
        str(report.seeds),
        f"{1 - report.duplicates:.0%}",
        f"{report.acceptance:.1%}",
        f"{per_draw:.2f}",
        str(len(report.problems)),
        ranges,
    )
