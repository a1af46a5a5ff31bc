"""``quizgen tradeoff``: measure what accuracy costs in time and write one page about it."""

from __future__ import annotations

from pathlib import Path

import click

from quizgen.cli.terminal import Progress, many


@click.command()
@click.argument("family", required=False, metavar="[FAMILY]")
@click.option("--out", default="tradeoff", metavar="DIR", help="Folder to write to.")
@click.option("--quick", is_flag=True, help="Fewer inputs and no SymPy: a fraction of the time.")
@click.option(
    "--count",
    type=click.IntRange(1),
    metavar="N",
    help="Draw N questions to count wrong keys (10000: nothing is extrapolated).",
)
@click.option("--list", "only_list", is_flag=True, help="Name the families and stop.")
def tradeoff(
    family: str | None, out: str, *, quick: bool, count: int | None, only_list: bool
) -> None:
    """Show what accuracy costs in time: an HTML page, SVG and PNG plots, CSV and JSON.

    FAMILY limits the page to one solver, for example thin-lens.
    """
    from quizgen.errors import BankError
    from quizgen.tradeoff.families import BY_NAME

    if only_list:
        click.echo("\n".join(BY_NAME))
        return
    if family is not None and family not in BY_NAME:
        raise BankError(f"unknown family {family!r}; there are {', '.join(BY_NAME)}")
    from quizgen.tradeoff.page import write
    from quizgen.tradeoff.report import measure

    words = ["quizgen", "tradeoff", *([family] if family else []), *(["--quick"] if quick else []),
             *(["--count", str(count)] if count else [])]  # fmt: skip
    with Progress("measuring") as progress:
        report = measure(
            [family] if family else [], quick=quick, drawn=count or 0, progress=progress
        )
    write(report, Path(out), " ".join(words))
    page = Path(out) / "tradeoff.html"
    click.echo(f"{page}: {many(len(report.families), 'formula')}, {report.seconds:.1f} s")
