"""The working precision of certified numbers, whatever else the process does with FLINT.

FLINT keeps one precision for the whole process, and every operation on a ball reads it: sums and
roots, but also a minus sign, an absolute value and a comparison with a rational. So each stretch of
work on balls states its precision, and no other thread works on balls meanwhile. Rationals are
exact without it.

Examples
--------
>>> from flint import arb
>>> with working_precision():
...     root = arb(2).sqrt()
>>> root.rel_accuracy_bits() > 150
True
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import wraps
from threading import RLock
from typing import ParamSpec, TypeVar

from flint import ctx

PRECISION = 160
"""Working precision of certified balls in bits."""

WIDE = 400
"""Precision in bits at which digits are read off: wider than any ball to be written."""

Result = TypeVar("Result")
Argument = TypeVar("Argument")
Given = ParamSpec("Given")

_LOCK = RLock()
_OUTER: list[int] = []
"""Precisions to go back to, innermost last; touched only under the lock."""

os.register_at_fork(
    before=_LOCK.acquire, after_in_parent=_LOCK.release, after_in_child=_LOCK.release
)


class working_precision:  # noqa: N801 - reads as a statement
    """Work on balls with so many bits: one thread at a time, nested at will.

    Never hold it across a ``yield``: the precision would leak into the caller. Used as a decorator
    it spans the whole call.

    Parameters
    ----------
    bits : int
        Precision in force inside.
    """

    def __init__(self, bits: int = PRECISION) -> None:
        """Store the bits; nothing is set before the block begins."""
        self.bits = bits

    def __call__(self, function: Callable[Given, Result]) -> Callable[Given, Result]:
        """Return the function with the precision set around each call."""

        @wraps(function)
        def run(*args: Given.args, **named: Given.kwargs) -> Result:
            """Return what the function returns, computed with the precision."""
            with self:
                return function(*args, **named)

        return run

    def __enter__(self) -> None:
        """Take the lock, and set the precision if it is another one."""
        _LOCK.acquire()
        outer = ctx.prec
        _OUTER.append(outer)
        if outer != self.bits:  # setting it costs ten times as much as reading it
            ctx.prec = self.bits

    def __exit__(self, *_error: object) -> None:
        """Go back to the precision from before, and release the lock."""
        outer = _OUTER.pop()
        if ctx.prec != outer:
            ctx.prec = outer
        _LOCK.release()


def at_working_precision(function: Callable[[Argument], Result]) -> Callable[[Argument], Result]:
    """Return a function that keeps the precision set around its call, else sets ``PRECISION``."""
    usual = working_precision()

    def run(argument: Argument) -> Result:
        """Return what the function returns, at a precision that was set."""
        with _LOCK:
            if _OUTER:
                return function(argument)
            with usual:
                return function(argument)

    return run
