"""Listening, on this machine alone."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import signal
import socket
import webbrowser
from collections.abc import Callable

import uvicorn

from quizgen.errors import StoreError
from quizgen.web.app import application
from quizgen.web.guard import ENTRANCE
from quizgen.web.settings import LOCAL, Settings
from quizgen.web.site import Site
from quizgen.web.store import Store

PATIENCE = 5
"""Seconds that answers on their way have when the server ends."""
IDLE = 75
"""Seconds that a connection may rest: who thinks, or saves every few seconds, keeps it."""


def run(settings: Settings, port: int, *, show: bool, tell: Callable[[str], object]) -> None:
    """Serve until interrupted.

    Parameters
    ----------
    settings : Settings
    port : int
        0 for the one of the first time if it is free, else any.
    show : bool
        Whether to open the browser.
    tell : callable
        Told the address.

    Raises
    ------
    StoreError
        If the port is taken.
    """
    app = application(settings)
    site: Site = app.state.site
    listening = _listening(port) if port else _as_before(site.store)
    place = f"http://{LOCAL[0]}:{listening.getsockname()[1]}"
    address = f"{place}{ENTRANCE}?key={site.settings.token}"

    def ready() -> None:
        tell(f"quizgen is at {address}\nCtrl-C ends it; nothing that was answered is lost.")
        if show:
            webbrowser.open(address)

    config = uvicorn.Config(
        app, log_level="warning", access_log=False, server_header=False,
        timeout_graceful_shutdown=PATIENCE, timeout_keep_alive=IDLE,
    )  # fmt: skip
    _end_like_ctrl_c()
    gc.freeze()  # what was loaded stays; looking through it each time would take 60 ms
    with contextlib.suppress(KeyboardInterrupt):  # the way in which it ends
        asyncio.run(_Server(config, ready).serve(sockets=[listening]))


def _end_like_ctrl_c() -> None:
    """Let no signal end this process before it has ended those that it began."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if hasattr(signal, "SIGHUP"):  # a terminal that is closed
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))


class _Server(uvicorn.Server):
    """Says when it can be asked."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self.ready = ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin to listen, and say so."""
        await super().startup(sockets)
        self.ready()


def _as_before(store: Store) -> socket.socket:
    """Listen where a page that was left open asks, and finds what its browser kept."""
    anywhere = _listening(0)
    port = anywhere.getsockname()[1]
    before = int(store.lasting("port", str(port)))
    if before == port:
        return anywhere
    try:
        found = _listening(before)
    except StoreError:
        return anywhere
    anywhere.close()
    return found


def _listening(port: int) -> socket.socket:
    listening = socket.socket(proto=socket.IPPROTO_TCP)  # so that asyncio sets TCP_NODELAY
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((LOCAL[0], port))
    except OSError as error:
        listening.close()
        raise StoreError(f"port {port}: {error.strerror or error}") from error
    return listening
