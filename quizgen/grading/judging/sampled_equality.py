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

_LARGEST_WHOLE = 40
"""Largest whole number at which formulas are compared."""

Domain = str | list[Scalar]
SampleInterval = str | tuple[Scalar, ...]
"""A domain that can be looked up: ``real``, ``positive``, ``whole`` or its two bounds."""

Env = Values


class SamplingResult(msgspec.Struct, frozen=True):
    """Whether two formulas are equal, and how far that is certain.

    Parameters
    ----------
    equal : bool or None
        None when it could not be decided.
    points : int
        Points at which the formulas were compared.
    ground : str
        ``proved`` (exact constants), ``sampled``, ``differs``, ``domain`` (one has a value where
        the other has none) or ``undecided``.
    ratio, difference : Value, optional
        Typed formula over key, and typed formula less key, where they are the same at all points
        of two different formulas.
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
    """Return the sample points of some domains: ``TRIES`` of them, the same in every process.

    The domains are the seed, so that an answer is judged alike today and when it is appealed.
    """
    source = random.Random("|".join(map(str, domains)))  # noqa: S311 - points, not secrets
    return tuple(
        {name: _draw_sample_value(domain, source) for name, domain in domains} for _ in range(TRIES)
    )


def _draw_sample_value(domain: SampleInterval, source: random.Random) -> fmpq:
    """Return a rational number of a domain: any size from 1e-3 to 16, or inside the two bounds.

    A whole number is one from 1 to 40.
    """
    if domain == "whole":
        return fmpq(source.randint(1, _LARGEST_WHOLE))
    # The offsets have a prime in the denominator, and all else a power of 2: no point is 0, 1, a
    # bound or a simple fraction, at which different formulas (x, x^2) happen to agree.
    size = fmpq(source.randint(1, 4095), 2 ** source.randint(8, 12)) + fmpq(1, 977)
    if domain == "positive":
        return size
    if domain == "real":
        return size if source.random() < 0.5 else -size
    low, high = (parse_exact(bound) for bound in domain)
    return low + (high - low) * fmpq(source.randint(1, 4094), 4096) + (high - low) * fmpq(1, 9767)


def sample_points(symbols: Mapping[str, Domain]) -> tuple[dict[str, fmpq], ...]:
    """Return rational points of the domain: both signs for ``real``, spread over the magnitudes.

    Each is a mapping of every name in ``symbols`` to a number; there are always ``TRIES``.
    """
    return _draw_sample_points(_freeze_domains(symbols))


def _freeze_domains(symbols: Mapping[str, Domain]) -> tuple[tuple[str, SampleInterval], ...]:
    """Return the domains as a sorted tuple, which a cache can look up."""
    return tuple([(n, tuple(d) if isinstance(d, list) else d) for n, d in sorted(symbols.items())])


def compile_exact(tree: Expr) -> Callable[[Env], Any]:
    """Return a formula compiled for bounded exact evaluation, which never raises.

    Its result is None where it has no value, and the class ``UndecidedError`` or
    ``TooLargeError`` where that cannot be told.
    """
    return _guard_evaluation(compile_expr(tree, bounded_exact_system()))


def _guard_evaluation(function: CompiledFormula) -> Callable[[Env], Any]:
    """Return a function that gives a formula's value, or why it has none, and never raises.

    The result is None where the formula has no value, and the class ``UndecidedError`` or
    ``TooLargeError`` where that cannot be told.
    """

    def evaluate(env: Env) -> Any:
        """Return the value at one point, None, or the class of the error."""
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
    """A formula's values at some points, each computed when it is first needed.

    The caller sets the precision once around all of them, since setting it takes a lock.
    """

    def __init__(self, tree: Expr, points: Sequence[Env]) -> None:
        """Compile a formula; nothing is evaluated yet."""
        self.points = points
        self._function = _guard_evaluation(compile_nested(tree, bounded_exact_system()))
        self._values: list[Any] = []

    def at(self, index: int) -> Any:
        """Return the value at one point, or what ``compile_exact`` gives where there is none."""
        while len(self._values) <= index:
            self._values.append(self._function(self.points[len(self._values)]))
        return self._values[index]


@lru_cache(maxsize=512)
def _sample_key_formula(
    tree: Expr, domains: tuple[tuple[str, SampleInterval], ...]
) -> SampledFormula:
    """Return the values of a key, which the answers of a whole class are compared with."""
    return SampledFormula(tree, _draw_sample_points(domains))


def are_equal(first: Expr, second: Expr, symbols: Mapping[str, Domain]) -> bool | None:
    """Return whether two formulas are equal over a domain; None if sampling cannot decide.

    Parameters and errors are those of ``compare_by_sampling``.
    """
    return compare_by_sampling(first, second, symbols, related=False).equal


def compare_by_sampling(
    first: Expr, second: Expr, symbols: Mapping[str, Domain], *, related: bool = True
) -> SamplingResult:
    """Return whether a typed formula equals the key, and by what factor or offset it does not.

    Equal means: at ``POINTS`` points of the domain both have a value, and the values agree to 20
    digits or exactly. One point at which they differ is a proof that the formulas do.

    Parameters
    ----------
    first, second : Expr
        The key and the typed formula.
    symbols : mapping of str to domain
        ``real``, ``positive``, ``whole`` or ``[low, high]`` per name.
    related : bool
        Whether to look for the factor or offset between different ones.

    Returns
    -------
    SamplingResult
        ``equal`` is None if too few points have a value, or the values are too uncertain.

    Raises
    ------
    FormulaReadError
        ``too-large`` if the typed formula is too large to be computed at any point.
    """
    used = names_in(first) | names_in(second)
    if not used:
        return _compare_constants(first, second)
    wanted = {name: domain for name, domain in symbols.items() if name in used}
    typed = SampledFormula(second, sample_points(wanted))
    with working_precision(BITS):
        key = _sample_key_formula(first, _freeze_domains(wanted))
        found = _compare_at_samples(key, typed)
        return _find_relation(key, typed, found) if related and found.ground == "differs" else found


def _compare_constants(first: Expr, second: Expr) -> SamplingResult:
    """Return whether two formulas without names have one value: proved if both are rational.

    Raises
    ------
    FormulaReadError
        If the typed one is too large to be computed.
    """
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
    """Return whether two formulas agree at ``POINTS`` points, or differ at one.

    Points where the key has no value do not count; a typed formula that has none where the key
    has one is wrong about the domain.

    Raises
    ------
    FormulaReadError
        If the typed formula is too large at every point.
    """
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
    """Return whether two values agree: exactly, or as sharp balls; None if a ball is too wide."""
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
    """Return the result with the factor or the offset of two different formulas, if they have one.

    The first twelve points serve; three of them must have a value, or a relation means nothing.
    """
    pairs = [(key.at(index), typed.at(index)) for index in range(12)]
    valued = [(a, b) for a, b in pairs if not any(map(_is_without_value, (a, b)))]
    ratio, difference = _find_common_ratio_or_offset(valued) if len(valued) >= 3 else (None, None)
    return replace(found, ratio=ratio, difference=difference)


def _is_without_value(value: object) -> bool:
    """Return whether a formula has no value at a point, or none that could be computed."""
    return value is None or isinstance(value, type)


def _find_common_ratio_or_offset(pairs: list[tuple[Any, Any]]) -> tuple[Any, Any]:
    """Return the ratio and the difference of typed value and key, each None if it varies.

    Both are None as soon as one value is 0: zero has no ratio, and an offset alone misleads there.
    """
    if any(a == 0 or b == 0 for a, b in pairs):
        return None, None
    ratios = [b / a for a, b in pairs]
    offsets = [b - a for a, b in pairs]
    same_ratio = all(values_agree(ratios[0], other) for other in ratios[1:])
    same_offset = all(values_agree(offsets[0], other) for other in offsets[1:])
    return (ratios[0] if same_ratio else None), (offsets[0] if same_offset else None)
