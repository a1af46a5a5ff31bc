"""What commands share of a terminal: its width, wrapping, colours, progress, harmless text."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Self

import click

from quizgen.core.text_width import lay_out_table, wrap_lines
from quizgen.core.untrusted import escape_control_characters

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress


NARROWEST = 20
"""Columns that text is laid out for at least."""
SHOWN = 20
"""Lines of a list that the terminal shows; the files have all."""
PATIENCE = 1.0
"""Seconds before progress is shown."""
LONGEST_MESSAGE = 1500
"""Characters of a message: what a damaged file holds may be longer than any screen."""


def terminal_width() -> int:
    """Return the columns of the terminal; 80 if there is none."""
    return max(shutil.get_terminal_size((80, 24)).columns, NARROWEST)


def is_interactive() -> bool:
    """Return whether the output goes to a terminal rather than to a file or program."""
    return sys.stdout.isatty()


class InterruptHandler:
    """Raises ``KeyboardInterrupt`` once, and remembers it.

    An extension may turn it into any other error.
    """

    came = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Interrupt what is running; later signals do nothing."""
        del number, frame
        if not self.came:
            self.came = True
            raise KeyboardInterrupt


def was_interrupted() -> bool:
    """Return whether Ctrl-C was pressed."""
    handler = signal.getsignal(signal.SIGINT)
    return isinstance(handler, InterruptHandler) and handler.came


def colour_choice() -> bool | None:
    """Return False if the environment asks for plain text, else None: the stream decides.

    ``click`` takes it from the context of the outermost command, for every ``echo`` in it.
    """
    plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    return False if plain else None


def to_one_line(text: str) -> str:
    """Return a text without line breaks and control characters, for a cell of a table."""
    return escape_control_characters(" ".join(text.split()))


def print_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print aligned columns; on a terminal the last one is wrapped, or stands below the others."""
    table = [head, *([to_one_line(cell) for cell in row] for row in rows)]
    for number, lines in enumerate(lay_out_table(table, _get_wrap_width())):
        for line in lines:
            click.echo(line if number else click.style(line, bold=True))


def _get_wrap_width() -> int:
    """Return the columns to wrap at; without a terminal nothing is wrapped."""
    return terminal_width() if is_interactive() else sys.maxsize


def format_count(count: int, word: str) -> str:
    """Return a count with its noun: ``1 question``, ``2 questions``."""
    return f"{count} {word}" + ("s" if count != 1 else "")


def print_sentence(text: str) -> None:
    """Print a sentence; on a terminal it is broken between words."""
    for line in wrap_lines(escape_control_characters(text), _get_wrap_width()):
        click.echo(line)


def print_message(message: str) -> None:
    """Print a message in one line on the error stream."""
    click.echo(f"quizgen: {shorten_message(' '.join(message.split()))}", err=True)


def shorten_message(message: str) -> str:
    """Return a message without control characters; what is too long loses its middle."""
    shown = escape_control_characters(message)
    if len(shown) <= LONGEST_MESSAGE:
        return shown
    return f"{shown[: LONGEST_MESSAGE - 200]} ... {shown[-200:]}"


def print_list(head: str, lines: Sequence[str]) -> None:
    """Print a heading and at most ``SHOWN`` lines; nothing without lines."""
    if not lines:
        return
    print_sentence(f"{head}:")
    for line in lines[:SHOWN]:
        print_sentence(to_one_line(line))
    if len(lines) > SHOWN:
        print_sentence(f"... and {len(lines) - SHOWN} more")


class ProgressLine:
    """A progress line on the error stream.

    It appears on a terminal, and only for work of more than a second.

    Parameters
    ----------
    what : str
        What is being done.
    total : int
        How many steps there are; 0 if that is not known.
    clock : callable
        Seconds.
    """

    def __init__(
        self, what: str, total: int = 0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.what, self.total, self.clock = what, total, clock
        self.done = 0
        self._bar: RichProgress | None = None
        self._start = clock()

    def __call__(self, name: str) -> None:
        """Count one step and show its name."""
        self.done += 1
        if self.clock() - self._start < PATIENCE or not _can_overwrite():
            return
        if self._bar is None:
            self._bar = _open_progress(self.what, self.total)
        task = self._bar.task_ids[0]
        self._bar.update(
            task, completed=self.done, now=escape_control_characters(name), refresh=True
        )

    def over(self, things: Iterable[str]) -> Iterator[str]:
        """Yield the names in order, and count each as a step."""
        for thing in things:
            self(thing)
            yield thing

    def __enter__(self) -> Self:
        """Return the line itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Remove the line from the terminal."""
        if self._bar:
            self._bar.stop()


def _can_overwrite() -> bool:
    """Return whether the error stream is a terminal that can overwrite a line."""
    return sys.stderr.isatty() and os.environ.get("TERM") != "dumb"


def _open_progress(what: str, total: int) -> RichProgress:
    """Return a progress display; without ``total`` it has no bar."""
    # Loaded where a line is shown: it takes longer than all else that most commands load.
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    # No thread that redraws: work that is timed would share its processor.
    line = Progress(
        TextColumn("{task.description}", markup=False),
        *([BarColumn(20), MofNCompleteColumn()] if total else [TextColumn("{task.completed}")]),
        TextColumn("{task.fields[now]}", markup=False),
        console=Console(stderr=True),
        auto_refresh=False,
        redirect_stdout=False,
        redirect_stderr=False,
        transient=True,
    )
    line.add_task(what, total=total or None, now="")
    line.start()
    return line


def build_command_line(*arguments: str | Path) -> str:
    """Return a quizgen command that works in the user's current folder."""
    return join_words([*_find_start_command(), *map(str, arguments)])


def join_words(words: list[str]) -> str:
    """Return words as one line for the shell, quoted where needed."""
    if os.name == "nt":
        from subprocess import list2cmdline

        return list2cmdline(words)
    return shlex.join(words)


def _find_start_command() -> list[str]:
    """Return the words that started this program: by uv, as a module, or by name."""
    if os.environ.get("UV_RUN_RECURSION_DEPTH"):
        return ["uv", "run", *_list_project_options(), "quizgen"]
    script = Path(sys.argv[0])
    if script.name == "__main__.py":
        return [_shorten_program(Path(sys.executable)), "-m", "quizgen"]
    return [_shorten_program(script) if script.stem == "quizgen" else "quizgen"]


def _list_project_options() -> list[str]:
    """Return the option that uv needs outside the project's folder; none inside."""
    home = Path(sys.prefix).parent
    inside = Path.cwd().is_relative_to(home) or not (home / "pyproject.toml").exists()
    return [] if inside else ["--project", str(home)]


def _shorten_program(program: Path) -> str:
    """Return a program's name if the shell finds the same one by it, else its path."""
    found = shutil.which(program.name)
    return program.name if found and Path(found).samefile(program) else str(program)
