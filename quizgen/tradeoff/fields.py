"""Number systems beyond the exact one: NumPy arrays, pairs of doubles, mpmath, SymPy.

Each is a ``quizgen.maths.tree.NumberSystem``, so one formula tree runs in all of them.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from fractions import Fraction
from functools import cache, reduce
from typing import Any

from quizgen.maths.floats import OPS
from quizgen.maths.systems import NumberSystem
from quizgen.maths.tree import Call, Expr, Num, walk

_SAME = ("add", "mul", "sub", "neg", "div", "abs", "eq", "ne", "lt", "le", "gt", "ge")
_ARITHMETIC: dict[str, Callable[..., Any]] = {name: OPS[name] for name in _SAME} | {
    "pow": operator.pow
}
"""Python's own operators, which every number system here understands."""


@cache
def arrays(bits: int) -> NumberSystem:
    """NumPy arrays of 32 or 64 bits, the formula as it is printed."""
    import numpy as np

    number = np.float32 if bits == 32 else np.float64
    ops = _ARITHMETIC | {
        "sqrt": np.sqrt,
        "exp": np.exp,
        "ln": np.log,
        "log2": np.log2,
        "log10": np.log10,
        "floor": np.floor,
        "mod": np.mod,
        "erf": _special("erf", bits),
        "erfc": _special("erfc", bits),
        "min": lambda *args: reduce(np.minimum, args),
        "max": lambda *args: reduce(np.maximum, args),
        "pi": lambda: number(math.pi),
        "piecewise": _where,
    }
    return NumberSystem(f"float{bits}", lambda q: number(float(q)), ops)


def _special(name: str, bits: int) -> Callable[[Any], Any]:
    """SciPy's function if SciPy is there, else the C library's, element by element."""
    import numpy as np

    try:
        import scipy.special
    except ImportError:
        slow = np.vectorize(getattr(math, name), otypes=[np.float64])
        return lambda x: slow(x).astype(np.float32 if bits == 32 else np.float64)
    function: Callable[[Any], Any] = getattr(scipy.special, name)
    return function


def _where(*args: Any) -> Any:
    import numpy as np

    value = args[-1]
    for chosen, condition in zip(args[-3::-2], args[-2::-2], strict=True):
        value = np.where(condition, chosen, value)
    return value


PAIR_OPS = frozenset({"add", "mul", "sub", "neg", "div", "pow", "abs"})
"""Operators that pairs of doubles know."""


@cache
def pairs() -> NumberSystem:
    """Unevaluated sums of two doubles (twice the working precision) on arrays."""
    from quizgen.arrays.double_double import Pair

    def constant(q: Fraction) -> Any:
        high = float(q)
        return Pair(high, float(q - Fraction(high)))

    ops = _ARITHMETIC | {"pow": lambda x, n: reduce(operator.mul, [x] * int(n.high))}
    return NumberSystem("double-double", constant, ops)


def fits_pairs(expr: Expr) -> bool:
    """Whether every operator of a formula works on pairs."""
    calls = [node for node in walk(expr) if isinstance(node, Call)]
    return all(call.op in PAIR_OPS for call in calls) and all(
        isinstance(call.args[1], Num) and call.args[1].value in {2, 3, 4}
        for call in calls
        if call.op == "pow"
    )


@cache
def multiprecision() -> NumberSystem:
    """``mpmath`` at the precision in force."""
    import mpmath as mp

    ops = _ARITHMETIC | {
        "sqrt": mp.sqrt,
        "exp": mp.exp,
        "ln": mp.log,
        "log2": lambda x: mp.log(x) / mp.log(2),
        "log10": mp.log10,
        "floor": mp.floor,
        "mod": lambda a, b: a - b * mp.floor(a / b),
        "erf": mp.erf,
        "erfc": mp.erfc,
        "min": min,
        "max": max,
        "pi": lambda: +mp.pi,
    }
    return NumberSystem("mpmath", lambda q: mp.mpf(q.numerator) / q.denominator, ops)


@cache
def symbolic() -> NumberSystem:
    """SymPy expressions on exact rationals, evaluated at the end."""
    import sympy

    ops = _ARITHMETIC | {
        "sqrt": sympy.sqrt,
        "exp": sympy.exp,
        "ln": sympy.log,
        "log2": lambda x: sympy.log(x) / sympy.log(2),
        "log10": lambda x: sympy.log(x) / sympy.log(10),
        "floor": sympy.floor,
        "mod": sympy.Mod,
        "erf": sympy.erf,
        "erfc": sympy.erfc,
        "min": sympy.Min,
        "max": sympy.Max,
        "abs": sympy.Abs,
        "eq": lambda a, b: a == b,
        "pi": lambda: sympy.pi,
    }
    return NumberSystem("SymPy", lambda q: sympy.Rational(q.numerator, q.denominator), ops)
