"""Are two formulas equal? Sampled in exact or certified arithmetic over the declared domain."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import msgspec
from flint import fmpq
from msgspec.structs import replace

from quizgen.errors import MathError, Undecided
from quizgen.maths.constants import Scalar, TooLargeError, bounded, exact_value
from quizgen.maths.notation import ReadError
from quizgen.maths.precision import working_precision
from quizgen.maths.systems import Compiled, compile_expr, compile_inner
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
    return _draws(_spans(symbols))


def _spans(symbols: Mapping[str, Domain]) -> tuple[tuple[str, Span], ...]:
    return tuple([(n, tuple(d) if isinstance(d, list) else d) for n, d in sorted(symbols.items())])


def compiled(tree: Expr) -> Callable[[Env], Any]:
    """Compile a formula for bounded exact evaluation.

    The result is None where it has no value, and the class ``Undecided`` or ``TooLargeError``
    where that cannot be told.
    """
    return _answering(compile_expr(tree, bounded()))


def _answering(function: Compiled) -> Callable[[Env], Any]:
    """Say what a formula's value is, or why it has none."""

    def evaluate(env: Env) -> Any:
        try:
            return function(env)
        except Undecided:
            return Undecided
        except TooLargeError:
            return TooLargeError
        except (MathError, ArithmeticError, ValueError, TypeError, AttributeError):
            return None  # the last two where a truth is reckoned with

    return evaluate


class Sampled:
    """A formula's values at some points, each computed when it is first asked for.

    The precision is stated once around all of them.
    """

    def __init__(self, tree: Expr, points: Sequence[Env]) -> None:
        self.points = points
        self._function = _answering(compile_inner(tree, bounded()))
        self._values: list[Any] = []

    def at(self, index: int) -> Any:
        """The value at one point."""
        while len(self._values) <= index:
            self._values.append(self._function(self.points[len(self._values)]))
        return self._values[index]


@lru_cache(maxsize=512)
def _of_key(tree: Expr, domains: tuple[tuple[str, Span], ...]) -> Sampled:
    """The values of a key, which a whole class is compared with."""
    return Sampled(tree, _draws(domains))


def equal(first: Expr, second: Expr, symbols: Mapping[str, Domain]) -> bool | None:
    """Whether a typed formula equals another one, as ``compare`` finds it."""
    return compare(first, second, symbols, related=False).equal


def compare(
    first: Expr, second: Expr, symbols: Mapping[str, Domain], *, related: bool = True
) -> Comparison:
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
    used = names(first) | names(second)
    if not used:
        return _constants(first, second)
    wanted = {name: domain for name, domain in symbols.items() if name in used}
    typed = Sampled(second, sample_points(wanted))
    with working_precision(BITS):
        key = _of_key(first, _spans(wanted))
        found = _sampled(key, typed)
        return _related(key, typed, found) if related and found.ground == "differs" else found


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


def _sampled(key: Sampled, typed: Sampled) -> Comparison:
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
        same = agree(a, b)
        if same is False:
            return Comparison(equal=False, points=met, ground="differs")
        sure = sure and same is True
        if met == POINTS:
            break
    if large == len(key.points):
        raise ReadError("too-large", 1)
    if apart:
        return Comparison(equal=False, points=met + apart, ground="domain")
    if met < POINTS or not sure:
        return Comparison(equal=None, points=met, ground="undecided")
    return Comparison(equal=True, points=met, ground="sampled")


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


def _related(key: Sampled, typed: Sampled, found: Comparison) -> Comparison:
    """Tell whether two different formulas differ by a factor or by an offset."""
    pairs = [(key.at(index), typed.at(index)) for index in range(12)]
    valued = [(a, b) for a, b in pairs if not any(map(_without_value, (a, b)))]
    ratio, difference = _relation(valued) if len(valued) >= 3 else (None, None)
    return replace(found, ratio=ratio, difference=difference)


def _without_value(value: object) -> bool:
    return value is None or isinstance(value, type)


def _relation(pairs: list[tuple[Any, Any]]) -> tuple[Any, Any]:
    if any(a == 0 or b == 0 for a, b in pairs):
        return None, None
    ratios = [b / a for a, b in pairs]
    offsets = [b - a for a, b in pairs]
    same_ratio = all(agree(ratios[0], other) for other in ratios[1:])
    same_offset = all(agree(offsets[0], other) for other in offsets[1:])
    return (ratios[0] if same_ratio else None), (offsets[0] if same_offset else None)
