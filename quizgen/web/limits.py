"""How long a connection may take to ask, and how many there may be."""

from __future__ import annotations

import asyncio
import contextlib

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

HEAD, BODY = 10.0, 120.0
"""Seconds in which the head of a request is to be there, and then its body."""
FILES = 65_536
"""Connections and files that a server asks the system for, if it gives as many."""


class TimedProtocol(H11Protocol):
    """HTTP whose requests have to arrive in time.

    uvicorn waits without end for the rest of a request, so that some hundred half-sent ones would
    hold every connection that there is. Each of them has its time as a whole: sending a byte now
    and then does not make it longer.
    """

    _ends: asyncio.TimerHandle | None = None
    _kind: object = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for a request."""
        super().connection_made(transport)
        self._watch_deadline()

    def data_received(self, data: bytes) -> None:
        """Go on waiting for what is still missing."""
        super().data_received(data)
        self._watch_deadline()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait for nothing more."""
        self._stop_watching()
        super().connection_lost(exc)

    def _watch_deadline(self) -> None:
        """Time what is missing of a request, from when it was first missing."""
        state = self.conn.their_state
        if state is self._kind:
            return
        self._stop_watching()
        seconds = {h11.IDLE: HEAD, h11.SEND_BODY: BODY}.get(state)
        if seconds is not None:
            self._kind = state
            self._ends = self.loop.call_later(seconds, self.transport.close)

    def _stop_watching(self) -> None:
        self._kind = None
        if self._ends is not None:
            self._ends.cancel()
            self._ends = None


def allow_connections() -> None:
    """Take as many connections as the system gives; usual is 1,024, which one client can hold."""
    with contextlib.suppress(ImportError, OSError, ValueError):  # not everywhere, or not allowed
        import resource

        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        most = FILES if hard == resource.RLIM_INFINITY else min(FILES, hard)
        if soft < most:
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
