"""Keys that let a browser of this machine in, and the file through which one gets there.

The address of a program that is started stands in the list of processes, which everybody on the
machine may read. So the browser is started with a file that only its owner reads, and the key in
that file is good once.
"""

from __future__ import annotations

import html
import secrets
from pathlib import Path

from quizgen.core.files import open_private


class Keys:
    """What may stand in the address that lets in.

    Parameters
    ----------
    printed : str
        The key in the address that is printed: good as long as the server runs.
    """

    def __init__(self, printed: str) -> None:
        self._printed = printed
        self._once: dict[str, Path] = {}

    def is_good(self, given: str) -> bool:
        """Whether a key lets in; one that is good once is used up, and its file goes."""
        if given in self._once:
            self._once.pop(given).unlink(missing_ok=True)
            return True
        return secrets.compare_digest(given.encode(), self._printed.encode())

    def write_redirect(self, folder: Path, address: str) -> Path:
        """A page that leads to an address with a key that is good once; only its owner reads it.

        Parameters
        ----------
        folder : pathlib.Path
        address : str
            Where the key is given, without it.
        """
        key = secrets.token_urlsafe(24)
        file = folder / f"open-{secrets.token_hex(8)}.html"
        there = html.escape(f"{address}?key={key}")
        with open_private(file) as stream:
            stream.write(
                b'<!DOCTYPE html><meta charset="utf-8"><title>quizgen</title>'
                b'<meta name="referrer" content="no-referrer">'
                + f'<meta http-equiv="refresh" content="0;url={there}">'.encode()
            )
        self._once[key] = file
        return file

    def close(self) -> None:
        """Remove the files of keys that nobody has used."""
        for file in self._once.values():
            file.unlink(missing_ok=True)
        self._once.clear()
