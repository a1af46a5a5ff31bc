"""Files of folders that somebody trusted, found by their digests."""

from __future__ import annotations

import threading
from pathlib import Path

from quizgen.core.cache import compute_digest

_FOLDERS: dict[Path, None] = {}
_LOCK = threading.Lock()


def trust_folder(folder: Path) -> None:
    """Let files below a folder be found by ``find_trusted_file`` from now on."""
    with _LOCK:
        _FOLDERS[folder.resolve()] = None


def find_trusted_file(pattern: str, digest: str) -> bytes | None:
    """Return the file of a digest below a trusted folder; None if there is none.

    Parameters
    ----------
    pattern : str
        Where in a folder such files lie, such as ``*/*/check.py``.
    digest : str
        Of all that the file holds, as ``compute_digest`` gives it.
    """
    for folder in list(_FOLDERS):
        for file in sorted(folder.glob(pattern)):
            found = file.read_bytes()
            if compute_digest(found) == digest:
                return found
    return None
