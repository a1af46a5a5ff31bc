"""``quizgen exam``."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen import render
from quizgen.bank.levels import CHOICES, EXAM
from quizgen.bank.qualified_names import BETWEEN
from quizgen.cli.options import (
    LANGUAGE_HELP,
    LEVEL_HELP,
    SEED,
    BankOptions,
    IntRangeParam,
    LanguageParam,
    bank_options,
    jobs_option,
    match_choice,
    open_bank,
    open_sound_bank,
    split_names,
    worthwhile_processes,
)
from quizgen.cli.terminal import ProgressLine, build_command_line, format_count
from quizgen.core.errors import InvalidChoiceError, PaperCodeError, RenderError
from quizgen.core.untrusted import escape_control_characters
from quizgen.locale import default_language
from quizgen.paper.answer_form import FORMS
from quizgen.paper.code import LARGEST_SEED

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank
    from quizgen.paper.blueprint import Blueprint
    from quizgen.paper.paper import Paper
    from quizgen.paper.provenance import BankRecord

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


class ExamOptions(BankOptions):
    """Options of ``quizgen exam``."""

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
@click.option(
    "--minutes", type=IntRangeParam(3, 9999), help="As many questions as this time allows."
)
@click.option(
    "--lang",
    type=LanguageParam(both=True),
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
@click.option("--count", type=IntRangeParam(1, 9999), default=1, show_default=True,
              help="Papers of consecutive seeds, each in a folder named by its code.")  # fmt: skip
@jobs_option
@click.option("--out", type=click.Path(path_type=Path),
              help=f"Folder to write to. [default: {HOME}/CODE]")  # fmt: skip
@click.option("--reference", is_flag=True, help="The questions with the numbers of the notes.")
@bank_options
def exam(**options: Unpack[ExamOptions]) -> None:
    """Make a mock exam with worked solutions, answer key and a blank answer form."""
    formats = [
        match_choice("--format", name, render.RENDERERS) for name in split_names(options["formats"])
    ]
    if options["count"] > 1:
        _make_many_papers(options, formats)
        return
    with ProgressLine("exam") as tell:
        paper = _build_requested_paper(options, tell)
        form = (options["out"] or _get_paper_folder(paper.code)) / f"answers.{options['form']}"
        kept = _has_filled_form(form, paper.code)
        contents = _build_paper_files(paper, formats, form.name, tell)
    _write_paper_files(form, contents, kept=kept)
    _report_paper(form, paper, contents, options, kept=kept)


def _make_many_papers(options: ExamOptions, formats: list[str]) -> None:
    """Write papers of consecutive seeds, each complete as soon as it is made."""
    from quizgen.core.executor import map_ordered, open_executor

    if options["code"] or options["reference"]:
        raise InvalidChoiceError(
            "--count makes papers of many seeds; leave --code and --reference out"
        )
    bank, count = open_sound_bank(options), options["count"]
    name = f"answers.{options['form']}"
    lang = options["lang"] or default_language(bank.languages)
    make = partial(
        _make_numbered_paper, bank, _load_blueprint_at_level(options, bank), lang, formats, name
    )
    first = _choose_first_seed(options)
    if first + count - 1 > LARGEST_SEED:
        raise InvalidChoiceError(
            f"--count: the last of {count} seeds would be beyond {LARGEST_SEED}"
        )
    processes = worthwhile_processes(options["jobs"], count * A_PAPER)
    codes: list[str] = []
    with ProgressLine("exam", count) as tell, open_executor(processes) as (executor, ahead):
        for code, contents in map_ordered(executor, make, range(first, first + count), ahead):
            form = (options["out"] or HOME) / _get_paper_folder(code).name / name
            _write_paper_files(form, contents, kept=_has_filled_form(form, code))
            codes.append(code)
            tell(code)
    click.echo(
        f"{format_count(count, 'paper')} in {options['out'] or HOME}: {codes[0]} to {codes[-1]}"
    )
    check = build_command_line("check", form.parent / KEY, form)
    click.echo(f"Next: fill in {form}, then: {check}")


def _make_numbered_paper(
    bank: Bank, blueprint: Blueprint, lang: str, formats: list[str], form: str, seed: int
) -> tuple[str, dict[str, bytes]]:
    """Return code and files of one of many papers; runs in a worker."""
    from quizgen.paper.paper import build_paper, silent

    paper = build_paper(bank, blueprint, seed, lang)
    contents = _build_paper_files(paper, formats, form, silent)
    if "pdf" in formats:
        from quizgen.render.typst_document import evict_cache

        evict_cache(PRETENDED)
    return paper.code, contents


def _build_paper_files(
    paper: Paper, formats: list[str], form: str, tell: Callable[[str], None]
) -> dict[str, bytes]:
    """Return the files of a paper by name, the key last.

    In this order a key in the folder always has its paper.
    """
    from quizgen.paper.answer_form import write_blank_form
    from quizgen.paper.answer_key import write_answer_key

    return {
        **dict(_iter_rendered_files(paper, formats, tell)),
        **paper.data_files,
        form: write_blank_form(paper, Path(form).suffix[1:]),
        KEY: write_answer_key(paper),
    }


def _write_paper_files(form: Path, contents: dict[str, bytes], *, kept: bool) -> None:
    """Write a paper's files; ``kept`` leaves a form with answers as it is."""
    from quizgen.core.files import write_all

    if kept:
        del contents[form.name]
    # Neighbours on a machine of several people read the paper at most.
    private = {name for name in contents if name == KEY or name.startswith("solutions.")}
    write_all(form.parent, contents, private=private)


