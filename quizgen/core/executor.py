"""Where work is done: here, in processes, or on a cluster, by one interface.

All of them are executors of ``concurrent.futures``: a function and a job go in, a value comes out.
A worker that is killed costs the job that it was at, which another one does again.
"""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import pickle
import signal
import threading
import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from multiprocessing.reduction import ForkingPickler
from typing import Any, ParamSpec, TypeVar, cast

from quizgen.core.errors import InvalidChoiceError, WorkerError, require_extra

P = ParamSpec("P")
T = TypeVar("T")
J = TypeVar("J")

TRIES = 3
"""Workers that may die of one job before it is given up."""
AHEAD = 2
"""Jobs that wait for each worker: enough to keep it busy, few enough to keep memory flat."""

_SPAWN = multiprocessing.get_context("spawn")


class InlineExecutor(Executor):
    """An executor that runs each job at once, in this process and thread."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Run a job and return its finished future; what the job raises is raised here."""
        done: Future[T] = Future()
        done.set_result(fn(*args, **kwargs))
        return done


class ProcessExecutor(ThreadPoolExecutor):
    """An executor of worker processes, each served by its own thread of this process.

    A process that dies takes no other with it: its job is given to another one, up to ``TRIES``
    times.

    Parameters
    ----------
    count : int
    initializer : callable, optional
        What each process calls before its first job.
    initargs : tuple
        What it is called with.
    longest : float, optional
        Seconds after which a process is taken to hang at its job, and killed.
    """

    def __init__(
        self,
        count: int,
        initializer: Callable[..., object] | None = None,
        initargs: tuple[Any, ...] = (),
        *,
        longest: float | None = None,
    ) -> None:
        super().__init__(count)
        self._initial = (initializer, initargs)
        self._longest = longest
        self._workers: list[_Worker] = []
        # The last one that was at work has most of what a job needs in its memory.
        self._idle: list[_Worker] = []
        self._stopped = False
        self._changing = threading.Lock()

    def start_all(self) -> None:
        """Start all processes now.

        Otherwise each starts with the first job that finds none idle.
        """
        with self._changing:
            self._idle += [self._begin_worker() for _ in range(self._max_workers)]

    @property
    def processes(self) -> list[SpawnProcess]:
        """The worker processes started so far; one that died is replaced when it is needed."""
        return [worker.process for worker in self._workers]

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Return the future of a job that runs in the next idle process."""
        return super().submit(self._run_in_worker, fn, *args, **kwargs)

    def _run_in_worker(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> T:
        """Return what a job returns in a process, or raise what it raises.

        A process that dies or hangs is discarded and the job tried again; after ``TRIES`` of them a
        ``WorkerError`` is raised.
        """
        job = bytes(ForkingPickler.dumps((fn, args, kwargs)))
        for _ in range(TRIES):
            worker = self._take_worker()
            answer = worker.answer(job, self._longest)
            if answer is not None:
                self._idle.append(worker)
                return cast("T", _unpickle_answer(answer))
            self._discard(worker)
        raise WorkerError(f"{TRIES} processes died of the same work (is there memory enough?)")

    def _take_worker(self) -> _Worker:
        """Return the idle process that worked last, or a new one.

        Raise ``WorkerError`` once stopped.
        """
        with self._changing:
            if self._stopped:
                raise WorkerError("the work was stopped")
            return self._idle.pop() if self._idle else self._begin_worker()

    def _begin_worker(self) -> _Worker:
        """Start a process and register it; the caller holds ``_changing``."""
        worker = _Worker(*self._initial)
        self._workers.append(worker)
        return worker

    def _discard(self, worker: _Worker) -> None:
        """Kill a process that died or hangs, and forget it."""
        with self._changing:
            worker.process.kill()
            self._workers.remove(worker)
        worker.close()

    def stop(self) -> None:
        """Kill all processes and cancel the jobs that wait."""
        with self._changing:
            self._stopped = True
            for worker in self._workers:
                worker.process.kill()
        self.shutdown(cancel_futures=True)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes once their work is done, as ``concurrent.futures`` defines it."""
        super().shutdown(wait, cancel_futures=cancel_futures)
        if wait:
            for worker in self._workers:
                worker.close()


class _Worker:
    """One worker process, which receives pickled jobs over a pipe and returns pickled results.

    A pipe ends with the process, even amid an answer. A ``ProcessPoolExecutor`` waits for ever for
    the rest of such an answer, because the other end of its queue is open here, too; it also gives
    up all jobs where one process dies, and leaves semaphores where it is killed itself.
    """

    def __init__(
        self, initializer: Callable[..., object] | None, initargs: tuple[Any, ...]
    ) -> None:
        self._line, there = _SPAWN.Pipe()
        self.process = _SPAWN.Process(
            target=_serve_jobs, args=(there, gc.get_threshold(), initializer, initargs), daemon=True
        )  # fmt: skip
        with shield_from_interrupt():
            self.process.start()
        there.close()

    def answer(self, job: bytes, longest: float | None) -> bytes | None:
        """Return the pickled result of a pickled job; None if the process died or took too long.

        ``longest`` is in seconds, None for no limit.
        """
        with contextlib.suppress(EOFError, OSError):
            self._line.send_bytes(job)
            if self._line.poll(longest):
                return self._line.recv_bytes()
        return None

    def close(self) -> None:
        """Close the pipe, which ends the process, and wait for it."""
        self._line.close()
        self.process.join()


