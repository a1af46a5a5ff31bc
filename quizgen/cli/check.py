"""Commands ``check``, ``mark`` and ``practice``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from quizgen.errors import KeyFileError

LANGUAGE = click.Choice(["en", "bn"])
DECIMAL = click.Choice(["auto", "point", "comma"])


@click.command(short_help="Mark typed answers with a paper's key.")
@click.argument("key", type=click.Path(path_type=Path))
@click.argument("answers", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option("--lang", type=LANGUAGE, help="Language of the remarks [the form's own].")
@click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")
@click.option("--csv", "as_csv", is_flag=True, help="Print CSV (the default for several forms).")
@click.option("--no-settle", is_flag=True, help="Never start SymPy for undecided formulas.")
def check(key: Path, answers: tuple[Path, ...], lang: str | None, **flags: bool) -> None:
    """Mark ANSWERS (answers.toml or answers.json, one or many) with KEY (key.json).

    One form prints a table with the mistake found in each part; several forms print CSV: marks and
    notes per part, one line per student.
    """
    from quizgen.paper.form import read_answers
    from quizgen.paper.key import read_key
    from quizgen.paper.marking import mark_paper

    paper = read_key(key)
    results = []
    for path in answers:
        form = read_answers(path)
        _same_paper(path, form.code, paper.code)
        chosen = lang or _known(form.student.lang) or _known(paper.langs[0] if paper.langs else "")
        result = mark_paper(
            paper,
            form.typed(),
            chosen or "en",
            decimal=form.student.decimal,
            settle=not flags["no_settle"],
        )
        results.append((str(path), form.student.name, chosen or "en", result))
    _print(results, as_json=flags["as_json"], as_csv=flags["as_csv"] or len(results) > 1)


def _known(lang: str) -> str:
    return lang if lang in {"en", "bn"} else ""


def _same_paper(path: Path, own: str, code: str) -> None:
    if own and code and own != code:
        raise KeyFileError(f"{path}: code {own} belongs to another paper; the key is for {code}")


def _print(results: list[tuple[str, str, str, Any]], *, as_json: bool, as_csv: bool) -> None:
    from quizgen.paper.report import class_csv, table_lines

    if as_json:
        import json

        tables = [
            {"file": file, "name": name, **result.as_json()} for file, name, _, result in results
        ]
        shown = tables[0] if len(tables) == 1 else tables
        click.echo(json.dumps(shown, ensure_ascii=False, indent=1))
    elif as_csv:
        rows = [(file, name, result) for file, name, _, result in results]
        click.echo(class_csv(rows), nl=False)
    else:
        ((_, _, lang, result),) = results
        import shutil

        columns = shutil.get_terminal_size((80, 24)).columns
        for line in table_lines(result, lang, columns, paint=sys.stdout.isatty()):
            click.echo(line)


@click.command(short_help="Mark one answer, or JSON Lines of answers (for authors).")
@click.argument("spec", required=False)
@click.argument("typed", required=False)
@click.option("--batch", is_flag=True, help="Read JSON Lines from standard input.")
@click.option("--lang", type=LANGUAGE, default="en", show_default=True)
@click.option("--decimal", type=DECIMAL, default="auto", show_default=True)
@click.option("--settle", is_flag=True, help="Allow SymPy to settle an undecided formula.")
def mark(spec: str | None, typed: str | None, *, batch: bool, **options: Any) -> None:
    """Mark TYPED against SPEC, an inline TOML table: '{kind="number", value="20/3", decimals=3}'.

    With --batch each line of standard input is {"spec": {...}, "typed": "...", "lang": "en",
    "decimal": "auto|point|comma"} and each line of output
    {"verdict", "credit", "read_as", "note", "message"}.
    """
    if batch:
        _batch()
        return
    if spec is None or typed is None:
        raise click.UsageError("give SPEC and TYPED, or --batch")
    import json

    from quizgen.marking.mark import mark as mark_one

    verdict = mark_one(_inline(spec), typed, **options)
    click.echo(json.dumps(verdict.as_json(), ensure_ascii=False))


def _inline(text: str) -> dict[str, Any]:
    import tomllib

    try:
        table = tomllib.loads(f"spec = {text}", parse_float=str)["spec"]
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise KeyFileError(f"spec: {error}") from None
    if not isinstance(table, dict):
        raise KeyFileError("spec: a table {...} is expected")
    return table


def _batch() -> None:
    from quizgen.marking.batch import marked

    out = sys.stdout.buffer
    for line in marked(sys.stdin.buffer):
        out.write(line + b"\n")
        out.flush()


@click.command(short_help="Practise in the terminal with instant feedback.")
@click.option("--topic", help="Only this topic.")
@click.option("--tier", type=click.Choice(list("ABCD")), help="Only this tier.")
@click.option("--lang", type=LANGUAGE, default="en", show_default=True)
@click.option("--count", type=click.IntRange(1, 200), default=10, show_default=True)
@click.option("--seed", help="Start the same session again.")
@click.option("--bank", "folder", type=click.Path(path_type=Path), help="A bank of your own.")
@click.option("--fresh", is_flag=True, help="Forget a session that was interrupted.")
def practice(**options: Any) -> None:
    """Practise in the terminal: instant feedback, hints, retries, worked solutions.

    Ctrl-C keeps the session; the same command goes on with it.
    """
    from quizgen.cli.practice import run

    run(**options)
