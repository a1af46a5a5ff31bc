"""A server in a process of its own, as `quizgen serve` starts it."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor


def ran(coroutine):
    """What a coroutine gives, in a thread: the browsers of other tests keep a loop in this one."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, coroutine).result()


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Served:
    """A server of one database and one port, to be killed and started again."""

    def __init__(self, database: str, *more: str, command: tuple[str, ...] = ("serve",)) -> None:
        self.port, self.printed = free_port(), ""
        self.database, self._more, self._command = database, more, command
        self._process: subprocess.Popen[str] | None = None
        self.start()

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def start(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "quizgen", *self._command, "--no-open", "--port", str(self.port),
             "--database", self.database, *self._more],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        )  # fmt: skip
        said = self._process.stdout.readline()
        assert said.startswith("quizgen is at "), said + self._process.stdout.read()
        assert self._process.stdout.readline().startswith("Ctrl-C ends it")
        self.printed = said.split()[-1]

    @property
    def entrance(self) -> str:
        """The address that was printed, on this machine."""
        return re.sub("https?://[^/]*", self.address, self.printed)

    @property
    def is_running(self) -> bool:
        """Whether it has not ended by itself."""
        return self._process.poll() is None

    def end(self) -> str:
        """End it as Ctrl-C does; what it has written meanwhile."""
        os.killpg(self._process.pid, signal.SIGINT)
        return self._process.communicate(timeout=60)[0]

    def kill(self) -> None:
        """End it and its workers as a power cut does."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._process.stdout.close()
