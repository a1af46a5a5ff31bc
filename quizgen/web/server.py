"""Listening, on this machine alone or where others reach it."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import signal
import socket
import webbrowser
from collections.abc import Callable

import h11
import uvicorn
from starlette.applications import Starlette
from uvicorn.protocols.http.h11_impl import H11Protocol

from quizgen.core.errors import StoreError
from quizgen.store import Store
from quizgen.web.app import create_app
from quizgen.web.auth import ENTRANCE, INVITED
from quizgen.web.event_log import FORMS, set_up_log
from quizgen.web.settings import LOCAL, ServerSettings
from quizgen.web.state import ServerState

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


PATIENCE = 5
"""Seconds that answers on their way have when the server ends."""
IDLE = 75
"""Seconds that a connection may rest: who thinks, or saves every few seconds, keeps it."""


def run_server(
    settings: ServerSettings,
    port: int,
    *,
    show: bool,
    tell: Callable[[str], object],
    invite: bool = False,
    log_form: str = FORMS[0],
) -> None:
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
    invite : bool
        Whether to invite somebody else who manages; the first one always is.
    log_form : str
        How the log is written: one of ``event_log.FORMS``.

    Raises
    ------
    StoreError
        If the port is taken.
    """
    set_up_log(log_form)
    app = create_app(settings)
    site: ServerState = app.state.site
    listening = (
        _open_listening_socket(settings.host, port)
        if port
        else _as_before(settings.host, site.store)
    )
    address = _build_start_url(site, listening.getsockname()[1], invite=invite)

    def ready() -> None:
        tell(f"quizgen is at {address}\nCtrl-C ends it; nothing that was answered is lost.")
        if show:
            webbrowser.open(_build_browser_url(site, address))

    _end_like_ctrl_c()
    _run_server(app, settings, listening, ready)


def _run_server(
    app: Starlette, settings: ServerSettings, listening: socket.socket, ready: Callable[[], None]
) -> None:
    """What is asked is written nowhere; only a proxy of ours is believed who asked."""
    config = uvicorn.Config(
        app, log_config=None, access_log=False, server_header=False,
        proxy_headers=settings.behind_proxy, forwarded_allow_ips=[LOCAL[0], "::1"],
        timeout_graceful_shutdown=PATIENCE, timeout_keep_alive=IDLE, http=TimedProtocol,
    )  # fmt: skip
    allow_connections()
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


def _build_start_url(site: ServerState, port: int, *, invite: bool) -> str:
    """What is opened first; where people sign in, an invitation for the first one who manages."""
    settings = site.settings
    place = settings.base_url(port)
    if not settings.accounts:
        return f"{place}{ENTRANCE}?key={settings.token}"
    accounts = site.store.accounts
    if invite or not accounts.has_manager():
        return f"{place}{INVITED}?key={accounts.invite(manages=True)}"
    return place


def _build_browser_url(site: ServerState, address: str) -> str:
    """What the browser is started with: anybody on the machine may read that."""
    if site.settings.accounts:  # an invitation is for the person at the terminal
        return address.partition("?")[0].removesuffix(INVITED)
    from platformdirs import user_data_path

    folder = user_data_path("quizgen", ensure_exists=True)
    return site.keys.write_redirect(folder, address.partition("?")[0]).as_uri()


def _as_before(host: str, store: Store) -> socket.socket:
    """Listen where a page that was left open asks, and finds what its browser kept."""
    anywhere = _open_listening_socket(host, 0)
    port = anywhere.getsockname()[1]
    before = int(store.shared_value("port", str(port)))
    if before == port:
        return anywhere
    try:
        found = _open_listening_socket(host, before)
    except StoreError:
        return anywhere
    anywhere.close()
    return found


def _open_listening_socket(host: str, port: int) -> socket.socket:
    try:
        family, kind, _, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        raise StoreError(f"{host}: {error.strerror or error}") from error
    listening = socket.socket(family, kind, socket.IPPROTO_TCP)  # so that asyncio sets TCP_NODELAY
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind(place)
    except OSError as error:
        listening.close()
        raise StoreError(f"{host}, port {port}: {error.strerror or error}") from error
    return listening
