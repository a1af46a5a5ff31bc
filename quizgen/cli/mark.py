"""``quizgen mark``."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TypedDict, Unpack

import click

from quizgen.cli.options import language_option
from quizgen.core.errors import KeyFileError
from quizgen.grading.options import DECIMALS
from quizgen.locale import FIRST


class MarkOptions(TypedDict):
    """Options of ``quizgen mark``."""

    lang: str | None
    decimal: str
    settle: bool


@click.command(
    short_help="Mark one answer, or JSON Lines of answers (for authors).",
    context_settings={"ignore_unknown_options": True},  # a negative answer is no option
)
@click.argument("spec", required=False)
@click.argument("typed", required=False)
@click.option("--batch", is_flag=True, help="Read JSON Lines from standard input.")
@language_option
@click.option("--decimal", type=click.Choice(DECIMALS), default=DECIMALS[0], show_default=True,
              help="The decimal sign.")  # fmt: skip
@click.option("--settle", is_flag=True, help="Allow SymPy to settle an undecided formula.")
def mark(
    spec: str | None, typed: str | None, *, batch: bool, **options: Unpack[MarkOptions]
) -> None:
    """Mark TYPED against SPEC, an inline TOML table: '{kind="number", value="20/3", decimals=3}'.

    With --batch each line of standard input is {"spec": {...}, "typed": "...", "lang": "en",
    "decimal": "auto|point|comma"} and each line of output
    {"verdict", "credit", "read_as", "note", "message"}.
    """
    if batch:
        _grade_batch()
        return
    if spec is None or typed is None:
        raise click.UsageError("give SPEC and TYPED, or --batch")
    import json

    from quizgen.kinds.grade import grade_answer

    verdict = grade_answer(
        _parse_inline_spec(spec), typed, lang=options["lang"] or FIRST, decimal=options["decimal"],
        settle=options["settle"],
    )  # fmt: skip
    click.echo(json.dumps(verdict.as_json(), ensure_ascii=False))


def _parse_inline_spec(text: str) -> Mapping[str, object]:
    """Return an inline TOML table as a mapping; decimals stay text, so none is rounded."""
    import tomllib

    try:
        table = tomllib.loads(f"spec = {text}", parse_float=str)["spec"]
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise KeyFileError(f"spec: {error}") from None
    if not isinstance(table, dict):
        raise KeyFileError("spec: a table {...} is expected")
    return table


def _grade_batch() -> None:
    """Grade each line of standard input as it comes."""
    from quizgen.kinds.batch import grade_lines

    out = sys.stdout.buffer
    for line in grade_lines(sys.stdin.buffer):
        out.write(line + b"\n")
        out.flush()
