"""Whether two formulas say the same: order, arrangement and indices of names aside.

``f*p_y/p_z``, ``f_x * x / z`` and ``(x/z)*f`` have one form; so have the equations ``N = f/D`` and
``D = f/N``. Formulas that many questions share by accident (``a + b``, ``2*x``) have none.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Hashable, Iterator
from fractions import Fraction

from quizgen.errors import FormulaError
from quizgen.maths.notation import ReadError, parse
from quizgen.maths.tree import Call, Expr, Num, Sym, names, walk

Form = Hashable
"""What formulas that say the same have in common."""

Powers = dict[Form, Fraction]
"""Factor to its power."""

LEAST = 3
"""Numbers and names that a formula must have to be told from others."""
SUMS = frozenset({"add", "sub", "neg", "min", "max", "mod", "floor", "abs"})
"""Operators that stand in many formulas."""
HIGHEST = 8
"""Power to which numbers are raised."""
_COORDINATE = re.compile(r"^[pq]('?)_([xyz])$")
_ACROSS = re.compile(r"^[yY](?='?$)")
_INDEX = re.compile(r"_(?:\d+|[A-Za-z])$")


def forms(expr: Expr) -> Iterator[Form]:
    """The forms of a formula and of all that stands in it, as far as they are distinctive."""
    for node in walk(expr):
        if isinstance(node, Call) and node.op == "eq":
            yield from _equation(*node.args)
        elif _is_distinctive(node):
            yield _form(node, _shortened(node))


def equation(name: str, expr: Expr) -> set[Form]:
    """What asking for a quantity asks for: its formula, and the same solved for another name."""
    whole = [_form(expr, _shortened(expr))] if _is_distinctive(expr) else []
    return {*whole, *_equation(Sym(name), expr)}


def in_program(code: str) -> Iterator[Expr]:
    """Formulas in a program."""
    try:
        tree = ast.parse(code)
    except SyntaxError:
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp):
            try:
                yield parse(ast.unparse(node).replace("**", "^"))
            except (ReadError, FormulaError):
                continue


def _is_distinctive(expr: Expr) -> bool:
    """Whether it is more than a name or two, and more than sums, squares and bounds of them."""
    nodes = list(walk(expr))
    constants = [node for node in nodes if isinstance(node, Call) and not node.args]
    leaves = [node for node in nodes if not isinstance(node, Call)] + constants
    signs = {node.op for node in nodes if isinstance(node, Call) and node.args}
    count = len(names(expr)) + len(set(constants))
    usual = SUMS if count >= LEAST else SUMS | {"mul", "pow"}
    return len(leaves) >= LEAST and count >= LEAST - 1 and not signs <= usual


def _equation(left: Expr, right: Expr) -> Iterator[Form]:
    """Products that are equal, in one form whichever of their names stands alone."""
    short = _shortened(Call("eq", (left, right)))
    number, powers = _multiplied(Call("div", (left, right)), short)
    plain = all(isinstance(base, str) and abs(n) <= LEAST for base, n in powers.items())
    if plain and number and len(powers) >= LEAST:
        turned = frozenset((base, -power) for base, power in powers.items())
        yield frozenset({(number, frozenset(powers.items())), (1 / number, turned)})


def _shortened(expr: Expr) -> dict[str, str]:
    """Names without what varies from question to question, where they stay different."""
    found = sorted(names(expr))
    short = [_ACROSS.sub("x", _INDEX.sub("", _COORDINATE.sub(r"\2\1", name))) for name in found]
    distinct = len(set(short)) == len(found)
    return dict(zip(found, short if distinct else found, strict=True))


def _form(expr: Expr, short: dict[str, str]) -> Form:
    """The form of a formula: its factors, each with its power."""
    number, powers = _product(expr, short)
    return (number, frozenset(powers.items()))


def _product(expr: Expr, short: dict[str, str]) -> tuple[Fraction, Powers]:
    """A number, and factors with their powers."""
    if isinstance(expr, Num):
        return expr.value, {}
    if isinstance(expr, Sym):
        return Fraction(1), {short[expr.name]: Fraction(1)}
    if expr.op in {"mul", "div", "neg"}:
        return _multiplied(expr, short)
    if expr.op == "pow" and isinstance(expr.args[1], Num):
        return _raised(*_product(expr.args[0], short), expr.args[1].value)
    if expr.op == "sqrt":
        return _raised(*_product(expr.args[0], short), Fraction(1, 2))
    return Fraction(1), {_whole(expr, short): Fraction(1)}


def _multiplied(expr: Call, short: dict[str, str]) -> tuple[Fraction, Powers]:
    number, powers = Fraction(-1 if expr.op == "neg" else 1), dict[Form, Fraction]()
    for place, arg in enumerate(expr.args):
        value, factors = _product(arg, short)
        below = expr.op == "div" and place
        number = number / (value or 1) if below else number * value
        for base, power in factors.items():
            powers[base] = powers.get(base, Fraction(0)) + (-power if below else power)
    return number, {base: power for base, power in powers.items() if power}


def _raised(number: Fraction, powers: Powers, power: Fraction) -> tuple[Fraction, Powers]:
    raised = {base: n * power for base, n in powers.items()}
    if number and power.denominator == 1 and abs(power) <= HIGHEST:
        return number**power.numerator, raised
    return Fraction(1), raised | ({number: power} if number != 1 else {})


def _whole(expr: Call, short: dict[str, str]) -> Form:
    """What is no product: a sum, in any order, or a function."""
    if expr.op in {"add", "sub"}:
        return ("sum", frozenset(_terms(expr, short).items()))
    args = [_form(arg, short) for arg in expr.args]
    return (expr.op, frozenset(args) if expr.op in {"min", "max"} else tuple(args))


def _terms(expr: Expr, short: dict[str, str]) -> dict[Form, Fraction]:
    if not isinstance(expr, Call) or expr.op not in {"add", "sub", "neg"}:
        number, powers = _product(expr, short)
        return {frozenset(powers.items()): number}
    found: dict[Form, Fraction] = {}
    for place, arg in enumerate(expr.args):
        turned = expr.op == "neg" or (expr.op == "sub" and place)
        for factors, number in _terms(arg, short).items():
            found[factors] = found.get(factors, Fraction(0)) + (-number if turned else number)
    return found
