"""Options shared by commands."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec, TypedDict, TypeVar

import click

from quizgen.bank.levels import CHOICES, EXAM
from quizgen.cli.terminal import format_count, print_message
from quizgen.core.untrusted import escape_control_characters
from quizgen.locale import FIRST, list_language_choices, list_languages
from quizgen.locale.custom import is_language_tag, normalise_language_tag
from quizgen.paper.code import LARGEST_SEED

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank

P = ParamSpec("P")
T = TypeVar("T")


class IntRangeParam(click.IntRange):
    """A whole number between bounds; named so in messages about other input."""

    name = "whole number"


class LanguageParam(click.types.StringParamType):
    """A language; with ``both`` also all of a bank's. A bank checks itself which it has."""

    name = "language"

    def __init__(self, *, both: bool = False) -> None:
        self.both = both

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return a language tag in its usual capitals; end with a message if it is none."""
        known = {one.lower(): one for one in self._list_choices()}
        if value.lower() in known:
            return known[value.lower()]
        if not is_language_tag(normalise_language_tag(value)):
            self.fail(f"{value!r} is no language (such as {', '.join(known)})", param, ctx)
        return normalise_language_tag(value)

    def _list_choices(self) -> tuple[str, ...]:
        """Return the languages that messages list."""
        return list_language_choices() if self.both else list_languages()


MOST_JOBS = 256
WORTH = 2.0
"""Seconds of work that are worth another process: it takes up to one to begin."""
LEVEL_HELP = "As in an exam, step by step, turned round, or by the seed."
LANGUAGE_HELP = (
    f"{', '.join(list_languages())}, or another that the bank has. "
    f"[default: {FIRST}, or the first that the bank has]"
)
SEED = IntRangeParam(0, LARGEST_SEED)
"""Seeds of papers, decks and previews."""


class BankOptions(TypedDict):
    """The options that name banks."""

    bank: tuple[Path, ...]
    trust: bool
    trust_bank: tuple[Path, ...]


def bank_options(command: Callable[P, T]) -> Callable[P, T]:
    """Return the command with ``--bank``, ``--trust`` and ``--trust-bank``."""
    trust = click.option("--trust", is_flag=True, help="Run the Python of every --bank this time.")
    one = click.option(
        "--trust-bank",
        type=click.Path(path_type=Path),
        multiple=True,
        help="Run the Python of this --bank this time, and of no other one.",
    )
    bank = click.option(
        "--bank",
        type=click.Path(path_type=Path),
        multiple=True,
        help="Another bank: its folder or name; several are mixed.",
    )
    return bank(trust(one(command)))


def open_bank(options: BankOptions) -> Bank:
    """Return the bank that the options name, or several as one."""
    from quizgen.bank.combined import open_banks
    from quizgen.bank.discovery import resolve_bank

    roots = [resolve_bank(named) for named in options["bank"]]
    allowed = _find_trusted_roots(roots, options)
    return open_banks([(str(root), is_trusted(root, allowed)) for root in roots])


def open_sound_bank(options: BankOptions) -> Bank:
    """Return the bank that the options name, without what cannot be asked; that is named once.

    Raises
    ------
    QuizgenError
        If nothing is left.
    """
    from quizgen.bank.bank import builtin_root

    bank = open_bank(options)
    if len(bank.members) == 1 and bank.root == builtin_root():
        return bank
    from quizgen.cli.author_language import explain_error
    from quizgen.lint.broken_templates import leave_out_broken

    sound, broken = leave_out_broken(bank)
    if broken and not len(sound):
        raise next(iter(broken.values()))
    told = {name: explain_error(error) for name, error in broken.items()}
    for said in dict.fromkeys(told.values()):
        names = ", ".join(name for name, one in told.items() if one == said)
        print_message(f"{said}; left out: {names}")
    return sound


def _find_trusted_roots(roots: Sequence[Path], options: BankOptions) -> set[Path]:
    """Return the folders of the banks whose Python the command line trusts.

    Raises
    ------
    click.BadParameter
        If ``--trust-bank`` names a bank that ``--bank`` does not.
    """
    from quizgen.bank.discovery import resolve_bank

    found = {root.resolve() for root in roots}
    if options["trust"]:
        _print_trusted_banks(roots)
        return found
    chosen = {resolve_bank(named).resolve(): named for named in options["trust_bank"]}
    for root, named in chosen.items():
        if root not in found:
            told = ", ".join(map(str, options["bank"])) or "none"
            raise click.BadParameter(
                f"{named} is not among the banks of --bank ({told})", param_hint="--trust-bank"
            )
    return {*chosen}


def _print_trusted_banks(roots: Sequence[Path]) -> None:
    """Print which banks ``--trust`` applies to, if there are several."""
    from quizgen.bank.bank import builtin_root
    from quizgen.bank.discovery import python_files

    ours = builtin_root().resolve()
    bring = [str(root) for root in roots if root.resolve() != ours and python_files(root)]
    if len(bring) > 1:
        said = f"--trust lets the Python of {len(bring)} banks run: {', '.join(bring)}"
        click.echo(f"quizgen: {escape_control_characters(said)}", err=True)


def is_trusted(root: Path, allowed: Collection[Path]) -> bool:
    """Return whether a bank's Python may run: by option, remembered, or confirmed now.

    Where nobody can be asked it is said at once that it does not run.

    Parameters
    ----------
    root : Path
    allowed : collection of Path
        Folders of the banks that the command line trusts.
    """
    from quizgen.bank.bank import builtin_root

    if root.resolve() in {*allowed, builtin_root().resolve()}:
        return True
    from quizgen.bank.discovery import is_trust_remembered, python_files, remember_trust

    files = python_files(root)
    if not files or is_trust_remembered(root):
        return bool(files)
    what = f"{root} brings {format_count(len(files), 'file')} of Python, such as {files[0].name}"
    if not (sys.stdin.isatty() and sys.stderr.isatty()):
        click.echo(
            f"quizgen: {escape_control_characters(what)}; it does not run without --trust", err=True
        )
        return False
    if not click.confirm(f"{what}. Run it, now and until it changes?", default=False, err=True):
        return False
    remember_trust(root)
    return True


def language_option(command: Callable[P, T]) -> Callable[P, T]:
    """Return the command with ``--lang``."""
    return click.option("--lang", type=LanguageParam(), help=LANGUAGE_HELP)(command)


def own_database() -> str:
    """Return the address of the learner's own database."""
    from platformdirs import user_data_path

    return f"sqlite:///{user_data_path('quizgen', ensure_exists=True) / 'learning.sqlite3'}"


