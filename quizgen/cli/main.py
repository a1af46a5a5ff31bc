"""The command line: thin commands, each loading only what it needs when it runs."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

import click

from quizgen.errors import QuizgenError

COMMANDS = {
    "exam": ("quizgen.cli.exam", "Make a mock exam with solutions and key."),
    "check": ("quizgen.cli.check", "Mark typed answers with a paper's key."),
    "practice": ("quizgen.cli.practice", "Practise in the terminal with instant feedback."),
    "mark": ("quizgen.cli.mark", "Mark one answer, or JSON Lines of answers (for authors)."),
    "cards": ("quizgen.cli.cards", "Make flashcards for Anki and other programs."),
    "templates": ("quizgen.cli.templates", "List the templates of the bank."),
    "preview": ("quizgen.cli.preview", "Show one question with its solution."),
    "lint": ("quizgen.cli.lint", "Prove templates sound over many seeds."),
    "doctor": ("quizgen.cli.doctor", "Check fonts, glyphs and versions."),
    "simulate": ("quizgen.cli.simulate", "Photograph a scene, running only the effects it needs."),
    "tradeoff": ("quizgen.cli.tradeoff", "Show what accuracy costs in time."),
}
"""Command name to the module that holds it and its one-line help."""


class _Lazy(click.Group):
    """A group that imports a command's module only when the command runs."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        del ctx
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        del ctx
        if cmd_name not in COMMANDS:
            return None
        module = import_module(COMMANDS[cmd_name][0])
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        del ctx
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in COMMANDS.items()])


@click.group(cls=_Lazy, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="quizgen")
def group() -> None:
    """Mock exams from parametric templates: exact solutions, figures, typed answers checked."""


def main(arguments: list[str] | None = None) -> Any:
    """Run the command line; every expected error is one line and exit code 2."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    try:
        return group.main(arguments, prog_name="quizgen", standalone_mode=False)
    except click.exceptions.Abort:
        _fail("interrupted; nothing was written")
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except QuizgenError as error:
        _fail(str(error))
    except (BrokenPipeError, KeyboardInterrupt):
        sys.stderr.close()
        sys.exit(2)
    except OSError as error:
        _fail(f"{error.filename or 'file'}: {error.strerror or error}")


def _fail(message: str) -> None:
    click.echo(f"quizgen: {' '.join(message.split())}", err=True)
    sys.exit(2)
