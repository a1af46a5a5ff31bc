"""How a result grows with one quantity: the power that the formulas themselves prove."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from quizgen.maths.tree import Call, Expr, Num, Sym

_SAME = frozenset({"neg", "abs"})
_ALIKE = frozenset({"add", "sub", "min", "max"})


def scaling_exponent(target: str, quantity: str, steps: Mapping[str, Expr]) -> Fraction | None:
    """Return the power of a quantity to which a result is proportional, for any positive factor.

    Parameters
    ----------
    target : str
        The result.
    quantity : str
        What is multiplied by a factor while everything else stays.
    steps : mapping of str to Expr
        Name to formula, without ``piecewise``.

    Returns
    -------
    Fraction or None
        0 where the quantity cancels; None where no power is the same for all factors.
    """

    def find_exponent(expr: Expr) -> Fraction | None:
        """Return the power of the quantity in a formula, with steps in place of their names."""
        if isinstance(expr, Num):
            return Fraction(0)
        if isinstance(expr, Sym):
            known = steps.get(expr.name)
            return Fraction(expr.name == quantity) if known is None else find_exponent(known)
        return find_exponent_of_call(expr)

    def find_exponent_of_call(expr: Call) -> Fraction | None:
        """Return the power of the quantity in a call; arguments that are 0 do not count."""
        powers = [find_exponent(arg) for arg in expr.args if not _is_zero(arg)]
        found = [power for power in powers if power is not None]
        if len(found) < len(powers):
            return None
        if expr.op == "pow":
            exponent = expr.args[1]
            if isinstance(exponent, Num):
                return found[0] * exponent.value
        return _combine_exponents(expr.op, found)

    return find_exponent(Sym(target))


def _combine_exponents(op: str, powers: list[Fraction]) -> Fraction | None:
    """Return the power of a call from those of its arguments; None if there is none."""
    if op == "mul":
        return sum(powers, Fraction(0))
    if op == "div" and len(powers) == 2:
        return powers[0] - powers[1]
    if op in _SAME and powers:
        return powers[0]
    if op == "sqrt":
        return powers[0] / 2
    if op in _ALIKE and len({*powers}) == 1:
        return powers[0]
    return None if any(powers) else Fraction(0)


def _is_zero(expr: Expr) -> bool:
    """Return whether a formula is the number 0."""
    return isinstance(expr, Num) and expr.value == 0
