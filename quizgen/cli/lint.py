"""``quizgen lint``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import BankOptions, bank_options, open_bank
from quizgen.errors import BankError

if TYPE_CHECKING:
    from quizgen.audit.lint import Report
    from quizgen.bank.folder import Bank


@click.command()
@click.argument("folder", type=click.Path(path_type=Path), required=False)
@click.option("--seeds", type=click.IntRange(1, 10**6), default=200, show_default=True)
@click.option("--only", multiple=True, help="Just this template (may be repeated).")
@bank_options
def lint(
    folder: Path | None, seeds: int, only: tuple[str, ...], **options: Unpack[BankOptions]
) -> None:
    """Prove templates sound over many seeds; exit code 1 if a problem is found."""
    from rich.console import Console
    from rich.table import Table

    bank = open_bank({"bank": folder or options["bank"], "trust": options["trust"]})
    table = Table("template", "draws", "distinct", "kept", "ms/draw", "answers", "problems")
    broken: list[str] = []
    for name in only or bank.paths:
        row, problems = _examined(bank, name, seeds)
        table.add_row(name, *row)
        broken += problems
    Console().print(table)
    for problem in broken:
        click.echo(problem, err=True)
    if broken:
        sys.exit(1)


def _examined(bank: Bank, name: str, seeds: int) -> tuple[tuple[str, ...], list[str]]:
    """Cells of a template's row, and its problems."""
    from quizgen.audit.lint import lint_template

    try:
        report = lint_template(bank.template(name), seeds, bank.languages)
    except BankError as error:
        return ("0", "", "", "", "", "1"), [str(error)]
    return _cells(report), [f"{name}: {problem}" for problem in report.problems]


def _cells(report: Report) -> tuple[str, ...]:
    ranges = ", ".join(f"{n} {a:.4g}..{b:.4g}" for n, (a, b) in report.ranges.items())
    per_draw = 1e3 * report.seconds / report.seeds if report.seeds else 0
    return (
        str(report.seeds),
        f"{1 - report.duplicates:.0%}",
        f"{report.acceptance:.1%}",
        f"{per_draw:.2f}",
        ranges,
        str(len(report.problems)),
    )
