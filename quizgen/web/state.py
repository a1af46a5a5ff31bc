"""What a running server shares: its bank, its database, its workers."""

from __future__ import annotations

import asyncio
from weakref import WeakValueDictionary

from quizgen.locale import FIRST, list_languages
from quizgen.store import Store
from quizgen.web.job_cache import WorkerPool
from quizgen.web.keys import Keys
from quizgen.web.passwords import RateLimiter
from quizgen.web.settings import ServerSettings


class ServerState:
    """What a running server shares.

    Parameters
    ----------
    settings : Settings

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
        self.patience = RateLimiter()
        """With those who sign in with wrong passwords."""
        self.languages = tuple(filter(list_languages().__contains__, self.bank.languages)) or (
            FIRST,
        )
        """Those that pages can be read in: of the bank, because questions stand on most."""
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    def attempt_lock(self, attempt: str) -> asyncio.Lock:
        """Held while an attempt is answered: of two answers at once the second sees the first."""
        return self._turns.setdefault(attempt, asyncio.Lock())

    def close(self) -> None:
        """End the processes and give the connections back."""
        self.keys.close()
        self.workers.close()
        self.store.close()
