"""Learners' programs: run on hidden inputs, each in a process that is locked down.

What was typed never runs in this process. Where the machine cannot bound memory, files and time
of another process, nothing runs and a person decides.
"""

from __future__ import annotations

import atexit
import json
import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from threading import BoundedSemaphore
from typing import Any, TypeAlias

import msgspec

from quizgen.core.decoding import decode_json

RUNNER = Path(__file__).with_name("program_runner.py")
AT_ONCE = 2
"""Processes at the same time: a class that hands in at once waits its turn."""
_TURNS = BoundedSemaphore(AT_ONCE)

ArrayValues: TypeAlias = dict[str, Any]
"""An array: the name of its type to its values in nested lists."""
ProgramInput: TypeAlias = int | float | ArrayValues


class ProgramOutcome(msgspec.Struct, frozen=True, kw_only=True):
    """What a program did on hidden inputs.

    Parameters
    ----------
    missed : tuple of str
        Cases in which it gives something else than the solution.
    changed : bool
        Whether it changed its inputs.
    trap : str
        The known wrong program that does the same in all cases.
    call, difference
        The first call that went wrong, and a note with fields that says how.
    refused, line, found
        Why it did not run, and where; empty if it did.
    fault : str
        Why there is no outcome, for authors; empty if there is one.
    """

    missed: tuple[str, ...] = ()
    changed: bool = False
    trap: str = ""
    call: str = ""
    difference: dict[str, str] = msgspec.field(default_factory=dict)
    refused: str = ""
    line: int = 0
    found: str = ""
    fault: str = ""


def can_run_programs() -> bool:
    """Return whether this machine can lock a process down."""
    return sys.platform.startswith("linux")


def run_program(
    text: str,
    *,
    function: str,
    parameters: str,
    solution: str,
    traps: Mapping[str, str],
    cases: Mapping[str, list[ProgramInput]],
) -> ProgramOutcome:
    """Return what a typed program does on hidden inputs, next to the solution and wrong programs.

    It never raises for what was typed.
    """
    if not can_run_programs():
        return ProgramOutcome(fault="programs are not run on this machine")
    job = {"program": text, "function": function, "parameters": parameters, "solution": solution,
           "traps": dict(traps), "cases": dict(cases)}  # fmt: skip
    try:
        return _run_job(json.dumps(job))
    except OSError as error:
        return ProgramOutcome(fault=str(error)[:200])


class _Runner:
    """A process that has loaded NumPy and gives each job a fork of its own."""

    def __init__(self) -> None:
        import subprocess  # only where a program runs: marking loads nothing of it

        environment = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "LANG": "C.UTF-8"}
        self.owner = os.getpid()
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-B", str(RUNNER)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
            cwd="/",
            start_new_session=True,
        )

    def run(self, job: bytes) -> bytes | None:
        """Return what came of a job; None where the process has ended."""
        lines, told = self._process.stdin, self._process.stdout
        if lines is None or told is None:
            return None
        with suppress(BrokenPipeError):
            lines.write(b"%d\n%b" % (len(job), job))
            lines.flush()
            length = told.readline()
            if length:
                return told.read(int(length))
        self.end()
        return None

    def end(self) -> None:
        """End the process, which reads no further job."""
        with suppress(BrokenPipeError):
            self._process.communicate()


_IDLE: list[_Runner] = []
"""Processes that wait for a job."""


def _pop_idle() -> _Runner | None:
    """Return a process that waits for a job of this process; None if none does."""
    with suppress(IndexError):
        while True:
            runner = _IDLE.pop()
            if runner.owner == os.getpid():  # else this process was forked, and it is the parent's
                return runner
    return None


@atexit.register
def _end_runners() -> None:
    """End the processes that wait."""
    while runner := _pop_idle():
        runner.end()


@lru_cache(maxsize=256)
def _run_job(job: str) -> ProgramOutcome:
    """Return the outcome of a job, cached: the same answer need not run again.

    Raises
    ------
    OSError
        If there is none, and there may be one another time.
    """
    data = job.encode()
    with _TURNS:
        runner = _pop_idle() or _Runner()
        told = runner.run(data)
        if told is None:  # it had waited too long
            runner = _Runner()
            told = runner.run(data)
        if told is None:
            raise OSError("the process that runs programs has ended")
        _IDLE.append(runner)
    outcome = decode_json(told, ProgramOutcome)
    if outcome.fault:
        raise OSError(outcome.fault)
    return outcome
