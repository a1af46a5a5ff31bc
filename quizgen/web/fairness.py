"""Fair shares: turns for heavy work, and how often something may be done.

In: who asks, under a name that can be compared. Out: a turn, or the seconds to wait. Must never
know: what is done in a turn.

Sources: Nagle, "On Packet Switches with Infinite Storage" (RFC 970): a queue for each who asks,
served in turn. Turner, "New directions in communications" (1986): the leaky bucket.
"""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from collections import Counter, OrderedDict, deque
from collections.abc import AsyncIterator, Callable, Hashable

REMEMBERED = 10_000
"""Askers whose tries are remembered; the oldest are forgotten first."""


class FairQueue:
    """Limits concurrent work and serves askers in turn, however many requests each has.

    A hundred requests of one asker hold up another's by one of them, not by a hundred.

    Parameters
    ----------
    slots : int
        How much is done at the same time.
    share : int, optional
        How much of that one asker may do; all of it if left out.
    """

    def __init__(self, slots: int, share: int | None = None) -> None:
        self._free, self._share = slots, slots if share is None else share
        self._busy: Counter[Hashable] = Counter()
        self._waiting: OrderedDict[Hashable, deque[asyncio.Future[None]]] = OrderedDict()

    @contextlib.asynccontextmanager
    async def turn(self, asker: Hashable) -> AsyncIterator[None]:
        """Wait for a slot, and hold it during the body of ``async with``."""
        mine = asyncio.get_running_loop().create_future()
        self._waiting.setdefault(asker, deque()).append(mine)
        self._start_next()
        try:
            await mine
            yield
        finally:
            if not mine.cancelled():  # else it was never given: whose turn it is went away
                self._free += 1
                self._busy[asker] -= 1
                self._busy = +self._busy
                self._start_next()

    def _start_next(self) -> None:
        """Start waiting work while slots are free, the longest waiting asker first."""
        for asker, queue in list(self._waiting.items()):
            while queue and queue[0].cancelled():
                queue.popleft()
            if queue and self._free and self._busy[asker] < self._share:
                queue.popleft().set_result(None)
                self._free -= 1
                self._busy[asker] += 1
                self._waiting.move_to_end(asker)
            if not queue:
                del self._waiting[asker]


class Allowance:
    """A rate limit for each asker: ``most`` times at once, then once every ``every`` seconds.

    Parameters
    ----------
    most : int
        How often at once.
    every : float
        Seconds after which it may be done once more.
    clock : callable
        Seconds that only go on.
    """

    def __init__(
        self, most: int, every: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._most, self._every, self._clock = most, every, clock
        self._used: OrderedDict[Hashable, tuple[float, float]] = OrderedDict()

    def seconds_to_wait(self, asker: Hashable) -> int:
        """Return the seconds until the asker may do it; 0 if at once."""
        return max(0, math.ceil((self._used_now(asker) + 1 - self._most) * self._every))

    def spend(self, asker: Hashable) -> None:
        """Count one use by the asker."""
        used = self._used_now(asker) + 1
        self._used.pop(asker, None)
        self._used[asker] = used, self._clock()
        if len(self._used) > REMEMBERED:
            self._used.popitem(last=False)

    def give_back(self, asker: Hashable) -> None:
        """Take one use by the asker back."""
        if asker in self._used:
            self._used[asker] = max(0.0, self._used_now(asker) - 1), self._clock()

    def _used_now(self, asker: Hashable) -> float:
        """Return the uses that still count; they decay by one every ``every`` seconds."""
        used, since = self._used.get(asker, (0.0, 0.0))
        return max(0.0, used - (self._clock() - since) / self._every)
