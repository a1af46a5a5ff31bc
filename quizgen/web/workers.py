"""A few processes that make questions, so that one slow picture holds up nobody."""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import signal
from collections import OrderedDict
from concurrent.futures import ProcessPoolExecutor

import msgspec

from quizgen.web.made import Made, MadePaper, Wanted, WantedPaper, make
from quizgen.web.settings import Settings

KEPT = 256
"""Questions that are kept ready, the latest ones."""


def _uninterrupted() -> None:
    """Leave Ctrl-C to the server, which ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _ready() -> None:
    """Load what the first question will need."""
    from quizgen.figures import _pen
    from quizgen.question import compose

    del _pen, compose


class Workers:
    """Makes questions in processes of its own and keeps the latest."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        context = multiprocessing.get_context("spawn")
        self.pool = ProcessPoolExecutor(settings.workers, context, _uninterrupted)
        self._kept: OrderedDict[Wanted | WantedPaper, Made | MadePaper] = OrderedDict()
        self._due: dict[Wanted | WantedPaper, asyncio.Future[Made | MadePaper]] = {}

    def warm(self) -> None:
        """Start the processes."""
        for _ in range(self.settings.workers):
            self.pool.submit(_ready)

    async def question(self, wanted: Wanted) -> Made:
        """A question, from those kept if it is among them.

        Raises
        ------
        BankError, DrawError
            If its template is wrong.
        """
        found = await self._found(wanted)
        assert isinstance(found, Made)  # noqa: S101 - what was asked for
        return found

    async def paper(self, wanted: WantedPaper) -> MadePaper:
        """A paper, from those kept if it is among them.

        Raises
        ------
        QuizgenError
            If there is no such paper, or a template is wrong.
        """
        found = await self._found(wanted)
        assert isinstance(found, MadePaper)  # noqa: S101 - what was asked for
        self._kept[WantedPaper(wanted.lang, found.code)] = found
        return found

    async def _found(self, wanted: Wanted | WantedPaper) -> Made | MadePaper:
        found = self._kept.get(wanted)
        if found is not None:
            self._kept.move_to_end(wanted)
            return found
        if wanted not in self._due:
            self._due[wanted] = asyncio.ensure_future(self._make(wanted))
        return await asyncio.shield(self._due[wanted])

    async def _make(self, wanted: Wanted | WantedPaper) -> Made | MadePaper:
        try:
            bank, trusted = self.settings.bank, self.settings.trusted
            loop = asyncio.get_running_loop()
            data = await loop.run_in_executor(self.pool, make, bank, trusted, wanted)
            found: Made | MadePaper
            if isinstance(wanted, WantedPaper):
                found = msgspec.json.decode(data, type=MadePaper)
            else:
                found = msgspec.json.decode(data, type=Made)
            self._kept[wanted] = found
            while len(self._kept) > KEPT:
                self._kept.popitem(last=False)
            return found
        finally:
            del self._due[wanted]

    def close(self) -> None:
        """End the processes."""
        with contextlib.suppress(RuntimeError):
            self.pool.shutdown(wait=False, cancel_futures=True)
