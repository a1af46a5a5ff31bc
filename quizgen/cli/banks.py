"""``quizgen banks``."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import BankOptions, bank_options, open_bank
from quizgen.cli.terminal import print_table
from quizgen.core.untrusted import escape_control_characters

if TYPE_CHECKING:
    from quizgen.paper.provenance import BankRecord

HEAD = ("bank", "version", "languages", "templates", "Python", "licence", "folder")


class BanksOptions(BankOptions):
    """Options of ``quizgen banks``."""

    remember: bool


@click.command()
@click.option("--remember", is_flag=True,
              help="Let the Python of every --bank run from now on, until it changes.")  # fmt: skip
@bank_options
def banks(**options: Unpack[BanksOptions]) -> None:
    """List the banks there are: the built-in one, those of packages, and --bank."""
    from quizgen.bank.combined import open_banks
    from quizgen.bank.discovery import (
        available_banks,
        describe_bank,
        remember_trust,
        resolve_bank,
    )

    if options["remember"]:
        if not options["bank"]:
            raise click.BadParameter("name a bank by --bank", param_hint="--remember")
        for named in options["bank"]:
            remember_trust(resolve_bank(named))
    found = {name: open_banks([(str(root), False)]) for name, root in available_banks().items()}
    if options["bank"]:
        found |= {own.name: own for own in open_bank(options).members}
    print_table(HEAD, [describe_bank(name, bank) for name, bank in found.items()])


def compare_banks(used: Iterable[BankRecord], named: tuple[Path, ...]) -> None:
    """Print how the banks at hand differ from those that a key was made from.

    Nothing is printed if they agree: grading uses the key alone.
    """
    from quizgen.bank.bank import Bank, builtin_bank
    from quizgen.bank.discovery import resolve_bank
    from quizgen.paper.provenance import describe_differences

    told = describe_differences(used, [builtin_bank(), *(Bank(resolve_bank(one)) for one in named)])
    if told:
        click.echo(f"quizgen: {escape_control_characters(told)}; marked by the key", err=True)
