"""What a server is started with."""

from __future__ import annotations

import contextlib
import ipaddress
import secrets
import socket
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from quizgen.bank.bank import Bank, builtin_bank

LOCAL = ("127.0.0.1", "localhost")
"""Names under which a browser on this machine reaches a server of its own."""
EVERYWHERE = "0.0.0.0"  # noqa: S104 - asked for by an option
"""Where a server listens that other devices are to reach."""


@dataclass(frozen=True)
class ServerSettings:
    """What a server was started with.

    Parameters
    ----------
    database : str
        Address of the database, as SQLAlchemy writes it.
    bank : Bank
        Whose questions are asked.
    host : str
        Where it listens. Anywhere but on this machine alone, people sign in.
    names : tuple of str
        Further names under which it may be asked.
    behind_proxy : bool
        Whether a server of this machine takes the requests, with https, and hands them on.
    token : str
        What the printed address holds: it lets in while the server runs. A browser that was let
        in has a session of its own, which outlives the server.
    workers : int
        Processes that make questions and mark exams.
    papers_ahead : tuple of (str, int)
        Blueprints, and how many papers of each are to wait for those who begin.
    phone : bool
        Whether the sole learner may go on with a phone of the same network.
    classroom : pathlib.Path, optional
        Folder of a class whose examiner asks; without it there are no pages for decisions.
    class_exam : pathlib.Path, optional
        Folder of a class that sits its exam here: then there is nothing else to do.
    examine : callable, optional
        Says what is wrong with a template; without it there are no pages for authors.
    """

    database: str
    bank: Bank = field(default_factory=builtin_bank)
    host: str = LOCAL[0]
    names: tuple[str, ...] = ()
    behind_proxy: bool = False
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24), repr=False)
    workers: int = 2
    papers_ahead: tuple[tuple[str, int], ...] = ()
    phone: bool = False
    classroom: Path | None = None
    class_exam: Path | None = None
    examine: Callable[[Bank, str], list[str]] | None = None

    @property
    def accounts(self) -> bool:
        """Whether people sign in: wherever others can reach the server, but with a phone of one."""
        if self.phone:
            return False
        if self.class_exam:
            return True
        return self.behind_proxy or not (self.host in LOCAL or _is_loopback(self.host))

    def is_own_name(self, name: str) -> bool:
        """Return whether the server may be addressed by a host name.

        Another site can make its own name lead here, but no number: where people sign in, any
        number does.
        """
        if name in {*LOCAL, self.host, *self.names}:
            return True
        return (self.accounts or self.phone) and (name in _own_names() or _is_number(name))

    def base_url(self, port: int) -> str:
        """Return the address of the server for browsers."""
        if self.behind_proxy and self.names:
            return f"https://{self.names[0]}"
        if self.phone and not self.names:
            return f"http://{LOCAL[0]}:{port}"
        everywhere = _is_number(self.host) and ipaddress.ip_address(self.host).is_unspecified
        name = self.names[0] if self.names else _find_network_address() if everywhere else self.host
        return f"http://[{name}]:{port}" if ":" in name else f"http://{name}:{port}"

    def phone_url(self, port: int) -> str:
        """Return the address of the server for another device of the network."""
        name = self.names[0] if self.names else _find_network_address()
        return f"http://{name}:{port}"


@cache
def _own_names() -> frozenset[str]:
    """Return the host names of this machine."""
    own = socket.gethostname().lower()
    return frozenset({own, f"{own}.local"})


def _find_network_address() -> str:
    """Return the IP address of this machine in its network.

    Opening a datagram socket makes the system choose it; nothing is sent.
    """
    with contextlib.suppress(OSError), socket.socket(type=socket.SOCK_DGRAM) as out:
        out.connect(("192.0.2.1", 9))  # an address that nobody has (RFC 5737)
        return str(out.getsockname()[0])
    return LOCAL[0]


def _is_number(name: str) -> bool:
    """Return whether a host name is an IP address."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _is_loopback(host: str) -> bool:
    """Return whether a host is an IP address of this machine alone."""
    return _is_number(host) and ipaddress.ip_address(host).is_loopback
