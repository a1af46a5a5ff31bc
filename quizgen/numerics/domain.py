"""What goes in and out of array functions, and what happens when there is no answer.

Policy, the same for every function of this package:

* A pole is an infinity (object in the focal plane, far limit beyond the hyperfocal distance).
* A value beyond the range of binary64 is rounded like any other: to infinity, or to zero.
* No answer (beyond the fold, hue of a grey, empty range, ...) raises ``DomainError`` when all
  arguments are scalars. With arrays the result is a ``numpy.ma.MaskedArray``, masked exactly
  where there is no answer (NaN lies under the mask). When every element has an answer, the
  result is a plain array. ``is_defined(result)`` is the mask to ask for in both cases.
* Arguments that are not finite have no answer (reason ``not-finite``), nor have those outside
  the range that a function states.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import numpy.typing as npt

Numbers = npt.ArrayLike
"""What the public functions take: a number, a list, an array."""

FloatOrArray = Any
"""What they return: a float for scalar arguments, else an array (masked without an answer)."""

Array = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]
Counts = npt.NDArray[np.int64]

ArrayLike = Array | tuple[Array, ...]
"""A block of the result, or one block of every result."""

ArrayFormula = Callable[..., ArrayLike]
"""A formula on blocks; a block of one element stands for all elements."""

Exact = Callable[..., Any]
"""The same quantity for fractions, as fractions."""


class DomainError(ValueError):
    """A function has no answer for scalar arguments; arrays are masked instead.

    Parameters
    ----------
    reason : str
        Language-free name of the reason, for example ``beyond-fold``.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class Interval(msgspec.Struct, frozen=True):
    """The interval in which an argument must lie, and the reason given when it does not."""

    low: float = -math.inf
    high: float = math.inf
    reason: str = "not-finite"
    closed: bool = False

    def contains(self, value: float | Array) -> Any:
        """Return whether values lie inside, by element; no for NaN."""
        if self.closed:
            return np.isfinite(value) & (value >= self.low) & (value <= self.high)
        return np.isfinite(value) & (value > self.low) & (value < self.high)

    def explain(self, value: float) -> str:
        """Return the reason why a value outside has no answer."""
        return self.reason if math.isfinite(value) else "not-finite"


REAL = Interval()
NONNEGATIVE = Interval(low=0.0, reason="negative", closed=True)


class Constraint(msgspec.Struct, frozen=True):
    """A relation between arguments for which there is no answer, such as z = 0.

    ``broken(*args)`` flags the elements that have it, and ``reason`` names it.
    """

    reason: str
    broken: Callable[..., Any]


def is_defined(result: FloatOrArray) -> Any:
    """Return which elements of an array result have an answer; True for a scalar."""
    return ~np.ma.getmaskarray(result) if isinstance(result, np.ndarray) else True
