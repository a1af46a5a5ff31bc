"""What a bank's files come to - chains, rules, prose - stored, so that each is worked out once.

It follows from the files, from quizgen's code between them and the result, and from the package
that this code asks. A wheel brings what its own bank comes to (``quizgen/_build_hook.py``).
"""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Generic, TypeVar

import msgspec

from quizgen.core.cache import compute_digest, read_cached, write_cached
from quizgen.core.decoding import prepare_type

T = TypeVar("T")

_VERSIONS = {
    "sympy": "release.py",
    "markdown_it": "__init__.py",
    "PIL": "_version.py",
    "math_core": "../math_core-*.dist-info/METADATA",
}
"""A package's file that says which version it is: to import it would take longer."""
_UNFIT = msgspec.MsgspecError, ValueError, OverflowError, RecursionError
"""What is raised where a thing cannot be written, or what is found is none."""


class CompileCache(Generic[T]):
    """Things of one kind that are stored.

    Parameters
    ----------
    kind : str
        Names them in the cache.
    shape : type
        What they are.
    *packages : str
        What else has a say in them, if anything.
    """

    def __init__(self, kind: str, shape: type[T], *packages: str) -> None:
        self.kind, self.packages = kind, packages
        prepare_type(shape)
        self._decoder = msgspec.msgpack.Decoder(shape, dec_hook=lambda kind, text: kind(text))

    def get(self, *sources: bytes) -> T | None:
        """Return what sources came to, if it is stored."""
        found = read_cached(self.kind, self._compute_key(sources))
        if found is None:
            return None
        with suppress(*_UNFIT):
            return self._decoder.decode(found)
        return None

    def store_compiled(self, thing: T, *sources: bytes) -> T:
        """Keep what sources came to, if it comes back the same."""
        with suppress(*_UNFIT):
            data = msgspec.msgpack.encode(thing, enc_hook=str)
            if self._decoder.decode(data) == thing:
                write_cached(self.kind, self._compute_key(sources), data)
        return thing

    def _compute_key(self, sources: tuple[bytes, ...]) -> str:
        """Return the name that a result is stored under: a digest of the code and its sources."""
        return compute_digest(_compute_code_digest(*self.packages), *sources)


@cache
def _compute_code_digest(*packages: str) -> bytes:
    """Return the digest of the code that makes of sources what is stored."""
    files = [file for package in packages for file in _list_version_files(package)]
    return compute_digest(_compute_own_digest(), *(file.read_bytes() for file in files)).encode()


@cache
def _compute_own_digest() -> bytes:
    """Return the digest of quizgen's own part of that code."""
    own = Path(__file__).parent.parent
    folders = ("bank", "core", "kinds", "maths", "typeset")
    files = [file for folder in folders for file in sorted((own / folder).rglob("*.py"))]
    return compute_digest(*(file.read_bytes() for file in files)).encode()


def _list_version_files(package: str) -> list[Path]:
    """Return the file that says which version a package is; none if it is not installed."""
    found = find_spec(package)
    if found is None or found.origin is None:
        return []
    return sorted(Path(found.origin).parent.glob(_VERSIONS[package]))
