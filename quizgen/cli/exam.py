"""``quizgen exam``."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Collection, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen import render
from quizgen.bank.clashes import BETWEEN
from quizgen.bank.levels import CHOICES, EXAM
from quizgen.cli.command import command
from quizgen.cli.options import (
    LANGUAGE_HELP,
    LEVEL_HELP,
    SEED,
    BankOptions,
    Tongue,
    Whole,
    bank_options,
    checked,
    jobs_option,
    open_bank,
    paying,
    split,
)
from quizgen.cli.terminal import Progress, many
from quizgen.errors import ChoiceError, CodeError, RenderError
from quizgen.locale import leading
from quizgen.outside import visible
from quizgen.paper.code import LARGEST_SEED
from quizgen.paper.form import FORMS

if TYPE_CHECKING:
    from quizgen.bank.folder import Bank
    from quizgen.paper.banks import UsedBank
    from quizgen.paper.blueprint import Blueprint
    from quizgen.paper.paper import Paper

KEY = "key.json"
HOME = Path("exam")
"""Holds a folder for each paper, named by its code."""
SUFFIXES = (".toml", ".csv", ".json")
NAMES = tuple(f"answers{suffix}" for suffix in SUFFIXES)
"""Forms in a paper's folder."""
A_PAPER = 0.5
"""Seconds that one of many takes, about."""
TO_SPARE = 12
"""Minutes that may be left over because no question is short enough."""
PRETENDED = 5
"""Documents after each of many papers, so that what was typeset is soon forgotten."""


class Options(BankOptions):
    """Which paper, and where to."""

    seed: int | None
    code: str | None
    blueprint: str | None
    topic: str | None
    minutes: int | None
    lang: str | None
    level: str | None
    formats: str
    form: str
    count: int
    jobs: int | None
    out: Path | None
    reference: bool


@click.command()
@click.option("--seed", type=SEED, help="Number that fixes every draw.")
@click.option("--code", help="Code of a paper: builds exactly that paper again.")
@click.option("--blueprint", help="mock, trial or a TOML file. [default: mock, else all.90]")
@click.option("--topic", help="Questions of one topic (or all), instead of a blueprint.")
@click.option("--minutes", type=Whole(3, 9999), help="As many questions as this time allows.")
@click.option(
    "--lang",
    type=Tongue(both=True),
    help=LANGUAGE_HELP,
)
@click.option(
    "--level",
    type=click.Choice(CHOICES, case_sensitive=False),
    help=f"{LEVEL_HELP} [default: {EXAM}]",
)
@click.option(
    "--format", "formats", default="html,pdf", show_default=True,
    help=f"Outputs, by comma: {', '.join(render.RENDERERS)}.",
)  # fmt: skip
@click.option("--form", type=click.Choice(FORMS, case_sensitive=False), default=FORMS[0],
              show_default=True, help="Blank form: for an editor or a spreadsheet.")  # fmt: skip
@click.option("--count", type=Whole(1, 9999), default=1, show_default=True,
              help="Papers of consecutive seeds, each in a folder named by its code.")  # fmt: skip
@jobs_option
@click.option("--out", type=click.Path(path_type=Path),
              help=f"Folder to write to. [default: {HOME}/CODE]")  # fmt: skip
@click.option("--reference", is_flag=True, help="The questions with the numbers of the notes.")
@bank_options
def exam(**options: Unpack[Options]) -> None:
    """Make a mock exam with worked solutions, answer key and a blank answer form."""
    formats = [checked("--format", name, render.RENDERERS) for name in split(options["formats"])]
    if options["count"] > 1:
        _many(options, formats)
        return
    with Progress("exam") as tell:
        paper = _paper(options, tell)
        form = (options["out"] or _home(paper.code)) / f"answers.{options['form']}"
        kept = _filled_in(form, paper.code)
        contents = _contents(paper, formats, form.name, tell)
    _write(form, contents, kept=kept)
    _report(form, paper, contents, options, kept=kept)


