"""What a bank's files come to - chains, rules, prose - kept, so that each is worked out once.

It follows from the files, from quizgen's code between them and what is kept, and from the package
that this code asks. A wheel brings what its own bank comes to (``quizgen/_build_hook.py``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
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
    """Cache of what sources are compiled to, of one type.

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
        """Prepare a decoder for ``shape``; nothing is read yet."""
        self.kind, self.packages = kind, packages
        prepare_type(shape)
        self._decoder = msgspec.msgpack.Decoder(shape, dec_hook=lambda kind, text: kind(text))

    def get(self, *sources: bytes) -> T | None:
        """Return what sources were compiled to, or None if the cache does not hold it."""
        found = read_cached(self.kind, self._compute_key(sources))
        if found is None:
            return None
        with suppress(*_UNFIT):
            return self._decoder.decode(found)
        return None

    def store_compiled(self, thing: T, *sources: bytes) -> T:
        """Store what sources were compiled to, if it survives being written and read."""
        with suppress(*_UNFIT):
            data = msgspec.msgpack.encode(thing, enc_hook=str)
            if self._decoder.decode(data) == thing:
                write_cached(self.kind, self._compute_key(sources), data)
        return thing

    def _compute_key(self, sources: tuple[bytes, ...]) -> str:
        """Return the key of sources: a digest of them and of the code that compiles them."""
        return compute_digest(_compute_code_digest(*self.packages), *sources)


@cache
def _compute_code_digest(*packages: str) -> bytes:
    """Return the digest of the code that compiles sources."""
    return compute_digest(*(file.read_bytes() for file in _iter_code_files(packages))).encode()


def _iter_code_files(packages: Iterable[str]) -> Iterator[Path]:
    """Yield the files whose change makes a compiled value out of date.

    Of packages that compile (SymPy, math-core) the file with the version is enough: they never
    change in place.
    """
    own = Path(__file__).parent.parent
    for folder in ("bank", "core", "kinds", "maths", "typeset"):
        yield from sorted((own / folder).rglob("*.py"))
    for package in packages:
        found = find_spec(package)
        if found is not None and found.origin is not None:
            yield from sorted(Path(found.origin).parent.glob(_VERSIONS[package]))