@contextmanager
def shield_from_interrupt() -> Iterator[None]:
    """Block Ctrl-C while processes are started, so that they inherit that and never see it.

    This process sees it and ends them.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # else it begins with the process, and unblocks signals
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve_jobs(
    line: Connection,
    threshold: tuple[int, int, int],
    initializer: Callable[..., object] | None,
    initargs: tuple[Any, ...],
) -> None:
    """Run a worker process: answer the jobs of a pipe until the parent closes it.

    ``threshold`` is the parent's for garbage collection, as ``gc.get_threshold`` returns it.
    """
    _set_up_worker(*threshold)
    if initializer:
        initializer(*initargs)
    with contextlib.suppress(EOFError, OSError):
        while True:
            line.send_bytes(_run_job(line.recv_bytes()))


def _set_up_worker(*threshold: int) -> None:
    """Have a worker end with its parent, ignore Ctrl-C and typeset in one thread.

    It collects garbage as seldom as its parent: the usual threshold took a twentieth of the time of
    many papers.
    """
    gc.set_threshold(*threshold)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # where it cannot be blocked
    os.environ["RAYON_NUM_THREADS"] = "1"
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the parent process and end this one: nobody would take its results."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _run_job(job: bytes) -> bytes:
    """Run a pickled job and return its pickled result, ``(True, value)`` or ``(False, error)``."""
    try:
        work, args, kwargs = pickle.loads(job)  # noqa: S301 - from the parent
        return bytes(ForkingPickler.dumps((True, work(*args, **kwargs))))
    except Exception as error:  # noqa: BLE001 - raised again by who asked
        error.add_note(traceback.format_exc())
        return _pickle_error(error)


def _pickle_error(error: Exception) -> bytes:
    """Return ``(False, error)``, pickled.

    An error that cannot be unpickled becomes its traceback.
    """
    try:
        told = bytes(ForkingPickler.dumps((False, error)))
        pickle.loads(told)  # noqa: S301 - made here
    except Exception:  # noqa: BLE001 - whatever its own code raises
        return bytes(ForkingPickler.dumps((False, RuntimeError(traceback.format_exc()))))
    return told


def _unpickle_answer(answer: bytes) -> Any:
    """Return the value that a worker sent, or raise the error that it sent."""
    good, value = pickle.loads(answer)  # noqa: S301 - from our own process
    if not good:
        raise value
    return value


@contextmanager
def open_executor(count: int, scheduler: str = "") -> Iterator[tuple[Executor, int]]:
    """Give an executor for a ``with`` block, and how many jobs to have in flight at a time.

    Parameters
    ----------
    count : int
        Processes; with 1, all is done in this one.
    scheduler : str
        Address of a Dask scheduler, whose workers do it instead.

    Raises
    ------
    InvalidChoiceError
        If there is no such scheduler, or Dask is not installed.
    """
    if scheduler:
        with _open_cluster_executor(scheduler) as found:
            yield found
    elif count == 1:
        yield InlineExecutor(), 1
    else:
        executor = ProcessExecutor(count)
        try:
            yield executor, count * AHEAD
        except BaseException:
            executor.stop()
            raise
        executor.shutdown()


@contextmanager
def _open_cluster_executor(scheduler: str) -> Iterator[tuple[Executor, int]]:
    """Give what ``open_executor`` gives, on the workers of a Dask scheduler."""
    require_extra("cluster", "--scheduler")
    from distributed import Client

    try:
        client = Client(scheduler, timeout=10, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InvalidChoiceError(f"scheduler {scheduler}: {error or 'no answer'}") from None
    with client:
        threads = sum(client.nthreads().values())
        yield client.get_executor(pure=False), max(1, threads) * AHEAD


def map_unordered(
    executor: Executor, work: Callable[[J], T], jobs: Iterable[J], ahead: int
) -> Iterator[T]:
    """Yield the result of each job as soon as it is there, in any order.

    At most ``ahead`` jobs are in flight, so that many jobs take no more memory than a few.
    """
    waiting: set[Future[T]] = set()
    for job in jobs:
        waiting.add(executor.submit(work, job))
        while len(waiting) >= ahead:
            done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            yield from (one.result() for one in done)
    while waiting:
        done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
        yield from (one.result() for one in done)


def map_ordered(
    executor: Executor, work: Callable[[J], T], jobs: Iterable[J], ahead: int
) -> Iterator[T]:
    """Yield the result of each job in the order of the jobs, with at most ``ahead`` in flight."""
    waiting: deque[Future[T]] = deque()
    for job in jobs:
        waiting.append(executor.submit(work, job))
        if len(waiting) >= ahead:
            yield waiting.popleft().result()
    while waiting:
        yield waiting.popleft().result()
