"""What was acknowledged is there after PostgreSQL was restarted under load."""

from __future__ import annotations

import itertools
import re
import threading
import time
from typing import Self

import httpx2
import pytest
from served import Served
from sqlalchemy import select
from sqlalchemy.exc import SQLAlchemyError

from quizgen.core.errors import QuizgenError
from quizgen.locale import load_words
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


class Browsers:
    """Browsers with an exam each, which save all the time, and what was acknowledged to them."""

    def __init__(self, served: Served) -> None:
        self.served = served
        self.saved: dict[str, int] = {}
        self.refused: list[httpx2.Response] = []
        self.unexpected: list[object] = []
        self._ended = threading.Event()
        self._threads = [threading.Thread(target=self._sit) for _ in range(THREADS)]

    def __enter__(self) -> Self:
        for one in self._threads:
            one.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        for one in self._threads:
            one.join()

    def wait_for_more(self, more: int) -> None:
        """Wait until each browser has saved some more answers."""
        goals = {at: number + more for at, number in self.saved.items()}
        last = time.monotonic() + SECONDS
        while len(self.saved) < THREADS or any(self.saved[at] < goals[at] for at in goals):
            assert time.monotonic() < last, "the server does not recover"
            assert self.served.is_running
            time.sleep(0.01)

    def _sit(self) -> None:
        with httpx2.Client(base_url=self.served.address, timeout=SECONDS) as browser:
            browser.get(self.served.entrance)
            page = browser.get("/exam").text
            token = re.search(r'name="token" value="(\w+)"', page)[1]
            sent = {"token": token, "blueprint": "trial"}
            at = browser.post("/exam", data=sent).headers["location"]
            part = re.search(r'<fieldset data-part="(\w+)"', browser.get(at).text)[1]
            self.saved[at] = -1
            for answer in itertools.count():
                if self._ended.is_set():
                    return
                sent = {"token": token, f"on-{part}": "", f"a-{part}": str(answer)}
                headers = {"accept": "application/json" if answer % 2 else "text/html"}
                kept = browser.post(at, data=sent, headers=headers)
                if kept.status_code in {200, 303}:
                    self.saved[at] = answer
                elif kept.status_code == 503:
                    self.refused.append(kept)
                    time.sleep(0.01)
                else:
                    self.unexpected.append((kept.status_code, kept.text))


@pytest.mark.slow
def test_a_server_outlives_restarts_of_its_postgresql(cluster):
    database = cluster.database()
    served = Served(database)
    try:
        with Browsers(served) as browsers:
            for how in ("fast", "immediate"):
                browsers.wait_for_more(20)
                before = len(browsers.refused)
                with cluster.away(how):
                    last = time.monotonic() + SECONDS
                    while len(browsers.refused) < before + 2 * THREADS:
                        assert time.monotonic() < last, "nobody is told"
                        time.sleep(0.01)
            browsers.wait_for_more(20)
    finally:
        served.end()
    assert browsers.unexpected == []
    told = load_words("en", "web")["error"]["503"]
    assert all(told in one.text for one in browsers.refused)
    store = Store(database)
    with store.database.reading() as connection:
        stored = dict(connection.execute(select(ANSWER.c.sitting, ANSWER.c.fields)).all())
    store.close()
    print(f"{sum(browsers.saved.values())} answers, {len(browsers.refused)} refused")
    for at, number in browsers.saved.items():
        assert int(stored[at.rpartition("/")[2]][0]) >= number
