"""``quizgen schema``."""

from __future__ import annotations

import click

from quizgen.bank.json_schema import SCHEMAS, build_json_schema


@click.command()
@click.argument("name", type=click.Choice(list(SCHEMAS)))
def schema(name: str) -> None:
    """Print the JSON Schema of template.toml or bank.toml, for editors."""
    click.echo(build_json_schema(name), nl=False)
