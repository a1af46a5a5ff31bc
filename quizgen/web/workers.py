"""A few processes that make questions, so that one slow picture holds up nobody."""

from __future__ import annotations

import asyncio
import contextlib
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor
from queue import LifoQueue

from quizgen.errors import QuizgenError
from quizgen.shapes import decoded
from quizgen.web.made import Job, Made, MadePaper, Wanted, WantedPaper
from quizgen.web.makers import Maker
from quizgen.web.settings import Settings

ROOM = 100_000_000
"""Bytes of what is kept ready, as it was sent; the latest."""

Asked = Wanted | WantedPaper | Job
Given = Made | MadePaper | bytes


class Kept:
    """The latest of what was made, as much of it as there is room for.

    Parameters
    ----------
    room : int
        Bytes.
    """

    def __init__(self, room: int) -> None:
        self.room = room
        self._found: OrderedDict[Asked, tuple[Given, int]] = OrderedDict()

    def get(self, wanted: Asked) -> Given | None:
        """What was kept; None where nothing is."""
        if wanted not in self._found:
            return None
        self._found.move_to_end(wanted)
        return self._found[wanted][0]

    def put(self, wanted: Asked, found: Given, size: int) -> None:
        """Keep something; what was not asked for the longest goes."""
        _, before = self._found.pop(wanted, (None, 0))
        self._found[wanted] = (found, size)
        self.room += before - size
        while self.room < 0:
            _, (_, size) = self._found.popitem(last=False)
            self.room += size


class Workers:
    """Makes questions in processes of its own and keeps the latest."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.makers: list[Maker] = []
        self._idle: LifoQueue[Maker] = LifoQueue()
        self._threads = ThreadPoolExecutor(settings.workers, "maker")
        self._kept = Kept(ROOM)
        self._due: dict[Asked, asyncio.Future[Given]] = {}

    def warm(self) -> None:
        """Start the processes."""
        for _ in range(self.settings.workers):
            maker = Maker(self.settings.bank)
            self.makers.append(maker)
            self._idle.put(maker)

    def _asked(self, wanted: Asked) -> bytes:
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
        return found

    async def done(self, job: Job) -> bytes:
        """What a job gives, from what is kept if it is among it; asked twice, it is done once.

        Raises
        ------
        QuizgenError
            If it cannot be done; tried anew by whoever asks next.
        """
        found = await self._found(job)
        assert isinstance(found, bytes)  # noqa: S101 - what was asked for
        return found

    @property
    def spare(self) -> bool:
        """Whether a process has nothing to do, and another has not either: that is for others."""
        return len(self._due) < self.settings.workers - 1

    async def prepare(self, wanted: Wanted) -> None:
        """Make a question that is likely asked soon, where a process has nothing else to do."""
        if self.spare:
            with contextlib.suppress(QuizgenError):  # told to whoever asks
                await self._found(wanted)

    async def _found(self, wanted: Asked) -> Given:
        found = self._kept.get(wanted)
        if found is not None:
            return found
        if wanted not in self._due:
            self._due[wanted] = asyncio.ensure_future(self._make(wanted))
        return await asyncio.shield(self._due[wanted])

    async def _make(self, wanted: Asked) -> Given:
        loop = asyncio.get_running_loop()
        try:
            data = await loop.run_in_executor(self._threads, self._asked, wanted)
            name, found = _read(wanted, data)
            self._kept.put(name, found, len(data))
            return found
        finally:
            del self._due[wanted]

    def close(self) -> None:
        """End the processes."""
        for maker in self.makers:
            maker.close()
        self._threads.shutdown(cancel_futures=True)


def _read(wanted: Asked, data: bytes) -> tuple[Asked, Given]:
    """What was made, after what it will be asked by: a paper by its code, however chosen."""
    if isinstance(wanted, WantedPaper):
        paper = decoded(data, MadePaper)
        return WantedPaper(wanted.lang, code=paper.code), paper
    if isinstance(wanted, Wanted):
        return wanted, decoded(data, Made)
    return wanted, data
