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

from quizgen.cli.options import (
    BankOptions,
    IntRangeParam,
    bank_options,
    jobs_option,
    open_bank,
    worthwhile_processes,
)
from quizgen.cli.terminal import ProgressLine, print_table, shorten_message, was_interrupted
from quizgen.core.errors import QuizgenError
from quizgen.core.executor import map_ordered, open_executor
from quizgen.core.untrusted import escape_control_characters
from quizgen.locale import FIRST
from quizgen.locale.explanations import (
    choose_explained_language,
    explain_diagnostic,
    explain_message,
    list_explained_languages,
)

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank
    from quizgen.core.diagnostics import Diagnostic
    from quizgen.lint.leaks import QuestionContent
    from quizgen.lint.template_checks import TemplateReport
    from quizgen.paper.blueprint import Blueprint

HEAD = ("template", "draws", "distinct", "kept", "ms/draw", "problems", "certain", "answers")
TEACH_HEAD = ("template", "part", "level", "code", "finding")
NOTHING = ("0", "", "", "", "1", "", "")
"""Cells of a template that could not be examined."""

A_TEMPLATE, A_DRAW, A_PAPER = 0.02, 0.0003, 0.1
"""Seconds that one takes to be examined, about: what is done once, and what with each draw."""
FEW = 20
"""Draws that are examined while an author waits."""
ENOUGH, ENOUGH_A_DRAW = 20.0, 0.05
"""Seconds after which a template is given up: many times what the slowest ones take."""


class LintOptions(BankOptions):
    """Options of ``quizgen lint``."""

    folder: Path | None
    seeds: int
    only: tuple[str, ...]
    teach: bool
    papers: int | None
    limit: int | None
    debug: bool
    json: bool
    lang: str | None
    jobs: int | None


@click.command()
@click.argument("folder", type=click.Path(path_type=Path), required=False)
@click.option("--seeds", type=IntRangeParam(1, 10**6), default=200, show_default=True,
              help="How many draws of each template to examine.")  # fmt: skip
@click.option("--only", multiple=True, help="Just this template (may be repeated).")
@click.option(
    "--teach",
    is_flag=True,
    help="Show only what stands between questions and teaching, with notes, and count pools.",
)
@click.option(
    "--papers",
    type=IntRangeParam(1, 10**5),
    help="Make so many papers of each blueprint, and name questions that tell another's answer.",
)
@click.option(
    "--limit",
    type=IntRangeParam(1, 10**6),
    help=f"Seconds of CPU after which a template is given up. "
    f"[default: {ENOUGH:g}, and {ENOUGH_A_DRAW:g} for each draw]",
)
@click.option("--json", is_flag=True, help="Print problems as JSON, one a line, for editors.")
@click.option("--lang", type=click.Choice(list_explained_languages()),
              help="Language of what is said. [default: that of the bank]")  # fmt: skip
@click.option("--debug", is_flag=True, help="Show where in Python an error came from.")
@jobs_option
@bank_options
def lint(**options: Unpack[LintOptions]) -> None:
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
    only = [whole.owner_of(name) for name in options["only"]]
    asked = {part: tuple(own for home, own in only if home is part) for part in whole.members}
    found = [
        _lint_bank(part, names or tuple(part.template_paths), options)
        for part, names in asked.items()
        if names or not only
    ]
    sys.exit(max(found))


def _lint_bank(bank: Bank, names: tuple[str, ...], options: LintOptions) -> int:
    """Check one bank, whatever others are named; return 1 if a problem is found."""
    if options["papers"]:
        return _print_leaks(bank, options["papers"], options["jobs"])
    if options["teach"]:
        return _print_teaching_findings(bank, names, options)
    rows, broken = _examine_templates(bank, names, options)
    broken = list({str(problem): problem for problem in broken}.values())
    lang = options["lang"] or _choose_language(bank)
    if options["json"]:
        for problem in broken:
            said = explain_diagnostic(problem, lang)
            click.echo(json.dumps(said.as_json(), ensure_ascii=False))
    else:
        print_table(HEAD, rows)
        for problem in broken:
            said = explain_diagnostic(problem, lang)
            click.echo(shorten_message(str(said)), err=True)
        _advise_on_words(bank)
    return int(bool(broken))


def _advise_on_words(bank: Bank) -> None:
    """Print where to translate the interface of a language that has no words yet."""
    from quizgen.bank.bank import LOCALE
    from quizgen.locale import untranslated_languages

    try:
        langs = untranslated_languages(bank.languages)
    except QuizgenError:  # it is told of by itself
        return
    for lang in langs:
        file = bank.folder / LOCALE / lang / "interface.toml"
        click.echo(
            escape_control_characters(
                f"advice: what quizgen says around questions in {lang!r} is English; "
                f"begin with {file} "
                f"(quizgen new language {lang} --bank {bank.root} --all writes it)"
            ),
            err=True,
        )


