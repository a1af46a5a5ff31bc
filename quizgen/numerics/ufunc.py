"""How a formula is run over arrays: in blocks, with exact fractions for the few doubtful elements.

Formulas see one-dimensional blocks that fit the cache and only elements that have an answer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import msgspec
import numpy as np

from quizgen.numerics.domain import (
    Array,
    ArrayFormula,
    Constraint,
    DomainError,
    Exact,
    Flags,
    FloatOrArray,
    Interval,
    Numbers,
)
from quizgen.numerics.rational import exact_arguments, nearest_double

BLOCK = 32768
"""Elements per block: temporaries stay near the processor, and calls are few."""


class StableUfunc(msgspec.Struct, frozen=True):
    """A formula on arrays, where it has an answer and where doubles are trusted.

    Parameters
    ----------
    formula : callable
        Takes blocks, returns a block or one per output. A NaN asks for ``exact``.
    spans : sequence of Interval
        Where each argument must lie to have an answer.
    rules : sequence of Constraint
        Relations without an answer.
    exact : callable, optional
        The same quantity for fractions, one element at a time (microseconds).
    least, reach : float
        ``formula`` is trusted for magnitudes between them.
    outputs : int
        Number of result arrays.
    """

    formula: ArrayFormula
    spans: Sequence[Interval]
    rules: Sequence[Constraint] = ()
    exact: Exact | None = None
    least: float = 0.0
    reach: float = math.inf
    outputs: int = 1

    def __call__(self, *args: Numbers) -> FloatOrArray:
        """Return the formula's value for scalars or arrays that broadcast together.

        It is a float for scalars and an array for others, masked where there is no answer.
        """
        shape, columns = broadcast_flat(*args)
        with np.errstate(all="ignore"):
            results = (
                self._evaluate_blocks(columns, shape) if shape else self._evaluate_scalar(columns)
            )
        return results if self.outputs > 1 else results[0]

    def _evaluate_scalar(self, args: list[Array]) -> tuple[float, ...]:
        """Return the results for one element; raise ``DomainError`` if there is no answer."""
        reason = self._find_domain_error(args)
        if reason is not None:
            raise DomainError(reason)
        return tuple(value[0].item() for value in self._evaluate_values(args))

    def _find_domain_error(self, args: list[Array]) -> str | None:
        """Return the reason why one element has no answer, or None."""
        for span, arg in zip(self.spans, args, strict=True):
            if not span.contains(arg[0]):
                return span.explain(float(arg[0]))
        return next((rule.reason for rule in self.rules if np.any(rule.broken(*args))), None)

    def _evaluate_blocks(self, args: list[Array], shape: tuple[int, ...]) -> tuple[Array, ...]:
        """Return the results for arrays of ``shape``, block by block."""
        columns = [np.full(math.prod(shape), np.nan) for _ in range(self.outputs)]
        masks: list[tuple[int, Flags]] = []
        for start, block in _iter_blocks(args, columns[0].size):
            parts = [column[start : start + BLOCK] for column in columns]
            bad = self._flag_undefined(block)
            if bad.any():
                masks.append((start, bad))
            if not bad.all():
                some = [arg[~bad] if arg.size > 1 else arg for arg in block]
                for part, value in zip(parts, self._evaluate_values(some), strict=True):
                    part[~bad] = value
        return tuple(_with_mask(column, masks).reshape(shape) for column in columns)

    def _flag_undefined(self, args: list[Array]) -> Flags:
        """Return flags of the elements without an answer."""
        bad = np.zeros(max(arg.size for arg in args), dtype=bool)
        for span, arg in zip(self.spans, args, strict=True):
            bad |= ~span.contains(arg)
        good = ~bad
        if good.any():
            some = [arg[good] if arg.size > 1 else arg for arg in args]
            for rule in self.rules:
                bad[good] |= rule.broken(*some)
        return bad

    def _evaluate_values(self, args: list[Array]) -> tuple[Array, ...]:
        """Return the results of a block, by fractions where the formula is not to be trusted."""
        values = self.formula(*args)
        columns = values if isinstance(values, tuple) else (values,)
        if self.exact is None:
            return columns
        flags = np.zeros(max(arg.size for arg in args), dtype=bool)
        for arg in args:  # zero is within reach
            size = np.abs(arg)
            flags |= (size > self.reach) | ((size < self.least) & (size > 0))
        for column in columns:
            flags |= np.isnan(column)
        return _replace_flagged(columns, flags, self.exact, args) if flags.any() else columns


def smallest_nonzero(sizes: Array) -> float:
    """Return the smallest of the values > 0, infinity without any; none may be negative."""
    least = float(sizes.min())
    return least or float(np.min(sizes, where=sizes > 0, initial=math.inf))


def _replace_flagged(
    columns: tuple[Array, ...], flags: Flags, exact: Exact, args: list[Array]
) -> tuple[Array, ...]:
    """Return the results with the flagged elements computed by exact fractions."""
    size = max(arg.size for arg in args)
    columns = tuple(column if column.size == size else np.full(size, column) for column in columns)
    for i in np.flatnonzero(np.broadcast_to(flags, size)):
        answer = exact(*exact_arguments(args, i))
        answers = answer if isinstance(answer, tuple) else (answer,)
        for column, value in zip(columns, answers, strict=True):
            column[i] = nearest_double(value)
    return columns


def broadcast_flat(*args: Numbers) -> tuple[tuple[int, ...], list[Array]]:
    """Return the common shape of the arguments, and each as a flat array of doubles.

    A single number, like the one camera of a picture, stays an array of one.
    """
    arrays = list(map(_to_doubles, args))
    shape = np.broadcast_shapes(*[array.shape for array in arrays])
    return shape, [
        array.reshape(-1)
        if array.size == 1
        else np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1)
        for array in arrays
    ]


def _to_doubles(arg: Numbers) -> Array:
    """Return an argument as doubles: masked elements are NaN, huge integers infinity.

    Raises ``TypeError`` for complex numbers.
    """
    array = np.asarray(arg)
    if array.dtype.kind == "c":  # NumPy would warn, and drop what is imaginary
        raise TypeError("the array functions take real numbers, not complex ones")
    if hasattr(arg, "mask") and isinstance(arg, np.ma.MaskedArray):  # np.ma takes long to load
        return np.asarray(np.ma.filled(arg.astype(np.float64), np.nan))
    try:
        with np.errstate(over="ignore"):
            return array.astype(np.float64, copy=False)
    except OverflowError:
        return np.vectorize(_round_integer, otypes=[np.float64])(array)


def _round_integer(value: int) -> float:
    """Return an integer as the nearest double, infinity if it is too large."""
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _iter_blocks(args: list[Array], size: int) -> Iterator[tuple[int, list[Array]]]:
    """Yield the start of each block and its part of every argument; arrays of one stay whole."""
    for start in range(0, size, BLOCK):
        yield start, [arg if arg.size == 1 else arg[start : start + BLOCK] for arg in args]


def _with_mask(column: Array, masks: list[tuple[int, Flags]]) -> Array:
    """Return the column, masked where flags (each with its start) say there is no answer."""
    if not masks:
        return column
    mask = np.zeros(column.size, dtype=bool)
    for start, bad in masks:
        mask[start : start + bad.size] = bad
    return np.ma.MaskedArray(column, mask=mask)
