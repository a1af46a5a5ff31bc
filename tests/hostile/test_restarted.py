"""What was acknowledged is there after PostgreSQL was restarted under load."""

from __future__ import annotations

import itertools
import re
import threading
import time
from typing import Self

import pytest
from sqlalchemy import select
from sqlalchemy.exc import SQLAlchemyError

from quizgen.core.errors import QuizgenError
from quizgen.store import Store
from quizgen.store.schema import ANSWER, SITTING

THREADS = 4
SECONDS = 20
"""How long the database may take to answer again."""


@pytest.fixture(scope="module")
def cluster():
    from databases import Cluster

    begun = Cluster()
    yield begun
    begun.end()


class Load:
    """Learners who save and hand in all the time, and what was acknowledged to them."""

    def __init__(self, store: Store) -> None:
        self.store = store
        self.saved: dict[str, int] = {}
        self.handed: set[str] = set()
        self.refused = 0
        self.unexpected: list[Exception] = []
        self._ended = threading.Event()
        learners = [store.learner(f"learner {n}").id for n in range(THREADS)]
        self._threads = [threading.Thread(target=self._write, args=(one,)) for one in learners]

    def __enter__(self) -> Self:
        for one in self._threads:
            one.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        for one in self._threads:
            one.join()

    def count(self) -> int:
        """How many answers were acknowledged so far."""
        return sum(number + 1 for number in list(self.saved.values()))

    def wait_for_more(self, more: int) -> None:
        """Wait until some more answers were acknowledged."""
        goal, last = self.count() + more, time.monotonic() + SECONDS
        while self.count() < goal:
            assert time.monotonic() < last, "the server does not recover"
            time.sleep(0.01)

    def _write(self, learner: int) -> None:
        for number in itertools.count():
            if self._ended.is_set():
                return
            try:
                self._sit(learner, f"mock-{number}-both-0a1b2c")
            except (SQLAlchemyError, QuizgenError):  # a page says 503, and nothing was acknowledged
                self.refused += 1
                time.sleep(0.01)
            except Exception as error:  # noqa: BLE001 - the test shows it
                self.unexpected.append(error)
                return

    def _sit(self, learner: int, code: str) -> None:
        sitting = self.store.sittings.begin(learner, code, None, pauses=False)
        for answer in range(5):
            if self.store.sittings.save(learner, sitting.id, {"1": [str(answer)]})[1]:
                self.saved[sitting.id] = answer
        self.store.sittings.hand_in(sitting)
        self.handed.add(sitting.id)


@pytest.mark.slow
def test_a_restarted_postgresql_has_lost_nothing(cluster):
    store = Store(cluster.database())
    with Load(store) as load:
        for how in ("fast", "immediate", "fast", "immediate"):
            load.wait_for_more(20)
            cluster.restart(how)
        load.wait_for_more(20)
    assert load.unexpected == []
    assert load.refused
    with store.database.reading() as connection:
        stored = dict(connection.execute(select(ANSWER.c.sitting, ANSWER.c.fields)).all())
        handed = set(connection.scalars(select(SITTING.c.id).where(SITTING.c.handed.is_not(None))))
    lost = [
        name for name, number in load.saved.items()
        if number > int(re.sub(r"\D", "", str(stored.get(name, ""))) or -1)
    ]  # fmt: skip
    print(f"{load.count()} answers, {len(load.handed)} handed in, {load.refused} refused")
    assert lost == []
    assert load.handed <= handed
    store.close()
