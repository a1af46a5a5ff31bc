"""What a draw comes to by SymPy and the solver's model alone."""

from __future__ import annotations

import sympy

from quizgen.bank.bank import builtin_bank
from quizgen.maths.numbers import format_for_key
from quizgen.maths.units import unit_factor

DIGITS = 30


def model(template):
    return builtin_bank().solver(template.rules.solver).MODEL


def given(drawn, **scaled):
    """Given quantities in base units, as SymPy has them."""
    return {
        symbol: sympy.Rational(format_for_key(drawn.shown[symbol.name] * unit_factor(drawn.template.units[symbol.name])))
        * sympy.Rational(str(scaled.get(symbol.name, 1)))
        for symbol in model(drawn.template).given
    }  # fmt: skip


def solved(drawn, wrong=(), **scaled):
    """Every quantity by name, step by step."""
    env = given(drawn, **scaled)
    swapped = {step.symbol: step.expr for step in wrong}
    for step in model(drawn.template).steps:
        env[step.symbol] = sympy.N(
            sympy.S(swapped.get(step.symbol, step.expr)).xreplace(env), DIGITS
        )
    return {symbol.name: value for symbol, value in env.items()}


def symbols(drawn, values):
    """Each symbol of the model with its value."""
    own = model(drawn.template)
    return {one: values[one.name] for one in [*own.given, *(step.symbol for step in own.steps)]}


def mistaken(drawn, values, trap, name):
    """What a quantity is to who makes a mistake there, and everything before it right."""
    wrong = model(drawn.template).traps[trap]
    steps = wrong if isinstance(wrong, tuple) else (wrong,)
    expr = next(step.expr for step in steps if step.symbol.name == name)
    return sympy.N(sympy.S(expr).xreplace(symbols(drawn, values)), DIGITS)


def near(a, b):
    size = max(abs(a), abs(b))
    return abs(a - b) <= sympy.Float("1e-12") * size  # models may hold floats: 0.299
