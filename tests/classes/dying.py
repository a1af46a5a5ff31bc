"""Work that kills the process that does it, once."""

from __future__ import annotations

import os
import signal
import threading
from functools import partial
from pathlib import Path

from quizgen.core.executor import ProcessExecutor


def once_dead(mark: Path, work, *arguments):
    """Die of the first job; do all others."""
    try:
        mark.touch(exist_ok=False)
    except FileExistsError:
        return work(*arguments)
    os.kill(os.getpid(), signal.SIGKILL)
    return None


class Long:
    """An answer that takes long to be told, and whose teller dies amid it."""

    def __init__(self, mark: Path) -> None:
        self.mark = mark

    def __reduce__(self):
        if not self.mark.exists():
            self.mark.touch()
            threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGKILL)).start()
        return bytes, (bytes(300_000_000),)


def always_dead(*_arguments):
    os.kill(os.getpid(), signal.SIGKILL)


class Mortal(ProcessExecutor):
    """Processes of which the first one dies of its first job."""

    def __init__(self, count: int, mark: Path) -> None:
        super().__init__(count)
        self.mark = mark

    def submit(self, fn, /, *args, **kwargs):
        return super().submit(partial(once_dead, self.mark, fn), *args, **kwargs)