def _many(options: Options, formats: list[str]) -> None:
    """Make papers of consecutive seeds; each is written whole as soon as it is made."""
    from quizgen.executors import in_order, workers

    if options["code"] or options["reference"]:
        raise ChoiceError("--count makes papers of many seeds; leave --code and --reference out")
    bank, count = open_bank(options), options["count"]
    name = f"answers.{options['form']}"
    lang = options["lang"] or leading(bank.languages)
    make = partial(_made, bank, _levelled(options, bank), lang, formats, name)
    first = _first_seed(options)
    if first + count - 1 > LARGEST_SEED:
        raise ChoiceError(f"--count: the last of {count} seeds would be beyond {LARGEST_SEED}")
    processes = paying(options["jobs"], count * A_PAPER)
    codes: list[str] = []
    with Progress("exam", count) as tell, workers(processes) as (executor, ahead):
        for code, contents in in_order(executor, make, range(first, first + count), ahead):
            form = (options["out"] or HOME) / _home(code).name / name
            _write(form, contents, kept=_filled_in(form, code))
            codes.append(code)
            tell(code)
    click.echo(f"{many(count, 'paper')} in {options['out'] or HOME}: {codes[0]} to {codes[-1]}")
    check = command("check", form.parent / KEY, form)
    click.echo(f"Next: fill in {form}, then: {check}")


def _made(
    bank: Bank, blueprint: Blueprint, lang: str, formats: list[str], form: str, seed: int
) -> tuple[str, dict[str, bytes]]:
    """Code and files of one paper of many."""
    from quizgen.paper.paper import build, silent

    paper = build(bank, blueprint, seed, lang)
    contents = _contents(paper, formats, form, silent)
    if "pdf" in formats:
        from quizgen.render.typ import forget

        forget(PRETENDED)
    return paper.code, contents


def _contents(
    paper: Paper, formats: list[str], form: str, tell: Callable[[str], None]
) -> dict[str, bytes]:
    """All files of a paper, the key last."""
    from quizgen.paper.form import form_bytes
    from quizgen.paper.key import key_bytes

    pages = dict(_rendered(paper, formats, tell))
    return {**pages, form: form_bytes(paper, Path(form).suffix[1:]), KEY: key_bytes(paper)}


def _write(form: Path, contents: dict[str, bytes], *, kept: bool) -> None:
    """Write a paper's files; a form that has been written in stays as it is."""
    from quizgen.files import write_all

    if kept:
        del contents[form.name]
    write_all(form.parent, contents)


def _filled_in(form: Path, paper: str) -> bool:
    """Whether there is a form already, with answers to this very paper.

    Raises
    ------
    RenderError
        If its folder has one with answers to another, or the key of another: answers to that may
        still come, from a printed page or from where a browser saved them.
    """
    from quizgen.paper.form import code_of_answers, holds_answers
    from quizgen.paper.key import code_of_key

    for path in sorted(p for p in form.parent.glob("*") if p.suffix.lower() in SUFFIXES):
        code = code_of_answers(path)
        unclear = path.name in NAMES and not code and holds_answers(path)
        if unclear or code not in {"", paper}:
            what = f"holds answers to {visible(code)}" if code else "may hold answers"
            raise RenderError(f"{path} {what}; nothing was written. Name another folder with --out")
    code = code_of_key(form.parent / KEY)
    if code not in {"", paper}:
        raise RenderError(
            f"{form.parent / KEY} is the key of {visible(code)}, whose answers may still come; "
            "nothing was written. Name another folder with --out"
        )
    return holds_answers(form)


def _paper(options: Options, tell: Progress) -> Paper:
    from quizgen.paper.banks import compared
    from quizgen.paper.paper import build, rebuild, reference_paper

    bank = open_bank(options)
    if options["code"]:
        if options["seed"] is not None or options["lang"]:
            raise CodeError("--code already fixes seed and language; leave --seed and --lang out")
        if options["level"]:
            raise CodeError("--code already fixes the level; leave --level out")
        if options["topic"] is not None or options["minutes"] is not None:
            raise CodeError("--code already fixes the questions; leave --topic and --minutes out")
        given = _blueprint(options, bank) if options["blueprint"] else None
        with compared(partial(_banks_of, options), bank):
            return rebuild(bank, options["code"], given, progress=tell)
    blueprint, lang = _levelled(options, bank), options["lang"] or leading(bank.languages)
    if options["reference"]:
        return reference_paper(bank, blueprint, lang, progress=tell)
    return build(bank, blueprint, _first_seed(options), lang, progress=tell)