def _has_filled_form(form: Path, paper: str) -> bool:
    """Return whether the form exists and holds answers to this paper.

    Raises
    ------
    RenderError
        If its folder has one with answers to another, or the key of another: answers to that may
        still come, from a printed page or from where a browser saved them.
    """
    from quizgen.paper.answer_form import has_answers, read_form_code
    from quizgen.paper.answer_key import read_key_code

    for path in sorted(p for p in form.parent.glob("*") if p.suffix.lower() in SUFFIXES):
        code = read_form_code(path)
        unclear = path.name in NAMES and not code and has_answers(path)
        if unclear or code not in {"", paper}:
            what = (
                f"holds answers to {escape_control_characters(code)}"
                if code
                else "may hold answers"
            )
            raise RenderError(f"{path} {what}; nothing was written. Name another folder with --out")
    code = read_key_code(form.parent / KEY)
    if code not in {"", paper}:
        raise RenderError(
            f"{form.parent / KEY} is the key of "
            f"{escape_control_characters(code)}, whose answers may still come; "
            "nothing was written. Name another folder with --out"
        )
    return has_answers(form)


def _build_requested_paper(options: ExamOptions, tell: ProgressLine) -> Paper:
    """Return the paper that the options name: by code, as reference, or by seed."""
    from quizgen.paper.paper import build_paper, build_reference_paper, rebuild_paper
    from quizgen.paper.provenance import bank_difference_context

    bank = open_sound_bank(options)
    if options["code"]:
        if options["seed"] is not None or options["lang"]:
            raise PaperCodeError(
                "--code already fixes seed and language; leave --seed and --lang out"
            )
        if options["level"]:
            raise PaperCodeError("--code already fixes the level; leave --level out")
        if options["topic"] is not None or options["minutes"] is not None:
            raise PaperCodeError(
                "--code already fixes the questions; leave --topic and --minutes out"
            )
        given = _load_requested_blueprint(options, bank) if options["blueprint"] else None
        with bank_difference_context(partial(_read_banks_of_code, options), bank):
            return rebuild_paper(bank, options["code"], given, progress=tell)
    blueprint, lang = (
        _load_blueprint_at_level(options, bank),
        options["lang"] or default_language(bank.languages),
    )
    if options["reference"]:
        return build_reference_paper(bank, blueprint, lang, progress=tell)
    return build_paper(bank, blueprint, _choose_first_seed(options), lang, progress=tell)


def _read_banks_of_code(options: ExamOptions) -> tuple[BankRecord, ...]:
    """Return the banks of a code's paper, from the key in its folder; none without a key."""
    from quizgen.paper.answer_key import read_answer_key

    key = (options["out"] or _get_paper_folder(str(options["code"]))) / KEY
    return read_answer_key(key).banks if key.exists() else ()


def _get_paper_folder(code: str) -> Path:
    """Return the folder of a paper's code.

    The sign between bank and blueprint is not allowed in all file systems.
    """
    return HOME / code.replace(BETWEEN, ".")


