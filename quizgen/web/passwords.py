"""Names and passwords as they are typed, how often they may be tried, and what is kept of them.

Of passwords an Argon2 hash is kept. Source: OWASP, "Slow Down Online Guessing Attacks with Device
Cookies".
"""

from __future__ import annotations

import asyncio
import re
import time
import unicodedata
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TYPE_CHECKING

from quizgen.web.fairness import Allowance, FairQueue

if TYPE_CHECKING:
    from argon2 import PasswordHasher

LONGEST_NAME = 60
SHORTEST, LONGEST = 8, 200
"""Characters of a password."""
AT_ONCE = 2
"""Passwords that are hashed at the same time: each takes 19 MB and a core."""

_JOINERS = "\u200c\u200d"  # Bangla writes with them
_HIDDEN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}


def normalise_user_name(typed: str) -> str | None:
    """Return a user name as it is stored; None if it is not allowed.

    Invisible characters and those that change the direction of writing could imitate another name.
    """
    name = " ".join(unicodedata.normalize("NFC", typed).split())
    hidden = any(unicodedata.category(c) in _HIDDEN for c in name if c not in _JOINERS)
    readable = re.search(r"\w", name) is not None
    return name if readable and not hidden and len(name) <= LONGEST_NAME else None


def is_acceptable(password: str) -> bool:
    """Return whether a password is neither too short nor too long."""
    return SHORTEST <= len(password) <= LONGEST


async def hash_password(password: str) -> str:
    """Return the Argon2id hash of a password, computed in a thread of its own."""
    return await asyncio.get_running_loop().run_in_executor(
        _make_hashing_threads(), _hash_password, password
    )


async def verify_password(kept: str | None, password: str) -> bool:
    """Return whether a password matches a hash; takes as long if there is none.

    The time must not tell whether a name has an account.
    """
    return await asyncio.get_running_loop().run_in_executor(
        _make_hashing_threads(), _is_right_password, kept, password
    )


def _hash_password(password: str) -> str:
    """Return the Argon2id hash of a password."""
    return _make_hasher().hash(_encode_password(password))


def _is_right_password(kept: str | None, password: str) -> bool:
    """Return whether a password matches; without a hash, one is verified for nothing."""
    from argon2.exceptions import VerifyMismatchError

    try:
        right = _make_hasher().verify(kept or _make_dummy_hash(), _encode_password(password))
    except VerifyMismatchError:
        return False
    return right and kept is not None


def _encode_password(password: str) -> bytes:
    """Return the password as bytes: composed equally whatever keyboard it was typed on."""
    return unicodedata.normalize("NFKC", password[:LONGEST]).encode()


@cache
def _make_hasher() -> PasswordHasher:
    """Return the Argon2id hasher with its cost."""
    from argon2 import PasswordHasher  # which only servers need where people sign in

    # OWASP's least for Argon2id: a class that signs in together waits seconds, not minutes.
    return PasswordHasher(time_cost=2, memory_cost=19_456, parallelism=1)


@cache
def _make_dummy_hash() -> str:
    """Return the hash that is verified where a name has no account."""
    return _make_hasher().hash(b"nobody's")


@cache
def _make_hashing_threads() -> ThreadPoolExecutor:
    """Return the threads that hash: few, since each needs 19 MB."""
    return ThreadPoolExecutor(AT_ONCE, "passwords")


class PasswordLimits:
    """Limits the tries of passwords by browser, name and address.

    A browser in which somebody has signed in before is told by a cookie: its tries count for it
    alone, so that wrong ones of others never keep its owner out. Any other try counts for the name
    at the address, for the name, and for the address.

    Parameters
    ----------
    clock : callable
        Seconds that only go on.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._of_browser = Allowance(10, 60.0, clock)
        self._of_name_at_address = Allowance(5, 60.0, clock)
        self._of_name = Allowance(50, 60.0, clock)
        self._of_address = Allowance(100, 2.0, clock)
        self.turns = FairQueue(AT_ONCE)
        """Of those whose passwords are hashed."""

    def _list_allowances(
        self, name: str, address: str, browser: str
    ) -> list[tuple[Allowance, object]]:
        """Return the rate limits that count a try, each with what it counts by."""
        if browser:
            return [(self._of_browser, browser)]
        return [
            (self._of_name_at_address, (name, address)),
            (self._of_name, name),
            (self._of_address, address),
        ]

    def begin(self, name: str, address: str, browser: str) -> int:
        """Return the seconds to wait before a try; 0 if it may be made, and then it counts.

        Parameters
        ----------
        name : str
            As it is compared.
        address : str
        browser : str
            What tells a browser in which somebody of this name has signed in; empty for others.
        """
        counted = self._list_allowances(name, address, browser)
        wait = max(allowance.seconds_to_wait(asker) for allowance, asker in counted)
        if not wait:
            for allowance, asker in counted:
                allowance.spend(asker)
        return wait

    def count_right(self, name: str, address: str, browser: str) -> None:
        """Take back a try that ``begin`` counted as failed and that turned out right.

        The arguments are those of ``begin``.
        """
        for allowance, asker in self._list_allowances(name, address, browser):
            allowance.give_back(asker)
