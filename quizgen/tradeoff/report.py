"""Measure everything once: plain data that the page and its plot are written from."""

from __future__ import annotations

import os
import platform
import time
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np

from quizgen.bank.bank import Bank
from quizgen.tradeoff.formulas import FORMULAS
from quizgen.tradeoff.questions import Questions, measure_questions
from quizgen.tradeoff.rivals import Match, matches
from quizgen.tradeoff.sweeps import FormulaSweep, sweep_formula


@dataclass(frozen=True)
class TradeoffReport:
    """Everything that the page shows, with where and when it was measured."""

    sweeps: tuple[FormulaSweep, ...]
    questions: Questions
    matches: tuple[Match, ...]
    machine: str
    date: str
    seconds: float

    @property
    def formulas_keeping_digits(self) -> tuple[int, int]:
        """How many printed formulas keep how many digits in an exam: all but the worst one."""
        worst = sorted(int(one.exam_digits) for one in self.sweeps)
        return len(worst) - 1, worst[1]

    @property
    def exam(self) -> float:
        """How near to its difficulty any printed formula comes in an exam."""
        return min(one.exam_left for one in self.sweeps)


def measure_tradeoff(bank: Bank) -> TradeoffReport:
    """Return the report, measured now: digits, questions and arrays.

    Parameters
    ----------
    bank : Bank
        The questions that are timed.
    """
    start = time.perf_counter()
    sweeps = tuple(map(sweep_formula, FORMULAS))
    questions, arrays = measure_questions(bank), tuple(matches())
    machine = (
        f"{platform.system()} {platform.machine()}, {os.cpu_count()} CPU, "
        f"Python {platform.python_version()}, NumPy {np.__version__}"
    )
    date = datetime.now(UTC).date().isoformat()
    return TradeoffReport(sweeps, questions, arrays, machine, date, time.perf_counter() - start)
