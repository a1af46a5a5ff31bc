"""``quizgen exam``."""

from __future__ import annotations

import secrets
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen import render
from quizgen.cli.command import command
from quizgen.cli.options import SEED, BankOptions, bank_options, checked, open_bank, split
from quizgen.cli.terminal import visible
from quizgen.errors import ChoiceError, CodeError, RenderError
from quizgen.locale import FIRST, choices

if TYPE_CHECKING:
    from quizgen.bank.folder import Bank
    from quizgen.paper.blueprint import Blueprint
    from quizgen.paper.paper import Paper

KEY, FORM = "key.json", "answers.toml"
HOME = Path("exam")
"""Holds a folder for each paper, named by its code."""
USUAL = "mock"
"""The blueprint of who asks for none."""


class Options(BankOptions):
    """Which paper, and where to."""

    seed: int | None
    code: str | None
    blueprint: str | None
    topic: str | None
    minutes: int | None
    lang: str | None
    formats: str
    out: Path | None
    reference: bool


@click.command()
@click.option("--seed", type=SEED, help="Number that fixes every draw.")
@click.option("--code", help="Code of a paper: builds exactly that paper again.")
@click.option("--blueprint", help=f"mock, trial or a TOML file. [default: {USUAL}]")
@click.option("--topic", help="Questions of one topic (or all), instead of a blueprint.")
@click.option(
    "--minutes", type=click.IntRange(3, 9999), help="As many questions as this time allows."
)
@click.option("--lang", type=click.Choice(choices()), help=f"Language. [default: {FIRST}]")
@click.option(
    "--format", "formats", default="html,pdf", show_default=True,
    help=f"Outputs, by comma: {', '.join(render.RENDERERS)}.",
)  # fmt: skip
@click.option("--out", type=click.Path(path_type=Path),
              help=f"Folder to write to. [default: {HOME}/CODE]")  # fmt: skip
@click.option("--reference", is_flag=True, help="The questions with the numbers of the notes.")
@bank_options
def exam(**options: Unpack[Options]) -> None:
    """Make a mock exam with worked solutions, answer key and a blank answer form."""
    from quizgen.files import write_all
    from quizgen.paper.form import form_bytes
    from quizgen.paper.key import key_bytes

    formats = [checked("--format", name, render.RENDERERS) for name in split(options["formats"])]
    paper = _paper(options)
    folder = options["out"] or HOME / paper.code
    kept = _filled_in(folder, paper)
    contents = dict(_rendered(paper, formats))
    if not kept:
        contents[FORM] = form_bytes(paper)
    contents[KEY] = key_bytes(paper)
    write_all(folder, contents)
    _report(folder, paper, contents, options, kept=kept)


def _filled_in(folder: Path, paper: Paper) -> bool:
    """Whether the folder has a form with answers to this very paper.

    Raises
    ------
    RenderError
        If it has one with answers to another, which would be separated from its key.
    """
    from quizgen.paper.form import code_of_answers, holds_answers

    for path in sorted(path for path in folder.glob("*") if path.suffix in {".toml", ".json"}):
        code = code_of_answers(path)
        unclear = path.name == FORM and not code and holds_answers(path)
        if unclear or code not in {"", paper.code}:
            what = f"holds answers to {visible(code)}" if code else "may hold answers"
            raise RenderError(f"{path} {what}; nothing was written. Name another folder with --out")
    return holds_answers(folder / FORM)


def _paper(options: Options) -> Paper:
    from quizgen.paper.paper import build, rebuild, reference_paper

    bank = open_bank(options)
    if options["code"]:
        if options["seed"] is not None or options["lang"]:
            raise CodeError("--code already fixes seed and language; leave --seed and --lang out")
        if options["topic"] is not None or options["minutes"] is not None:
            raise CodeError("--code already fixes the questions; leave --topic and --minutes out")
        given = _blueprint(options, bank) if options["blueprint"] else None
        return rebuild(bank, options["code"], given, progress=_tell)
    blueprint = _blueprint(options, bank)
    lang = options["lang"] or FIRST
    if options["reference"]:
        return reference_paper(bank, blueprint, lang)
    seed = secrets.randbelow(10**6) if options["seed"] is None else options["seed"]
    return build(bank, blueprint, seed, lang, progress=_tell)


def _blueprint(options: Options, bank: Bank) -> Blueprint:
    from quizgen.paper.blueprint import EVERYTHING, load_blueprint, of_topic, topics

    topic, minutes = options["topic"], options["minutes"]
    if topic is None and minutes is None:
        return load_blueprint(options["blueprint"] or USUAL, bank)
    if options["blueprint"]:
        raise ChoiceError("--blueprint names the questions; leave --topic and --minutes out")
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


def _report(
    folder: Path, paper: Paper, written: Collection[str], options: Options, *, kept: bool
) -> None:
    for name in sorted(written):
        click.echo(f"  {folder / name}")
    if kept:
        click.echo(f"  {folder / FORM} holds answers and was left as it is")
    count = f"{len(paper.items)} question{'s' if len(paper.items) != 1 else ''}"
    click.echo(f"{count}, {float(paper.points):g} points, {paper.minutes} min")
    if paper.variety:
        click.echo(f"One of {paper.variety_text} papers that this blueprint can make")
    again = command("exam", "--code", paper.code, *_again(options))
    check = command("check", folder / KEY, folder / FORM)
    click.echo(f"Code: {paper.code}")
    click.echo(f"The same paper again: {again}")
    click.echo(f"Next: fill in {folder / FORM}, then: {check}")
    if "exam.html" in written:
        page = command("check", folder / KEY, folder / "answers.json")
        click.echo(f"  or fill in {folder / 'exam.html'}, save answers.json there, then: {page}")


def _again(options: Options) -> list[str]:
    """Options without which a code does not lead to the same paper."""
    words: list[str] = []
    if options["blueprint"] and Path(options["blueprint"]).exists():
        words += ["--blueprint", options["blueprint"]]
    if options["bank"]:
        words += ["--bank", str(options["bank"])]
    return words + ["--trust"] * options["trust"]
