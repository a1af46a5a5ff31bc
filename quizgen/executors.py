"""Where work is done: here, in processes, or on a cluster, by one interface.

All of them are executors of ``concurrent.futures``: a function and a job go in, a value comes out.
A worker that is killed costs the job that it was at, which another one does again.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import ParamSpec, TypeVar

from quizgen.errors import ChoiceError, WorkerError

P = ParamSpec("P")
T = TypeVar("T")
J = TypeVar("J")

TRIES = 3
"""Workers that may die of one job before it is given up."""
AHEAD = 2
"""Jobs that wait for each worker: enough to keep it busy, few enough to keep memory flat."""


class Here(Executor):
    """Does each job at once, in this process."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Do it."""
        done: Future[T] = Future()
        done.set_result(fn(*args, **kwargs))
        return done


class Processes(ThreadPoolExecutor):
    """Processes of which each has a thread here, so that one that dies takes no other with it.

    Parameters
    ----------
    count : int
    """

    def __init__(self, count: int) -> None:
        super().__init__(count)
        self._own = threading.local()
        self._all: list[ProcessPoolExecutor] = []

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Do it in a process that is free."""
        return super().submit(self._elsewhere, fn, *args, **kwargs)

    def _elsewhere(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> T:
        for _ in range(TRIES):
            try:
                return self._process().submit(fn, *args, **kwargs).result()
            except BrokenProcessPool:
                self._own.process = None
        raise WorkerError(f"{TRIES} processes died of the same work (is there memory enough?)")

    def _process(self) -> ProcessPoolExecutor:
        """The process of this thread, begun anew if it has died."""
        if getattr(self._own, "process", None) is None:
            spawn = multiprocessing.get_context("spawn")
            self._own.process = ProcessPoolExecutor(
                1, mp_context=spawn, initializer=_begin, initargs=gc.get_threshold()
            )
            self._all.append(self._own.process)
        found: ProcessPoolExecutor = self._own.process
        return found

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes."""
        super().shutdown(wait, cancel_futures=cancel_futures)
        for process in self._all:
            process.shutdown(wait, cancel_futures=cancel_futures)


def _begin(*threshold: int) -> None:
    """A worker ends with its parent and at Ctrl-C, and typesets in one thread: it has company.

    It looks for garbage as seldom as its parent, which took a twentieth of each of many papers.
    """
    gc.set_threshold(*threshold)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    os.environ["RAYON_NUM_THREADS"] = "1"
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def workers(count: int, scheduler: str = "") -> Iterator[tuple[Executor, int]]:
    """An executor, and how many jobs it should be given at a time.

    Parameters
    ----------
    count : int
        Processes; with 1, all is done in this one.
    scheduler : str
        Address of a Dask scheduler, whose workers do it instead.

    Raises
    ------
    ChoiceError
        If there is no such scheduler, or Dask is not installed.
    """
    if scheduler:
        with _cluster(scheduler) as found:
            yield found
    elif count == 1:
        yield Here(), 1
    else:
        executor = Processes(count)
        try:
            yield executor, count * AHEAD
        finally:
            executor.shutdown(cancel_futures=True)


@contextmanager
def _cluster(scheduler: str) -> Iterator[tuple[Executor, int]]:
    try:
        from distributed import Client
    except ImportError:
        raise ChoiceError("a scheduler needs Dask: install quizgen[cluster]") from None
    try:
        client = Client(scheduler, timeout=10, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ChoiceError(f"scheduler {scheduler}: {error or 'no answer'}") from None
    with client:
        threads = sum(client.nthreads().values())
        yield client.get_executor(pure=False), max(1, threads) * AHEAD


def run(executor: Executor, work: Callable[[J], T], jobs: Iterable[J], ahead: int) -> Iterator[T]:
    """Do jobs, and give each result as it is there."""
    waiting: set[Future[T]] = set()
    for job in jobs:
        waiting.add(executor.submit(work, job))
        while len(waiting) >= ahead:
            done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            yield from (one.result() for one in done)
    while waiting:
        done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
        yield from (one.result() for one in done)


def in_order(
    executor: Executor, work: Callable[[J], T], jobs: Iterable[J], ahead: int
) -> Iterator[T]:
    """Do jobs, and give the results in the order of the jobs."""
    waiting: deque[Future[T]] = deque()
    for job in jobs:
        waiting.append(executor.submit(work, job))
        if len(waiting) >= ahead:
            yield waiting.popleft().result()
    while waiting:
        yield waiting.popleft().result()
