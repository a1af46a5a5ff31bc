"""``quizgen class admit`` and ``open``: an exam of a class in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import TypedDict, Unpack

import click

from quizgen.cli.options import MOST_JOBS, IntRangeParam, LanguageParam
from quizgen.cli.terminal import print_sentence
from quizgen.core.errors import require_extra
from quizgen.locale import FIRST

_folder = click.argument("folder", type=click.Path(path_type=Path))


class ClassOpenOptions(TypedDict):
    """Options of ``quizgen class open``."""

    folder: Path
    port: int
    show: bool
    host: str
    names: tuple[str, ...]
    behind_proxy: bool
    invite: bool
    database: str | None
    workers: int
    log_form: str


@click.command()
@_folder
@click.option("--address", required=True, help="Of the server: https://exam.school.example.")
@click.option("--lang", type=LanguageParam(), default=FIRST, help="Of the cards.")
def admit(folder: Path, address: str, lang: str) -> None:
    """Write cards with the codes by which the class in FOLDER comes into the exam in the browser.

    lists/admission.pdf has eight on a page, in the order of the seats. Each code works once. With
    safe_exam_browser = true in exam.toml it also writes lists/exam.seb, which students open.
    """
    from quizgen.classes.admission import write_admission_files
    from quizgen.classes.class_folder import ClassFolder

    if not address.startswith(("http://", "https://")) or len(address) > 200:
        raise click.BadParameter("begins with http:// or https://", param_hint="--address")
    for path in write_admission_files(ClassFolder(folder), address.rstrip("/"), lang):
        print_sentence(str(path))
    print_sentence(f"The exam: quizgen class open {folder}")


@click.command("open")
@_folder
@click.option("--port", type=IntRangeParam(0, 65535), default=0,
              help="Port; if left out the one of the first time, or a free one.")  # fmt: skip
@click.option(
    "--host",
    metavar="ADDRESS",
    default="0.0.0.0",  # noqa: S104 - whom it is for
    help="Where to listen. [default: for everybody in the network]",
)
@click.option("--name", "names", metavar="NAME", multiple=True,
              help="A further name under which the server is asked; may be repeated.")  # fmt: skip
@click.option("--behind-proxy", is_flag=True,
              help="A web server on this machine hands on the requests, with https.")  # fmt: skip
@click.option("--invite", is_flag=True, help="Print an invitation for one more supervisor.")
@click.option("--open/--no-open", "show", default=True, help="Open the browser.")
@click.option(
    "--database",
    metavar="ADDRESS",
    default=None,
    help="Where answers are kept until they are handed in. [default: in FOLDER]",
)
@click.option("--workers", type=IntRangeParam(1, MOST_JOBS), default=2,
              help="Processes that make papers. [default: 2]")  # fmt: skip
@click.option("--log", "log_form", type=click.Choice(("plain", "json")), default="plain",
              help="How what goes wrong is written to the standard error.")  # fmt: skip
def open_(**options: Unpack[ClassOpenOptions]) -> None:
    """Let the class in FOLDER sit its exam in the browser: own papers, own time, one code each.

    Who opens the printed link first supervises: who is in, last saves, more time, pauses, an end.
    What is handed in lands in the folder, for class mark. Started again, it goes on where it was.
    """
    require_extra("web", "quizgen class open")
    from quizgen.classes.class_folder import ClassFolder
    from quizgen.classes.generation import open_class_bank
    from quizgen.classes.seats import DATABASE
    from quizgen.web.server import run_server
    from quizgen.web.settings import ServerSettings

    folder = options["folder"]
    bank = open_class_bank(ClassFolder(folder).settings)
    settings = ServerSettings(
        options["database"] or f"sqlite:///{folder / DATABASE}",
        bank,
        host="127.0.0.1" if options["behind_proxy"] else options["host"],
        names=tuple(name.lower() for name in options["names"]),
        behind_proxy=options["behind_proxy"],
        workers=options["workers"],
        class_exam=folder,
    )
    run_server(
        settings, options["port"], show=options["show"], tell=click.echo,
        invite=options["invite"], log_form=options["log_form"],
    )  # fmt: skip


COMMANDS = (admit, open_)
