"""Integrals that no formula gives: computed twice, by mpmath, and refused where the two differ."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from flint import arb, fmpq

from quizgen.core.errors import MathError, UndecidedError
from quizgen.maths.precision import working_precision
from quizgen.maths.values import AnyNumber

DIGITS = (30, 45)
"""Decimal digits of the two computations."""
AGREED = 25
"""Digits in which they must agree: as many are stated of the result."""


def integrate(
    function: Callable[[AnyNumber], AnyNumber], low: AnyNumber, high: AnyNumber, system: Any
) -> AnyNumber:
    """Return an integral between finite bounds; in balls, one that holds both computations.

    Raises
    ------
    MathError
        If the two computations differ, or the function has no value between the bounds.
    """
    if system.name not in {"exact", "bounded"}:
        import mpmath

        return float(mpmath.quad(lambda x: float(function(float(x))), [float(low), float(high)]))
    first, second = (_compute(function, low, high, digits) for digits in DIGITS)
    size = max(abs(second), 1)
    if abs(first - second) > size * fmpq(1, 10**AGREED):
        raise UndecidedError("two computations of the integral differ")
    return arb(second, size * fmpq(1, 10**AGREED))


def _compute(
    function: Callable[[AnyNumber], AnyNumber], low: AnyNumber, high: AnyNumber, digits: int
) -> fmpq:
    """Return the integral by mpmath's quadrature with so many digits.

    Raises ``MathError`` if the function has no value at a point that is needed.
    """
    import mpmath

    def at(x: Any) -> Any:
        """Return the function's value as mpmath's number, the middle of a ball for one."""
        value = function(fmpq(*_convert_to_ratio(x)))
        value = value if isinstance(value, fmpq) else value.mid().fmpq()
        return mpmath.mpf(int(value.p)) / int(value.q)

    def bound(value: AnyNumber) -> Any:
        """Return a bound of the integral as mpmath's number."""
        exact = value if isinstance(value, fmpq) else value.mid().fmpq()
        return mpmath.mpf(int(exact.p)) / int(exact.q)

    with working_precision(4 * digits), mpmath.workdps(digits):
        try:
            found = mpmath.quad(at, [bound(low), bound(high)])
        except (MathError, ZeroDivisionError) as error:
            raise MathError(f"the integral has no value: {error}") from error
        return fmpq(*_convert_to_ratio(found))


def _convert_to_ratio(x: Any) -> tuple[int, int]:
    """Return one of mpmath's numbers exactly, as numerator and denominator."""
    sign, mantissa, exponent, _ = x._mpf_
    top = -int(mantissa) if sign else int(mantissa)
    return (top << exponent, 1) if exponent >= 0 else (top, 1 << -exponent)
