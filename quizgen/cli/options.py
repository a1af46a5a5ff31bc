"""Options shared by commands."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from quizgen.bank.folder import Bank


def bank_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--bank`` and ``--trust``."""
    trust = click.option("--trust", is_flag=True, help="Run the Python solvers of --bank.")
    bank = click.option(
        "--bank", type=click.Path(path_type=Path), help="Another bank of templates."
    )
    return bank(trust(command))


def open_bank(options: dict[str, Any]) -> Bank:
    """The bank that the options name."""
    from quizgen.bank.folder import Bank, builtin

    return Bank(options["bank"], trusted=options["trust"]) if options["bank"] else builtin()
