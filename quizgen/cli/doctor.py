"""``quizgen doctor``."""

from __future__ import annotations

import click

from quizgen.core.errors import QuizgenError


@click.command()
def doctor() -> None:
    """Check fonts, glyph coverage and versions."""
    from quizgen.lint.doctor import run_checks

    bad = False
    for name, outcome, fine in run_checks():
        click.echo(f"{'ok ' if fine else 'BAD'} {name}: {outcome}")
        bad = bad or not fine
    if bad:
        raise QuizgenError("doctor found something to mend (see above)")
