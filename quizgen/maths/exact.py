"""Operators on exact values: rationals stay rational, everything else is a certified ball.

Run them under ``working_precision``. Any of them raises ``MathError`` where there is no finite real
value, and ``UndecidedError`` where a ball does not settle a sign, an order or a whole number. What
is not here is a ball's own method (``sin``, ``tan``).
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from types import SimpleNamespace

from flint import arb, fmpq, fmpz

from quizgen.core.errors import MathError, UndecidedError
from quizgen.maths.values import Value

LARGEST_POWER = 4096
"""Largest integer exponent raised exactly: bounds the size of the result."""


def _to_ball(x: Value) -> arb:
    """Return a value as a ball."""
    return x if isinstance(x, arb) else arb(x)


def _require_finite(x: arb) -> arb:
    """Return a ball that is finite.

    Raises
    ------
    MathError
        If it is not: there is no real value.
    """
    if not x.is_finite():
        raise MathError("no finite real value")
    return x


def divide(a: Value, b: Value) -> Value:
    """Return the quotient.

    Raises
    ------
    MathError
        If the divisor is 0, or a ball around it.
    """
    if b == 0:
        raise MathError("division by zero")
    if isinstance(a, fmpq) and isinstance(b, fmpq):
        return a / b
    return _require_finite(_to_ball(a) / _to_ball(b))


def power(a: Value, b: Value) -> Value:
    """Return a power with a real exponent.

    Raises
    ------
    MathError
        If it has no real value.
    UndecidedError
        If the sign of the base cannot be certified.
    """
    if isinstance(a, fmpq) and isinstance(b, fmpq) and b.q == 1 and abs(b.p) <= LARGEST_POWER:
        if a == 0 and b < 0:
            raise MathError("division by zero")
        return a ** int(b.p)
    if isinstance(b, fmpq) and b == fmpq(1, 2):
        return square_root(a)
    if a == 0 and _certify_sign(b) > 0:
        return fmpq(0)
    if isinstance(b, fmpq) and b.q == 1:
        return _require_finite(_to_ball(a) ** _to_ball(b))
    if _certify_sign(a) < 0:
        raise MathError("power of a negative number")
    return _require_finite(_to_ball(a) ** _to_ball(b))


def square_root(a: Value) -> Value:
    """Return the square root, rational where it can be.

    Raises
    ------
    MathError
        If the number is negative.
    """
    if isinstance(a, fmpq):
        if a < 0:
            raise MathError("square root of a negative number")
        root = _rational_root(a)
        if root is not None:
            return root
    return _require_finite(_to_ball(a).sqrt())


def _rational_root(a: fmpq) -> fmpq | None:
    """Return the square root of a rational, None if it is not rational."""
    p, q = fmpz(a.p).isqrt(), fmpz(a.q).isqrt()
    return fmpq(p, q) if p * p == a.p and q * q == a.q else None


def _certify_sign(a: Value) -> int:
    """Return -1, 0 or 1.

    Raises
    ------
    UndecidedError
        If a ball holds 0 and other numbers.
    """
    if a > 0:
        return 1
    if a < 0:
        return -1
    if isinstance(a, fmpq) or a.is_zero():
        return 0
    raise UndecidedError("sign cannot be certified")


def sign(a: Value) -> fmpq:
    """Return -1, 0 or 1; UndecidedError where a ball does not settle it."""
    return fmpq(_certify_sign(a))


ComparisonOperator = Callable[[Value, Value], bool]


def _make_certified_comparison(
    test: ComparisonOperator, opposite: ComparisonOperator
) -> ComparisonOperator:
    """Return a relation that is false only if its opposite is certain.

    It raises UndecidedError where balls overlap.
    """

    def decide(a: Value, b: Value) -> bool:
        """Return whether the relation certainly holds, or certainly does not."""
        if test(a, b):
            return True
        if (isinstance(a, fmpq) and isinstance(b, fmpq)) or opposite(a, b):
            return False
        raise UndecidedError("comparison cannot be certified")

    return decide


is_less = _make_certified_comparison(operator.lt, operator.ge)
is_at_most = _make_certified_comparison(operator.le, operator.gt)
is_more = _make_certified_comparison(operator.gt, operator.le)
is_at_least = _make_certified_comparison(operator.ge, operator.lt)


def equal(a: Value, b: Value) -> bool:
    """Return whether two values are equal; balls can only be certainly different.

    Raises
    ------
    UndecidedError
        If balls overlap.
    """
    if isinstance(a, fmpq) and isinstance(b, fmpq):
        return bool(a == b)
    if not _to_ball(a).overlaps(_to_ball(b)):
        return False
    raise UndecidedError("equality cannot be certified")


def unequal(a: Value, b: Value) -> bool:
    """Return the opposite of ``equal``."""
    return not equal(a, b)


def floor(a: Value) -> fmpq:
    """Return the largest integer not above; UndecidedError where a ball does not settle it."""
    if isinstance(a, fmpq):
        return fmpq(a.floor())
    integer = a.floor().unique_fmpz()
    if integer is None:
        raise UndecidedError("rounding cannot be certified")
    return fmpq(integer)


def ceil(a: Value) -> fmpq:
    """Return the smallest integer not below; UndecidedError where a ball does not settle it."""
    return -floor(-a)


def round_half_away(a: Value) -> fmpq:
    """Return the nearest integer, half away from zero, as the stems promise."""
    return floor(abs(a) + fmpq(1, 2)) * _certify_sign(a)


def remainder(a: Value, b: Value) -> Value:
    """Return the remainder of a over b, b not 0; it has the sign of b, as in Python."""
    return a - b * floor(divide(a, b))


def minimum(a: Value, b: Value) -> Value:
    """Return the smaller of two; UndecidedError where balls overlap."""
    return a if is_less(a, b) else b


def maximum(a: Value, b: Value) -> Value:
    """Return the larger of two; UndecidedError where balls overlap."""
    return b if is_less(a, b) else a


def natural_log(a: Value) -> Value:
    """Return the logarithm to base e.

    Raises
    ------
    MathError
        If the number is not positive.
    """
    if _certify_sign(a) <= 0:
        raise MathError("logarithm of a number that is not positive")
    return _to_ball(a).log()


def binary_log(a: Value) -> Value:
    """Return the logarithm to base 2, rational for its powers."""
    return _take_logarithm(a, 2)


def decimal_log(a: Value) -> Value:
    """Return the logarithm to base 10, rational for its powers."""
    return _take_logarithm(a, 10)


def _take_logarithm(a: Value, base: int) -> Value:
    """Return the logarithm to an integer base, rational for powers of the base."""
    power = _integer_log(a, base) if isinstance(a, fmpq) and a > 0 else None
    return natural_log(a) / arb(base).log() if power is None else fmpq(power)


def _integer_log(a: fmpq, base: int) -> int | None:
    """Return the integer logarithm of a power of the base; None for any other number."""
    big, sign = (a, 1) if a >= 1 else (1 / a, -1)
    if big.q != 1:
        return None
    value, power = int(big.p), 0
    while value % base == 0:
        value, power = value // base, power + 1
    return sign * power if value == 1 else None


def exponential(a: Value) -> Value:
    """Return the power of e; 1 for 0."""
    return fmpq(1) if isinstance(a, fmpq) and a == 0 else _require_finite(_to_ball(a).exp())


def error_function(a: Value) -> Value:
    """Return the error function; 0 for 0."""
    return fmpq(0) if isinstance(a, fmpq) and a == 0 else _to_ball(a).erf()


def complementary_error_function(a: Value) -> Value:
    """Return 1 minus the error function, accurate also where that is tiny; 1 for 0."""
    return fmpq(1) if isinstance(a, fmpq) and a == 0 else _to_ball(a).erfc()


def atan2(y: Value, x: Value) -> arb:
    """Return the angle of the point (x, y) in radians."""
    return arb.atan2(_to_ball(y), _to_ball(x))


def pi() -> arb:
    """Return half the length of the unit circle."""
    return arb.pi()


def _wrap_ball_method(name: str) -> Callable[[Value], arb]:
    """Return a method of balls as a function of any value, which must be finite."""
    method = getattr(arb, name)

    def apply(a: Value) -> arb:
        """Return the method's value; MathError if it is not finite."""
        return _require_finite(method(_to_ball(a)))

    return apply


BALLS = SimpleNamespace(**{name: _wrap_ball_method(name) for name in dir(arb) if name[0] != "_"})
"""A ball's own methods as functions that must have a finite value."""
