"""What the machine said of answers, kept from one run of marking to the next.

An assistant marks a class many times, and nearly all answers are as they were. All of it follows
from keys, answers and the code, whose digest names it, so it never goes stale; without the file,
or with one that somebody has changed, answers are judged anew.
"""

from __future__ import annotations

import sys
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

import msgspec

from quizgen.classes.pseudonyms import student_mac
from quizgen.core.cache import compute_digest
from quizgen.core.decoding import json_decoder, prepare_type
from quizgen.core.files import PRIVATE, write_all

FILE = ".judged.jsonl"
READERS = ("python-flint", "mpmath", "msgspec", "numpy", "rapidfuzz")
"""Whose versions may change what is read."""
PASSING = frozenset({"unchecked", "program-time"})
"""What is said of a program where the machine had no time for it: to be tried again."""
T = TypeVar("T")


class _Line(msgspec.Struct):
    """A thing that is kept: its name, its seal, and itself."""

    name: str
    seal: str
    found: msgspec.Raw


_LINE = json_decoder(_Line).decode


class JudgedAnswers:
    """Things that one run found and the next need not find again.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    secret : str
        With it lines are sealed: who cannot read it cannot write one that counts.
    """

    def __init__(self, folder: Path, secret: str) -> None:
        self.folder, self._secret = folder, secret
        self._before = self._read()
        self._now: dict[str, bytes] = {}
        self._adds = False

    def _read(self) -> dict[str, _Line]:
        """Return the lines of the run before by name; none where there are none to be read."""
        try:
            lines = (self.folder / FILE).read_bytes().splitlines()
            return {one.name: one for one in map(_LINE, lines)}
        except (OSError, ValueError):
            return {}

    def get(self, name: str, shape: type[T]) -> T | None:
        """Return what is kept under a name; None if nothing is that can be trusted."""
        data = self._now.get(name) or self._find_before(name)
        if data is None:
            return None
        prepare_type(shape)
        try:
            found = msgspec.json.decode(data, type=shape, dec_hook=lambda kind, text: kind(text))
        except (msgspec.DecodeError, ValueError, ZeroDivisionError):
            return None
        self._now[name] = data
        return found

    def _find_before(self, name: str) -> bytes | None:
        """Return what the run before kept under a name; None if somebody has changed it."""
        line = self._before.get(name)
        if line is None or line.seal != self._seal(name, bytes(line.found)):
            return None
        return bytes(line.found)

    def keep(self, name: str, found: object) -> None:
        """Note something under a name for the next run."""
        self._now[name], self._adds = msgspec.json.encode(found, enc_hook=str), True

    def write(self) -> None:
        """Write what this run found or took; what neither named is gone.

        Where nothing was found anew the file stays: it has what people decided meanwhile, too.
        """
        if not self._adds:
            return
        lines = (
            msgspec.json.encode(_Line(name, self._seal(name, data), msgspec.Raw(data)))
            for name, data in self._now.items()
        )
        write_all(self.folder, {FILE: b"".join(line + b"\n" for line in lines)}, PRIVATE)

    def _seal(self, name: str, data: bytes) -> str:
        """Return the seal of a line."""
        return student_mac(
            self._secret, "judged", name, data.decode("utf-8", "surrogateescape")
        ).hex()


@cache
def compute_judging_digest() -> bytes:
    """Return the digest of all code and words that answers are read and judged by."""
    home = Path(__file__).parent.parent
    files = sorted(path for ending in ("py", "toml") for path in home.rglob(f"*.{ending}"))
    told = " ".join([sys.version, *map(version, READERS)])
    return compute_digest(told.encode(), *(path.read_bytes() for path in files)).encode()
