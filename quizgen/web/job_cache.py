"""A few processes that make questions, so that one slow picture holds up nobody."""

from __future__ import annotations

import asyncio
import contextlib
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor
from queue import LifoQueue

from quizgen.core.decoding import decode_json
from quizgen.core.errors import QuizgenError
from quizgen.web.makers import Maker
from quizgen.web.question_view import (
    PaperRequest,
    PaperView,
    QuestionRequest,
    QuestionView,
    WorkerJob,
)
from quizgen.web.settings import ServerSettings

ROOM = 100_000_000
"""Bytes of what is kept ready, as it was sent; the latest."""

PoolRequest = QuestionRequest | PaperRequest | WorkerJob
PoolResult = QuestionView | PaperView | bytes


class ResultCache:
    """The latest of what was made, as much of it as there is room for.

    Parameters
    ----------
    room : int
        Bytes.
    """

    def __init__(self, room: int) -> None:
        self.room = room
        self._found: OrderedDict[PoolRequest, tuple[PoolResult, int]] = OrderedDict()

    def get(self, wanted: PoolRequest) -> PoolResult | None:
        """What was kept; None where nothing is."""
        if wanted not in self._found:
            return None
        self._found.move_to_end(wanted)
        return self._found[wanted][0]

    def put(self, wanted: PoolRequest, found: PoolResult, size: int) -> None:
        """Keep something; what was not asked for the longest goes."""
        _, before = self._found.pop(wanted, (None, 0))
        self._found[wanted] = (found, size)
        self.room += before - size
        while self.room < 0:
            _, (_, size) = self._found.popitem(last=False)
            self.room += size


class WorkerPool:
    """Makes questions in processes of its own and keeps the latest."""

    def __init__(self, settings: ServerSettings) -> None:
        self.settings = settings
        self.makers: list[Maker] = []
        self._idle: LifoQueue[Maker] = LifoQueue()
        self._threads = ThreadPoolExecutor(settings.workers, "maker")
        self._kept = ResultCache(ROOM)
        self._due: dict[PoolRequest, asyncio.Future[PoolResult]] = {}

    def warm(self) -> None:
        """Start the processes."""
        for _ in range(self.settings.workers):
            maker = Maker(self.settings.bank)
            self.makers.append(maker)
            self._idle.put(maker)

    def _make_in_free_process(self, wanted: PoolRequest) -> bytes:
        """Let the first maker that is idle make it; there is one for each thread."""
        maker = self._idle.get()
        try:
            return maker.make(wanted)
        finally:
            self._idle.put(maker)

    async def get_question(self, wanted: QuestionRequest) -> QuestionView:
        """A question, from those kept if it is among them.

        Raises
        ------
        BankError, DrawError
            If its template is wrong.
        """
        found = await self._get_or_make(wanted)
        assert isinstance(found, QuestionView)  # noqa: S101 - what was asked for
        return found

    async def get_paper(self, wanted: PaperRequest) -> PaperView:
        """A paper, from those kept if it is among them.

        Raises
        ------
        QuizgenError
            If there is no such paper, or a template is wrong.
        """
        found = await self._get_or_make(wanted)
        assert isinstance(found, PaperView)  # noqa: S101 - what was asked for
        return found

    async def get_result(self, job: WorkerJob) -> bytes:
        """What a job gives, from what is kept if it is among it; asked twice, it is done once.

        Raises
        ------
        QuizgenError
            If it cannot be done; tried anew by whoever asks next.
        """
        found = await self._get_or_make(job)
        assert isinstance(found, bytes)  # noqa: S101 - what was asked for
        return found

    @property
    def has_spare(self) -> bool:
        """Whether a process has nothing to do, and another has not either: that is for others."""
        return len(self._due) < self.settings.workers - 1

    async def prefetch(self, wanted: QuestionRequest) -> None:
        """Make a question that is likely asked soon, where a process has nothing else to do."""
        if self.has_spare:
            with contextlib.suppress(QuizgenError):  # told to whoever asks
                await self._get_or_make(wanted)

    async def _get_or_make(self, wanted: PoolRequest) -> PoolResult:
        found = self._kept.get(wanted)
        if found is not None:
            return found
        if wanted not in self._due:
            self._due[wanted] = asyncio.ensure_future(self._make_result(wanted))
        return await asyncio.shield(self._due[wanted])

    async def _make_result(self, wanted: PoolRequest) -> PoolResult:
        loop = asyncio.get_running_loop()
        try:
            data = await loop.run_in_executor(self._threads, self._make_in_free_process, wanted)
            name, found = _decode_result(wanted, data)
            self._kept.put(name, found, len(data))
            return found
        finally:
            del self._due[wanted]

    def close(self) -> None:
        """End the processes."""
        for maker in self.makers:
            maker.close()
        self._threads.shutdown(cancel_futures=True)


def _decode_result(wanted: PoolRequest, data: bytes) -> tuple[PoolRequest, PoolResult]:
    """What was made, after what it will be asked by: a paper by its code, however chosen."""
    if isinstance(wanted, PaperRequest):
        paper = decode_json(data, PaperView)
        return PaperRequest(wanted.lang, code=paper.code), paper
    if isinstance(wanted, QuestionRequest):
        return wanted, decode_json(data, QuestionView)
    return wanted, data
