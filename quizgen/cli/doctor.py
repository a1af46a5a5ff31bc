"""``quizgen doctor``."""

from __future__ import annotations

import click

from quizgen.errors import QuizgenError


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
