"""A command in the folder of a class that dies: ``class_command.py FOLDER LEFT PLACE WORD...``.

Before the change of the folder with number PLACE, counted from 1, it is killed; with 0 it comes to
its end and prints how many there were. LEFT holds each file as it was when it was last synced, by
the number of its inode.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
from pathlib import Path

from quizgen.cli.main import main

CHANGES = frozenset({"os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.chmod"})


class Changes:
    """Counts what a command changes below a folder, and dies before one of them."""

    def __init__(self, folder: str, left: Path, place: int) -> None:
        self.folder, self.left, self.place, self.count = folder, left, place, 0
        self._sync = os.fsync
        # A file that is held open keeps its inode from being given to another one.
        self._held = [
            os.open(file, os.O_RDONLY) for file in Path(folder).rglob("*") if file.is_file()
        ]

    def note(self, event: str, arguments: tuple[object, ...]) -> None:
        """Hear what Python asks the system for."""
        written = event == "open" and isinstance(arguments[2], int) and arguments[2] & (
            os.O_WRONLY | os.O_RDWR)  # fmt: skip
        if (written or event in CHANGES) and self.folder in str(Path(str(arguments[0])).absolute()):
            self._step()

    def sync(self, number: int) -> None:
        """Keep what is on the disk from now on."""
        if self.folder in (path := str(Path(f"/proc/self/fd/{number}").readlink())):
            self._step()
            if Path(path).is_file():
                shutil.copy(path, self.left / str(os.fstat(number).st_ino))
                self._held.append(os.dup(number))
        self._sync(number)

    def _step(self) -> None:
        self.count += 1
        if self.count == self.place:
            os.kill(os.getpid(), signal.SIGKILL)


if __name__ == "__main__":
    changes = Changes(str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]), int(sys.argv[3]))
    sys.addaudithook(changes.note)
    os.fsync = changes.sync
    try:
        main(sys.argv[4:])
    finally:
        print(f"\n{changes.count}")
