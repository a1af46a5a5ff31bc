"""``quizgen banks``."""

from __future__ import annotations

from typing import Unpack

import click

from quizgen.cli.options import BankOptions, bank_options, open_bank
from quizgen.cli.terminal import print_table

HEAD = ("bank", "version", "languages", "templates", "Python", "licence", "folder")


@click.command()
@bank_options
def banks(**options: Unpack[BankOptions]) -> None:
    """List the banks there are: the built-in one, those of packages, and --bank."""
    from quizgen.bank.folder import Bank, builtin
    from quizgen.bank.found import described, installed

    found = {builtin().about.name: builtin()}
    found |= {name: Bank(root) for name, root in installed().items()}
    if options["bank"]:
        own = open_bank(options)
        found[own.about.name or own.root.resolve().name] = own
    print_table(HEAD, [described(name, bank) for name, bank in found.items()])
