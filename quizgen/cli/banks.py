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
    from quizgen.bank.found import described, known
    from quizgen.bank.mixed import opened

    found = {name: opened([(str(root), False)]) for name, root in known().items()}
    if options["bank"]:
        found |= {own.name: own for own in open_bank(options).parts}
    print_table(HEAD, [described(name, bank) for name, bank in found.items()])
