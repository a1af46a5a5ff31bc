"""``quizgen export``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import (
    LANGUAGE_HELP,
    SEED,
    BankOptions,
    IntRangeParam,
    LanguageParam,
    bank_options,
    open_sound_bank,
    resolve_topic,
    split_names,
)
from quizgen.cli.terminal import ProgressLine
from quizgen.core.errors import InvalidChoiceError
from quizgen.lms import FORMATS, MANIFEST_SUFFIX, TEX_FORMATS, get_exporter
from quizgen.locale import default_language

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank
    from quizgen.lms.items import ExportItem

MOST = 1000
"""Most variants of a question in one file."""


class ExportOptions(BankOptions):
    """Options of ``quizgen export``."""

    target: str
    blueprint: str | None
    topic: str | None
    templates: str | None
    variants: int
    seed: int
    lang: str | None
    maths: str
    out: Path | None


@click.command()
@click.argument("target", metavar="FORMAT", type=click.Choice([*FORMATS], case_sensitive=False))
@click.option("--blueprint", help="A slot for each question of it. [default: mock, else all.90]")
@click.option("--topic", help="A slot for each template of this topic.")
@click.option("--template", "templates", help="A slot for each of these templates, by comma.")
@click.option("--variants", type=IntRangeParam(1, MOST), default=10, show_default=True,
              help="Questions in a slot, as many as there are.")  # fmt: skip
@click.option("--seed", type=SEED, default=0, show_default=True,
              help="Number that fixes every draw.")  # fmt: skip
@click.option("--lang", type=LanguageParam(both=True), help=LANGUAGE_HELP)
@click.option("--maths", type=click.Choice(["mathml", "tex"], case_sensitive=False),
              default="mathml", show_default=True,
              help="How formulas are written: tex for a filter such as MathJax.")  # fmt: skip
@click.option("--out", type=click.Path(path_type=Path),
              help="File to write. [default: in the folder export]")  # fmt: skip
@bank_options
def export(**options: Unpack[ExportOptions]) -> None:
    """Write questions for a learning management system, with variants to draw from.

    FORMAT is moodle (Moodle XML), qti21 or qti3 (packages of QTI 2.1 and 3.0), or canvas (a package
    of QTI 1.2 as Canvas reads it). Parts that the system cannot mark become essays; a report next
    to the file says which and why. Another file next to it holds what quizgen check needs to mark
    the responses; it has all the answers.
    """
    from quizgen.core.files import PRIVATE, write_all
    from quizgen.lms.items import manual_parts
    from quizgen.lms.manifest import write_manifest
    from quizgen.lms.manifest_writer import manifest_entry
    from quizgen.lms.markup import formula_dialect
    from quizgen.paper.provenance import record_banks

    target = options["target"]
    if options["maths"] == "tex" and target not in TEX_FORMATS:
        raise InvalidChoiceError(
            f"--maths tex: not for {target}, only for {', '.join(TEX_FORMATS)}"
        )
    path = options["out"] or Path("export") / FORMATS[target]
    exporter = get_exporter(target)
    with ProgressLine("export") as tell, formula_dialect(options["maths"]):
        bank = open_sound_bank(options)
        items = list(_iter_requested_items(bank, options, tell))
        data = exporter.write(items)
        banks = record_banks(bank, {item.key.template for item in items})
        entries = (manifest_entry(item, exporter.list_questions(item)) for item in items)
        manifest = write_manifest(entries, banks)
    lines = [
        f"{item.id}: {field} exported as essay: {why}"
        for item in items
        for field, why in manual_parts(item)
    ]
    contents = {path.name + MANIFEST_SUFFIX: manifest, path.name: data}
    if lines:
        contents = {f"{path.name}.report.txt": _encode_lines(lines), **contents}
    for file in write_all(path.parent, contents, PRIVATE):
        click.echo(f"  {file}")
    _print_summary(items, lines)


def _encode_lines(lines: list[str]) -> bytes:
    """Return lines as bytes in UTF-8."""
    return "".join(f"{line}\n" for line in lines).encode()


def _iter_requested_items(
    bank: Bank, options: ExportOptions, tell: ProgressLine
) -> Iterator[ExportItem]:
    """Yield the questions that the options name.

    Raises
    ------
    InvalidChoiceError
        If they are named in two ways.
    """
    from quizgen.lms.items import items_from_blueprint, items_from_templates
    from quizgen.paper.blueprint import default_blueprint_name, load_blueprint

    named = [options[key] for key in ("blueprint", "topic", "templates")]
    if len(named) - named.count(None) > 1:
        raise InvalidChoiceError(
            "--blueprint, --topic and --template each name the questions; give one"
        )
    langs = bank.resolve_languages(options["lang"] or default_language(bank.languages))
    if options["topic"] is None and options["templates"] is None:
        plan = load_blueprint(options["blueprint"] or default_blueprint_name(bank), bank)
        made = partial(items_from_blueprint, bank, plan)
    else:
        made = partial(items_from_templates, bank, _list_requested_templates(options, bank))
    return made(options["seed"], options["variants"], langs, tell)


def _list_requested_templates(options: ExportOptions, bank: Bank) -> list[str]:
    """Return the templates of a topic, or those named.

    Raises
    ------
    InvalidChoiceError
        If none is.
    """
    if options["topic"] is None:
        names = list(dict.fromkeys(split_names(options["templates"])))
        if not names:
            raise InvalidChoiceError("--template names no template")
        return names
    topic = resolve_topic(bank, options["topic"])
    return [name for name in bank.template_paths if bank.rules(name).topic == topic]


def _print_summary(items: list[ExportItem], lines: list[str]) -> None:
    """Print how many questions there are, and why some are graded manually."""
    slots, parts = {item.category for item in items}, sum(len(item.parts) for item in items)
    click.echo(f"questions: {len(items)}, slots: {len(slots)}, parts: {parts}")
    why = Counter(line.rpartition(": ")[2] for line in lines)
    if lines:
        told = ", ".join(f"{count} {name}" for name, count in why.most_common())
        click.echo(f"parts exported as essay: {len(lines)} ({told})")
