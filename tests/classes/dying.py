"""Work that kills the process that does it, once."""

from __future__ import annotations

import os
import signal
from functools import partial
from pathlib import Path

from quizgen.executors import Processes


def once_dead(mark: Path, work, *arguments):
    """Die of the first job; do all others."""
    try:
        mark.touch(exist_ok=False)
    except FileExistsError:
        return work(*arguments)
    os.kill(os.getpid(), signal.SIGKILL)
    return None


def always_dead(*_arguments):
    os.kill(os.getpid(), signal.SIGKILL)


class Mortal(Processes):
    """Processes of which the first one dies of its first job."""

    def __init__(self, count: int, mark: Path) -> None:
        super().__init__(count)
        self.mark = mark

    def submit(self, fn, /, *args, **kwargs):
        return super().submit(partial(once_dead, self.mark, fn), *args, **kwargs)
