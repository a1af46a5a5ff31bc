"""Constants that people write: evaluated exactly, or as certified balls, in bounded time."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

from flint import fmpq
from msgspec.structs import replace

from quizgen.core.errors import MathError
from quizgen.maths.notation import FormulaReadError, parse_formula
from quizgen.maths.number_systems import NumberSystem, compile_expr, exact_system
from quizgen.maths.precision import PRECISION, working_precision
from quizgen.maths.tree import Expr
from quizgen.maths.values import Value

Scalar = str | int | float
"""A number as it is written: ``"20/3"``, ``"6.67"``, ``12`` or a constant formula."""

LARGEST_BITS = 4000
"""Largest size of an intermediate value."""


def _count_size_bits(value: Value) -> float:
    """Return about how many binary digits a number's size takes, both ways from one."""
    if isinstance(value, fmpq):
        return float(value.height_bits())
    if not value.is_finite():
        raise MathError("no finite real value")
    return abs(float(abs(value).mid().man_exp()[1])) + PRECISION if value != 0 else 1.0


class TooLargeError(MathError):
    """An intermediate value is beyond what anyone could mean."""


def _guarded_power(a: Value, b: Value) -> Value:
    """Return a power; TooLargeError before it takes time and memory."""
    size = abs(b) if isinstance(b, fmpq) else abs(b).mid().fmpq()
    if size > LARGEST_BITS or _count_size_bits(a) * float(size) > LARGEST_BITS:
        raise TooLargeError("too large")
    return exact_system().ops["pow"](a, b)


def _guarded_exp(a: Value) -> Value:
    """Return a power of e; TooLargeError before it takes time and memory."""
    if abs(a) > LARGEST_BITS:
        raise TooLargeError("too large")
    return exact_system().ops["exp"](a)


@cache
def bounded_exact_system() -> NumberSystem:
    """Return the exact number system with bounds on size, for what learners type.

    Its operators raise ``TooLargeError`` instead of running for long.
    """
    ops: dict[str, Callable[..., Any]] = {
        **exact_system().ops,
        "pow": _guarded_power,
        "exp": _guarded_exp,
    }
    return replace(exact_system(), name="bounded", ops=ops)


def evaluate_constant(tree: Expr) -> Value:
    """Return the value of a tree without names, exact or a certified ball, in bounded time.

    Raises
    ------
    FormulaReadError
        If it has no finite real value or is too large.
    """
    try:
        with working_precision():
            value = compile_expr(tree, bounded_exact_system())({})
    except TooLargeError:
        raise FormulaReadError("too-large", 1) from None
    except (MathError, ZeroDivisionError, OverflowError, ValueError) as error:
        raise FormulaReadError("no-value", 1, str(error)) from None
    except (KeyError, TypeError, AttributeError):
        raise FormulaReadError("not-a-number", 1) from None
    if isinstance(value, int):  # a truth, or what is made of truths
        raise FormulaReadError("not-a-number", 1)
    if not isinstance(value, fmpq) and not _is_accurate(value):
        raise FormulaReadError("no-value", 1, "not determined")
    return value


def _is_accurate(ball: Value) -> bool:
    """Return whether a ball has 40 bits at least, or is as good as a point near 0."""
    return bool(ball.rel_accuracy_bits() >= 40 or ball.rad() < fmpq(1, 10**30))


@lru_cache(maxsize=8192)
def _evaluate_author_constant(text: str) -> Value:
    """Return the value of an author's constant: ``20/3``, ``6.67``, ``-1e-3``, ``sqrt(2)/2``.

    Raises
    ------
    FormulaError
        If it cannot be read or has no value.
    """
    try:
        whole, slash, below = text.partition("/")
        return fmpq(int(whole), int(below) if slash else 1)
    except (ValueError, ZeroDivisionError):
        return evaluate_constant(parse_formula(text, symbols=()))


def parse_exact(value: str | float) -> Value:
    """Return the exact value of a spec's entry; a float counts as the decimal it prints as.

    Raises
    ------
    FormulaError
        If it cannot be read or has no value.
    """
    return _evaluate_author_constant(value if isinstance(value, str) else repr(value))
