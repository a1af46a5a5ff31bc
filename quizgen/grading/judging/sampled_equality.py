"""Are two formulas equal? Sampled in exact or certified arithmetic over the declared domain."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.core.errors import MathError, UndecidedError
from quizgen.maths.constants import Scalar, TooLargeError, bounded_exact_system, parse_exact
from quizgen.maths.notation import FormulaReadError
from quizgen.maths.number_systems import CompiledFormula, compile_expr, compile_nested
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Expr, names_in
from quizgen.maths.values import Value, Values

POINTS = 8
"""Points at which both formulas must have a value and agree."""

TRIES = 96
"""Points tried: a key may have a value on a part of the declared domain only."""

BITS = 128
"""Working precision: a difference beyond 30 digits is seen."""

Domain = str | list[Scalar]
SampleInterval = str | tuple[Scalar, ...]
"""A domain that can be looked up: ``real``, ``positive`` or its two bounds."""

Env = Values


class SamplingResult(msgspec.Struct, frozen=True):
    """What sampling found.

    ``equal`` is None when it could not be decided; ``ratio`` and ``difference`` are the common
    factor and offset of two different formulas, if there are any.
    """

    equal: bool | None
    points: int
    ground: str
    ratio: Value | None = None
    difference: Value | None = None


@lru_cache(maxsize=512)
def _draw_sample_points(
    domains: tuple[tuple[str, SampleInterval], ...],
) -> tuple[dict[str, fmpq], ...]:
    """The sample points of some domains: the same in every process."""
    source = random.Random("|".join(map(str, domains)))  # noqa: S311 - points, not secrets
    return tuple(
        {name: _draw_sample_value(domain, source) for name, domain in domains} for _ in range(TRIES)
    )


def _draw_sample_value(domain: SampleInterval, source: random.Random) -> fmpq:
    size = fmpq(source.randint(1, 4095), 2 ** source.randint(8, 12)) + fmpq(1, 977)
    if domain == "positive":
        return size
    if domain == "real":
        return size if source.random() < 0.5 else -size
    low, high = (parse_exact(bound) for bound in domain)
    return low + (high - low) * fmpq(source.randint(1, 4094), 4096) + (high - low) * fmpq(1, 9767)


def sample_points(symbols: Mapping[str, Domain]) -> tuple[dict[str, fmpq], ...]:
    """Return rational points of the domain: both signs for ``real``, spread over the magnitudes."""
    return _draw_sample_points(_freeze_domains(symbols))


def _freeze_domains(symbols: Mapping[str, Domain]) -> tuple[tuple[str, SampleInterval], ...]:
    return tuple([(n, tuple(d) if isinstance(d, list) else d) for n, d in sorted(symbols.items())])


def compile_exact(tree: Expr) -> Callable[[Env], Any]:
    """Compile a formula for bounded exact evaluation.

    The result is None where it has no value, and the class ``Undecided`` or ``TooLargeError``
    where that cannot be told.
    """
    return _guard_evaluation(compile_expr(tree, bounded_exact_system()))


def _guard_evaluation(function: CompiledFormula) -> Callable[[Env], Any]:
    """Say what a formula's value is, or why it has none."""

    def evaluate(env: Env) -> Any:
        try:
            return function(env)
        except UndecidedError:
            return UndecidedError
        except TooLargeError:
            return TooLargeError
        except (MathError, ArithmeticError, ValueError, TypeError, AttributeError):
            return None  # the last two where a truth is reckoned with

    return evaluate


class SampledFormula:
    """A formula's values at some points, each computed when it is first asked for.

    The precision is stated once around all of them.
    """

    def __init__(self, tree: Expr, points: Sequence[Env]) -> None:
        self.points = points
        self._function = _guard_evaluation(compile_nested(tree, bounded_exact_system()))
        self._values: list[Any] = []

    def at(self, index: int) -> Any:
        """The value at one point."""
        while len(self._values) <= index:
            self._values.append(self._function(self.points[len(self._values)]))
        return self._values[index]


@lru_cache(maxsize=512)
def _of_key(tree: Expr, domains: tuple[tuple[str, SampleInterval], ...]) -> SampledFormula:
    """The values of a key, which a whole class is compared with."""
    return SampledFormula(tree, _draw_sample_points(domains))


