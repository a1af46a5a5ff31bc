"""What was worked out once and is kept: in a wheel from when it was built, else in a cache.

A thing is kept under the digest of all that it follows from, so it never goes stale and needs no
date. What is damaged is worked out again without a word, as if it had never been kept; so is
everything where the cache may have been written by somebody else, or cannot be written.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import secrets
import stat
import time
from functools import cache
from pathlib import Path

SHIPPED = Path(__file__).parent.parent / "builtin" / "kept"
"""What the wheel brings."""
LARGEST = 1_000_000
"""Bytes of the largest thing that is kept."""
OLD = 90 * 86400.0
"""Seconds after which a thing is swept away: it may be what nothing leads to any more."""
SWEPT, PAUSE = ".{}-swept", 86400.0
"""File whose time says when the folder beside it was last searched, and seconds until again."""
_SUM = 64


def compute_digest(*parts: bytes) -> str:
    """Return the SHA-256 of several byte strings as 64 hexadecimal digits.

    The length of each part is hashed, too: ``(b"ab", b"c")`` and ``(b"a", b"bc")`` differ.
    """
    total = hashlib.sha256()
    for part in parts:
        total.update(len(part).to_bytes(8, "big"))
        total.update(part)
    return total.hexdigest()


def read_cached(kind: str, key: str) -> bytes | None:
    """Return the bytes stored under a key, or None.

    What the wheel brings is searched first, then the user's cache.

    Parameters
    ----------
    kind : str
        What sort of thing it is, which is a folder of the cache.
    key : str
        Digest of everything that the bytes follow from.
    """
    found = _read_entry(SHIPPED, kind, key)
    if found is None and (home := user_cache_folder()) is not None:
        found = _read_entry(home, kind, key)
    return found


def _read_entry(folder: Path, kind: str, key: str) -> bytes | None:
    """Return the stored bytes of one cache folder; None if missing, too large or damaged."""
    with contextlib.suppress(OSError), (folder / kind / key).open("rb") as stream:
        found = stream.read(LARGEST + _SUM + 1)
        if found[:_SUM] == _compute_checksum(kind, key, found[_SUM:]):
            return found[_SUM:]
    return None


def write_cached(kind: str, key: str, data: bytes) -> None:
    """Store bytes in the user's cache under a kind and a digest of all that they follow from.

    Nothing is stored, and nothing raised, where there is no safe cache folder, the data is larger
    than ``LARGEST`` or the disk refuses: a cache only saves time. Old entries of the kind go.
    """
    home = user_cache_folder()
    if home is None or len(data) > LARGEST:
        return
    with contextlib.suppress(OSError):
        write_entry(home, kind, key, data)
        remove_stale(home / kind)


def write_entry(home: Path, kind: str, key: str, data: bytes) -> None:
    """Write one cache entry below ``home`` so that ``read_cached`` accepts it, or not at all.

    The checksum goes in front of the data. Raises ``OSError`` where the folder cannot be written.
    """
    folder = home / kind
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f".{key}.{os.getpid()}-{secrets.token_hex(4)}.part"
    try:
        part.write_bytes(_compute_checksum(kind, key, data) + data)
        part.replace(folder / key)
    finally:
        part.unlink(missing_ok=True)


def _compute_checksum(kind: str, key: str, data: bytes) -> bytes:
    """Return the 64 bytes in front of an entry: it is undamaged and under its own key."""
    return compute_digest(kind.encode(), key.encode(), data).encode()


@cache
def user_cache_folder() -> Path | None:
    """Return the cache folder of the user, created if missing; None if others may write there."""
    from platformdirs import user_cache_path

    with contextlib.suppress(OSError, RuntimeError):
        folder = user_cache_path("quizgen")
        if folder.is_absolute():
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            return folder if _is_own(folder.stat()) else None
    return None


def _is_own(folder: os.stat_result) -> bool:
    """Return whether a folder belongs to this user and nobody else may write to it."""
    if not hasattr(os, "getuid"):
        return True
    return folder.st_uid == os.getuid() and not folder.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


@cache
def remove_stale(folder: Path) -> None:
    """Delete the files of a folder that are older than ``OLD``; at most once in ``PAUSE``.

    To look through a folder that many versions have written to takes seconds.
    """
    swept, now = folder.with_name(SWEPT.format(folder.name)), time.time()
    if swept.exists() and 0 <= now - swept.stat().st_mtime < PAUSE:
        return
    swept.touch()
    for path in folder.iterdir():
        if now - path.stat().st_mtime > OLD:
            path.unlink(missing_ok=True)
