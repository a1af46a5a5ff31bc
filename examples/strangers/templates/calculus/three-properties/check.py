"""Whether a function has a value and slope 0 at 0, and a slope at 1: each is worth a third."""

from fractions import Fraction

import sympy

from quizgen.grading.checking import read_as_sympy

X = sympy.Symbol("x", real=True)


def check(values, answer):
    """Judge each property by itself; the first that fails is said."""
    f = read_as_sympy(answer, "x").subs(sympy.Symbol("x"), X)
    if f.has(sympy.nan, sympy.zoo):
        return None
    slope = f.diff(X)
    wanted = {
        "value": (f, 0, values["b"]),
        "stationary": (slope, 0, 0),
        "slope": (slope, 1, values["m"]),
    }
    failed = [name for name, (g, place, value) in wanted.items() if not is_at(g, place, value)]
    share = Fraction(3 - len(failed), 3)
    return (share, failed[0]) if failed else 1


def is_at(g, place, value):
    """Return whether g tends to a value at a place from both sides."""
    return all(sympy.simplify(sympy.limit(g, X, place, side) - value) == 0 for side in "+-")