def database_option(command: Callable[P, T]) -> Callable[P, T]:
    """Return the command with ``--database``."""
    return click.option(
        "--database",
        metavar="ADDRESS",
        default=own_database,
        help="Where to keep what is done: sqlite:///FILE, postgresql+psycopg://...",
    )(command)


def level_option(command: Callable[P, T]) -> Callable[P, T]:
    """Return the command with ``--level``."""
    kind = click.Choice(CHOICES, case_sensitive=False)
    return click.option(
        "--level", type=kind, default=EXAM, show_default=True, help=LEVEL_HELP
    )(command)  # fmt: skip


def jobs_option(command: Callable[P, T]) -> Callable[P, T]:
    """Return the command with ``--jobs``."""
    return click.option(
        "--jobs", type=IntRangeParam(1, MOST_JOBS), help="Processes. [default: as many as pay]"
    )(command)


def worthwhile_processes(asked: int | None, seconds: float) -> int:
    """Return the processes to start: as requested, else no more than the work is worth.

    Parameters
    ----------
    asked : int or None
    seconds : float
        What the work takes one process, about.
    """
    return asked or max(1, min(os.cpu_count() or 1, int(seconds / WORTH)))


def match_choice(option: str, name: str, allowed: Collection[str]) -> str:
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


def resolve_topic(bank: Bank, name: str) -> str:
    """Return the topic that ``--topic`` names: by its name or its title in any language.

    Raises
    ------
    click.BadParameter
        If there is none; it names all.
    """
    wanted = name.strip().casefold()
    for topic in bank.topics:
        titles = (bank.topic_title(topic, lang) for lang in list_languages())
        if wanted in {title.casefold() for title in titles}:
            return topic
    return match_choice("--topic", name, bank.topics)


def split_names(text: str | None) -> tuple[str, ...]:
    """Return the names in a comma-separated text."""
    return tuple(name.strip() for name in (text or "").split(",") if name.strip())