def are_equal(first: Expr, second: Expr, symbols: Mapping[str, Domain]) -> bool | None:
    """Whether a typed formula equals another one, as ``compare`` finds it."""
    return compare_by_sampling(first, second, symbols, related=False).equal


def compare_by_sampling(
    first: Expr, second: Expr, symbols: Mapping[str, Domain], *, related: bool = True
) -> SamplingResult:
    """Compare a typed formula with the key.

    Parameters
    ----------
    first, second : Expr
        The key and the typed formula.
    symbols : mapping of str to domain
        ``real``, ``positive`` or ``[low, high]`` per name.
    related : bool
        Whether to look for the factor or offset between different ones.
    """
    used = names_in(first) | names_in(second)
    if not used:
        return _compare_constants(first, second)
    wanted = {name: domain for name, domain in symbols.items() if name in used}
    typed = SampledFormula(second, sample_points(wanted))
    with working_precision(BITS):
        key = _of_key(first, _freeze_domains(wanted))
        found = _compare_at_samples(key, typed)
        return _find_relation(key, typed, found) if related and found.ground == "differs" else found


def _compare_constants(first: Expr, second: Expr) -> SamplingResult:
    with working_precision(2 * BITS):
        a, b = compile_exact(first)({}), compile_exact(second)({})
        if b is TooLargeError:
            raise FormulaReadError("too-large", 1)
        if b is None or a is None:
            return SamplingResult(equal=False, points=1, ground="domain")
        if isinstance(a, type) or isinstance(b, type):
            return SamplingResult(equal=None, points=0, ground="undecided")
        exact = isinstance(a, fmpq) and isinstance(b, fmpq)
        return SamplingResult(values_agree(a, b), 1, "proved" if exact else "sampled")


def _compare_at_samples(key: SampledFormula, typed: SampledFormula) -> SamplingResult:
    apart = large = met = 0
    sure = True
    for index in range(len(key.points)):
        a, b = key.at(index), typed.at(index)
        large += b is TooLargeError
        if isinstance(a, type) or isinstance(b, type):
            continue
        if a is None or b is None:
            apart += a is not None
            continue
        met += 1
        same = values_agree(a, b)
        if same is False:
            return SamplingResult(equal=False, points=met, ground="differs")
        sure = sure and same is True
        if met == POINTS:
            break
    if large == len(key.points):
        raise FormulaReadError("too-large", 1)
    if apart:
        return SamplingResult(equal=False, points=met + apart, ground="domain")
    if met < POINTS or not sure:
        return SamplingResult(equal=None, points=met, ground="undecided")
    return SamplingResult(equal=True, points=met, ground="sampled")


def values_agree(a: Value, b: Value) -> bool | None:
    """Whether two values agree: exactly, or as sharp balls; None if the balls are too wide."""
    if isinstance(a, fmpq) and isinstance(b, fmpq):
        return bool(a == b)
    difference = a - b
    if difference != 0:
        return False
    size = abs(a) + abs(b)
    sharp = abs(difference) < (size + fmpq(1, 10**30)) * fmpq(1, 10**20)
    return True if sharp else None


def _find_relation(
    key: SampledFormula, typed: SampledFormula, found: SamplingResult
) -> SamplingResult:
    """Tell whether two different formulas differ by a factor or by an offset."""
    pairs = [(key.at(index), typed.at(index)) for index in range(12)]
    valued = [(a, b) for a, b in pairs if not any(map(_without_value, (a, b)))]
    ratio, difference = _find_common_ratio_or_offset(valued) if len(valued) >= 3 else (None, None)
    return replace(found, ratio=ratio, difference=difference)


def _without_value(value: object) -> bool:
    return value is None or isinstance(value, type)


def _find_common_ratio_or_offset(pairs: list[tuple[Any, Any]]) -> tuple[Any, Any]:
    if any(a == 0 or b == 0 for a, b in pairs):
        return None, None
    ratios = [b / a for a, b in pairs]
    offsets = [b - a for a, b in pairs]
    same_ratio = all(values_agree(ratios[0], other) for other in ratios[1:])
    same_offset = all(values_agree(offsets[0], other) for other in offsets[1:])
    return (ratios[0] if same_ratio else None), (offsets[0] if same_offset else None)
