"""A few processes that make questions, so that one slow picture holds up nobody."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor
from queue import LifoQueue

import msgspec

from quizgen.web.made import Job, Made, MadePaper, Wanted, WantedPaper
from quizgen.web.makers import Maker
from quizgen.web.settings import Settings

KEPT = 256
"""Questions that are kept ready, the latest ones."""
JOBS_KEPT = 24
"""Of other things, such as photographs, which are larger."""


class Workers:
    """Makes questions in processes of its own and keeps the latest."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.makers: list[Maker] = []
        self._idle: LifoQueue[Maker] = LifoQueue()
        self._threads = ThreadPoolExecutor(settings.workers, "maker")
        self._kept: OrderedDict[Wanted | WantedPaper, Made | MadePaper] = OrderedDict()
        self._due: dict[Wanted | WantedPaper, asyncio.Future[Made | MadePaper]] = {}
        self._jobs: OrderedDict[Job, asyncio.Future[bytes]] = OrderedDict()

    def warm(self) -> None:
        """Start the processes."""
        for _ in range(self.settings.workers):
            maker = Maker(self.settings.bank, trusted=self.settings.trusted)
            self.makers.append(maker)
            self._idle.put(maker)

    def _asked(self, wanted: Wanted | WantedPaper | Job) -> bytes:
        """Let the first maker that is idle make it; there is one for each thread."""
        maker = self._idle.get()
        try:
            return maker.make(wanted)
        finally:
            self._idle.put(maker)

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

    async def done(self, job: Job) -> bytes:
        """What a job gives, from what is kept if it is among it; asked twice, it is done once.

        Raises
        ------
        QuizgenError
            If it cannot be done; tried anew by whoever asks next.
        """
        if job not in self._jobs:
            self._jobs[job] = asyncio.ensure_future(self._bytes(job))
        self._jobs.move_to_end(job)
        while len(self._jobs) > JOBS_KEPT:
            self._jobs.popitem(last=False)
        try:
            return await asyncio.shield(self._jobs[job])
        except Exception:
            self._jobs.pop(job, None)
            raise

    async def _bytes(self, wanted: Wanted | WantedPaper | Job) -> bytes:
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._threads, self._asked, wanted)

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
            data = await self._bytes(wanted)
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
        for maker in self.makers:
            maker.close()
        self._threads.shutdown(cancel_futures=True)
