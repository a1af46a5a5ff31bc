"""How kernels are run over arrays: in blocks, by the shortest way that keeps the digits.

Kernels see one-dimensional blocks that fit the cache and only elements that have an answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from quizgen.arrays.aliases import (
    Array,
    Blocks,
    Exact,
    Flags,
    Formula,
    Limits,
    Numbers,
    Result,
    Values,
)
from quizgen.arrays.domain import REAL, DomainError, Rule, Span
from quizgen.arrays.rational import exactly, nearest

BLOCK = 32768
"""Elements per block: temporaries stay near the processor, and calls are few."""

REACH = 2.0**120
"""Magnitudes from its inverse to it are moderate, unless a way says otherwise."""


@cache
def _settle_the_allocator() -> None:
    """Let the C library see a larger array come and go, once.

    Until then it gives temporaries from 128 KiB on back to the system one by one, which can cost
    as much as the computation. The array is never written to and takes no memory.
    """
    np.empty(16 * BLOCK)


@dataclass(frozen=True, slots=True)
class Short:
    """A shorter way for blocks of moderate size.

    Parameters
    ----------
    fill : callable
        Takes the blocks and then the arrays to be filled, one per output (see ``filled``).
    reach : float
        It takes arguments that are zero or of magnitude ``1/reach`` to ``reach``.
    watched : sequence of int, optional
        The arguments for which that matters (all of them by default).
    tiny : bool
        Whether it also takes magnitudes below ``1/reach``.
    fits : callable
        Further condition, on the limits of the arguments.
    """

    fill: Callable[..., None]
    reach: float = REACH
    watched: Sequence[int] | None = None
    tiny: bool = False
    fits: Callable[..., bool] = lambda *_limits: True

    def watches(self, i: int) -> bool:
        """Whether the size of an argument matters."""
        return self.watched is None or i in self.watched

    def takes(self, args: Blocks, limits: Sequence[Limits]) -> bool:
        """Whether a block may go this way."""
        chosen = range(len(args)) if self.watched is None else self.watched
        least = 0.0 if self.tiny else 1 / self.reach
        odd = any(_may_be_odd(args[i], limits[i], least, self.reach) for i in chosen)
        return not odd and self.fits(*limits)


@dataclass(frozen=True, slots=True)
class Exactly:
    """The same quantity for fractions, to settle what doubles leave in doubt.

    Parameters
    ----------
    formula : callable
        Takes ``fractions.Fraction`` arguments and returns what ``nearest`` takes.
    reach : float
        ``compute`` is trusted for zero and magnitudes from ``1/reach`` to ``reach``.
    """

    formula: Exact
    reach: float = REACH

    def settle(self, values: Values, doubtful: Flags | None, args: Blocks) -> Values:
        """Replace the doubtful values, and those of arguments beyond reach."""
        far = extreme(args, self.reach)
        flags = far if doubtful is None else doubtful if far is None else far | doubtful
        if flags is None or not flags.any():
            return values
        return _settled(values, flags, self.formula, args)


@dataclass(frozen=True, slots=True)
class Kernel:
    """How to compute a family member: one careful way, and two others around it.

    Parameters
    ----------
    compute : callable
        The careful way: takes blocks, returns ``Values``. With ``exact`` set it returns
        ``(values, doubtful)``: ``doubtful`` flags elements to be recomputed exactly, or is None.
    spans : sequence of Span
        Where each argument must lie to have an answer.
    rules : sequence of Rule
        Further relations without an answer.
    exact : Exactly, optional
        Settles doubtful elements, one by one.
    short : Short, optional
        Tried first, block by block.
    outputs : int
        Number of result arrays.
    """

    compute: Callable[..., Any]
    spans: Sequence[Span]
    rules: Sequence[Rule] = ()
    exact: Exactly | None = None
    short: Short | None = None
    outputs: int = 1

    def __call__(self, *args: Numbers) -> Result:
        """Run the kernel on scalars or arrays that broadcast together."""
        shape, columns = flattened(*args)
        with np.errstate(all="ignore"):
            return self._array(columns, shape) if shape else self._scalar(columns)

    def _scalar(self, args: list[Array]) -> Result:
        reason = self._why_not(args)
        if reason is not None:
            raise DomainError(reason)
        values = self.carefully(args)
        if isinstance(values, tuple):
            return tuple(value[0].item() for value in values)
        return values[0].item()

    def _why_not(self, args: list[Array]) -> str | None:
        for span, arg in zip(self.spans, args, strict=True):
            if not span.holds(arg[0], arg[0]):
                return span.reason_for(float(arg[0]))
        for rule in self.rules:
            if np.any(rule.broken(*args)):
                return rule.reason
        return None

    def _array(self, args: list[Array], shape: tuple[int, ...]) -> Result:
        _settle_the_allocator()
        columns = [np.empty(math.prod(shape)) for _ in range(self.outputs)]
        masks: list[tuple[int, Flags]] = []
        fixed = [_limits(arg) if arg.size == 1 else None for arg in args]
        checks = [self._check(i) for i in range(len(args))]
        for start, block in _blocks(args, columns[0].size):
            limits = [
                known or check(arg) for known, check, arg in zip(fixed, checks, block, strict=True)
            ]
            parts = [column[start : start + BLOCK] for column in columns]
            bad = self._fill(parts, block, limits)
            if bad is not None:
                masks.append((start, bad))
        results = tuple(_with_mask(column, masks).reshape(shape) for column in columns)
        return results if self.outputs > 1 else results[0]

    def _check(self, i: int) -> Callable[[Array], Limits]:
        """How an argument is looked at: only finite, or with its limits."""
        watched = self.short is None or self.short.watches(i)
        return _limits if watched or self.spans[i] != REAL else _finite_limits

    def _fill(self, parts: list[Array], args: list[Array], limits: list[Limits]) -> Flags | None:
        """Fill a block of the results and flag the elements without an answer."""
        bad = self._bad(args, limits)
        if bad is None and self.short is not None and self.short.takes(args, limits):
            self.short.fill(*args, *parts)
            return None
        good = slice(None) if bad is None else ~bad
        if bad is not None:
            for part in parts:
                part[bad] = np.nan  # masked later
            if bad.all():
                return bad
            args = [arg[good] if arg.size > 1 else arg for arg in args]
        values = self.carefully(args)
        for part, value in zip(
            parts, values if isinstance(values, tuple) else (values,), strict=True
        ):
            part[good] = value
        return bad

    def _bad(self, args: list[Array], limits: list[Limits]) -> Flags | None:
        spans = list(zip(self.spans, args, strict=True))
        if all(
            span.holds(*limit) for span, limit in zip(self.spans, limits, strict=True)
        ) and not any(rule.possible(*limits) and np.any(rule.broken(*args)) for rule in self.rules):
            return None
        bad = np.zeros(max(arg.size for arg in args), dtype=bool)
        for span, arg in spans:
            bad |= ~span.holds(arg, arg)
        good = ~bad
        if good.any():
            some = [arg[good] if arg.size > 1 else arg for arg in args]
            for rule in self.rules:
                bad[good] |= rule.broken(*some)
        return bad

    def carefully(self, args: Blocks) -> Values:
        """Compute blocks whose every element has an answer, and settle what is in doubt."""
        values: Values
        if self.exact is None:
            values = self.compute(*args)
            return values
        values, doubtful = self.compute(*args)
        return self.exact.settle(values, doubtful, args)


def in_short_blocks(fill: Callable[..., bool], kernel: Kernel, *args: Numbers) -> Result:
    """Run ``fill(*blocks, out)`` on arrays, and the kernel on the blocks that it refuses."""
    shape, columns = flattened(*args)
    result = np.empty(math.prod(shape))
    masks: list[tuple[int, Flags]] = []
    with np.errstate(all="ignore"):
        for start, block in _blocks(columns, result.size):
            part = result[start : start + BLOCK]
            if not fill(*block, part):
                careful = kernel(*block)
                part[...] = np.ma.getdata(careful)
                if isinstance(careful, np.ma.MaskedArray):
                    masks.append((start, np.ma.getmaskarray(careful)))
    return _with_mask(result, masks).reshape(shape)


def extreme(args: Sequence[Array], reach: float) -> Flags | None:
    """Flag elements with an argument that is not zero and not within ``1/reach .. reach``."""
    flags: Flags | None = None
    for arg in args:
        low, high = arg.min(), arg.max()
        if high <= reach and low >= 1 / reach:
            continue
        size = np.abs(arg)
        odd = (size > reach) | ((size < 1 / reach) & (size > 0))
        if odd.any():
            flags = odd if flags is None else flags | odd
    return flags


def _limits(arg: Array) -> Limits:
    return float(arg.min()), float(arg.max())


def _finite_limits(arg: Array) -> Limits:
    """Any limits will do for finite values, and a finite sum proves them finite."""
    total = float(arg.sum())
    return (0.0, 0.0) if math.isfinite(total) else _limits(arg)


def _may_be_odd(arg: Array, limits: Limits, least: float, reach: float) -> bool:
    """Whether a block has a value that is neither zero nor within least .. reach."""
    low, high = limits
    if high > reach or low < -reach:
        return True
    if least == 0 or low >= least or high <= -least:
        return False
    size = np.abs(arg) if low < 0 else arg
    return bool(((size < least) & (size > 0)).any())


def filled(formula: Formula) -> Callable[..., None]:
    """Make a formula with one result the ``fill`` of a short way."""

    def fill(*blocks: Array) -> None:
        blocks[-1][...] = formula(*blocks[:-1])

    return fill


def _settled(values: Values, flags: Flags, exact: Exact, args: Blocks) -> Values:
    """The values, exact where they are flagged."""
    columns = values if isinstance(values, tuple) else (values,)
    shape = max(arg.size for arg in args)
    columns = tuple(
        column if column.size == shape else np.full(shape, column) for column in columns
    )
    for i in np.flatnonzero(np.broadcast_to(flags, shape)):
        answer = exact(*exactly(args, i))
        answers = answer if isinstance(values, tuple) else (answer,)
        for column, value in zip(columns, answers, strict=True):
            column[i] = nearest(value)
    return columns if isinstance(values, tuple) else columns[0]


def flattened(*args: Numbers) -> tuple[tuple[int, ...], list[Array]]:
    """Give the common shape of some arguments and their values in a row.

    What is the same number throughout, like the one camera of a picture, becomes one value.
    """
    arrays = [np.asarray(arg, dtype=np.float64) for arg in args]
    shape = np.broadcast_shapes(*[array.shape for array in arrays])
    single = [_is_one_number(array) for array in arrays]
    if all(single) and math.prod(shape) > 1:
        return shape, [np.full(math.prod(shape), array.flat[0]) for array in arrays]
    return shape, [
        array.reshape(-1)[:1]
        if one
        else np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1)
        for array, one in zip(arrays, single, strict=True)
    ]


def _is_one_number(array: Array) -> bool:
    if array.size < 2:
        return array.size == 1
    first = array.flat[0]
    return bool(array.flat[-1] == first) and bool((array == first).all())


def _blocks(args: list[Array], size: int) -> Iterator[tuple[int, list[Array]]]:
    for start in range(0, size, BLOCK):
        yield start, [arg if arg.size == 1 else arg[start : start + BLOCK] for arg in args]


def _with_mask(column: Array, masks: list[tuple[int, Flags]]) -> Array:
    """The column, masked where there is no answer."""
    if not masks:
        return column
    mask = np.zeros(column.size, dtype=bool)
    for start, bad in masks:
        mask[start : start + bad.size] = bad
    return np.ma.MaskedArray(column, mask=mask)
