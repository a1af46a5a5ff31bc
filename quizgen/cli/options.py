"""Options shared by commands."""

from __future__ import annotations

from collections.abc import Callable, Collection
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec, TypedDict, TypeVar

import click

from quizgen.bank.levels import CHOICES, EXAM
from quizgen.locale import FIRST, languages
from quizgen.paper.code import LARGEST_SEED

if TYPE_CHECKING:
    from quizgen.bank.folder import Bank

P = ParamSpec("P")
T = TypeVar("T")


class Whole(click.IntRange):
    """A whole number between bounds, and called so where something else is typed."""

    name = "whole number"


LEVEL_HELP = "As in an exam, step by step, turned round, or by the seed."
SEED = Whole(0, LARGEST_SEED)
"""Seeds of papers, decks and previews."""


class BankOptions(TypedDict):
    """The bank that a command works on."""

    bank: Path | None
    trust: bool


def bank_options(command: Callable[P, T]) -> Callable[P, T]:
    """Add ``--bank`` and ``--trust``."""
    trust = click.option("--trust", is_flag=True, help="Run the Python solvers of --bank.")
    bank = click.option(
        "--bank", type=click.Path(path_type=Path), help="Another bank of templates."
    )
    return bank(trust(command))


def open_bank(options: BankOptions) -> Bank:
    """The bank that the options name."""
    from quizgen.bank.folder import Bank, builtin

    return Bank(options["bank"], trusted=options["trust"]) if options["bank"] else builtin()


def language_option(command: Callable[P, T]) -> Callable[P, T]:
    """Add ``--lang``, one of the languages there are."""
    kind = click.Choice(languages(), case_sensitive=False)
    return click.option("--lang", type=kind, default=FIRST, show_default=True, help="Language.")(
        command
    )


def own_database() -> str:
    """Address of a learner's own database."""
    from platformdirs import user_data_path

    return f"sqlite:///{user_data_path('quizgen', ensure_exists=True) / 'learning.sqlite3'}"


def database_option(command: Callable[P, T]) -> Callable[P, T]:
    """Add ``--database``, where what is learnt is kept, in the browser as in the terminal."""
    return click.option(
        "--database",
        metavar="ADDRESS",
        default=own_database,
        help="Where to keep what is done: sqlite:///FILE, postgresql+psycopg://...",
    )(command)


def level_option(command: Callable[P, T]) -> Callable[P, T]:
    """Add ``--level``, one of the levels there are."""
    kind = click.Choice(CHOICES, case_sensitive=False)
    return click.option(
        "--level", type=kind, default=EXAM, show_default=True, help=LEVEL_HELP
    )(command)  # fmt: skip


def checked(option: str, name: str, allowed: Collection[str]) -> str:
    """Return the allowed name that this one is, in capitals or not.

    Raises
    ------
    click.BadParameter
        If there is none; it names all.
    """
    for known in allowed:
        if known.casefold() == name.strip().casefold():
            return known
    raise click.BadParameter(f"{name!r} (allowed: {', '.join(allowed)})", param_hint=option)


def topic_option(bank: Bank, name: str) -> str:
    """Return the topic that ``--topic`` names: by its name or its title in any language.

    Raises
    ------
    click.BadParameter
        If there is none; it names all.
    """
    wanted = name.strip().casefold()
    for topic in bank.topics:
        titles = (bank.topic_title(topic, lang) for lang in languages())
        if wanted in {title.casefold() for title in titles}:
            return topic
    return checked("--topic", name, bank.topics)


def split(text: str | None) -> tuple[str, ...]:
    """Names that stand between commas."""
    return tuple(name.strip() for name in (text or "").split(",") if name.strip())
