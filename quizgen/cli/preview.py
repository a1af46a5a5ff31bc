"""``quizgen preview``."""

from __future__ import annotations

from pathlib import Path
from typing import Unpack

import click

from quizgen.cli.options import (
    SEED,
    BankOptions,
    bank_options,
    language_option,
    level_option,
    open_bank,
)
from quizgen.locale import default_language


class PreviewOptions(BankOptions):
    """Options of ``quizgen preview``."""

    seed: int
    reference: bool
    quiz: bool
    lang: str | None
    level: str
    html: Path | None


@click.command()
@click.argument("name")
@click.option("--seed", type=SEED, default=0, show_default=True, help="Number that fixes the draw.")
@click.option("--reference", is_flag=True, help="The numbers printed in the notes.")
@click.option("--quiz", is_flag=True, help="The question alone, as a learner sees it.")
@language_option
@level_option
@click.option("--html", type=click.Path(path_type=Path), help="Write a page of it instead.")
@bank_options
def preview(name: str, **options: Unpack[PreviewOptions]) -> None:
    """Show one question, with its key and worked solution unless --quiz is given."""
    from quizgen.paper.code import REFERENCE
    from quizgen.paper.paper import single_question_paper
    from quizgen.render.text import format_question

    bank = open_bank(options)
    template, lang = bank.template(name), options["lang"] or default_language(bank.languages)
    seed = REFERENCE if options["reference"] else options["seed"]
    page = options["html"]
    paper = single_question_paper(
        template, seed, lang, level=options["level"], figures=page is not None
    )
    if page is None:
        click.echo(format_question(paper.items[0], solved=not options["quiz"]))
        return
    from quizgen.core.files import write_all
    from quizgen.render import render_paper

    kind = "exam" if options["quiz"] else "solutions"
    write_all(page.parent, {page.name: render_paper(paper, kind, "html")})
    click.echo(str(page))
