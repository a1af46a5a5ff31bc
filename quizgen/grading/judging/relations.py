"""Equations and inequalities as facts: where they hold, what follows, which solutions a step loses.

A *world* says what each quantity is: some are free and take exact values at points of their
domains, the others are formulas of them. A relation holds in a world if its sides agree at all
points, exactly or as certified balls. In the right world every true line holds; in the world of a
wrong line hold the lines that follow from it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache, reduce
from itertools import islice
from typing import Any

import msgspec
from flint import fmpq

from quizgen.grading.judging.algebraic_equality import convert_to_quotient, is_rational
from quizgen.grading.judging.sampled_equality import (
    BITS,
    POINTS,
    Domain,
    Env,
    compile_exact,
    sample_points,
    values_agree,
)
from quizgen.maths.notation import format_tree
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in, substitute, walk_tree
from quizgen.maths.values import Value

LEAST_POINTS = 4
"""Points at which a relation must have a value on both sides, or nothing is said of it."""
ROUNDED = fmpq(1, 50)
"""Share of a value by which the decimal that stands for it may be off, besides its last place."""
RECKONED = fmpq(1, 500)
"""Share by which sides may differ that were worked out from rounded decimals."""
MOST_HELD = 500
"""Relations for which a world remembers whether they hold."""
SHARP_PLACES = 3
"""Decimals from which on a number is taken for a rounded one, not for a given one."""
LEAST_DIGITS = 2
"""Units of its last place that a rounded decimal has at least: 0.02 for 0.0203, not 0.01."""
SHARP_FIGURES = 3
"""Figures from which on a decimal is."""

_ZERO, _ONE = Num(Fraction(0)), Num(Fraction(1))


class Relation(msgspec.Struct, frozen=True):
    """Two sides and the sign between them: ``eq``, ``ne``, ``lt``, ``le``, ``gt`` or ``ge``.

    ``near`` says that the sign was ≈: the sides are only about equal.
    """

    op: str
    left: Expr
    right: Expr
    near: bool = False

    @property
    def tree(self) -> Call:
        """The relation as a tree."""
        return Call(self.op, (self.left, self.right))

    @property
    def names(self) -> frozenset[str]:
        """The names on both sides."""
        return names_in(self.left) | names_in(self.right)

    @property
    def difference(self) -> Expr:
        """What is 0 where an equation holds."""
        return Call("sub", (self.left, self.right))


class World:
    """What each quantity is: free within its domain, or a formula of others.

    Parameters
    ----------
    domains : mapping of str to Domain
        Of every name that may occur.
    definitions : mapping of str to Expr
        Formulas of the names that are not free; none depends on itself.
    where : sequence of Expr
        Conditions that hold at every point.
    """

    def __init__(
        self,
        domains: Mapping[str, Domain],
        definitions: Mapping[str, Expr],
        where: Sequence[Expr] = (),
    ) -> None:
        """Take what is known; points are computed when they are first needed."""
        self.domains, self.definitions, self.where = dict(domains), dict(definitions), tuple(where)
        self._points: tuple[dict[str, Any], ...] | None = None
        self._held: dict[tuple[Relation, bool], bool | None] = {}

    def define(self, name: str, formula: Expr, domain: Domain = "real") -> World | None:
        """Return the world in which a name is a formula; None if the formula depends on it."""
        definitions = {**self.definitions, name: formula}
        if _is_circular(name, definitions):
            return None
        return World({name: domain, **self.domains}, definitions, self.where)

    def holds(self, relation: Relation, *, rounded: bool = True) -> bool | None:
        """Return whether a relation holds at all points; None if that cannot be told.

        Without ``rounded`` a decimal is exactly what it says. What was said of the last lines is
        remembered: many learners write the same ones.
        """
        asked = relation, rounded
        if asked not in self._held:
            if len(self._held) >= MOST_HELD:
                self._held.clear()
            self._held[asked] = self._find_whether_holds(relation, rounded=rounded)
        return self._held[asked]

    def _find_whether_holds(self, relation: Relation, *, rounded: bool) -> bool | None:
        """Return whether a relation holds, compared at each point."""
        if not relation.names <= self.domains.keys():
            return None
        left, right = compile_exact(relation.left), compile_exact(relation.right)
        met, sure, points = 0, True, self.points
        with working_precision(BITS):
            for env in points:
                a, b = left(env), right(env)
                if not (_is_value(a) and _is_value(b)):
                    continue
                found = _compare(relation, a, b, rounded=rounded)
                if found is False:
                    return False
                met, sure = met + 1, sure and found is True
                if met == POINTS:
                    break
        return True if sure and met >= LEAST_POINTS else None

    @property
    def points(self) -> tuple[dict[str, Any], ...]:
        """The points: the value of every name, where all of them have one."""
        if self._points is None:  # two threads may both compute them, and find the same
            domains = tuple((name, _freeze(of)) for name, of in self.domains.items())
            self._points = _list_points(domains, tuple(self.definitions.items()), self.where)
        return self._points


@lru_cache(maxsize=256)
def _list_points(
    domains: tuple[tuple[str, Any], ...],
    definitions: tuple[tuple[str, Expr], ...],
    where: tuple[Expr, ...],
) -> tuple[dict[str, Any], ...]:
    """Return the points of a world: what is right leads every learner to the same ones."""
    with working_precision(BITS):
        return tuple(islice(_iter_points(dict(domains), dict(definitions), where), 2 * POINTS))


def _iter_points(
    domains: Mapping[str, Any], definitions: Mapping[str, Expr], where: Sequence[Expr]
) -> Iterator[dict[str, Any]]:
    """Yield points of the free names with the values of the others, where they may lie."""
    free = {name: of for name, of in domains.items() if name not in definitions}
    formulas = [(name, compile_exact(definitions[name])) for name in _in_order(definitions)]
    conditions = [compile_exact(one) for one in where]
    for point in sample_points(free):
        env: dict[str, Any] = dict(point)
        for name, formula in formulas:
            env[name] = formula(env)
        fits = all(_lies_in(env[name], domains[name]) for name, _ in formulas)
        if fits and all(condition(env) is True for condition in conditions):
            yield env


def _in_order(definitions: Mapping[str, Expr]) -> list[str]:
    """Return the defined names, each behind those that its formula has."""
    found: dict[str, None] = {}

    def visit(name: str) -> None:
        """Add a name behind what it depends on."""
        for other in sorted(names_in(definitions[name]) & definitions.keys()):
            if other not in found:
                visit(other)
        found[name] = None

    for name in definitions:
        if name not in found:
            visit(name)
    return list(found)


def _is_circular(name: str, definitions: Mapping[str, Expr]) -> bool:
    """Return whether a name's formula depends on it, maybe through others."""
    seen, todo = set[str](), [name]
    while todo:
        for other in names_in(definitions[todo.pop()]) & definitions.keys():
            if other == name:
                return True
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return False


