"""``quizgen banks``."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import BankOptions, bank_options, open_bank
from quizgen.cli.terminal import print_table
from quizgen.outside import visible

if TYPE_CHECKING:
    from quizgen.paper.banks import UsedBank

HEAD = ("bank", "version", "languages", "templates", "Python", "licence", "folder")


@click.command()
@bank_options
def banks(**options: Unpack[BankOptions]) -> None:
    """List the banks there are: the built-in one, those of packages, and --bank."""
    from quizgen.bank.found import described, known
    from quizgen.bank.mixed import opened

    found = {name: opened([(str(root), False)]) for name, root in known().items()}
    if options["bank"]:
        found |= {own.name: own for own in open_bank(options).parts}
    print_table(HEAD, [described(name, bank) for name, bank in found.items()])


def compare(used: Iterable[UsedBank], named: tuple[Path, ...]) -> None:
    """Say which of the banks that are named, and of ours, are others than those of a key."""
    from quizgen.bank.folder import Bank, builtin
    from quizgen.bank.found import root_of
    from quizgen.paper.banks import differing

    told = differing(used, [builtin(), *(Bank(root_of(one)) for one in named)])
    if told:
        click.echo(f"quizgen: {visible(told)}; marked by the key", err=True)
