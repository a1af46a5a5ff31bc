"""Operators of the float64 field."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from functools import reduce
from struct import pack, unpack
from typing import Any


def _sign(a: float) -> float:
    return 0.0 if a == 0 else math.copysign(1.0, a)


def _round(a: float) -> float:
    return math.copysign(math.floor(abs(a) + 0.5), a)


OPS: dict[str, Callable[..., Any]] = {
    "add": lambda *args: reduce(operator.add, args),
    "mul": lambda *args: reduce(operator.mul, args),
    "sub": operator.sub,
    "neg": operator.neg,
    "div": operator.truediv,
    "pow": math.pow,
    "sqrt": math.sqrt,
    "exp": math.exp,
    "ln": math.log,
    "log2": math.log2,
    "log10": math.log10,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "atan2": math.atan2,
    "erf": math.erf,
    "erfc": math.erfc,
    "abs": abs,
    "sign": _sign,
    "floor": lambda a: float(math.floor(a)),
    "ceil": lambda a: float(math.ceil(a)),
    "round": _round,
    "mod": operator.mod,
    "min": min,
    "max": max,
    "pi": lambda: math.pi,
    "eq": operator.eq,
    "ne": operator.ne,
    "lt": operator.lt,
    "le": operator.le,
    "gt": operator.gt,
    "ge": operator.ge,
    "and": lambda *args: all(args),
    "or": lambda *args: any(args),
    "not": operator.not_,
}


def single(x: Any) -> Any:
    """Round to float32; truth values stay."""
    return x if isinstance(x, bool) else unpack("f", pack("f", x))[0]


SINGLE_OPS: dict[str, Callable[..., Any]] = {
    name: (lambda *args, op=op: single(op(*args))) for name, op in OPS.items()
}
"""The same operators, each result rounded to float32."""