def _is_value(value: object) -> bool:
    """Return whether a formula has a value at a point that could be computed."""
    return value is not None and not isinstance(value, (type, bool))


def _lies_in(value: Any, domain: Domain) -> bool:
    """Return whether a value is there, and one of a domain as far as its sign goes."""
    return _is_value(value) and (domain != "positive" or bool(value > 0))


def _compare(relation: Relation, a: Value, b: Value, *, rounded: bool) -> bool | None:
    """Return whether the sides of a relation compare as it says; None if that is undecided."""
    same = values_agree(a, b)
    if relation.op == "ne":
        return None if same is None else not same
    if relation.op != "eq":
        if same is not False:
            return same if relation.op in {"le", "ge"} or same is None else False
        return bool(a < b) if relation.op in {"lt", "le"} else bool(a > b)
    if same is False and rounded and _agree_when_rounded(relation, a, b):
        return True
    return same


def _agree_when_rounded(relation: Relation, a: Value, b: Value) -> bool:
    """Return whether two values agree as far as the decimals of a relation say.

    A side that is one decimal may be rounded to its last place, or cut off there by a fiftieth of
    the value at most; sides that were reckoned from rounded decimals are within two thousandths.
    """
    far, size = abs(a - b), abs(b)
    units = [unit for unit in map(_last_place, (relation.left, relation.right)) if unit]
    if units and size < min(units, key=float) * LEAST_DIGITS:
        return False
    if any(2 * far <= unit and size >= 10 * unit for unit in units):
        return True
    near = [unit for unit in units if 2 * far <= unit or _is_cut_off(relation, unit, a, b)]
    if any(far <= unit for unit in near) or (relation.near and not units):
        return bool(far <= size * ROUNDED)
    return _has_rounded_number(relation) and bool(far <= size * RECKONED)


def _is_cut_off(relation: Relation, unit: fmpq, a: Value, b: Value) -> bool:
    """Return whether the side that is a decimal with this last place is the smaller one."""
    left, right = (_last_place(side) == unit for side in (relation.left, relation.right))
    return bool((left and abs(a) <= abs(b)) or (right and abs(b) <= abs(a)))


