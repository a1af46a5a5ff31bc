"""What a server is started with."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from quizgen.bank.folder import Bank

LOCAL = ("127.0.0.1", "localhost")
"""Names under which a browser on this machine reaches a server of its own."""


@dataclass(frozen=True)
class Settings:
    """What a server is started with.

    Parameters
    ----------
    database : str
        Address of the database, as SQLAlchemy writes it.
    bank : pathlib.Path, optional
        Folder of another bank.
    trusted : bool
        Whether that bank's own solvers may run.
    hosts : tuple of str
        Names under which the server may be asked.
    token : str
        What the opened address holds: only who has it is let in. A database that was served
        before keeps its own.
    workers : int
        Processes that make questions.
    """

    database: str
    bank: Path | None = None
    trusted: bool = False
    hosts: tuple[str, ...] = LOCAL
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24), repr=False)
    workers: int = 2
    examine: Callable[[Bank, str], list[str]] | None = None
