"""One way of computing a family, and what several ways share: balls, rounding, digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from quizgen.errors import MathError
from quizgen.maths.precision import working_precision

Column = npt.NDArray[np.floating[Any]]
"""One input of many rows, as doubles or as float32."""

Row = Sequence[float]
"""All inputs of one computation."""

Value = Any
"""A number of the system that a rung computes in: double, column, fraction, ball, mpf, ..."""

Inputs = Mapping[str, Value]
"""Quantities by name, in the number system of a rung."""

WANTED_BITS = 63
"""Relative bits asked of a ball, so that rounding it to 53 bits is right."""

MOST_BITS = 12800
DIGITS = 50


@dataclass(frozen=True)
class Rung:
    """One way of computing.

    Parameters
    ----------
    key : str
        Language-free name; the words stand in ``words/*.toml``.
    kind : str
        ``array`` (``run`` takes columns) or ``scalar`` (``run`` takes one prepared input).
    run : callable
        The computation that is timed.
    prepare : callable
        Turns a row of doubles into what a scalar ``run`` takes; not timed.
    finish : callable
        Turns what ``run`` returns into doubles; not timed.
    """

    key: str
    kind: str
    run: Callable[..., Any]
    prepare: Callable[[Any], Any] = tuple
    finish: Callable[[Any], Any] = float


def to_float(value: Value) -> float:
    """Nearest double of an exact rational or the middle of a ball."""
    if hasattr(value, "rel_accuracy_bits"):
        return float(value.mid())
    if hasattr(value, "p") and hasattr(value, "q"):
        return int(value.p) / int(value.q)
    return float(value)


def ball_value(compiled: Callable[..., Any], inputs: Inputs, wanted: int = WANTED_BITS) -> Value:
    """Evaluate with balls, doubling the precision until enough bits are certain.

    Raises
    ------
    MathError
        If 12800 bits are not enough.
    """
    import flint

    precision = 80
    while precision <= MOST_BITS:
        with working_precision(precision):
            try:
                value = compiled({name: flint.arb(q) for name, q in inputs.items()})
            except (MathError, ZeroDivisionError):
                value = None
            if value is not None and (not hasattr(value, "rad") or _certain(value, wanted)):
                return value
        precision *= 2
    raise MathError("a ball does not become small enough")


def _certain(value: Value, wanted: int) -> bool:
    return bool(value.rel_accuracy_bits() >= wanted or value.is_zero())
