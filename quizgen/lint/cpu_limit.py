"""An end for what an author's Python does, which may have none of its own."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

AGAIN = 1.0
"""Seconds after which it is stopped once more, in case it caught the first time."""


class CpuLimitExceeded(BaseException):
    """Raised in code that took too much processor time.

    A ``BaseException``, because an author's ``except Exception`` must not catch it.
    """


@contextmanager
def cpu_limit(seconds: float) -> Iterator[None]:
    """Interrupt the body of ``with`` after so many seconds of processor time.

    Python of an author may loop without end. No limit applies on Windows, which has no such timer,
    nor outside the main thread, the only one that a signal interrupts.

    Raises
    ------
    CpuLimitExceeded
        Where it was at that time.
    """
    if (
        not hasattr(signal, "setitimer")
        or threading.current_thread() is not threading.main_thread()
    ):
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        """Raise in the frame that is running."""
        del number, frame
        raise CpuLimitExceeded(f"not done after {seconds:g} s")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
