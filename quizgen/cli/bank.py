"""``quizgen templates``, ``preview``, ``lint`` and ``doctor``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from quizgen.cli.options import bank_options, open_bank
from quizgen.errors import BankError, QuizgenError


@click.command()
@click.option("--coverage", is_flag=True, help="What of the curriculum is covered, with holes.")
@bank_options
def templates(*, coverage: bool, **options: Any) -> None:
    """List the templates of the bank: id, tier, topic, pool size, languages."""
    from rich.console import Console
    from rich.table import Table

    bank = open_bank(options)
    if coverage:
        _print_coverage(bank)
        return
    table = Table("id", "tier", "topic", "pool", "languages", "title")
    for template in bank:
        rules = template.rules
        pool = f"{rules.pool:,}".replace(",", " ") if rules.pool else "-"
        title = next(iter(template.texts.values())).title if template.texts else ""
        table.add_row(
            template.id, rules.tier, rules.topic, pool, " ".join(template.languages), title
        )
    Console().print(table)
    click.echo(f"{len(bank)} templates")


def _print_coverage(bank: Any) -> None:
    from rich.console import Console
    from rich.table import Table

    from quizgen.audit.coverage import coverage

    table = Table("group", "covered", "of", "holes")
    for row in coverage(bank):
        table.add_row(row.group, str(len(row.covered)), str(row.total), " ".join(row.holes))
    Console().print(table)


@click.command()
@click.argument("name")
@click.option("--seed", type=click.IntRange(0, 10**9), default=0, show_default=True)
@click.option("--reference", is_flag=True, help="The numbers printed in the notes.")
@click.option("--lang", type=click.Choice(["en", "bn"]), default="en", show_default=True)
@click.option("--html", type=click.Path(path_type=Path), help="Write a page to look at instead.")
@bank_options
def preview(name: str, **options: Any) -> None:
    """Show one question with its key and worked solution."""
    from quizgen.paper.paper import single
    from quizgen.render.text import question_text

    template = open_bank(options).template(name)
    seed = "reference" if options["reference"] else options["seed"]
    paper = single(template, seed, options["lang"], figures=options["html"] is not None)
    if options["html"] is None:
        click.echo(question_text(paper.items[0]))
        return
    from quizgen.files import write_all
    from quizgen.render import render

    page: Path = options["html"]
    write_all(page.parent, {page.name: render(paper, "solutions", "html")})
    click.echo(str(page))


@click.command()
@click.argument("folder", type=click.Path(path_type=Path), required=False)
@click.option("--seeds", type=click.IntRange(1, 10**6), default=200, show_default=True)
@click.option("--only", multiple=True, help="Just this template (may be repeated).")
@bank_options
def lint(folder: Path | None, seeds: int, only: tuple[str, ...], **options: Any) -> None:
    """Prove templates sound over many seeds; exit code 1 if a problem is found."""
    from rich.console import Console
    from rich.table import Table

    from quizgen.audit.lint import lint as examine

    if folder is not None:
        options["bank"] = folder
    bank = open_bank(options)
    table = Table("template", "draws", "distinct", "kept", "ms/draw", "answers", "problems")
    broken: list[str] = []
    for name in only or bank.paths:
        try:
            report = examine(bank.template(name), seeds)
        except BankError as error:
            broken.append(str(error))
            table.add_row(name, "0", "", "", "", "", "1")
            continue
        ranges = ", ".join(f"{n} {a:.4g}..{b:.4g}" for n, (a, b) in report.ranges.items())
        per_draw = 1e3 * report.seconds / report.seeds if report.seeds else 0
        table.add_row(
            name, str(report.seeds), f"{1 - report.duplicates:.0%}", f"{report.acceptance:.1%}",
            f"{per_draw:.2f}", ranges, str(len(report.problems)),
        )  # fmt: skip
        broken += [f"{name}: {problem}" for problem in report.problems]
    Console().print(table)
    for problem in broken:
        click.echo(problem, err=True)
    if broken:
        sys.exit(1)


@click.command()
def doctor() -> None:
    """Check fonts, glyph coverage and versions."""
    from quizgen.audit.doctor import checks

    bad = False
    for name, outcome, fine in checks():
        click.echo(f"{'ok ' if fine else 'BAD'} {name}: {outcome}")
        bad = bad or not fine
    if bad:
        raise QuizgenError("doctor found something to mend (see above)")
