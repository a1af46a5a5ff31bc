"""``quizgen serve``."""

from __future__ import annotations

from pathlib import Path
from typing import Unpack

import click

from quizgen.cli.lint import lint_while_writing
from quizgen.cli.options import (
    MOST_JOBS,
    BankOptions,
    IntRangeParam,
    bank_options,
    database_option,
    open_bank,
)
from quizgen.core.errors import require_extra


class ServeOptions(BankOptions):
    """Options of ``quizgen serve``."""

    port: int
    show: bool
    host: str
    names: tuple[str, ...]
    behind_proxy: bool
    invite: bool
    database: str
    workers: int
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
    help="Folder of a class: decide there what no program can.",
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
    from quizgen.web.settings import ServerSettings

    settings = ServerSettings(
        options["database"],
        open_bank(options),
        host=options["host"],
        names=tuple(name.lower() for name in options["names"]),
        behind_proxy=options["behind_proxy"],
        examine=lint_while_writing if options["author"] else None,
        classroom=options["classroom"],
        workers=options["workers"],
    )
    if settings.accounts and options["author"]:
        raise click.UsageError("--author shows every solution: on this machine alone")
    if settings.accounts and options["classroom"]:
        raise click.UsageError("--class shows names and keys: on this machine alone")
    if options["invite"] and not settings.accounts:
        raise click.UsageError("--invite: nobody signs in; see --host")
    from quizgen.web.server import run_server

    run_server(
        settings, options["port"], show=options["show"], tell=click.echo,
        invite=options["invite"], log_form=options["log_form"],
    )  # fmt: skip
