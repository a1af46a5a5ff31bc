"""``quizgen mark``."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Unpack

import click

from quizgen.cli.options import (
    SEED,
    BankOptions,
    bank_options,
    language_option,
    open_bank,
)
from quizgen.core.errors import KeyFileError
from quizgen.grading.options import DECIMALS
from quizgen.grading.verdict import Verdict
from quizgen.locale import FIRST


class MarkOptions(BankOptions):
    """Options of ``quizgen mark``."""

    part: str
    seed: int
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
@click.option("--part", default="a", show_default=True, help="The part of the template.")
@click.option("--seed", type=SEED, default=1, show_default=True, help="Number that fixes the draw.")
@language_option
@click.option("--decimal", type=click.Choice(DECIMALS), default=DECIMALS[0], show_default=True,
              help="The decimal sign.")  # fmt: skip
@click.option("--settle", is_flag=True, help="Allow SymPy to settle an undecided formula.")
@bank_options
def mark(
    spec: str | None, typed: str | None, *, batch: bool, **options: Unpack[MarkOptions]
) -> None:
    """Mark TYPED against SPEC, an inline TOML table: '{kind="number", value="20/3", decimals=3}'.

    SPEC may also be the name of a template: then a part of it is marked, with the question around,
    as a paper is. The numbers are those of ``quizgen preview`` with the same seed.

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

    inline = spec.lstrip().startswith("{")
    verdict = _mark_spec(spec, typed, options) if inline else _mark_template(spec, typed, options)
    click.echo(json.dumps(verdict.as_json(), ensure_ascii=False))


def _mark_spec(spec: str, typed: str, options: MarkOptions) -> Verdict:
    """Return the verdict on an answer to a specification given on the command line."""
    from quizgen.kinds.grade import grade_answer

    return grade_answer(
        _parse_inline_spec(spec), typed, lang=options["lang"] or FIRST, decimal=options["decimal"],
        settle=options["settle"],
    )  # fmt: skip


def _mark_template(name: str, typed: str, options: MarkOptions) -> Verdict:
    """Return the verdict on an answer to a part of a template, as drawn for the seed."""
    from quizgen.paper.one_part import mark_part

    return mark_part(
        open_bank(options).template(name), typed, part=options["part"], seed=options["seed"],
        lang=options["lang"] or FIRST, decimal=options["decimal"],
    )  # fmt: skip


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