def _examine_templates(
    bank: Bank, names: tuple[str, ...], options: LintOptions
) -> tuple[list[tuple[str, ...]], list[Diagnostic]]:
    """Return the rows of the table of templates, and all problems of the bank."""
    from quizgen.lint.bank_checks import check_leaks

    limit, seeds, debug = _compute_time_limit(options), options["seeds"], options["debug"]
    rows, heard = [], list["QuestionContent"]()
    broken = _check_bank(bank, limit, whole=len(names) == len(bank.template_paths))
    examine = partial(_examine_template, bank, seeds=seeds, limit=limit, debug=debug)
    with (
        ProgressLine("lint", len(names)) as progress,
        open_executor(_count_processes(options, names)) as (executor, ahead),
    ):
        results = map_ordered(executor, examine, progress.over(names), ahead)
        for name, (row, problems, said) in zip(names, results, strict=True):
            rows.append((name, *row))
            broken += problems
            heard += said
    broken += check_leaks(bank, heard)
    return rows, broken


def _check_bank(bank: Bank, limit: float, *, whole: bool) -> list[Diagnostic]:
    """Return what is wrong with the files of no template; with ``whole`` also the sheet."""
    from quizgen.cards.checks import check_cards
    from quizgen.cli.lint_outputs import check_sheet
    from quizgen.lint.bank_checks import check_bank_files
    from quizgen.lint.cpu_limit import CpuLimitExceeded, cpu_limit

    found: list[Diagnostic] = []
    try:
        with cpu_limit(limit):
            found += check_bank_files(bank)
            found += check_cards(bank)
            found += check_sheet(bank) if whole and not found else ()
    except (QuizgenError, CpuLimitExceeded) as error:
        found.append(_diagnose_crash(bank, bank.folder / "bank.toml", error))
    return found


def _choose_language(bank: Bank) -> str:
    """Return the language that the authors of a bank are told in."""
    try:
        return choose_explained_language(bank.languages)
    except QuizgenError:  # it is told of by itself
        return FIRST


def lint_while_writing(bank: Bank, name: str) -> list[str]:
    """Return the messages on a template, over few draws: quick enough while writing."""
    lang = _choose_language(bank)
    found = _examine_template(bank, name, FEW, ENOUGH)[1]
    return [str(explain_diagnostic(problem, lang)) for problem in found]


def _print_teaching_findings(bank: Bank, names: tuple[str, ...], options: LintOptions) -> int:
    """Print what keeps templates from testing well; return 1 if there are errors."""
    rows: list[tuple[str, ...]] = []
    with (
        ProgressLine("lint", len(names)) as progress,
        open_executor(_count_processes(options, names)) as (executor, ahead),
    ):
        lang = options["lang"] or _choose_language(bank)
        limit = _compute_time_limit(options)
        findings = partial(_build_teaching_rows, bank, options["seeds"], limit, lang)
        for found in map_ordered(executor, findings, progress.over(names), ahead):
            rows += found
    if rows:
        print_table(TEACH_HEAD, rows)
    errors = {row[0] for row in rows if row[2] == "error"}
    click.echo(f"{len(errors)} of {len(names)} templates with errors")
    return int(bool(errors))


def _build_teaching_rows(
    bank: Bank, seeds: int, limit: float, lang: str, name: str
) -> list[tuple[str, ...]]:
    """Return the rows of a template's findings on quality."""
    from quizgen.lint.cpu_limit import CpuLimitExceeded, cpu_limit
    from quizgen.lint.item_quality import review_template

    try:
        with cpu_limit(limit):
            found = review_template(bank.template(name), seeds)
    except (QuizgenError, CpuLimitExceeded) as error:
        stopped = _diagnose_crash(bank, bank.template_paths[name] / "template.toml", error)
        said = explain_message(stopped.code, stopped.message, lang)
        return [(name, "", "error", stopped.code, f"{stopped.file}: {said}")]
    return [
        (one.template, one.label, one.level, one.code, explain_message(one.code, one.what, lang))
        for one in found
    ]


def _print_leaks(bank: Bank, count: int, jobs: int | None) -> int:
    """Print which questions of papers give away others; return 1 if any does."""
    from quizgen.paper.blueprint import load_blueprint

    found: dict[str, list[int]] = {}
    processes = worthwhile_processes(jobs, count * len(bank.blueprints) * A_PAPER)
    with open_executor(processes) as (executor, ahead):
        for name in bank.blueprints:
            tells = partial(_describe_leaks, bank, load_blueprint(name, bank))
            with ProgressLine(f"lint {name}", count) as progress:
                asked = map(int, progress.over(map(str, range(count))))
                for seed, saying in enumerate(map_ordered(executor, tells, asked, ahead)):
                    for said in saying:
                        found.setdefault(said, []).append(seed)
    for said, seeds in found.items():
        rate = f"({len(seeds)} of {count} papers, first seed {seeds[0]})"
        click.echo(escape_control_characters(f"{said} {rate}"), err=True)
    papers = count * len(bank.blueprints)
    told = f"{len(found)} answers told" if found else "none tells an answer of its own"
    click.echo(f"{papers} papers of {', '.join(bank.blueprints) or 'no blueprint'}: {told}")
    return int(bool(found))


