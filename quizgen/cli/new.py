"""``quizgen new``: a bank or a question to begin with."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import ParamSpec, TypeVar

import click

from quizgen.bank.scaffold import (
    FIRST,
    KINDS,
    english_translation_files,
    scaffold_bank,
    scaffold_language,
    scaffold_package,
    scaffold_template,
)
from quizgen.cli.options import LanguageParam
from quizgen.cli.terminal import build_command_line
from quizgen.core.errors import BankError
from quizgen.core.files import write_all
from quizgen.core.untrusted import NAMES, is_identifier

_SCHEMA = re.compile(rb"\A#:schema .*\n")

P = ParamSpec("P")
T = TypeVar("T")


def bank_to_write(function: Callable[P, T]) -> Callable[P, T]:
    """Return the command with ``--bank``, a folder to write into."""
    function = click.option("--trust", is_flag=True, expose_value=False,
                            help="As everywhere beside --bank; nothing of the bank runs here.")(
                                function)  # fmt: skip
    return click.option("--bank", "root", type=click.Path(path_type=Path), default=Path(),
                        help="The bank to write it into (by default where you stand).")(
                            function)  # fmt: skip


@click.group()
def new() -> None:
    """Write a bank or a question to begin with: sound as it is, and to be changed."""


@new.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--lang",
    "langs",
    type=LanguageParam(),
    multiple=True,
    default=("en",),
    show_default=True,
    help="A language that it is to be written in (may be repeated).",
)
@click.option(
    "--package", is_flag=True, help="As a package to be installed and published, with a CI file."
)
def bank(folder: Path, langs: tuple[str, ...], package: bool) -> None:
    """Write a bank with one question into FOLDER."""
    name = folder.resolve().name
    if not is_identifier(name):
        raise BankError(
            f"{name!r} is no name for a bank (allowed: {NAMES}); make it in a folder that has one,"
            " and call the folder as you like afterwards"
        )
    inside, found = scaffold_package(name, langs) if package else ("", scaffold_bank(name, langs))
    _write_new_files(folder, found)
    _print_next_steps(folder / inside, FIRST[1])
    if package:
        click.echo(f"  pip install -e {folder}    (then --bank {name} finds it)")


@new.command()
@click.argument("lang", type=LanguageParam())
@bank_to_write
@click.option("--all", "words", is_flag=True,
              help="With everything that quizgen says, in English, to be translated.")  # fmt: skip
def language(lang: str, root: Path, words: bool) -> None:
    """Write into a bank what quizgen does not know of the language LANG."""
    from quizgen.bank.bank import Bank
    from quizgen.locale import SHIPPED

    Bank(root)  # or says that none is there
    if (SHIPPED / lang).is_dir():
        raise BankError(f"quizgen has words for {lang!r} itself")
    found = scaffold_language(lang)
    if words:
        found = {name: data for name, data in found.items() if not (root / name).exists()}
        found |= english_translation_files(lang)
    _write_new_files(root, found)


def _add_kind_options(function: Callable[P, T]) -> Callable[P, T]:
    """Return the command with a flag for each kind of question."""
    for kind, text in reversed(KINDS.items()):
        function = click.option(f"--{kind}", "kind", flag_value=kind, help=text)(function)
    return function


@new.command()
@click.argument("place", metavar="TOPIC/NAME")
@_add_kind_options
@bank_to_write
def template(place: str, kind: str | None, root: Path) -> None:
    """Write a question TOPIC/NAME into a bank: rules, words and, if it computes, a solver."""
    from quizgen.bank.bank import Bank

    topic, slash, name = place.partition("/")
    if not slash:
        raise BankError(f"{place!r} has no topic before it; write TOPIC/{place}")
    _require_name(topic)
    _require_name(name)
    own = Bank(root)
    if own.metadata.topics and topic not in own.topics:
        file, known = own.folder / "bank.toml", ", ".join(own.topics)
        raise BankError(
            f"{file}: no topic {topic!r} (there are {known}); write it under [topics] first"
        )
    if name in own.template_paths:
        raise BankError(f"{own.template_paths[name]}: there is a template {name!r} already")
    made = scaffold_template(topic, name, kind or next(iter(KINDS)), own.languages or ("en",))
    if not (root / "schemas").is_dir():  # as in a checkout: editors would look for it in vain
        made = {path: _SCHEMA.sub(b"", text) for path, text in made.items()}
    _write_new_files(root, made)
    _print_next_steps(root, name)


def _require_name(name: str) -> None:
    """Raise ``BankError`` unless a name is allowed in banks."""
    if not is_identifier(name):
        raise BankError(f"{name!r} is no name (allowed: {NAMES})")


def _write_new_files(root: Path, contents: Mapping[str, bytes]) -> None:
    """Write all files, or none if one exists already; print their paths."""
    for name in contents:
        if (root / name).exists():
            raise BankError(f"{root / name}: there already; nothing was written")
    for path in write_all(root, contents):
        click.echo(str(path))


def _print_next_steps(root: Path, name: str) -> None:
    """Print the commands to go on with."""
    where = ("--bank", str(root), "--trust")
    click.echo("Next:")
    click.echo(f"  {build_command_line('preview', name, *where)}")
    click.echo(f"  {build_command_line('lint', *where)}")
