"""The time of exams: it goes on evenly, whatever is done to the clock of the machine."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from pathlib import Path

JUMP = 2.0
"""Seconds by which the clock of a machine may differ before that is a jump, and told."""
_BOOT = Path("/proc/sys/kernel/random/boot_id")
_LOG = logging.getLogger("quizgen.clock")


def steady() -> float:
    """Return seconds since the machine was started, time asleep included; it never jumps."""
    name = getattr(time, "CLOCK_BOOTTIME", None)
    return time.monotonic() if name is None else time.clock_gettime(name)


def since_boot() -> str:
    """Return a name for this run of the machine, the same until it restarts; "" if unknown."""
    try:
        return f"clock-{_BOOT.read_text().strip()[:23]}"
    except OSError:
        return ""


class Clock:
    """A clock that cannot be set: seconds since 1970 at a beginning, counted on steadily.

    Parameters
    ----------
    anchor : tuple of float, optional
        What the steady clock and the time of exams said at one moment; without it, now.
    wall, even : callable
        The machine's clock, which can be set, and the steady one.
    """

    def __init__(
        self,
        anchor: tuple[float, float] | None = None,
        wall: Callable[[], float] = time.time,
        even: Callable[[], float] = steady,
    ) -> None:
        self._wall, self._even = wall, even
        self.anchor = anchor or (even(), wall())
        self._apart = 0.0

    def now(self) -> float:
        """Return the time in seconds since 1970.

        Jumps of the machine's clock are ignored, logged once.
        """
        at, began = self.anchor
        found = began + self._even() - at
        apart = self._wall() - found
        if abs(apart - self._apart) > JUMP:
            _LOG.warning("the clock was set by %+.1f s; exams do not follow", apart - self._apart)
            self._apart = apart
        return found