def _choose_first_seed(options: ExamOptions) -> int:
    """Return the seed in the options, or a random one."""
    from quizgen.paper.quota import draw_first_seed

    return draw_first_seed() if options["seed"] is None else options["seed"]


def _load_blueprint_at_level(options: ExamOptions, bank: Bank) -> Blueprint:
    """Return the blueprint that the options name, at their level."""
    import msgspec

    return msgspec.structs.replace(
        _load_requested_blueprint(options, bank), level=options["level"] or EXAM
    )


def _load_requested_blueprint(options: ExamOptions, bank: Bank) -> Blueprint:
    """Return the blueprint of a topic, of a length, or by its name."""
    from quizgen.paper.blueprint import (
        EVERYTHING,
        default_blueprint_name,
        load_blueprint,
        topic_blueprint,
        topic_choices,
    )

    topic, minutes = options["topic"], options["minutes"]
    if topic is None and minutes is None:
        return load_blueprint(options["blueprint"] or default_blueprint_name(bank), bank)
    if options["blueprint"]:
        raise InvalidChoiceError("--blueprint names the questions; leave --topic and --minutes out")
    if topic is not None:
        match_choice("--topic", topic, topic_choices(bank))
    return topic_blueprint(bank, topic or EVERYTHING, minutes or 0)


def _iter_rendered_files(
    paper: Paper, formats: list[str], tell: Callable[[str], None]
) -> Iterator[tuple[str, bytes]]:
    """Yield name and bytes of each rendered file of a paper."""
    for output in formats:
        for kind in render.KINDS:
            name = f"{kind}.{output}"
            tell(name)
            yield name, render.render_paper(paper, kind, output)


def _report_paper(
    form: Path, paper: Paper, written: Collection[str], options: ExamOptions, *, kept: bool
) -> None:
    """Print the files, the size of the paper, and how to go on."""
    folder = form.parent
    for name in sorted(written):
        click.echo(f"  {folder / name}")
    if kept:
        click.echo(f"  {form} has been written in and was left as it is")
    click.echo(
        f"{format_count(len(paper.items), 'question')}, "
        f"{float(paper.points):g} points, {paper.minutes} min"
    )
    _report_variety(paper, options["minutes"])
    again = build_command_line("exam", "--code", paper.code, *_list_rebuild_options(options))
    check = build_command_line("check", folder / KEY, form)
    click.echo(f"Code: {paper.code}")
    click.echo(f"The same paper again: {again}")
    click.echo(f"Next: fill in {form}, then: {check}")
    if "exam.html" in written:
        page = build_command_line("check", folder / KEY, folder / "answers.json")
        click.echo(f"  or fill in {folder / 'exam.html'}, save answers.json there, then: {page}")
    _report_short_exam(options)


def _report_short_exam(options: ExamOptions) -> None:
    """Print how to get the trial exam, where nothing was said and the long paper was made."""
    from quizgen.paper.blueprint import TRIAL, find_blueprint, longest_minutes

    if any(options[name] for name in ("code", "blueprint", "topic", "minutes")):
        return
    short = find_blueprint(TRIAL, open_bank(options))
    if short is not None and short.minutes:
        command = build_command_line("exam", "--blueprint", TRIAL, *_list_rebuild_options(options))
        click.echo(f"Shorter, as long as the real one ({longest_minutes(short)} min): {command}")


def _report_variety(paper: Paper, asked: int | None) -> None:
    """Print how many papers there are, and whether the time requested is used."""
    from quizgen.paper.blueprint import EVERYTHING

    if paper.variety:
        click.echo(f"One of up to {paper.variety_text} papers that this blueprint can make")
    if asked and asked > paper.minutes + TO_SPARE:
        topic = paper.blueprint.topic
        where = "this bank" if topic == EVERYTHING else f"topic {topic}"
        click.echo(f"You asked for {asked} min: {where} has no more questions that go together")


def _list_rebuild_options(options: ExamOptions) -> list[str]:
    """Return the options that a code needs to give the same paper."""
    words: list[str] = []
    if options["blueprint"] and Path(options["blueprint"]).exists():
        words += ["--blueprint", options["blueprint"]]
    for named in options["bank"]:
        words += ["--bank", str(named)]
    for named in options["trust_bank"]:
        words += ["--trust-bank", str(named)]
    return words + ["--trust"] * options["trust"]
