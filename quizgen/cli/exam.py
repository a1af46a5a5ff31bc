"""``quizgen exam``."""

from __future__ import annotations

import secrets
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen import render
from quizgen.cli.options import SEED, BankOptions, bank_options, checked, open_bank, split
from quizgen.errors import CodeError
from quizgen.locale import FIRST, choices

if TYPE_CHECKING:
    from quizgen.bank.folder import Bank
    from quizgen.paper.blueprint import Blueprint
    from quizgen.paper.paper import Paper

KEY, FORM = "key.json", "answers.toml"


class Options(BankOptions):
    """Which paper, and where to."""

    seed: int | None
    code: str | None
    blueprint: str
    topic: str | None
    minutes: int | None
    lang: str | None
    formats: str
    out: Path
    reference: bool


@click.command()
@click.option("--seed", type=SEED, help="Number that fixes every draw.")
@click.option("--code", help="Code of a paper: builds exactly that paper again.")
@click.option("--blueprint", default="mock", show_default=True, help="mock, trial or a TOML file.")
@click.option("--topic", help="Questions of one topic (or all), instead of a blueprint.")
@click.option(
    "--minutes", type=click.IntRange(3, 9999), help="As many questions as this time allows."
)
@click.option("--lang", type=click.Choice(choices()), help=f"Language. [default: {FIRST}]")
@click.option(
    "--format", "formats", default="html,pdf", show_default=True,
    help=f"Outputs, by comma: {', '.join(render.RENDERERS)}.",
)  # fmt: skip
@click.option("--out", type=click.Path(path_type=Path), default=Path("exam"), show_default=True,
              help="Folder to write to.")  # fmt: skip
@click.option("--reference", is_flag=True, help="The questions with the numbers of the notes.")
@bank_options
def exam(**options: Unpack[Options]) -> None:
    """Make a mock exam with worked solutions, answer key and a blank answer form."""
    from quizgen.files import write_all
    from quizgen.paper.form import form_bytes, holds_answers
    from quizgen.paper.key import key_bytes

    formats = [checked("--format", name, render.RENDERERS) for name in split(options["formats"])]
    paper = _paper(options)
    contents = dict(_rendered(paper, formats))
    contents[KEY] = key_bytes(paper)
    folder = options["out"]
    kept = holds_answers(folder / FORM)
    if not kept:
        contents[FORM] = form_bytes(paper)
    write_all(folder, contents)
    _report(folder, paper, contents, kept=kept)


def _paper(options: Options) -> Paper:
    from quizgen.paper.paper import build, rebuild, reference_paper

    bank = open_bank(options)
    blueprint = _blueprint(options, bank)
    if options["code"]:
        if options["seed"] is not None or options["lang"]:
            raise CodeError("--code already fixes seed and language; leave --seed and --lang out")
        given = blueprint if Path(options["blueprint"]).suffix else None
        return rebuild(bank, options["code"], given, progress=_tell)
    lang = options["lang"] or FIRST
    if options["reference"]:
        return reference_paper(bank, blueprint, lang)
    seed = secrets.randbelow(10**6) if options["seed"] is None else options["seed"]
    return build(bank, blueprint, seed, lang, progress=_tell)


def _blueprint(options: Options, bank: Bank) -> Blueprint:
    from quizgen.paper.blueprint import EVERYTHING, load_blueprint, of_topic, topics

    topic, minutes = options["topic"], options["minutes"]
    if topic is None and minutes is None:
        return load_blueprint(options["blueprint"], bank)
    if topic is not None:
        checked("--topic", topic, topics(bank))
    return of_topic(bank, topic or EVERYTHING, minutes or 0)


def _tell(name: str) -> None:
    """Progress: one mark per question, on the error stream so that output stays clean."""
    click.echo(f" {name}", nl=False, err=True)


def _rendered(paper: Paper, formats: list[str]) -> Iterator[tuple[str, bytes]]:
    click.echo("", err=True)
    for output in formats:
        for kind in render.KINDS:
            name = f"{kind}.{output}"
            _tell(name)
            yield name, render.render_paper(paper, kind, output)
    click.echo("", err=True)


def _report(folder: Path, paper: Paper, written: Collection[str], *, kept: bool) -> None:
    for name in sorted(written):
        click.echo(f"  {folder / name}")
    if kept:
        click.echo(f"  {folder / FORM} holds answers and was left as it is")
    count = f"{len(paper.items)} question{'s' if len(paper.items) != 1 else ''}"
    click.echo(f"{count}, {float(paper.points):g} points, {paper.minutes} min")
    if paper.variety:
        click.echo(f"One of {paper.variety_text} papers that this blueprint can make")
    click.echo(f"Code: {paper.code}   (quizgen exam --code {paper.code} makes this paper again)")
    click.echo(f"Next: fill in {folder / FORM}, then: quizgen check {folder / KEY} {folder / FORM}")