def _banks_of(options: Options) -> tuple[UsedBank, ...]:
    """The banks that the paper of a code was made from, if its key is still in its folder."""
    from quizgen.paper.key import read_key

    key = (options["out"] or _home(str(options["code"]))) / KEY
    return read_key(key).banks if key.exists() else ()


def _home(code: str) -> Path:
    """The folder of a paper; what parts a bank from its blueprint's name parts drives elsewhere."""
    return HOME / code.replace(BETWEEN, ".")


def _first_seed(options: Options) -> int:
    return secrets.randbelow(10**6) if options["seed"] is None else options["seed"]


def _levelled(options: Options, bank: Bank) -> Blueprint:
    import msgspec

    return msgspec.structs.replace(_blueprint(options, bank), level=options["level"] or EXAM)


def _blueprint(options: Options, bank: Bank) -> Blueprint:
    from quizgen.paper.blueprint import EVERYTHING, load_blueprint, of_topic, topics, usual

    topic, minutes = options["topic"], options["minutes"]
    if topic is None and minutes is None:
        return load_blueprint(options["blueprint"] or usual(bank), bank)
    if options["blueprint"]:
        raise ChoiceError("--blueprint names the questions; leave --topic and --minutes out")
    if topic is not None:
        checked("--topic", topic, topics(bank))
    return of_topic(bank, topic or EVERYTHING, minutes or 0)


def _rendered(
    paper: Paper, formats: list[str], tell: Callable[[str], None]
) -> Iterator[tuple[str, bytes]]:
    for output in formats:
        for kind in render.KINDS:
            name = f"{kind}.{output}"
            tell(name)
            yield name, render.render_paper(paper, kind, output)


def _report(
    form: Path, paper: Paper, written: Collection[str], options: Options, *, kept: bool
) -> None:
    folder = form.parent
    for name in sorted(written):
        click.echo(f"  {folder / name}")
    if kept:
        click.echo(f"  {form} has been written in and was left as it is")
    click.echo(
        f"{many(len(paper.items), 'question')}, {float(paper.points):g} points, {paper.minutes} min"
    )
    _remark(paper, options["minutes"])
    again = command("exam", "--code", paper.code, *_again(options))
    check = command("check", folder / KEY, form)
    click.echo(f"Code: {paper.code}")
    click.echo(f"The same paper again: {again}")
    click.echo(f"Next: fill in {form}, then: {check}")
    if "exam.html" in written:
        page = command("check", folder / KEY, folder / "answers.json")
        click.echo(f"  or fill in {folder / 'exam.html'}, save answers.json there, then: {page}")


def _remark(paper: Paper, asked: int | None) -> None:
    """Say how many papers there are, and whether the time that was asked for is used."""
    from quizgen.paper.blueprint import EVERYTHING

    if paper.variety:
        click.echo(f"One of up to {paper.variety_text} papers that this blueprint can make")
    if asked and asked > paper.minutes + TO_SPARE:
        topic = paper.blueprint.topic
        where = "this bank" if topic == EVERYTHING else f"topic {topic}"
        click.echo(f"You asked for {asked} min: {where} has no more questions that go together")


def _again(options: Options) -> list[str]:
    """Options without which a code does not lead to the same paper."""
    words: list[str] = []
    if options["blueprint"] and Path(options["blueprint"]).exists():
        words += ["--blueprint", options["blueprint"]]
    for named in options["bank"]:
        words += ["--bank", str(named)]
    for named in options["trust_bank"]:
        words += ["--trust-bank", str(named)]
    return words + ["--trust"] * options["trust"]