def _last_place(side: Expr) -> fmpq | None:
    """Return one unit of the last decimal of a side that is a decimal or so many %; else None."""
    inner = side.args[0] if isinstance(side, Call) and side.op == "neg" else side
    whole = 1
    if isinstance(inner, Call) and inner.op == "div" and inner.args[1] == _HUNDRED:
        inner, whole = inner.args[0], 100
    if not isinstance(inner, Num) or not inner.decimal:
        return None
    return fmpq(1, 10 ** _count_places(inner) * whole)


_HUNDRED = Num(Fraction(100))


def _count_places(number: Num) -> int:
    """Return the decimals of a decimal number."""
    value, places = number.value, 0
    while value.denominator != 1 and places < 60:
        value, places = value * 10, places + 1
    return places


def _has_rounded_number(relation: Relation) -> bool:
    """Return whether a number of a relation has so many digits that it is a rounded one."""
    return any(
        isinstance(node, Num) and node.decimal and _is_sharp(node)
        for side in (relation.left, relation.right)
        for node in walk_tree(side)
    )


def _is_sharp(number: Num) -> bool:
    """Return whether a decimal has the decimals or figures of one that was rounded: 0.042, 15.9."""
    places = _count_places(number)
    figures = str(abs(number.value.numerator) * 10**places // number.value.denominator)
    return places >= SHARP_PLACES or (places > 0 and len(figures) >= SHARP_FIGURES)


MOST_ROOTS = 4
"""Solutions that are followed when an equation is solved for a name."""


def solve_for(relation: Relation, name: str) -> tuple[Expr, ...]:
    """Return formulas for a name that may satisfy an equation; the caller checks them.

    A name that occurs once is isolated; one that occurs more often is taken for linear once the
    fractions are cleared.
    """
    if relation.op != "eq":
        return ()
    sides = (relation.left, relation.right)
    counts = [sum(node == Sym(name) for node in walk_tree(side)) for side in sides]
    if sum(counts) == 1:
        own, other = sides if counts[0] else sides[::-1]
        return tuple(_isolate(own, other, name))
    top, _ = as_fraction(relation.difference)
    at_0, at_1 = (substitute(top, {name: value}) for value in (_ZERO, _ONE))
    return (Call("div", (at_0, Call("sub", (at_0, at_1)))),)


def _isolate(side: Expr, target: Expr, name: str) -> Iterator[Expr]:
    """Yield what a name is that occurs once in a side, if the side is equal to ``target``."""
    todo = [(side, target)]
    for _ in range(200):
        if not todo:
            return
        node, value = todo.pop()
        if not isinstance(node, Call):
            yield value
            continue
        place = next(i for i, arg in enumerate(node.args) if name in names_in(arg))
        others = node.args[:place] + node.args[place + 1 :]
        undone = [(node.args[place], one) for one in _undo(node.op, place, others, value)]
        todo += undone[:MOST_ROOTS]


def _undo(op: str, place: int, others: tuple[Expr, ...], value: Expr) -> tuple[Expr, ...]:
    """Return what the argument at a place can be, if the operator gives ``value``."""
    inverse = _INVERSES.get(op)
    if inverse is not None:
        return inverse(value)
    if op in {"add", "mul"}:
        rest = others[0] if len(others) == 1 else Call(op, others)
        return (Call("sub" if op == "add" else "div", (value, rest)),)
    if op in {"sub", "div"}:
        (other,) = others
        back = {"sub": "add", "div": "mul"}[op]
        return (Call(op, (other, value)) if place else Call(back, (value, other)),)
    if op == "pow":
        return _undo_power(place, others[0], value)
    return ()


def _undo_power(place: int, other: Expr, value: Expr) -> tuple[Expr, ...]:
    """Return the bases (at place 0) or the exponent that give a power."""
    if place:
        return (Call("div", (Call("ln", (value,)), Call("ln", (other,)))),)
    if not isinstance(other, Num):
        return (Call("pow", (value, Call("div", (_ONE, other)))),)
    if other.value == 0:
        return ()
    root = Call("pow", (value, Num(1 / other.value)))
    if other.value.denominator == 1 and other.value.numerator % 2 == 0:
        return (Call("neg", (root,)), root)
    return (root,)


def _call(op: str) -> Any:
    """Return the function that applies an operator to a formula, as its only inverse."""
    return lambda value: (Call(op, (value,)),)


_INVERSES: dict[str, Any] = {
    "neg": _call("neg"),
    "exp": _call("ln"),
    "ln": _call("exp"),
    "tan": _call("atan"),
    "atan": _call("tan"),
    "sqrt": lambda value: (Call("pow", (value, Num(Fraction(2)))),),
    "log2": lambda value: (Call("pow", (Num(Fraction(2)), value)),),
    "log10": lambda value: (Call("pow", (Num(Fraction(10)), value)),),
    "abs": lambda value: (Call("neg", (value,)), value),
}
"""Functions of one argument to what undoes them."""


def as_fraction(tree: Expr) -> tuple[Expr, Expr]:
    """Return a formula as numerator and denominator, nothing cancelled."""
    if not isinstance(tree, Call):
        return tree, _ONE
    parts = [as_fraction(arg) for arg in tree.args]
    if tree.op == "neg":
        return Call("neg", (parts[0][0],)), parts[0][1]
    if tree.op == "div":
        (top, low), (by, under) = parts
        return _product(top, under), _product(low, by)
    if tree.op == "mul":
        return tuple(reduce(_product, column) for column in zip(*parts, strict=True))
    if tree.op in {"add", "sub"}:
        return reduce(lambda a, b: _sum(tree.op, a, b), parts)
    return tree, _ONE


def _product(a: Expr, b: Expr) -> Expr:
    """Return a product, without a factor of 1."""
    if _ONE in (a, b):
        return b if a == _ONE else a
    return Call("mul", (a, b))


def _sum(op: str, a: tuple[Expr, Expr], b: tuple[Expr, Expr]) -> tuple[Expr, Expr]:
    """Return the sum or difference of two fractions."""
    if a[1] == b[1]:
        return Call(op, (a[0], b[0])), a[1]
    return Call(op, (_product(a[0], b[1]), _product(b[0], a[1]))), _product(a[1], b[1])


def implies(
    first: Relation, second: Relation, domains: Mapping[str, Domain], order: Sequence[str]
) -> bool:
    """Return whether a relation follows from another alone, all names being free otherwise.

    ``order`` lists the names that it is best solved for, the best first.
    """
    if first.op != "eq":
        return first == second or _is_multiple(first, second, domains)
    solved = _list_solved_worlds(first, second, domains, order)
    return bool(solved) and all(world.holds(second) is True for world in solved)


def _list_solved_worlds(
    first: Relation, second: Relation, domains: Mapping[str, Domain], order: Sequence[str]
) -> tuple[World, ...]:
    """Return worlds in which an equation holds, solved for the first name for which that works.

    There is one for each solution that its domain allows.
    """
    shared = sorted(first.names & second.names, key=lambda one: (one not in order, one))
    used = [(name, _freeze(of)) for name, of in domains.items()
            if name in first.names | second.names]  # fmt: skip
    return _solve_for_one_of(first, tuple(shared), tuple(used))


@lru_cache(maxsize=512)
def _solve_for_one_of(
    relation: Relation, names: tuple[str, ...], domains: tuple[tuple[str, Any], ...]
) -> tuple[World, ...]:
    """Return the worlds of an equation that is solved for the first of some names that works.

    One line is compared with all known mistakes, and these with the lines of all learners.
    """
    for name in names:
        worlds = [
            World(dict(domains), {name: formula})
            for formula in solve_for(relation, name)
            if name not in names_in(formula)
        ]
        found = tuple(world for world in worlds if world.holds(relation) is True)
        if found:
            return found
    return ()


def _is_multiple(first: Relation, second: Relation, domains: Mapping[str, Domain]) -> bool:
    """Return whether an inequality is another one, times what is positive and the same all over."""
    if {first.op, second.op} & {"eq", "ne"}:
        return False
    mine, other = _as_at_least(first), _as_at_least(second)
    if mine[1] != other[1]:
        return False
    used = {name: of for name, of in domains.items() if name in first.names | second.names}
    ratio = compile_exact(Call("div", (mine[0], other[0])))
    with working_precision(BITS):
        values = [value for env in sample_points(used)[:12] if _is_value(value := ratio(env))]
    return (
        len(values) >= LEAST_POINTS
        and bool(values[0] > 0)
        and all(values_agree(values[0], value) is not False for value in values)
    )


def _as_at_least(relation: Relation) -> tuple[Expr, bool]:
    """Return what is at least 0 where an inequality holds, and whether it may be 0."""
    turned = relation.op in {"lt", "le"}
    sides = (relation.right, relation.left) if turned else (relation.left, relation.right)
    return Call("sub", sides), relation.op in {"le", "ge"}


def find_lost_solution(
    before: Relation, after: Relation, domains: Mapping[str, Domain], where: Sequence[Expr] = ()
) -> str:
    """Return what a step from one equation to the next overlooks; empty if it is safe.

    It is a factor that the step divides by although it may be 0 (``x``), or the name whose other
    root is lost (``x``).
    """
    if before.op != "eq" or after.op != "eq":
        return ""
    known = tuple((name, _freeze(of)) for name, of in domains.items())
    return _find_lost_in_step(before, after, known, tuple(where))


@lru_cache(maxsize=1024)
def _find_lost_in_step(
    before: Relation, after: Relation, known: tuple[tuple[str, Any], ...], where: tuple[Expr, ...]
) -> str:
    """Return what a step overlooks, for many learners who take the same one."""
    domains = dict(known)
    return _find_zero_divisor(before, after, domains, where) or _find_lost_root(
        before, after, domains
    )


def _find_lost_root(before: Relation, after: Relation, domains: Mapping[str, Domain]) -> str:
    """Return the name of which the first equation has a solution that the second has not."""
    used = {name: of for name, of in domains.items() if name in before.names | after.names}
    for name in sorted(before.names & after.names):
        roots = [World(used, {name: root}) for root in solve_for(before, name)
                 if name not in names_in(root)]  # fmt: skip
        kept = [world.holds(after) is True for world in roots if world.holds(before) is True]
        if any(kept) and not all(kept):
            return name
    return ""


def _find_zero_divisor(
    before: Relation, after: Relation, domains: Mapping[str, Domain], where: Sequence[Expr]
) -> str:
    """Return a factor that is divided by on the way and may be 0; empty without one."""
    trees = (before.difference, after.difference)
    used = tuple(sorted(before.names | after.names))
    if not all(map(is_rational, trees)) or not used:
        return ""
    try:
        (top, low), (next_top, next_low) = (convert_to_quotient(tree, used) for tree in trees)
        if next_top == 0 or len(top) * len(next_top) > 400:
            return ""
        gone, left = divmod(top, next_top)
        if left != 0:
            return ""
        known = [factor for factor, _ in low.factor()[1]]
        factors = [one for one, _ in (*gone.factor()[1], *next_low.factor()[1]) if one not in known]
    except (ValueError, ZeroDivisionError, OverflowError):
        return ""
    points = _list_where(used, tuple((name, _freeze(domains[name])) for name in used), where)
    for factor in factors:
        signs = {bool(factor(*(env[name] for name in used)) > 0) for env in points}
        if len(signs) == 2:
            return _write_polynomial(factor, used)
    return ""


def _freeze(domain: Domain) -> Any:
    """Return a domain that can be looked up."""
    return tuple(domain) if isinstance(domain, list) else domain


def _list_where(
    used: Sequence[str], domains: tuple[tuple[str, Any], ...], where: Sequence[Expr]
) -> list[Env]:
    """Return the sample points of some names, of those that meet the conditions about them."""
    about = [compile_exact(one) for one in where if names_in(one) <= {*used}]
    points = sample_points(
        {name: list(of) if isinstance(of, tuple) else of for name, of in domains}
    )
    with working_precision(BITS):
        return [env for env in points if all(condition(env) is True for condition in about)]


def _write_polynomial(polynomial: Any, used: Sequence[str]) -> str:
    """Return a polynomial as a formula in its names."""
    terms: list[Expr] = []
    for exponents, factor in polynomial.terms():
        powers = [Call("pow", (Sym(name), Num(Fraction(int(e))))) if e > 1 else Sym(name)
                  for name, e in zip(used, exponents, strict=False) if e]  # fmt: skip
        number = Num(Fraction(int(factor.p), int(factor.q)))
        parts = powers if number == _ONE and powers else [number, *powers]
        terms.append(parts[0] if len(parts) == 1 else Call("mul", tuple(parts)))
    from quizgen.maths.tidy import tidy_formula  # small, and needed for a sentence alone

    return format_tree(tidy_formula(terms[0] if len(terms) == 1 else Call("add", tuple(terms))))


@lru_cache(maxsize=256)
def build_world(
    domains: tuple[tuple[str, Any], ...],
    definitions: tuple[tuple[str, Expr], ...],
    where: tuple[Expr, ...],
) -> World:
    """Return the right world of a key, which the answers of a whole class are judged in."""
    return World(
        {name: list(of) if isinstance(of, tuple) else of for name, of in domains},
        dict(definitions),
        where,
    )
