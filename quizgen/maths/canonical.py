"""Whether two formulas say the same: order, arrangement and indices of names aside.

``f*p_y/p_z``, ``f_x * x / z`` and ``(x/z)*f`` have one form; so have the equations ``N = f/D`` and
``D = f/N``. Formulas that many questions share by accident (``a + b``, ``2*x``) have none.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Hashable, Iterator
from fractions import Fraction

from quizgen.core.errors import FormulaError
from quizgen.maths.notation import FormulaReadError, parse_formula
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, walk_tree

CanonicalForm = Hashable
"""What formulas that say the same have in common."""

Powers = dict[CanonicalForm, Fraction]
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


def canonical_forms(expr: Expr) -> Iterator[CanonicalForm]:
    """Yield the forms of a formula and of all that stands in it, as far as they are distinctive."""
    for node in walk_tree(expr):
        if isinstance(node, Call) and node.op == "eq":
            yield from _iter_equation_forms(*node.args)
        elif _is_distinctive(node):
            yield _build_canonical_form(node, _shorten_names(node))


def canonical_equation(name: str, expr: Expr) -> set[CanonicalForm]:
    """Return the forms of a quantity's formula, and of the same solved for another name."""
    whole = [_build_canonical_form(expr, _shorten_names(expr))] if _is_distinctive(expr) else []
    return {*whole, *_iter_equation_forms(Sym(name), expr)}


def formulas_in_program(code: str) -> Iterator[Expr]:
    """Yield the formulas in a program; none if it cannot be parsed."""
    try:
        tree = ast.parse(code)
    except SyntaxError:
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp):
            try:
                yield parse_formula(ast.unparse(node).replace("**", "^"))
            except (FormulaReadError, FormulaError):
                continue


def _is_distinctive(expr: Expr) -> bool:
    """Return whether it is more than a name or two, and more than usual signs between them.

    Sums, bounds, products and squares of few names occur in unrelated questions.
    """
    nodes = list(walk_tree(expr))
    constants = [node for node in nodes if isinstance(node, Call) and not node.args]
    leaves = [node for node in nodes if not isinstance(node, Call)] + constants
    signs = {node.op for node in nodes if isinstance(node, Call) and node.args}
    count = len(names_in(expr)) + len(set(constants))
    usual = SUMS if count >= LEAST else SUMS | {"mul", "pow"}
    return len(leaves) >= LEAST and count >= LEAST - 1 and not signs <= usual


def _iter_equation_forms(left: Expr, right: Expr) -> Iterator[CanonicalForm]:
    """Yield the form of two equal products, the same whichever of their names stands alone."""
    short = _shorten_names(Call("eq", (left, right)))
    number, powers = _multiply_factors(Call("div", (left, right)), short)
    plain = all(isinstance(base, str) and abs(n) <= LEAST for base, n in powers.items())
    if plain and number and len(powers) >= LEAST:
        turned = frozenset((base, -power) for base, power in powers.items())
        yield frozenset({(number, frozenset(powers.items())), (1 / number, turned)})


def _shorten_names(expr: Expr) -> dict[str, str]:
    """Return the names without what varies from question to question.

    They stay as they are where two would become the same.
    """
    found = sorted(names_in(expr))
    short = [_ACROSS.sub("x", _INDEX.sub("", _COORDINATE.sub(r"\2\1", name))) for name in found]
    distinct = len(set(short)) == len(found)
    return dict(zip(found, short if distinct else found, strict=True))


def _build_canonical_form(expr: Expr, short: dict[str, str]) -> CanonicalForm:
    """Return the form of a formula: its factors, each with its power."""
    number, powers = _collect_factors(expr, short)
    return (number, frozenset(powers.items()))


def _collect_factors(expr: Expr, short: dict[str, str]) -> tuple[Fraction, Powers]:
    """Return a formula as a number, and factors with their powers."""
    if isinstance(expr, Num):
        return expr.value, {}
    if isinstance(expr, Sym):
        return Fraction(1), {short.get(expr.name, expr.name): Fraction(1)}  # a sum binds its own
    if expr.op in {"mul", "div", "neg"}:
        return _multiply_factors(expr, short)
    if expr.op == "pow" and isinstance(expr.args[1], Num):
        return _raise_factors(*_collect_factors(expr.args[0], short), expr.args[1].value)
    if expr.op == "sqrt":
        return _raise_factors(*_collect_factors(expr.args[0], short), Fraction(1, 2))
    return Fraction(1), {_build_non_product_form(expr, short): Fraction(1)}


def _multiply_factors(expr: Call, short: dict[str, str]) -> tuple[Fraction, Powers]:
    """Return the factors of a product, quotient or negated formula, powers added up."""
    number, powers = Fraction(-1 if expr.op == "neg" else 1), dict[CanonicalForm, Fraction]()
    for place, arg in enumerate(expr.args):
        value, factors = _collect_factors(arg, short)
        below = expr.op == "div" and place
        number = number / (value or 1) if below else number * value
        for base, power in factors.items():
            powers[base] = powers.get(base, Fraction(0)) + (-power if below else power)
    return number, {base: power for base, power in powers.items() if power}


def _raise_factors(number: Fraction, powers: Powers, power: Fraction) -> tuple[Fraction, Powers]:
    """Return the factors of a power; a number stays a factor if its power is not exact."""
    raised = {base: n * power for base, n in powers.items()}
    if number and power.denominator == 1 and abs(power) <= HIGHEST:
        return number**power.numerator, raised
    return Fraction(1), raised | ({number: power} if number != 1 else {})


def _build_non_product_form(expr: Call, short: dict[str, str]) -> CanonicalForm:
    """Return the form of what is no product: a sum, in any order, or a function."""
    if expr.op in {"add", "sub"}:
        return ("sum", frozenset(_collect_terms(expr, short).items()))
    args = [_build_canonical_form(arg, short) for arg in expr.args]
    return (expr.op, frozenset(args) if expr.op in {"min", "max"} else tuple(args))


def _collect_terms(expr: Expr, short: dict[str, str]) -> dict[CanonicalForm, Fraction]:
    """Return each term of a sum, as its factors, with the number before it."""
    if not isinstance(expr, Call) or expr.op not in {"add", "sub", "neg"}:
        number, powers = _collect_factors(expr, short)
        return {frozenset(powers.items()): number}
    found: dict[CanonicalForm, Fraction] = {}
    for place, arg in enumerate(expr.args):
        turned = expr.op == "neg" or (expr.op == "sub" and place)
        for factors, number in _collect_terms(arg, short).items():
            found[factors] = found.get(factors, Fraction(0)) + (-number if turned else number)
    return found
