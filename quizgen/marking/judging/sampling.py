"""Are two formulas equal? Sampled in exact or certified arithmetic over the declared domain."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

import msgspec
from flint import fmpq

from quizgen.errors import MathError, Undecided
from quizgen.maths.constants import Scalar, TooLargeError, bounded, exact_value
from quizgen.maths.notation import ReadError
from quizgen.maths.precision import working_precision
from quizgen.maths.systems import compile_expr
from quizgen.maths.tree import Expr, names
from quizgen.maths.values import Value, Values

POINTS = 8
"""Points at which both formulas must have a value and agree."""

TRIES = 96
"""Points tried: a key may have a value on a part of the declared domain only."""

BITS = 128
"""Working precision: a difference beyond 30 digits is seen."""

Domain = str | list[Scalar]
Span = str | tuple[Scalar, ...]
"""A domain that can be looked up: ``real``, ``positive`` or its two bounds."""

Env = Values


class Comparison(msgspec.Struct, frozen=True):
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
def _draws(domains: tuple[tuple[str, Span], ...]) -> tuple[dict[str, fmpq], ...]:
    """The sample points of some domains: the same in every process."""
    source = random.Random("|".join(map(str, domains)))  # noqa: S311 - points, not secrets
    return tuple({name: _draw(domain, source) for name, domain in domains} for _ in range(TRIES))


def _draw(domain: Span, source: random.Random) -> fmpq:
    size = fmpq(source.randint(1, 4095), 2 ** source.randint(8, 12)) + fmpq(1, 977)
    if domain == "positive":
        return size
    if domain == "real":
        return size if source.random() < 0.5 else -size
    low, high = (exact_value(bound) for bound in domain)
    return low + (high - low) * fmpq(source.randint(1, 4094), 4096) + (high - low) * fmpq(1, 9767)


def sample_points(symbols: Mapping[str, Domain]) -> tuple[dict[str, fmpq], ...]:
    """Return rational points of the domain: both signs for ``real``, spread over the magnitudes."""
    return _draws(
        tuple((n, tuple(d) if isinstance(d, list) else d) for n, d in sorted(symbols.items()))
    )


def compiled(tree: Expr) -> Callable[[Env], Any]:
    """Compile a formula for bounded exact evaluation.

    The result is None where it has no value, and the class ``Undecided`` or ``TooLargeError``
    where that cannot be told.
    """
    function = compile_expr(tree, bounded())

    def evaluate(env: Env) -> Any:
        try:
            return function(env)
        except Undecided:
            return Undecided
        except TooLargeError:
            return TooLargeError
        except (MathError, ZeroDivisionError, OverflowError, ValueError, TypeError):
            return None

    return evaluate


def compare(first: Expr, second: Expr, symbols: Mapping[str, Domain]) -> Comparison:
    """Compare a typed formula with the key.

    Parameters
    ----------
    first, second : Expr
        The key and the typed formula.
    symbols : mapping of str to domain
        ``real``, ``positive`` or ``[low, high]`` per name.
    """
    used = names(first) | names(second)
    if not used:
        return _constants(first, second)
    points = sample_points({name: domain for name, domain in symbols.items() if name in used})
    with working_precision(BITS):
        return _sampled(compiled(first), compiled(second), points)


def _constants(first: Expr, second: Expr) -> Comparison:
    with working_precision(2 * BITS):
        a, b = compiled(first)({}), compiled(second)({})
        if b is TooLargeError:
            raise ReadError("too-large", 1)
        if b is None or a is None:
            return Comparison(equal=False, points=1, ground="domain")
        if isinstance(a, type) or isinstance(b, type):
            return Comparison(equal=None, points=0, ground="undecided")
        exact = isinstance(a, fmpq) and isinstance(b, fmpq)
        return Comparison(agree(a, b), 1, "proved" if exact else "sampled")


def _sampled(
    first: Callable[[Env], Any], second: Callable[[Env], Any], points: Sequence[Env]
) -> Comparison:
    pairs: list[tuple[Any, Any]] = []
    apart = large = 0
    for point in points:
        a, b = first(point), second(point)
        large += b is TooLargeError
        if isinstance(a, type) or isinstance(b, type):
            continue
        if a is None or b is None:
            apart += a is not None
            continue
        pairs.append((a, b))
        if agree(a, b) is False:
            return _different(first, second, points, len(pairs))
        if len(pairs) == POINTS:
            break
    if large == len(points):
        raise ReadError("too-large", 1)
    if apart:
        return Comparison(equal=False, points=len(pairs) + apart, ground="domain")
    if len(pairs) < POINTS or not all(agree(a, b) for a, b in pairs):
        return Comparison(equal=None, points=len(pairs), ground="undecided")
    return Comparison(equal=True, points=len(pairs), ground="sampled")


def agree(a: Value, b: Value) -> bool | None:
    """Whether two values agree: exactly, or as sharp balls; None if the balls are too wide."""
    if isinstance(a, fmpq) and isinstance(b, fmpq):
        return bool(a == b)
    difference = a - b
    if difference != 0:
        return False
    size = abs(a) + abs(b)
    sharp = abs(difference) < (size + fmpq(1, 10**30)) * fmpq(1, 10**20)
    return True if sharp else None


def _different(
    first: Callable[[Env], Any], second: Callable[[Env], Any], points: Sequence[Env], count: int
) -> Comparison:
    """Tell whether two different formulas differ by a factor or by an offset."""
    pairs = list(_values(first, second, points[:12]))
    ratio, difference = _relation(pairs) if len(pairs) >= 3 else (None, None)
    return Comparison(False, count, "differs", ratio, difference)


def _values(
    first: Callable[[Env], Any], second: Callable[[Env], Any], points: Sequence[Env]
) -> Iterator[tuple[Any, Any]]:
    for point in points:
        a, b = first(point), second(point)
        if not any(value is None or isinstance(value, type) for value in (a, b)):
            yield a, b


def _relation(pairs: list[tuple[Any, Any]]) -> tuple[Any, Any]:
    if any(a == 0 or b == 0 for a, b in pairs):
        return None, None
    ratios = [b / a for a, b in pairs]
    offsets = [b - a for a, b in pairs]
    same_ratio = all(agree(ratios[0], other) for other in ratios[1:])
    same_offset = all(agree(offsets[0], other) for other in offsets[1:])
    return (ratios[0] if same_ratio else None), (offsets[0] if same_offset else None)
