"""A few processes that make questions, so that one slow picture holds up nobody."""

from __future__ import annotations

import asyncio
import contextlib
from collections import OrderedDict
from collections.abc import Hashable
from concurrent.futures import Future
from typing import Generic, TypeVar

from quizgen.core.decoding import decode_json
from quizgen.core.errors import QuizgenError
from quizgen.core.executor import ProcessExecutor
from quizgen.web.fairness import FairQueue
from quizgen.web.question_view import (
    QuestionRequest,
    QuestionView,
    WorkerJob,
    make_from_held_bank,
    prepare_process,
)
from quizgen.web.settings import ServerSettings

# Seconds after which a process is taken to hang: a paper of some hours takes a tenth of it.
LONGEST = 120.0
ROOM = 50_000_000
"""Bytes of what is kept ready, as it was sent; the latest."""

PoolRequest = QuestionRequest | WorkerJob
PoolResult = QuestionView | bytes
K = TypeVar("K")
V = TypeVar("V")


class ResultCache(Generic[K, V]):
    """A least-recently-used cache limited by bytes.

    Parameters
    ----------
    room : int
        Bytes.
    """

    def __init__(self, room: int) -> None:
        self.room = room
        self._found: OrderedDict[K, tuple[V, int]] = OrderedDict()

    def get(self, wanted: K) -> V | None:
        """Return what is stored; None if nothing is."""
        if wanted not in self._found:
            return None
        self._found.move_to_end(wanted)
        return self._found[wanted][0]

    def store_result(self, wanted: K, found: V, size: int) -> None:
        """Store a result of ``size`` bytes; evict the least recently used ones."""
        before = self._found.pop(wanted)[1] if wanted in self._found else 0
        self._found[wanted] = (found, size)
        self.room += before - size
        while self.room < 0:
            _, (_, size) = self._found.popitem(last=False)
            self.room += size


class WorkerPool:
    """Runs jobs in worker processes and caches their results."""

    def __init__(self, settings: ServerSettings) -> None:
        self.settings = settings
        self.pool = ProcessExecutor(
            settings.workers, prepare_process, (settings.bank,), longest=LONGEST
        )
        self._kept: ResultCache[PoolRequest, PoolResult] = ResultCache(ROOM)
        self._due: dict[PoolRequest, asyncio.Future[PoolResult]] = {}
        # Where others ask too, one who asks for hours of work leaves them a process.
        share = max(1, settings.workers - 1) if settings.accounts else settings.workers
        self._turns = FairQueue(settings.workers, share)

    def warm(self) -> None:
        """Start the worker processes before the first request."""
        self.pool.start_all()

    def _submit(self, wanted: PoolRequest) -> Future[bytes]:
        """Start a job in a worker; return the future of its bytes."""
        return self.pool.submit(make_from_held_bank, wanted)

    async def get_question(self, wanted: QuestionRequest, asker: Hashable = None) -> QuestionView:
        """Return a rendered question, from the cache or from a worker.

        Parameters
        ----------
        wanted : QuestionRequest
        asker : hashable, optional
            Who waits for it: all who ask have their turns.

        Raises
        ------
        BankError, SamplingError
            If its template is wrong.
        """
        found = await self._get_or_make(wanted, asker)
        assert isinstance(found, QuestionView)  # noqa: S101 - what was asked for
        return found

    async def get_result(
        self, job: WorkerJob, asker: Hashable = None, *, is_kept: bool = True
    ) -> bytes:
        """Return the bytes of a job, from the cache or a worker; concurrent requests share one run.

        Parameters
        ----------
        job : WorkerJob
        asker : hashable, optional
            Who waits for it: all who ask have their turns.
        is_kept : bool
            Whether it may be asked for again: else it takes no room.

        Raises
        ------
        QuizgenError
            If it cannot be done; tried again at the next request.
        """
        found = await self._get_or_make(job, asker, is_kept=is_kept)
        assert isinstance(found, bytes)  # noqa: S101 - what was asked for
        return found

    @property
    def alive(self) -> int:
        """Return the number of live worker processes; a dead one is replaced at its next job."""
        return sum(process.is_alive() for process in self.pool.processes)

    @property
    def is_busy(self) -> bool:
        """Whether anything is being made."""
        return bool(self._due)

    @property
    def has_spare(self) -> bool:
        """Whether two workers are idle: one may prefetch, the other stays for requests."""
        return len(self._due) < self.settings.workers - 1

    async def prefetch(self, wanted: QuestionRequest) -> None:
        """Make a question that is likely requested next, if a worker is idle."""
        if self.has_spare:
            with contextlib.suppress(QuizgenError):  # said to the next who asks
                await self._get_or_make(wanted, self)

    async def _get_or_make(
        self, wanted: PoolRequest, asker: Hashable, *, is_kept: bool = True
    ) -> PoolResult:
        """Return a cached result, or wait for the one run that makes it."""
        found = self._kept.get(wanted)
        if found is not None:
            return found
        if wanted not in self._due:
            self._due[wanted] = due = asyncio.ensure_future(
                self._make_result(wanted, asker, is_kept=is_kept)
            )
            due.add_done_callback(_forget_error)
        return await asyncio.shield(self._due[wanted])

    async def _make_result(
        self, wanted: PoolRequest, asker: Hashable, *, is_kept: bool
    ) -> PoolResult:
        """Run a job in a worker when it is the asker's turn; return and cache its result."""
        try:
            async with self._turns.turn(asker):
                data = await asyncio.wrap_future(self._submit(wanted))
            found = decode_json(data, QuestionView) if isinstance(wanted, QuestionRequest) else data
            if is_kept:
                self._kept.store_result(wanted, found, len(data))
            return found
        finally:
            del self._due[wanted]

    def close(self) -> None:
        """Stop the worker processes."""
        self.pool.stop()


def _forget_error(due: asyncio.Future[PoolResult]) -> None:
    """Mark an error as retrieved: its request may be gone, and asyncio would log it."""
    if not due.cancelled():
        due.exception()
