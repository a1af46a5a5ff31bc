"""One process that makes questions, told what is wanted over a pipe.

A pipe needs no semaphore, which a server that is killed would leave behind, and it ends with the
server: a maker whose server is gone reads its end and goes too.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import threading
from multiprocessing.connection import Connection

from quizgen.bank.bank import Bank
from quizgen.core.errors import BankError
from quizgen.executors import uninterrupted
from quizgen.web.question_view import QuestionRequest, WorkerJob, run_request

LONGEST = 120.0
"""Seconds after which a process is taken to hang."""
TRIES = 2
"""How many processes a question may take down."""

_SPAWN = multiprocessing.get_context("spawn")


class Maker:
    """A process that makes one question after another; where it dies another takes its place.

    Parameters
    ----------
    bank : Bank
        Opened anew by the process.
    """

    def __init__(self, bank: Bank) -> None:
        self._bank = bank
        self._closed = False
        self._changing = threading.Lock()
        self._begin()

    def _begin(self) -> None:
        self._line, there = _SPAWN.Pipe()
        self.process = _SPAWN.Process(target=_work, args=(there, self._bank), daemon=True)
        with uninterrupted():
            self.process.start()
        there.close()

    def make(self, wanted: QuestionRequest | WorkerJob) -> bytes:
        """A question, a paper or another job, as ``made.make`` gives it.

        Raises
        ------
        QuizgenError
            If a template is wrong, or there is no such paper.
        """
        for _ in range(TRIES):
            with contextlib.suppress(EOFError, OSError):
                self._line.send(wanted)
                if self._line.poll(LONGEST):
                    return _answer(self._line.recv())
            self._follow()
        raise BankError(f"{wanted}: no process lived to make it")

    def _follow(self) -> None:
        """Put a new process in the place of this one."""
        with self._changing:
            if self._closed:
                raise BankError("the server ends")
            self._end()
            self._begin()

    def close(self) -> None:
        """End the process, whatever it does."""
        with self._changing:
            self._closed = True
            self._end()

    def _end(self) -> None:
        self.process.kill()
        self.process.join()


def _answer(told: bytes | Exception) -> bytes:
    if isinstance(told, bytes):
        return told
    raise told


def _work(line: Connection, bank: Bank) -> None:
    """Make what is wanted until nobody wants anything."""
    import numpy as np  # what the first question will need

    from quizgen.question import compose

    del np, compose
    with contextlib.suppress(EOFError, OSError):
        while True:
            line.send(_made(bank, line.recv()))


def _made(bank: Bank, wanted: QuestionRequest | WorkerJob) -> bytes | Exception:
    try:
        return run_request(bank, wanted)
    except Exception as error:
        return error
