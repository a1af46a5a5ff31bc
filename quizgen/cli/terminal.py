"""What commands share of a terminal: its width, wrapping, colours, progress, harmless text."""

from __future__ import annotations

import os
import re
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from types import FrameType, TracebackType
from typing import Self

import click

from quizgen.columns import is_wide, width
from quizgen.core.untrusted import escape_control_characters

NARROWEST = 20
"""Columns that text is laid out for at least."""
_BLANKS = re.compile(r"[ \t\n]+")
"""Where a line may break; not at a no-break space."""
GAP = "  "
"""Between the columns of a table."""
READABLE = 20
"""Columns below which a text beside others is not squeezed."""
PATIENCE = 1.0
"""Seconds before progress is shown."""


def columns() -> int:
    """Width of the terminal; 80 where there is none."""
    return max(shutil.get_terminal_size((80, 24)).columns, NARROWEST)


def on_terminal() -> bool:
    """Whether people read along; otherwise what is printed goes to a file or a program."""
    return sys.stdout.isatty()


class Interrupt:
    """Handles Ctrl-C and remembers it, for it may come out of an extension as any other error."""

    came = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Stop whatever is running; a second Ctrl-C has nothing left to stop."""
        del number, frame
        if not self.came:
            self.came = True
            raise KeyboardInterrupt


def interrupted() -> bool:
    """Whether Ctrl-C has come."""
    handler = signal.getsignal(signal.SIGINT)
    return isinstance(handler, Interrupt) and handler.came


def colour_choice() -> bool | None:
    """``False`` where the environment asks for plain text; ``None`` leaves it to the stream.

    ``click`` takes it from the context of the outermost command, for every ``echo`` below it.
    """
    plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    return False if plain else None


def wrapped(text: str, room: int, first: str = "", rest: str = "") -> Iterator[str]:
    """Lines of a text, broken between words.

    Parameters
    ----------
    text : str
        A word that is longer than a line stays whole; characters of double width may part.
    room : int
        Columns of a line.
    first, rest : str
        What the first line and the others begin with.
    """
    line, used, empty = first, width(first), True
    for glue, piece in _pieces(text):
        more = width(piece)
        if not empty and used + len(glue) + more > room:
            yield line.rstrip(" ")
            line, used, empty = rest, width(rest), True
        if not empty:
            line, used = line + glue, used + len(glue)
        line, used, empty = line + piece, used + more, False
    yield line.rstrip(" ")


def _pieces(text: str) -> Iterator[tuple[str, str]]:
    """What may stand on a line of its own, and the blank in front of it."""
    for word in filter(None, _BLANKS.split(text)):
        glue = " "
        for piece in _unbreakable(word):
            yield glue, piece
            glue = ""


def _unbreakable(word: str) -> Iterator[str]:
    piece = ""
    for character in word:
        if piece and is_wide(character):
            yield piece
            piece = ""
        piece += character
    yield piece


def one_line(text: str) -> str:
    """A text without line breaks and other control characters, as a cell of a table."""
    return escape_control_characters(" ".join(text.split()))


def print_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print aligned columns; on a terminal the last one is wrapped, or stands below the others."""
    body = [[one_line(cell) for cell in row] for row in rows]
    sizes = [max(map(len, column)) for column in zip(head, *body, strict=True)][:-1]
    room = columns() if on_terminal() else sys.maxsize
    for number, row in enumerate([head, *body]):
        for line in _row_lines(row, sizes, room):
            click.echo(line if number else click.style(line, bold=True))


def _row_lines(row: Sequence[str], sizes: Sequence[int], room: int) -> Iterator[str]:
    cells = "".join(f"{cell:{size}}{GAP}" for cell, size in zip(row, sizes, strict=False))
    if room - len(cells) >= READABLE:
        yield from wrapped(row[-1], room, cells, " " * len(cells))
        return
    line = cells.rstrip()
    yield from [line] if len(line) <= room else wrapped(line, room, "", GAP)
    if row[-1]:
        yield from wrapped(row[-1], room, GAP * 2, GAP * 2)


def many(count: int, word: str) -> str:
    """How many of something there are: ``1 question``, ``2 questions``."""
    return f"{count} {word}" + ("s" if count != 1 else "")


def tell(text: str) -> None:
    """Print a sentence; on a terminal it is broken between words."""
    for line in wrapped(
        escape_control_characters(text), columns() if on_terminal() else sys.maxsize
    ):
        click.echo(line)


class Progress:
    """One line on the error stream, if that is a terminal and it takes longer than a second.

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
        self._shown = 0
        self._start = clock()

    def __call__(self, name: str) -> None:
        """Tell what is done now."""
        self.done += 1
        if self.clock() - self._start < PATIENCE or not sys.stderr.isatty():
            return
        count = f"{self.done}/{self.total}" if self.total else f"{self.done}"
        self._overwrite(escape_control_characters(f"{self.what} {count} {name}")[: columns() - 1])

    def _overwrite(self, line: str) -> None:
        click.echo(f"\r{line.ljust(self._shown)}\r{line}", nl=False, err=True)
        self._shown = len(line)

    def over(self, things: Iterable[str]) -> Iterator[str]:
        """Things in their order, each told as it comes."""
        for thing in things:
            self(thing)
            yield thing

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the line as it was."""
        if self._shown:
            self._overwrite("")
