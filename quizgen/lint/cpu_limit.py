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
    """What an author's Python did has no end in sight."""


@contextmanager
def cpu_limit(seconds: float) -> Iterator[None]:
    """Stop what takes more time of the processor than this.

    Without effect on Windows, which has no such clock, and beside the main thread, which alone can
    be stopped.

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
        del number, frame
        raise CpuLimitExceeded(f"not done after {seconds:g} s")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
