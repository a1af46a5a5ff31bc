"""What a running server shares: its bank, its database, its workers."""

from __future__ import annotations

import asyncio
import html
import logging
import secrets
import time
from pathlib import Path
from typing import TYPE_CHECKING
from weakref import WeakValueDictionary

from starlette.exceptions import HTTPException

from quizgen.core.files import open_private
from quizgen.locale import FIRST, list_languages
from quizgen.store import Store
from quizgen.web.event_log import log_event
from quizgen.web.fairness import Allowance
from quizgen.web.job_cache import WorkerPool
from quizgen.web.papers import Papers
from quizgen.web.papers_ahead import PapersAhead
from quizgen.web.passwords import PasswordLimits
from quizgen.web.settings import ServerSettings

if TYPE_CHECKING:
    from quizgen.web.class_room import ClassRoom

SCAN_SECONDS = 600.0
"""How long a code on the screen may be scanned."""


class Keys:
    """Keys that let a browser of this machine in: the printed one, and one-time keys in files.

    Parameters
    ----------
    printed : str
        The key in the address that is printed: good as long as the server runs.
    """

    def __init__(self, printed: str) -> None:
        self._printed = printed
        self._once: dict[str, Path] = {}
        self._scanned: dict[str, float] = {}

    def is_good(self, given: str) -> bool:
        """Return whether a key lets in; a one-time key is used up by that, and its file deleted."""
        if time.monotonic() < self._scanned.pop(given, 0.0):
            return True
        if given in self._once:
            self._once.pop(given).unlink(missing_ok=True)
            return True
        return secrets.compare_digest(given.encode(), self._printed.encode())

    def make_for_phone(self) -> str:
        """Return a key to scan: good once, and for ``SCAN_SECONDS``; the one before it ends."""
        key = secrets.token_urlsafe(24)
        self._scanned = {key: time.monotonic() + SCAN_SECONDS}
        return key

    def write_redirect(self, folder: Path, address: str) -> Path:
        """Write a private page that redirects to ``address`` with a one-time key; return its path.

        Parameters
        ----------
        folder : pathlib.Path
        address : str
            Where the key is given, without it.
        """
        key = secrets.token_urlsafe(24)
        file = folder / f"open-{secrets.token_hex(8)}.html"
        there = html.escape(f"{address}?key={key}")
        with open_private(file) as stream:
            stream.write(
                b'<!DOCTYPE html><meta charset="utf-8"><title>quizgen</title>'
                b'<meta name="referrer" content="no-referrer">'
                + f'<meta http-equiv="refresh" content="0;url={there}">'.encode()
            )
        self._once[key] = file
        return file

    def close(self) -> None:
        """Delete the files of unused one-time keys."""
        for file in self._once.values():
            file.unlink(missing_ok=True)
        self._once.clear()


def open_class_room(
    settings: ServerSettings, store: Store, workers: WorkerPool, papers: Papers
) -> ClassRoom | None:
    """Return the class that sits its exam on a server; None for any other server."""
    if settings.class_exam is None:
        return None
    from quizgen.web.class_room import ClassRoom  # what a class needs may not be installed

    return ClassRoom(settings.class_exam, store, workers, papers)


QUOTAS = {"exam": (30, 600.0), "practice": (300, 10.0), "import": (3, 21_600.0)}
"""What a learner may begin at once, and seconds until once more: each takes room on the disk."""


class QuotaError(HTTPException):
    """HTTP 429: a learner has started more than the server has room for."""


class ServerState:
    """What all requests of a running server share.

    Parameters
    ----------
    settings : ServerSettings

    Raises
    ------
    StoreError
        If the database cannot be opened.
    """

    def __init__(self, settings: ServerSettings) -> None:
        self.bank = settings.bank
        self.store = Store(settings.database)
        self.settings = settings
        self.workers = WorkerPool(settings)
        self.keys = Keys(settings.token)
        """Keys that let a browser of this machine in."""
        self.admitted: set[str] = set()
        """Tokens that the database has said to be good, so that not each request asks it."""
        self.papers = Papers(self.store, self.workers)
        self.papers_ahead = PapersAhead(settings, self.store, self.workers, self.papers)
        self.room = open_class_room(settings, self.store, self.workers, self.papers)
        """The class that sits its exam here, if one does."""
        self.password_limits = PasswordLimits()
        self.browser_secret = self.store.shared.settle("browsers", secrets.token_urlsafe(24))
        """What proves that somebody has signed in at a browser before."""
        self._quotas = {name: Allowance(*quota) for name, quota in QUOTAS.items()}
        self.languages = tuple(filter(list_languages().__contains__, self.bank.languages)) or (
            FIRST,
        )
        """Those that pages can be read in: of the bank, because questions stand on most."""
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    def attempt_lock(self, attempt: str) -> asyncio.Lock:
        """Return the lock of an attempt: of two answers at once the second sees the first."""
        return self._turns.setdefault(attempt, asyncio.Lock())

    def spend_quota(self, what: str, learner: int) -> None:
        """Count that a learner starts something; without accounts nothing is limited.

        Raises
        ------
        QuotaError
            If it has been begun too often.
        """
        if not self.settings.accounts:
            return
        wait = self._quotas[what].seconds_to_wait(learner)
        if wait:
            log_event("quota is used up", logging.WARNING, learner=learner, of=what)
            raise QuotaError(429, headers={"retry-after": str(wait)})
        self._quotas[what].spend(learner)

    def close(self) -> None:
        """Stop the workers and close the database."""
        self.keys.close()
        self.workers.close()
        self.store.close()