def _describe_leaks(bank: Bank, blueprint: Blueprint, seed: int) -> list[str]:
    """Return a line for each leak in the paper of one seed."""
    from quizgen.lint.leaks import find_paper_leaks
    from quizgen.paper.paper import build_paper

    return [
        f"{one.teller}: tells the answer of {' '.join(filter(None, (one.asker, one.label)))}: "
        f"{one.what}"
        for one in find_paper_leaks(build_paper(bank, blueprint, seed, "both", figures=False))
    ]


def _count_processes(options: LintOptions, names: tuple[str, ...]) -> int:
    """Return how many processes to check templates with."""
    return worthwhile_processes(
        options["jobs"], len(names) * (A_TEMPLATE + options["seeds"] * A_DRAW)
    )


def _compute_time_limit(options: LintOptions) -> float:
    """Return the seconds of processor time after which a template is given up."""
    return options["limit"] or ENOUGH + options["seeds"] * ENOUGH_A_DRAW


def _examine_template(
    bank: Bank, name: str, seeds: int, limit: float, *, debug: bool = False
) -> tuple[tuple[str, ...], list[Diagnostic], list[QuestionContent]]:
    """Return a template's table row, its problems, and what its questions print and ask."""
    from quizgen.lint.cpu_limit import CpuLimitExceeded, cpu_limit

    try:  # an author's Python may print, and not into our JSON
        with cpu_limit(limit), redirect_stdout(sys.stderr):
            report = _build_template_report(bank, name, seeds)
    except (Exception, CpuLimitExceeded) as error:
        if was_interrupted():
            raise KeyboardInterrupt from error
        if debug:
            traceback.print_exception(error)
        return (
            NOTHING,
            [_diagnose_crash(bank, bank.template_paths[name] / "template.toml", error)],
            [],
        )
    return _format_report_cells(report), report.problems, report.heard


def _build_template_report(bank: Bank, name: str, seeds: int) -> TemplateReport:
    """Return what was found for a template and the formulas of its solver."""
    from quizgen.bank.formulas import find_missing_formulas, find_unnamed_formulas
    from quizgen.cli.lint_outputs import check_outputs
    from quizgen.core.diagnostics import can_be_ignored, diagnose
    from quizgen.lint.template_checks import lint_template

    template = bank.template(name)
    report = lint_template(template, seeds, bank.languages)
    file = template.solver_file or template.file
    found = [
        diagnose(
            "QG216",
            file,
            f"formula {formula!r}, which templates/cards/formulas.toml lacks",
            ("formulas", formula),
        )
        for formula in find_missing_formulas(bank, name)
    ]
    found += [
        diagnose(
            "QG217",
            file,
            f"step {step!r} has the form of {', '.join(forms)} and names no formula",
            ("Step", step),
        )
        for step, forms in find_unnamed_formulas(bank, name).items()
    ]
    report.problems += [one for one in found if one.code not in template.rules.ignore]
    # What cannot be drawn or has no words fails in every output; once is enough.
    if report.seeds and all(can_be_ignored(one.code) for one in report.problems):
        report.problems += check_outputs(bank, template)
    return report


def _diagnose_crash(bank: Bank, file: Path, error: BaseException) -> Diagnostic:
    """Return a diagnostic of an unexpected error, at its place in the bank if it has one."""
    from quizgen.core.diagnostics import diagnose
    from quizgen.lint.cpu_limit import CpuLimitExceeded

    if isinstance(error, QuizgenError):
        return error.diagnostic(file)
    root = bank.root.resolve()
    frames = [
        (Path(frame.f_code.co_filename), line)
        for frame, line in traceback.walk_tb(error.__traceback__)
    ]
    own = [(one, line) for one, line in frames if one.resolve().is_relative_to(root)]
    if isinstance(error, CpuLimitExceeded):  # in whatever of quizgen it was just then
        place, line = own[-1] if own else (file, 0)
        place = bank.root / place.resolve().relative_to(root) if own else file
        return diagnose("QG602", place, str(error), line=line)
    at, line = (own or frames)[-1]
    what = f"{type(error).__name__}: {error} (in {at}:{line}; --debug shows the way there)"
    return diagnose("QG603", file, what)


def _format_report_cells(report: TemplateReport) -> tuple[str, ...]:
    """Return the cells of a template's row."""
    ranges = ", ".join(f"{n} {a:.4g}..{b:.4g}" for n, (a, b) in report.ranges.items())
    per_draw = 1e3 * report.seconds / report.seeds if report.seeds else 0
    return (
        str(report.seeds),
        f"{1 - report.duplicates:.0%}",
        f"{report.acceptance:.1%}",
        f"{per_draw:.2f}",
        str(len(report.problems)),
        report.certainty,
        ranges,
    )
