"""``quizgen serve``."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.lint import lint_while_writing
from quizgen.cli.options import (
    MOST_JOBS,
    BankOptions,
    IntRangeParam,
    bank_options,
    database_option,
    open_sound_bank,
)
from quizgen.core.errors import require_extra

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank


MOST_AHEAD = 5000
"""Papers of a blueprint that are made ahead: each takes a third of a megabyte of the database."""


def _parse_papers_ahead(
    _context: click.Context, _option: click.Parameter, given: tuple[str, ...]
) -> tuple[tuple[str, int], ...]:
    """Return blueprints or topics, and how many papers of each; the bank says which there are."""
    return tuple(map(_parse_one_ahead, given))


def _parse_one_ahead(text: str) -> tuple[str, int]:
    """Return a blueprint and how many papers of it to make ahead, from ``mock=300``.

    Raises ``click.BadParameter`` if it is not written so, or if the number is out of bounds.
    """
    name, _, number = text.rpartition("=")
    if not name or not re.fullmatch("[0-9]{1,4}", number, re.ASCII):
        raise click.BadParameter(f"{text!r} is not like mock=300")
    if not 1 <= int(number) <= MOST_AHEAD:
        raise click.BadParameter(f"{text!r}: 1 to {MOST_AHEAD} papers")
    return name, int(number)


class ServeOptions(BankOptions):
    """Options of ``quizgen serve``."""

    port: int
    show: bool
    host: str
    names: tuple[str, ...]
    behind_proxy: bool
    phone: bool
    invite: bool
    database: str
    workers: int
    papers_ahead: tuple[tuple[str, int], ...]
    log_form: str
    backup: Path | None
    author: bool
    classroom: Path | None


@click.command()
@click.option(
    "--port",
    type=IntRangeParam(0, 65535),
    default=0,
    help="Port; if left out the one of the first time, or a free one.",
)
@click.option(
    "--host",
    metavar="ADDRESS",
    default="127.0.0.1",
    help="Where to listen: 0.0.0.0 for everybody in the network, who then sign in.",
)
@click.option(
    "--name",
    "names",
    metavar="NAME",
    multiple=True,
    help="A further name under which the server is asked; may be repeated.",
)
@click.option(
    "--behind-proxy",
    is_flag=True,
    help="A web server on this machine hands on the requests, with https; people sign in.",
)
@click.option(
    "--phone",
    is_flag=True,
    help="Go on with a phone of the same network, as the same learner: it scans a code once.",
)
@click.option("--invite", is_flag=True, help="Print an invitation for one more who manages.")
@click.option("--open/--no-open", "show", default=True, help="Open the browser.")
@database_option
@click.option(
    "--workers",
    type=IntRangeParam(1, MOST_JOBS),
    default=2,
    help="Processes that make questions and mark exams. [default: 2]",
)
@click.option(
    "--papers-ahead",
    metavar="NAME=NUMBER",
    multiple=True,
    callback=_parse_papers_ahead,
    help="Papers to make ahead, such as mock=300: who begins waits for none; may be repeated.",
)
@click.option(
    "--log",
    "log_form",
    type=click.Choice(("plain", "json")),
    default="plain",
    help="How what goes wrong and who signs in is written to the standard error.",
)
@click.option(
    "--backup",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Copy the database of a server, which may be running, and end.",
)
@click.option(
    "--author", is_flag=True, help="Show every template with its solution, as it is saved."
)
@click.option(
    "--class",
    "classroom",
    type=click.Path(path_type=Path, file_okay=False, exists=True),
    help="Folder of a class: mark there what no program can; who signs in is named as a marker.",
)
@bank_options
def serve(**options: Unpack[ServeOptions]) -> None:
    """Practise and sit the exam in a browser: alone, or with everybody in the network."""
    require_extra("web", "quizgen serve")
    if options["classroom"]:
        require_extra("class", "quizgen serve --class")
    if options["backup"]:
        from quizgen.store.database import back_up

        back_up(options["database"], options["backup"])
        click.echo(f"{options['backup']}: written")
        return
    from quizgen.web.settings import EVERYWHERE, LOCAL, ServerSettings

    if options["phone"] and (options["behind_proxy"] or options["host"] != LOCAL[0]):
        raise click.UsageError("--phone: one learner alone; with --host people sign in")
    settings = ServerSettings(
        options["database"],
        open_sound_bank(options),
        host=EVERYWHERE if options["phone"] else options["host"],
        names=tuple(name.lower() for name in options["names"]),
        behind_proxy=options["behind_proxy"],
        phone=options["phone"],
        examine=lint_while_writing if options["author"] else None,
        classroom=options["classroom"],
        workers=options["workers"],
        papers_ahead=options["papers_ahead"],
    )
    _check_blueprints(settings.bank, options["papers_ahead"])
    if (settings.accounts or settings.phone) and options["author"]:
        raise click.UsageError("--author shows every solution: on this machine alone")
    if settings.phone and options["classroom"]:
        raise click.UsageError("--class shows names and keys: with --phone nobody signs in")
    if options["invite"] and not settings.accounts:
        raise click.UsageError("--invite: nobody signs in; see --host")
    from quizgen.web.server import run_server

    run_server(
        settings, options["port"], show=options["show"], tell=click.echo,
        invite=options["invite"], log_form=options["log_form"],
    )  # fmt: skip


def _check_blueprints(bank: Bank, wanted: tuple[tuple[str, int], ...]) -> None:
    """Refuse papers of what the bank has not, and two numbers for one blueprint."""
    if not wanted:
        return
    from quizgen.paper.blueprint import find_blueprint

    names = [name for name, _ in wanted]
    for name in names:
        if find_blueprint(name, bank) is None:
            known = ", ".join((*bank.blueprints, *bank.topics))
            raise click.UsageError(f"--papers-ahead: no blueprint {name!r} ({known})")
        if names.count(name) > 1:
            raise click.UsageError(f"--papers-ahead: {name} stands there twice")
