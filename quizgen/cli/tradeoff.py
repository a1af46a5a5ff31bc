"""``quizgen tradeoff``: measure what accuracy costs and write one page about it."""

from __future__ import annotations

from pathlib import Path

import click


@click.command()
@click.option("--out", default="tradeoff", metavar="DIR", help="Folder to write to.")
def tradeoff(out: str) -> None:
    """Show what accuracy costs: an HTML page, its plot as SVG, and all numbers as JSON."""
    from quizgen.bank.bank import builtin_bank
    from quizgen.tradeoff.page import write_page
    from quizgen.tradeoff.report import measure_tradeoff

    report = measure_tradeoff(builtin_bank())
    write_page(report, Path(out), "quizgen tradeoff")
    click.echo(f"{Path(out) / 'tradeoff.html'}: {report.seconds:.1f} s")
