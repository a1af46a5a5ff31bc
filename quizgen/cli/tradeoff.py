"""``quizgen tradeoff``: measure what accuracy costs and write one page about it."""

from __future__ import annotations

from pathlib import Path

import click


@click.command()
@click.option("--out", default="tradeoff", metavar="DIR", help="Folder to write to.")
def tradeoff(out: str) -> None:
    """Show what accuracy costs: an HTML page, its plot as SVG, and all numbers as JSON."""
    from quizgen.bank.folder import builtin
    from quizgen.tradeoff.page import write
    from quizgen.tradeoff.report import measure

    report = measure(builtin())
    write(report, Path(out), "quizgen tradeoff")
    click.echo(f"{Path(out) / 'tradeoff.html'}: {report.seconds:.1f} s")
