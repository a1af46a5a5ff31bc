"""Learners' programs: run on hidden inputs by a process that is locked down.

What was typed never runs in this process. Where the machine cannot bound memory, files and time
of another process, nothing runs and a person decides.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from threading import BoundedSemaphore
from typing import Any, TypeAlias

import msgspec

from quizgen.core.decoding import decode_json

RUNNER = Path(__file__).with_name("program_runner.py")
HANGS = 20.0
"""Seconds after which the process is killed: the machine is too busy for the little it computes."""
AT_ONCE = 2
"""Processes at the same time: a class that hands in at once waits its turn."""
LARGEST = 100_000
"""Characters of an outcome."""
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


@lru_cache(maxsize=256)
def _run_job(job: str) -> ProgramOutcome:
    """Return the outcome of a job, cached: the same answer need not run again.

    Raises
    ------
    OSError
        If there is none, and there may be one another time.
    """
    import subprocess  # only where a program runs: marking loads nothing of it

    environment = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "LANG": "C.UTF-8"}
    try:
        with _TURNS:
            done = subprocess.run(
                [sys.executable, "-I", "-B", str(RUNNER)],
                input=job.encode(),
                capture_output=True,
                timeout=HANGS,
                env=environment,
                cwd="/",
                start_new_session=True,
                check=False,
            )
    except subprocess.TimeoutExpired:
        raise OSError(f"no outcome after {HANGS:g} seconds") from None
    if done.returncode < 0 or b"MemoryError" in done.stderr:  # killed by its limits
        return ProgramOutcome(refused="program-time")
    if done.returncode:
        raise OSError(done.stderr.decode("utf-8", "replace").strip()[-300:])
    return decode_json(done.stdout[:LARGEST], ProgramOutcome)
