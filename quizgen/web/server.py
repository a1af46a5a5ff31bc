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
    """HTTP/1.1 that closes connections whose request does not arrive in time.

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
        """Handle data and continue to wait for what is missing."""
        super().data_received(data)
        self._watch_deadline()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._stop_watching()
        super().connection_lost(exc)

    def _watch_deadline(self) -> None:
        """Start the timer for the head or the body, when it is first awaited."""
        state = self.conn.their_state
        if state is self._kind:
            return
        self._stop_watching()
        seconds = {h11.IDLE: HEAD, h11.SEND_BODY: BODY}.get(state)
        if seconds is not None:
            self._kind = state
            self._ends = self.loop.call_later(seconds, self.transport.close)

    def _stop_watching(self) -> None:
        """Cancel the timer."""
        self._kind = None
        if self._ends is not None:
            self._ends.cancel()
            self._ends = None


def allow_connections() -> None:
    """Raise the limit of open files: at the usual 1,024 one client could hold them all."""
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
    settings : ServerSettings
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
        else _open_previous_port(settings.host, site.store)
    )
    address = _build_start_url(site, listening.getsockname()[1], invite=invite)

    def ready() -> None:
        """Print the address and open the browser, once the server listens."""
        tell(f"quizgen is at {address}\nCtrl-C ends it; nothing that was answered is lost.")
        if settings.class_exam:
            tell(f"Students come in at {settings.base_url(listening.getsockname()[1])}")
        if show:
            webbrowser.open(_build_browser_url(site, address))

    _end_like_ctrl_c()
    _run_server(app, settings, listening, ready)


def _run_server(
    app: Starlette, settings: ServerSettings, listening: socket.socket, ready: Callable[[], None]
) -> None:
    """Run uvicorn on an open socket.

    No access log: addresses may hold answers. The address of a client is taken from a proxy on this
    machine only.
    """
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
    """Handle termination signals like Ctrl-C, so that the workers are ended first."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if hasattr(signal, "SIGHUP"):  # a terminal that is closed
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))


class _Server(uvicorn.Server):
    """A uvicorn server that calls ``ready`` once it listens."""

    def __init__(self, config: uvicorn.Config, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self.ready = ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen, then call ``ready``."""
        await super().startup(sockets)
        self.ready()


def _build_start_url(site: ServerState, port: int, *, invite: bool) -> str:
    """Return the address to print: with a key, or where people sign in an invitation."""
    settings = site.settings
    place = settings.base_url(port)
    if not settings.accounts:
        return f"{place}{ENTRANCE}?key={settings.token}"
    accounts = site.store.accounts
    if invite or not accounts.has_manager():
        return f"{place}{INVITED}?key={accounts.invite(manages=True)}"
    return place


def _build_browser_url(site: ServerState, address: str) -> str:
    """Return the address to start the browser with, without any key.

    Anybody on the machine can read the arguments of a process, so a key is in a private file.
    """
    if site.settings.accounts:  # an invitation is for the person at the terminal
        return address.partition("?")[0].removesuffix(INVITED)
    from platformdirs import user_data_path

    folder = user_data_path("quizgen", ensure_exists=True)
    return site.keys.write_redirect(folder, address.partition("?")[0]).as_uri()


def _open_previous_port(host: str, store: Store) -> socket.socket:
    """Return a socket on the port of the last run if it is free, else on any.

    An open page, and what its browser stored, then still work.
    """
    anywhere = _open_listening_socket(host, 0)
    port = anywhere.getsockname()[1]
    before = int(store.shared.settle("port", str(port)))
    if before == port:
        return anywhere
    try:
        found = _open_listening_socket(host, before)
    except StoreError:
        return anywhere
    anywhere.close()
    return found


def _open_listening_socket(host: str, port: int) -> socket.socket:
    """Return a bound socket; port 0 takes any free one. ``StoreError`` if it is taken."""
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
