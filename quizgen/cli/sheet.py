"""``quizgen sheet``."""

from __future__ import annotations

from pathlib import Path
from typing import Unpack

import click

from quizgen.cli.options import (
    LANGUAGE_HELP,
    BankOptions,
    LanguageParam,
    bank_options,
    match_choice,
    open_sound_bank,
    resolve_topic,
    split_names,
)
from quizgen.cli.terminal import format_count
from quizgen.locale import default_language
from quizgen.render import SHEET_FORMATS

NAME = "formulas"


class SheetOptions(BankOptions):
    """Options of ``quizgen sheet``."""

    lang: str | None
    topics: str | None
    formats: str
    out: Path


@click.command()
@click.option("--lang", type=LanguageParam(both=True), help=LANGUAGE_HELP)
@click.option("--topic", "topics", help="Only these topics, by comma.")
@click.option("--format", "formats", default=",".join(SHEET_FORMATS), show_default=True,
              help="html (with all remarks), pdf (to print); by comma.")  # fmt: skip
@click.option("--out", type=click.Path(path_type=Path), default=Path("sheet"), show_default=True,
              help="Folder to write to.")  # fmt: skip
@bank_options
def sheet(**options: Unpack[SheetOptions]) -> None:
    """Write the formulas of the chapter, by topic, on a sheet to print and a page to read."""
    from quizgen.core.files import write_all
    from quizgen.question.formula_sheet import compose_sheet
    from quizgen.render import render_sheet

    formats = [
        match_choice("--format", name, SHEET_FORMATS) for name in split_names(options["formats"])
    ]
    if not formats:
        raise click.BadParameter(
            f"no format (allowed: {', '.join(SHEET_FORMATS)})", param_hint="--format"
        )
    bank = open_sound_bank(options)
    topics = [resolve_topic(bank, name) for name in split_names(options["topics"])]
    made = compose_sheet(bank, options["lang"] or default_language(bank.languages), topics)
    folder = options["out"]
    for path in write_all(folder, {f"{NAME}.{f}": render_sheet(made, f) for f in formats}):
        click.echo(f"  {path}")
    count, topics_there = sum(len(group.lines) for group in made.groups), len(made.groups)
    click.echo(f"{format_count(count, 'formula')} in {format_count(topics_there, 'topic')}")
