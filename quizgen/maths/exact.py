"""Operators of the exact field: rationals stay rational, everything else is a certified ball."""

from __future__ import annotations

import operator
from collections.abc import Callable
from functools import reduce
from typing import Any

from flint import arb, fmpq, fmpz

from quizgen.errors import MathError, Undecided

LARGEST_POWER = 4096
"""Largest integer exponent raised exactly: bounds the size of the result."""


def _ball(x: Any) -> arb:
    return x if isinstance(x, arb) else arb(x)


def _finite(x: arb) -> arb:
    if not x.is_finite():
        raise MathError("no finite real value")
    return x


def _div(a: Any, b: Any) -> Any:
    if b == 0:
        raise MathError("division by zero")
    if isinstance(a, fmpq) and isinstance(b, fmpq):
        return a / b
    return _finite(_ball(a) / _ball(b))


def _pow(a: Any, b: Any) -> Any:
    if isinstance(a, fmpq) and isinstance(b, fmpq) and b.q == 1 and abs(b.p) <= LARGEST_POWER:
        if a == 0 and b < 0:
            raise MathError("division by zero")
        return a ** int(b.p)
    if isinstance(b, fmpq) and b == fmpq(1, 2):
        return _sqrt(a)
    if a == 0 and _sign(b) > 0:
        return fmpq(0)
    if _sign(a) < 0:
        raise MathError("power of a negative number")
    return _finite(_ball(a) ** _ball(b))


def _sqrt(a: Any) -> Any:
    if isinstance(a, fmpq):
        if a < 0:
            raise MathError("square root of a negative number")
        root = _rational_root(a)
        if root is not None:
            return root
    return _finite(_ball(a).sqrt())


def _rational_root(a: fmpq) -> fmpq | None:
    p, q = fmpz(a.p).isqrt(), fmpz(a.q).isqrt()
    return fmpq(p, q) if p * p == a.p and q * q == a.q else None


def _sign(a: Any) -> int:
    if a > 0:
        return 1
    if a < 0:
        return -1
    if isinstance(a, fmpq) or a.is_zero():
        return 0
    raise Undecided("sign cannot be certified")


def _compare(test: Callable[[Any, Any], Any], opposite: Callable[[Any, Any], Any]) -> Any:
    def decide(a: Any, b: Any) -> bool:
        if test(a, b):
            return True
        if (isinstance(a, fmpq) and isinstance(b, fmpq)) or opposite(a, b):
            return False
        raise Undecided("comparison cannot be certified")

    return decide


def _equal(a: Any, b: Any) -> bool:
    if isinstance(a, fmpq) and isinstance(b, fmpq):
        return bool(a == b)
    if not _ball(a).overlaps(_ball(b)):
        return False
    raise Undecided("equality cannot be certified")


def _floor(a: Any) -> Any:
    if isinstance(a, fmpq):
        return fmpq(a.floor())
    integer = a.floor().unique_fmpz()
    if integer is None:
        raise Undecided("rounding cannot be certified")
    return fmpq(integer)


def _round(a: Any) -> Any:
    """Round half away from zero, as the stems promise."""
    return _floor(abs(a) + fmpq(1, 2)) * _sign(a)


def _function(name: str) -> Callable[[Any], Any]:
    def apply(a: Any) -> arb:
        return _finite(getattr(_ball(a), name)())

    return apply


def _log(base: int | None) -> Callable[[Any], Any]:
    def apply(a: Any) -> Any:
        if _sign(a) <= 0:
            raise MathError("logarithm of a number that is not positive")
        if base is not None and isinstance(a, fmpq):
            power = _integer_log(a, base)
            if power is not None:
                return fmpq(power)
        ball = _ball(a).log()
        return ball if base is None else ball / arb(base).log()

    return apply


def _integer_log(a: fmpq, base: int) -> int | None:
    big, sign = (a, 1) if a >= 1 else (1 / a, -1)
    if big.q != 1:
        return None
    value, power = int(big.p), 0
    while value % base == 0:
        value, power = value // base, power + 1
    return sign * power if value == 1 else None


def _exp(a: Any) -> Any:
    return fmpq(1) if isinstance(a, fmpq) and a == 0 else _finite(_ball(a).exp())


def _erf(a: Any) -> Any:
    return fmpq(0) if isinstance(a, fmpq) and a == 0 else _ball(a).erf()


def _least(a: Any, b: Any) -> Any:
    return a if LESS(a, b) else b


def _most(a: Any, b: Any) -> Any:
    return b if LESS(a, b) else a


LESS = _compare(operator.lt, operator.ge)

OPS: dict[str, Callable[..., Any]] = {
    "add": lambda *args: reduce(operator.add, args),
    "mul": lambda *args: reduce(operator.mul, args),
    "sub": operator.sub,
    "neg": operator.neg,
    "div": _div,
    "pow": _pow,
    "sqrt": _sqrt,
    "exp": _exp,
    "ln": _log(None),
    "log2": _log(2),
    "log10": _log(10),
    "sin": _function("sin"),
    "cos": _function("cos"),
    "tan": _function("tan"),
    "asin": _function("asin"),
    "acos": _function("acos"),
    "atan": _function("atan"),
    "atan2": lambda y, x: arb.atan2(_ball(y), _ball(x)),
    "erf": _erf,
    "erfc": lambda a: 1 - _erf(a) if isinstance(a, fmpq) and a == 0 else _ball(a).erfc(),
    "abs": abs,
    "sign": lambda a: fmpq(_sign(a)),
    "floor": _floor,
    "ceil": lambda a: -_floor(-a),
    "round": _round,
    "mod": lambda a, b: a - b * _floor(_div(a, b)),
    "min": lambda *args: reduce(_least, args),
    "max": lambda *args: reduce(_most, args),
    "pi": arb.pi,
    "eq": _equal,
    "ne": lambda a, b: not _equal(a, b),
    "lt": LESS,
    "le": _compare(operator.le, operator.gt),
    "gt": _compare(operator.gt, operator.le),
    "ge": _compare(operator.ge, operator.lt),
    "and": lambda *args: all(args),
    "or": lambda *args: any(args),
    "not": operator.not_,
}
