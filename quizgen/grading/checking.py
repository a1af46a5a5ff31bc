"""Answers that an author's ``check.py`` judges: in a process of its own, and only if trusted.

A key names the file by its digest and holds no code: what runs is a file below a folder that
somebody trusted, and exactly the one that the key was made with. Where there is none, a person
decides.
"""

from __future__ import annotations

import multiprocessing
import signal
import threading
from collections.abc import Iterable, Mapping
from contextlib import redirect_stdout
from fractions import Fraction
from functools import cache, lru_cache
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import module_from_spec
from io import StringIO
from numbers import Real
from typing import TYPE_CHECKING, Any, TypeAlias

import msgspec

from quizgen.core.errors import QuizgenError
from quizgen.core.trusted_files import find_trusted_file
from quizgen.grading.reading.answer_reader import drop_reason, write_in_signs
from quizgen.grading.reading.formulas import read_formula
from quizgen.grading.reading.matrices import split_matrix
from quizgen.maths.notation import FormulaReadError

if TYPE_CHECKING:
    from types import FrameType

    from quizgen.core.executor import ProcessExecutor

SECONDS = 5
"""What a check may take for one answer."""
PAIR = 2
"""What a check gives: a share and the name of a sentence."""
HANGS = 30.0
"""Seconds after which its process is killed: it did not even notice that its time was over."""
CHECK = "check.py"

CheckValue: TypeAlias = str | list[str]
"""A quantity of the question as a key holds it: a rational number or a text, or a list of them."""


class CheckOutcome(msgspec.Struct, frozen=True):
    """What a check said of an answer.

    Parameters
    ----------
    share : Fraction or None
        Of the points; None if it could not read the answer.
    says : str
        Name of the sentence for the learner.
    fault : str
        Why there is no outcome, for authors; empty if there is one.
    """

    share: Fraction | None = None
    says: str = ""
    fault: str = ""


def run_check(
    digest: str, function: str, values: Mapping[str, CheckValue], typed: str
) -> CheckOutcome:
    """Return what the check of a digest says of a typed answer.

    It never raises for what the check does: a fault of it is part of the outcome.

    Raises
    ------
    FormulaReadError
        If the check could not read the answer, and says where.
    """
    source = find_trusted_file(f"*/*/{CHECK}", digest)
    if source is None:
        return CheckOutcome(fault="its check.py is not here, or its bank is not trusted")
    job = (source, function, dict(values), typed)
    if multiprocessing.current_process().daemon:  # which may start no process, and is one itself
        return _run_within_time(*job)
    try:
        return _get_executor().submit(_run_within_time, *job).result()
    except QuizgenError as error:
        if isinstance(error, FormulaReadError):
            raise
        return CheckOutcome(fault=str(error))


@cache
def _get_executor() -> ProcessExecutor:
    """Return the process that checks run in; one that hangs is killed and replaced."""
    from quizgen.core.executor import ProcessExecutor  # only where there is a check

    return ProcessExecutor(1, longest=HANGS)


def _run_within_time(
    source: bytes, function: str, values: dict[str, CheckValue], typed: str
) -> CheckOutcome:
    """Run a check in this process, for ``SECONDS`` at most where there is such a timer."""
    timed = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
    try:
        check = _load_check(source)[
            function
        ]  # before the clock: an import that is cut stays broken
        before = signal.signal(signal.SIGALRM, _end_check) if timed else None
        if timed:
            signal.setitimer(signal.ITIMER_REAL, SECONDS)
        try:
            given = {name: _to_python(value) for name, value in values.items()}
            with redirect_stdout(StringIO()):
                found = check(given, typed)
        finally:
            if timed:
                signal.setitimer(signal.ITIMER_REAL, 0)
                signal.signal(signal.SIGALRM, before)
        return _read_outcome(found)
    except FormulaReadError:
        raise
    except BaseException as error:  # noqa: BLE001 - an author's Python may raise anything
        return CheckOutcome(fault=f"{type(error).__name__}: {error}"[:500])


