"""Papers made before anybody begins them, so that a whole class may begin at once.

Making a paper takes a processor some tenths of a second, taking one from the stock a few
milliseconds. The stock is filled while the server has nothing else to do.
"""

from __future__ import annotations

import asyncio
import logging
import time
from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool

import quizgen
from quizgen.bank.bank import Bank, builtin_root
from quizgen.core.cache import compute_digest
from quizgen.core.errors import BankError, QuizgenError
from quizgen.core.untrusted import read_bytes
from quizgen.paper.code import ENGINE
from quizgen.paper.quota import draw_first_seed
from quizgen.store import ExamRecord, Store
from quizgen.web.event_log import find_cause, log_event
from quizgen.web.job_cache import WorkerPool
from quizgen.web.papers import FORMAT, MakePaper, Papers
from quizgen.web.settings import ServerSettings

QUIET = 2.0
"""Seconds without a request after which a server is taken to have nothing else to do."""
BUSY_PAUSE = 10.0
"""Seconds from one paper to the next on a server that is asked all the time."""
LOOK = 2.0
"""Seconds after which a stock that is full, or could not be filled, is looked at again."""
IDLE_LOOK = 0.1
"""Seconds after which workers that had something to do are looked at again."""


class PapersAhead:
    """Fills the stock of papers, and begins exams with them.

    Parameters
    ----------
    settings : ServerSettings
        Its ``papers_ahead`` says how many papers of which blueprints there are to be.
    store : Store
    workers : WorkerPool
    papers : Papers
    """

    def __init__(
        self, settings: ServerSettings, store: Store, workers: WorkerPool, papers: Papers
    ) -> None:
        self._settings, self._store = settings, store
        self._workers, self._papers = workers, papers
        self._version = ""
        self._last_request = self._last_made = -BUSY_PAUSE

    def note_request(self) -> None:
        """Let people go first: somebody has just asked for something."""
        self._last_request = time.monotonic()

    async def begin_exam(
        self, learner: int, blueprint: str, *, has_clock: bool, pauses: bool
    ) -> ExamRecord | None:
        """Return an exam begun with a paper of the stock; None if it has none for the learner.

        Parameters
        ----------
        learner : int
        blueprint : str
        has_clock, pauses : bool
            As of ``PaperStock.begin_exam``.
        """
        if not self._version:
            return None
        return await run_in_threadpool(
            self._store.stock.begin_exam, learner, blueprint, self._version,
            has_clock=has_clock, pauses=pauses,
        )  # fmt: skip

    async def fill_always(self) -> None:
        """Drop what another bank or version has made, then keep the stock full until cancelled."""
        while True:
            try:
                pause = await self._fill_one()
            except (QuizgenError, SQLAlchemyError) as error:
                log_event("no paper made ahead", logging.WARNING, **find_cause(error))
                pause = LOOK
            await asyncio.sleep(pause)

    async def _fill_one(self) -> float:
        """Make one paper if one is missing and nobody waits; seconds until the next look."""
        if not self._version and not await self._open_stock():
            return LOOK
        if not self._is_idle():
            return IDLE_LOOK
        for blueprint, count in self._settings.papers_ahead:
            stock = self._store.stock
            there = await run_in_threadpool(stock.count_papers, blueprint, self._version)
            if there < count:
                wanted = MakePaper(blueprint=blueprint, seed=draw_first_seed())
                self._last_made = time.monotonic()
                paper = await self._papers.make(wanted, self)
                await run_in_threadpool(stock.add_paper, blueprint, self._version, paper)
                return 0.0
        return LOOK

    def _is_idle(self) -> bool:
        """Whether no worker has anything to do, and nobody has asked for some seconds.

        On a server that is always asked, one paper is made now and then.
        """
        now = time.monotonic()
        is_quiet = now - self._last_request > QUIET or now - self._last_made > BUSY_PAUSE
        return is_quiet and not self._workers.is_busy

    async def _open_stock(self) -> bool:
        """Find out which papers may be given away; False where there are none and will be none."""
        stock = self._store.stock
        if not self._settings.papers_ahead and await run_in_threadpool(stock.is_empty):
            return False
        version = await run_in_threadpool(compute_stock_version, self._settings.bank)
        dropped = await run_in_threadpool(stock.drop_other_versions, version)
        if dropped:
            log_event("papers made ahead were dropped", logging.INFO, count=dropped)
        self._version = version
        return True


def compute_stock_version(bank: Bank) -> str:
    """Digest of all that a paper follows from besides its seed: this version, and the banks.

    Parameters
    ----------
    bank : Bank

    Raises
    ------
    BankError
        If a file of it cannot be read.
    """
    roots = dict.fromkeys([*(part.root for part in bank.members), builtin_root()])
    found = [(root, file) for root in roots for file in _list_bank_files(root)]
    names = [file.relative_to(root).as_posix().encode() for root, file in found]
    version = f"{quizgen.__version__} {ENGINE} {FORMAT}".encode()
    return compute_digest(version, *names, *(read_bytes(file, BankError) for _, file in found))


def _list_bank_files(root: Path) -> list[Path]:
    """Return what stands in a bank, without what Python leaves there."""
    found = (file for kind in ("templates", "solvers") for file in (root / kind).rglob("*"))
    return sorted(file for file in found if file.is_file() and file.suffix != ".pyc")
