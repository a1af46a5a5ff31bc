"""The command line: thin commands, each loading only what it needs when it runs."""

from __future__ import annotations

import contextlib
import io
import os
import signal
import sys
from importlib import import_module
from keyword import iskeyword
from typing import NoReturn

import click

from quizgen.cli.terminal import InterruptHandler, colour_choice, print_message, was_interrupted
from quizgen.core.errors import QuizgenError
from quizgen.core.untrusted import escape_control_characters

WRONG = 2
"""Exit code of wrong use, and of files that cannot be read or written."""
INTERRUPTED = 130
"""Exit code after Ctrl-C: 128 and the number of the signal, as shells have it."""

COMMANDS = {
    "exam": ("quizgen.cli.exam", "Make a mock exam with solutions and key."),
    "check": ("quizgen.cli.check", "Mark typed answers with a paper's key."),
    "practice": ("quizgen.cli.practice", "Practise in the terminal with instant feedback."),
    "class": ("quizgen.cli.classes", "Examine a class: a paper for each student."),
    "mark": ("quizgen.cli.mark", "Mark one answer, or JSON Lines of answers (for authors)."),
    "cards": ("quizgen.cli.cards", "Make flashcards for Anki and other programs."),
    "sheet": ("quizgen.cli.sheet", "Write the formulas of the chapter on a sheet."),
    "export": ("quizgen.cli.export", "Write questions for Moodle, Canvas or QTI."),
    "serve": ("quizgen.cli.serve", "Practise and sit the exam in a browser."),
    "templates": ("quizgen.cli.templates", "List the templates of the bank."),
    "preview": ("quizgen.cli.preview", "Show one question with its solution."),
    "banks": ("quizgen.cli.banks", "List the banks there are."),
    "new": ("quizgen.cli.new", "Begin a bank or a question of one's own."),
    "lint": ("quizgen.cli.lint", "Prove templates sound over many seeds."),
    "schema": ("quizgen.cli.schema", "Print what editors check bank files by."),
    "doctor": ("quizgen.cli.doctor", "Check fonts, glyphs and versions."),
    "simulate": (
        "quizgen.cli.simulate",
        "Photograph a scene with what is asked, and say what was left out.",
    ),
    "tradeoff": ("quizgen.cli.tradeoff", "Show what accuracy costs in time."),
}
"""Command name to the module that holds it and its one-line help."""


class _Lazy(click.Group):
    """A group that imports a command's module only when the command runs."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands, in the order of the help."""
        del ctx
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, imported only now; None if there is none."""
        del ctx
        if cmd_name not in COMMANDS:
            return None
        module = import_module(COMMANDS[cmd_name][0])
        name = f"{cmd_name}_" if iskeyword(cmd_name) else cmd_name
        command: click.Command = getattr(module, name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return a command and its arguments; end with all names for an unknown one."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            ctx.fail(f"no command {args[0]!r} (there are {', '.join(COMMANDS)})")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands without importing any."""
        del ctx
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in COMMANDS.items()])


DECIDING = ("matplotlib", "typst", "fontpkg-hind-siliguri")
"""Packages whose version decides the bytes of a paper; a wheel fixes them for who installs it."""


def _print_version(context: click.Context, _option: click.Parameter, wanted: bool) -> None:
    """Print our version and those that decide bytes, and end."""
    if wanted and not context.resilient_parsing:
        from importlib.metadata import version

        others = ", ".join(f"{name} {version(name)}" for name in DECIDING)
        click.echo(f"quizgen {version('quizgen')} ({others}, Python {sys.version.split()[0]})")
        context.exit()


@click.group(cls=_Lazy, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the versions that decide what is made.",
)
@click.pass_context
def root_group(context: click.Context) -> None:
    """Mock exams from parametric templates: exact solutions, figures, typed answers checked.

    Exit codes: 0 all went well, 1 something was found (a problem, a form that cannot be read), 2
    wrong use or a file that cannot be read or written, 130 interrupted by Ctrl-C. NO_COLOR=1
    switches colours off.
    """
    context.color = colour_choice()


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; every expected error is one line and exit code 2."""
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, InterruptHandler())
    try:
        status = _run_command(arguments)
    except (click.exceptions.Abort, KeyboardInterrupt):
        _stop_at_once()
    except Exception:
        if not was_interrupted():
            raise
        _stop_at_once()
    if status:
        sys.exit(status)


def _run_command(arguments: list[str] | None) -> int:
    """Return the exit code of a command; print expected errors in one line."""
    try:
        status = root_group.main(arguments, prog_name="quizgen", standalone_mode=False)
    except click.exceptions.Abort:
        raise
    except click.ClickException as error:
        shown = io.StringIO()
        error.show(shown)
        click.echo(escape_control_characters(shown.getvalue()), nl=False, err=True)
    except QuizgenError as error:
        from quizgen.cli.author_language import explain_error

        print_message(explain_error(error, arguments))
    except BrokenPipeError:
        sys.stderr.close()
    except OSError as error:
        print_message(f"{error.filename or 'file'}: {error.strerror or error}")
    else:
        return status if isinstance(status, int) else 0
    return WRONG


def _stop_at_once() -> NoReturn:
    """Print that it was interrupted and end the process: extensions may hang in finalisers."""
    with contextlib.suppress(OSError, ValueError):
        print_message("interrupted")
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(INTERRUPTED)