def _end_check(_signal: int, _frame: FrameType | None) -> None:
    """Raise that the time of a check is over."""
    raise TimeoutError(f"it takes more than {SECONDS} seconds")


class _TrustedSource(SourceFileLoader):
    """Loader of a check from the text that was found by its digest, not from a file again."""

    def __init__(self, source: bytes) -> None:
        """Take the text."""
        super().__init__("check", CHECK)
        self._source = source

    def path_stats(self, path: str) -> Mapping[str, Any]:
        """Raise that there is no such file: neither is one read nor bytecode kept of it."""
        raise OSError(path)

    def get_data(self, path: str) -> bytes:
        """Return the text; there is no bytecode of it."""
        if path != CHECK:
            raise OSError(path)
        return self._source


@lru_cache(maxsize=64)
def _load_check(source: bytes) -> dict[str, Any]:
    """Return the names of a check's module, run once for each text of it."""
    if b"sympy" in source:  # which read_as_sympy needs, too
        import sympy  # noqa: F401
    loader = _TrustedSource(source)
    module = module_from_spec(ModuleSpec("check", loader, origin=CHECK))
    loader.exec_module(module)
    return vars(module)


def _to_python(value: CheckValue) -> Any:
    """Return a quantity as a check takes it: whole numbers, fractions, texts, lists of them."""
    if isinstance(value, list):
        return [_to_python(one) for one in value]
    try:
        number = Fraction(value)
    except (ValueError, ZeroDivisionError):
        return value
    return number.numerator if number.denominator == 1 else number


def _read_outcome(found: Any) -> CheckOutcome:
    """Return what a check gave as an outcome; a fault if it is nothing that it may give."""
    share, says = found if isinstance(found, tuple) and len(found) == PAIR else (found, "")
    if isinstance(says, str) and share is None:
        return CheckOutcome(None, says)
    if isinstance(says, str) and isinstance(share, Real) and 0 <= float(share) <= 1:
        # As it is written, so that 0.1 is a tenth; a truth is 0 or 1.
        exactly = str(int(share)) if isinstance(share, bool) else str(share)
        return CheckOutcome(Fraction(exactly), says)
    what = f"it gives {found!r}; a share from 0 to 1 or None is expected, alone or with a name"
    return CheckOutcome(fault=what[:500])


def read_matrix_as_sympy(typed: str, symbols: str | Iterable[str] = "") -> Any:
    """Return a typed matrix, ``[1, 2; 3, 4]`` or a row on each line, as a SymPy matrix.

    Parameters
    ----------
    typed : str
    symbols : str or iterable of str
        The names that its entries may have.

    Raises
    ------
    FormulaReadError
        If it cannot be read; a check that lets it pass has the answer asked back.
    """
    from sympy import Matrix

    return Matrix([[read_as_sympy(one, symbols) for one in row] for row in split_matrix(typed)])


def read_as_sympy(typed: str, symbols: str | Iterable[str], *, log: str = "") -> Any:
    """Return a typed formula as a SymPy expression; nothing that was typed is run as code.

    Parameters
    ----------
    typed : str
        As students type it: ``2x^2 + sin 3x``, LaTeX, decimal commas.
    symbols : str or iterable of str
        The names that it may have, such as ``"x C1 C2"``.
    log : {"", "ln", "log2", "log10"}
        What ``log`` without a base means; without it, such an answer is asked back.

    Raises
    ------
    FormulaReadError
        If it cannot be read or has no value, as 1/0; a check that lets it pass has the answer
        asked back.
    """
    from sympy import nan, oo, zoo

    from quizgen.grading.judging.sympy_equality import to_sympy

    names = symbols.split() if isinstance(symbols, str) else list(symbols)
    written = write_in_signs(drop_reason(typed))
    found = to_sympy(read_formula(written, names, log=log).tree, frozenset(), real=False)
    if found.has(nan, zoo, oo):
        raise FormulaReadError("no-value", 1, typed)
    return found
