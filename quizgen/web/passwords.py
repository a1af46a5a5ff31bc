"""Names and passwords as they are typed, and what is kept of passwords: an Argon2 hash."""

from __future__ import annotations

import asyncio
import math
import re
import time
import unicodedata
from collections import OrderedDict
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from argon2 import PasswordHasher

LONGEST_NAME = 60
SHORTEST, LONGEST = 8, 200
"""Characters of a password."""
AT_ONCE = 2
"""Passwords that are hashed at the same time: each takes 19 MB and a core."""
FREE = 5
"""Wrong passwords after which one has to wait."""
LONGEST_WAIT = 300.0
REMEMBERED = 10_000

_JOINERS = "\u200c\u200d"  # Bangla writes with them
_HIDDEN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}


def normalise_user_name(typed: str) -> str | None:
    """A name as it is kept; None if it cannot be one.

    Nothing in it may turn the text around it, or not be seen.
    """
    name = " ".join(unicodedata.normalize("NFC", typed).split())
    hidden = any(unicodedata.category(c) in _HIDDEN for c in name if c not in _JOINERS)
    readable = re.search(r"\w", name) is not None
    return name if readable and not hidden and len(name) <= LONGEST_NAME else None


def is_acceptable(password: str) -> bool:
    """Whether a password is neither too short nor too long."""
    return SHORTEST <= len(password) <= LONGEST


async def hash_password(password: str) -> str:
    """What is kept of a password."""
    return await asyncio.get_running_loop().run_in_executor(
        _make_hashing_threads(), _hash_password, password
    )


async def verify_password(kept: str | None, password: str) -> bool:
    """Whether a password is the one that was kept; takes as long where none was."""
    return await asyncio.get_running_loop().run_in_executor(
        _make_hashing_threads(), _is_right_password, kept, password
    )


def _hash_password(password: str) -> str:
    return _make_hasher().hash(_encode_password(password))


def _is_right_password(kept: str | None, password: str) -> bool:
    from argon2.exceptions import VerifyMismatchError

    try:
        right = _make_hasher().verify(kept or _make_dummy_hash(), _encode_password(password))
    except VerifyMismatchError:
        return False
    return right and kept is not None


def _encode_password(password: str) -> bytes:
    return unicodedata.normalize("NFKC", password[:LONGEST]).encode()


@cache
def _make_hasher() -> PasswordHasher:
    from argon2 import PasswordHasher  # which only servers need where people sign in

    # OWASP's least for Argon2id: a class that signs in together waits seconds, not minutes.
    return PasswordHasher(time_cost=2, memory_cost=19_456, parallelism=1)


@cache
def _make_dummy_hash() -> str:
    return _make_hasher().hash(b"nobody's")


@cache
def _make_hashing_threads() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(AT_ONCE, "passwords")


class RateLimiter:
    """Lets what keeps failing be tried again only later and later.

    Parameters
    ----------
    clock : callable
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._tries: OrderedDict[Hashable, tuple[int, float]] = OrderedDict()

    def seconds_to_wait(self, who: Hashable) -> int:
        """Seconds to wait before a try; 0 if it may be made now, and then it counts as failed."""
        count, since = self._tries.pop(who, (0, 0.0))
        now = self._clock()
        left = since + _compute_waiting_time(count) - now if count >= FREE else 0.0
        if left > 0:
            self._tries[who] = count, since
            return math.ceil(left)
        self._tries[who] = count + 1, now
        if len(self._tries) > REMEMBERED:
            self._tries.popitem(last=False)
        return 0

    def reset(self, who: Hashable) -> None:
        """Forget what failed before."""
        self._tries.pop(who, None)


def _compute_waiting_time(count: int) -> float:
    return min(LONGEST_WAIT, 2.0 ** min(count - FREE, 20))
