"""A PostgreSQL of the tests' own: Debian's, in a folder that is thrown away."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from uuid import uuid4

import psycopg
from needed import absent


def programs() -> Path:
    """Where PostgreSQL's programs stand, which Debian keeps off the path."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    on_path = shutil.which("initdb")
    if not found and not on_path:
        absent("PostgreSQL", "postgresql")
    return (found[-1] if found else Path(on_path)).parent


class Cluster:
    """A server without a network, run by somebody who is not root, which it insists on."""

    def __init__(self) -> None:
        found = programs()
        self._pg_ctl = found / "pg_ctl"
        self._folder = Path(tempfile.mkdtemp(prefix="qz"))
        self._user = "postgres" if os.geteuid() == 0 else None
        if self._user:
            shutil.chown(self._folder, self._user)
        self._run(found / "initdb", "--auth=trust", "--username=tests", "--no-sync",
                  "--encoding=UTF8", "--locale=C")  # fmt: skip
        self._options = f"-k {self._folder} -c listen_addresses='' -c fsync=off"
        self._start()

    def _start(self) -> None:
        log = str(self._folder / "log")
        self._run(self._pg_ctl, "start", "-w", "-s", "-l", log, "-o", self._options)

    def restart(self, how: str) -> None:
        """End it, ``fast`` or ``immediate``, and start it again."""
        with self.away(how):
            pass

    @contextlib.contextmanager
    def away(self, how: str) -> Iterator[None]:
        """Be ended during a ``with`` block."""
        self._run(self._pg_ctl, "stop", "-w", "-m", how, "-s")
        try:
            yield
        finally:
            self._start()

    def _run(self, *command: object) -> None:
        subprocess.run(
            [*map(str, command), "-D", str(self._folder / "data")], check=True, user=self._user,
            cwd=self._folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        )  # fmt: skip

    def database(self) -> str:
        """The address of a new, empty database."""
        name = f"t{uuid4().hex}"
        with psycopg.connect(
            f"host={self._folder} user=tests dbname=postgres", autocommit=True
        ) as server:
            server.execute(f"CREATE DATABASE {name}")
        return f"postgresql+psycopg://tests@/{name}?host={self._folder}"

    def end(self) -> None:
        self._run(self._pg_ctl, "stop", "-m", "immediate", "-s")
        shutil.rmtree(self._folder)
