"""Nobody is held up by another who asks for very much."""

from __future__ import annotations

import asyncio
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import pytest
from served import ran

from quizgen.web.fairness import Allowance, FairQueue
from quizgen.web.job_cache import WorkerPool
from quizgen.web.settings import ServerSettings


class Work:
    """Work of several who ask, each piece as long as it is let; what was begun, in order."""

    def __init__(self, queue: FairQueue) -> None:
        self.queue, self.begun = queue, []
        self.may_end = asyncio.Event()

    async def piece(self, asker: str) -> None:
        async with self.queue.turn(asker):
            self.begun.append(asker)
            await self.may_end.wait()

    def ask(self, asker: str, count: int = 1) -> list[asyncio.Task]:
        return [asyncio.create_task(self.piece(asker)) for _ in range(count)]


def test_one_who_asks_for_thirty_lets_the_next_one_in_after_two():
    async def story():
        work = Work(FairQueue(1))
        tasks = [*work.ask("greedy", 30), *work.ask("modest")]
        await asyncio.sleep(0)  # until all have asked
        work.may_end.set()
        await asyncio.gather(*tasks)
        return work.begun

    assert ran(story()).index("modest") == 2, "after the one under way and the one before"


def test_one_alone_has_everything_but_what_is_kept_for_others():
    async def story():
        work = Work(FairQueue(3, share=2))
        tasks = work.ask("greedy", 5)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        alone = list(work.begun)
        tasks += work.ask("modest")
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        both = list(work.begun)
        work.may_end.set()
        await asyncio.gather(*tasks)
        return alone, both, len(work.begun)

    assert ran(story()) == (["greedy"] * 2, ["greedy", "greedy", "modest"], 6)


def test_who_goes_away_while_waiting_takes_no_turn_with_them():
    async def story():
        work = Work(FairQueue(1))
        first, gone, last = (work.ask(name)[0] for name in ("first", "gone", "last"))
        await asyncio.sleep(0)
        gone.cancel()
        work.may_end.set()
        await asyncio.gather(first, last)
        with pytest.raises(asyncio.CancelledError):
            await gone
        await asyncio.gather(*work.ask("again", 2))
        return work.begun

    assert ran(story()) == ["first", "last", "again", "again"]


def test_an_allowance_is_spent_and_comes_back_with_time():
    now = [0.0]
    allowed = Allowance(3, 60.0, lambda: now[0])
    for _ in range(3):
        assert allowed.seconds_to_wait("a") == 0
        allowed.spend("a")
    assert allowed.seconds_to_wait("a") == 60
    assert allowed.seconds_to_wait("b") == 0
    now[0] += 59
    assert allowed.seconds_to_wait("a") == 1
    now[0] += 1
    assert allowed.seconds_to_wait("a") == 0
    allowed.spend("a")
    allowed.give_back("a")
    assert allowed.seconds_to_wait("a") == 0
    now[0] += 3600
    allowed.spend("a")
    assert allowed.seconds_to_wait("a") == 0


@dataclass(frozen=True)
class Number:
    """A job that no process has to do."""

    number: int

    def run(self, bank: object) -> bytes:
        """What a process would do; the tests put a function of their own in its place."""
        del bank
        raise AssertionError("no process is asked")


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_a_learner_who_begins_thirty_exams_does_not_hold_up_the_next(monkeypatch, workers):
    begun, may_end = [], threading.Event()

    def make() -> bytes:
        may_end.wait()
        return b"made"

    def submit(_pool: WorkerPool, wanted: Number) -> Future[bytes]:
        begun.append(wanted.number)
        return threads.submit(make)

    async def story():
        monkeypatch.setattr(WorkerPool, "_submit", submit)
        found = WorkerPool(ServerSettings("sqlite://", host="0.0.0.0", workers=workers))
        greedy = [asyncio.create_task(found.get_result(Number(n), "greedy")) for n in range(30)]
        await asyncio.sleep(0)
        modest = asyncio.create_task(found.get_result(Number(99), "modest"))
        await asyncio.sleep(0.05)
        may_end.set()
        await asyncio.gather(*greedy, modest)
        found.close()

    with ThreadPoolExecutor(workers) as threads:
        ran(story())
    assert begun.index(99) <= 2 * workers
