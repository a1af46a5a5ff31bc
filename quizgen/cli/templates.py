"""``quizgen templates``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import BankOptions, bank_options, open_bank

if TYPE_CHECKING:
    from quizgen.bank.folder import Bank
    from quizgen.bank.template import Template


@click.command()
@click.option("--coverage", is_flag=True, help="What of the curriculum is covered, with holes.")
@click.option("--covers", metavar="ITEM", help="Only those that cover this item, such as Q4a.")
@bank_options
def templates(*, coverage: bool, covers: str | None, **options: Unpack[BankOptions]) -> None:
    """List the templates of the bank: id, tier, topic, pool size, languages."""
    bank = open_bank(options)
    if coverage:
        _print_coverage(bank)
    elif covers is not None:
        _print_covering(bank, covers)
    else:
        _print_all(bank)


def _print_all(bank: Bank) -> None:
    rows = [
        (t.id, t.rules.tier, t.rules.topic, _pool(t), " ".join(t.languages), _title(t))
        for t in bank
    ]
    _print(("id", "tier", "topic", "pool", "languages", "title"), rows)
    click.echo(f"{len(bank)} templates")


def _pool(template: Template) -> str:
    pool = template.rules.pool
    return f"{pool:,}".replace(",", " ") if pool else "-"


def _title(template: Template) -> str:
    return next((text.title for text in template.texts.values()), "")


def _print_covering(bank: Bank, item: str) -> None:
    from quizgen.audit.coverage import covering

    found = [bank.template(name) for name in covering(bank, item)]
    if found:
        _print(("id", "topic", "title"), [(t.id, t.rules.topic, _title(t)) for t in found])
    else:
        click.echo(f"no template covers {item!r}")


def _print_coverage(bank: Bank) -> None:
    from quizgen.audit.coverage import coverage

    rows = [
        (row.group, str(len(row.covered)), str(row.total), " ".join(row.holes))
        for row in coverage(bank)
    ]
    _print(("group", "covered", "of", "holes"), rows)


def _print(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(*head)
    for row in rows:
        table.add_row(*row)
    Console().print(table)
