"""``quizgen check``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from quizgen.errors import KeyFileError
from quizgen.locale import FIRST, languages

if TYPE_CHECKING:
    from quizgen.paper.form import Answers
    from quizgen.paper.key import Key
    from quizgen.paper.marking import PaperResult


class Marked(NamedTuple):
    """A form that has been marked."""

    file: str
    name: str
    lang: str
    result: PaperResult


@click.command(short_help="Mark typed answers with a paper's key.")
@click.argument("key", type=click.Path(path_type=Path))
@click.argument("answers", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--lang", type=click.Choice(languages()), help="Language of the remarks [the form's own]."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")
@click.option("--csv", "as_csv", is_flag=True, help="Print CSV (the default for several forms).")
@click.option("--no-settle", is_flag=True, help="Never start SymPy for undecided formulas.")
def check(key: Path, answers: tuple[Path, ...], lang: str | None, **flags: bool) -> None:
    """Mark ANSWERS (answers.toml or answers.json, one or many) with KEY (key.json).

    One form prints a table with the mistake found in each part; several forms print CSV: marks and
    notes per part, one line per student.
    """
    from quizgen.paper.key import read_key

    paper = read_key(key)
    marked = [_marked(paper, path, lang, settle=not flags["no_settle"]) for path in answers]
    if flags["as_json"]:
        _print_json(marked)
    elif flags["as_csv"] or len(marked) > 1:
        from quizgen.paper.report import class_csv

        click.echo(class_csv([(one.file, one.name, one.result) for one in marked]), nl=False)
    else:
        _print_table(marked[0])


def _marked(key: Key, path: Path, lang: str | None, *, settle: bool) -> Marked:
    from quizgen.paper.form import read_answers
    from quizgen.paper.marking import mark_paper

    form = read_answers(path)
    if form.code and key.code and form.code != key.code:
        raise KeyFileError(
            f"{path}: code {form.code} belongs to another paper; the key is for {key.code}"
        )
    chosen = lang or _own(form, key)
    decimal = form.student.decimal
    result = mark_paper(key, form.typed(), chosen, decimal=decimal, settle=settle)
    return Marked(str(path), form.student.name, chosen, result)


def _own(form: Answers, key: Key) -> str:
    """The language that the form, else the paper, is written in."""
    wished = (form.student.lang, *key.langs[:1])
    return next((lang for lang in wished if lang in languages()), FIRST)


def _print_json(marked: list[Marked]) -> None:
    import json

    tables = [{"file": one.file, "name": one.name, **one.result.as_json()} for one in marked]
    shown = tables[0] if len(tables) == 1 else tables
    click.echo(json.dumps(shown, ensure_ascii=False, indent=1))


def _print_table(one: Marked) -> None:
    import shutil

    from quizgen.paper.report import table_lines

    columns = shutil.get_terminal_size((80, 24)).columns
    for line in table_lines(one.result, one.lang, columns, paint=sys.stdout.isatty()):
        click.echo(line)
