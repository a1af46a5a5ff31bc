"""The folder of a class is written by one command at a time; another one waits for its turn."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from quizgen.classes.class_folder import SETTINGS
from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, restrict_folder

FILE = ".lock"
PATIENCE = 60.0
"""Seconds to wait for another command."""
_PAUSE = 0.05


@contextlib.contextmanager
def lock_folder(folder: Path, patience: float = PATIENCE) -> Iterator[None]:
    """Hold an exclusive lock on the folder of a class during the body of ``with``.

    The operating system releases it where a process is killed.

    Names of files are numbers of students: what others could look into is closed to them, too.

    Parameters
    ----------
    folder : pathlib.Path
        One that is not there is left to who reads it.
    patience : float
        Seconds to wait for another command.

    Raises
    ------
    ClassError
        If another command still writes there.
    """
    if not folder.is_dir():
        yield
        return
    number = os.open(folder / FILE, os.O_RDWR | os.O_CREAT, PRIVATE)
    try:
        last = time.monotonic() + patience
        while not _try_lock(number):
            if time.monotonic() > last:
                raise ClassError(
                    f"{folder}: another command writes there; try again when it has ended"
                )
            time.sleep(_PAUSE)
        if (folder / SETTINGS).exists():
            restrict_folder(folder)
        yield
    finally:
        os.close(number)


def _try_lock(number: int) -> bool:
    """Return whether the lock on a file descriptor could be taken now, without waiting."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(number, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
