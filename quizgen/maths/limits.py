"""What a result approaches while one quantity grows without bound, or shrinks to 0: proved.

A result that the four operations and whole powers make of one quantity is a quotient of two
polynomials in it, which are computed exactly; the limit is that of their leading terms.
"""

from __future__ import annotations

from collections.abc import Mapping

from flint import fmpq, fmpq_poly

from quizgen.maths.numbers import to_rational
from quizgen.maths.tree import Call, Expr, Num, Sym
from quizgen.maths.values import Value

MOST_POWER = 12
"""Largest power that is multiplied out."""

Quotient = tuple[fmpq_poly, fmpq_poly]
"""Numerator and denominator."""


class _NoQuotientError(Exception):
    """Raised where a formula is no quotient of polynomials, or is too large."""


def find_limit(
    target: str,
    quantity: str,
    steps: Mapping[str, Expr],
    values: Mapping[str, Value],
    *,
    grows: bool,
) -> fmpq | None:
    """Return what a result approaches; None where that is not finite, or not proved here.

    Parameters
    ----------
    target : str
        The result.
    quantity : str
        What grows without bound or shrinks to 0, from above, while everything else stays.
    steps : mapping of str to Expr
        Name to formula, without ``piecewise``.
    values : mapping of str to Value
        Of all other names.
    grows : bool
        Whether it grows.
    """
    known: dict[str, Quotient] = {quantity: (fmpq_poly([0, 1]), fmpq_poly([1]))}

    def of(expr: Expr) -> Quotient:
        """Return a formula as a quotient of polynomials in the quantity."""
        if isinstance(expr, Num):
            return fmpq_poly([to_rational(expr.value)]), fmpq_poly([1])
        if isinstance(expr, Sym):
            if expr.name not in known:
                known[expr.name] = of(steps[expr.name]) if expr.name in steps else constant(expr)
            return known[expr.name]
        return _combine(expr, [of(arg) for arg in expr.args])

    def constant(expr: Sym) -> Quotient:
        """Return the value of a name that does not change."""
        value = values.get(expr.name)
        if not isinstance(value, fmpq):
            raise _NoQuotientError
        return fmpq_poly([value]), fmpq_poly([1])

    try:
        above, below = of(Sym(target))
    except (_NoQuotientError, KeyError, ZeroDivisionError):
        return None
    return _compare_leading_terms(above, below, grows=grows)


def _combine(expr: Call, args: list[Quotient]) -> Quotient:
    """Return a call of quotients as a quotient in lowest terms."""
    if not args:
        raise _NoQuotientError
    above, below = args[0]
    if expr.op == "neg":
        return -above, below
    if expr.op == "pow":
        return _raise_to_power(above, below, expr.args[1])
    for other_above, other_below in args[1:]:
        if expr.op in {"add", "sub"}:
            sign = 1 if expr.op == "add" else -1
            above = above * other_below + sign * other_above * below
            below *= other_below
        elif expr.op == "mul":
            above, below = above * other_above, below * other_below
        elif expr.op == "div":
            above, below = above * other_below, below * other_above
        else:
            raise _NoQuotientError
        above, below = _reduce(above, below)
    if expr.op not in {"add", "sub", "mul", "div"}:
        raise _NoQuotientError
    return above, below


def _raise_to_power(above: fmpq_poly, below: fmpq_poly, exponent: Expr) -> Quotient:
    """Return a quotient to a whole power."""
    if isinstance(exponent, Call) and exponent.op == "neg":
        return _raise_to_power(below, above, exponent.args[0])
    if not isinstance(exponent, Num) or exponent.value.denominator != 1:
        raise _NoQuotientError
    power = int(exponent.value)
    if abs(power) > MOST_POWER:
        raise _NoQuotientError
    first, second = (above, below) if power >= 0 else (below, above)
    return _reduce(first ** abs(power), second ** abs(power))


def _reduce(above: fmpq_poly, below: fmpq_poly) -> Quotient:
    """Return a quotient in lowest terms; ``ZeroDivisionError`` if there is nothing below."""
    if not below:
        raise ZeroDivisionError
    common = above.gcd(below)
    return above // common, below // common


def _compare_leading_terms(above: fmpq_poly, below: fmpq_poly, *, grows: bool) -> fmpq | None:
    """Return the limit of a quotient in lowest terms; None if it has none that is finite."""
    if not above:
        return fmpq(0)
    if not grows:
        return None if below[0] == 0 else above[0] / below[0]
    if above.degree() > below.degree():
        return None
    top = below.degree()
    return above[top] / below[top]
