"""Which single slip in a chain gives a number: the chain is mutated and recomputed in floats.

A slip is a small change of one formula: a term left out, a sign turned, a wrong parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cached_property
from typing import Any

import msgspec

from quizgen.maths.chain import Chain, ChainStep, CompiledSteps
from quizgen.maths.number_systems import compile_expr, float64_system
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in
from quizgen.maths.units import get_unit
from quizgen.maths.values import map_numbers

PREFIXES = (-6, -3, -2, -1, 1, 2, 3, 6)
MOST_CHAINS = 256


class SlipCandidate(msgspec.Struct, frozen=True):
    """One slip: its note, what it concerns, and the compiled steps that recompute the target."""

    note: str
    detail: str
    plan: CompiledSteps


Results = list[tuple[SlipCandidate, float]]
"""Slips and what they give."""


class SlipSearch(msgspec.Struct, dict=True):
    """All single slips of one chain, compiled once."""

    chain: Chain
    _slips: dict[str, list[SlipCandidate]] = msgspec.field(default_factory=dict)
    _last: dict[str, tuple[dict[str, float], Results]] = msgspec.field(default_factory=dict)
    """Target to the numbers met last and what every slip gives there: a class shares a paper."""

    @cached_property
    def _same_dimension_names(self) -> dict[str, list[str]]:
        """Return the name of each given quantity with the others of the same dimension."""
        kinds = {name: get_unit(text).dimension for name, text in self.chain.given.items()}
        return {
            name: [other for other in kinds if other != name and kinds[other] == kind]
            for name, kind in kinds.items()
        }

    def slips(self, target: str) -> list[SlipCandidate]:
        """Return every slip that can change a quantity, compiled when it is first needed."""
        if target not in self._slips:
            self._slips[target] = list(self._iter_slips(target))
        return self._slips[target]

    def _iter_slips(self, target: str) -> Iterator[SlipCandidate]:
        """Yield the slips in the steps that a quantity needs, then those in given units."""
        needed = self.chain.required_steps(target)
        for step in self.chain.steps:
            if step.name in needed:
                for note, detail, changed in self._iter_step_mutations(step):
                    wrong = ChainStep(step.name, changed)
                    yield SlipCandidate(
                        note,
                        detail,
                        self.chain.compile_affected_steps([wrong], float64_system(), within=needed),
                    )
        yield from self._iter_unit_prefix_slips(needed)

    def _iter_step_mutations(self, step: ChainStep) -> Iterator[tuple[str, str, Expr]]:
        """Yield note, detail and wrong formula for each slip in one step.

        The detail is the step's name; for a wrong parameter or base it is both that were confused.
        """
        for note, detail, changed in mutate_formula(step.expr, self._same_dimension_names):
            yield note, detail if note in {"wrong-parameter", "log-base"} else step.name, changed
        for name in sorted(names_in(step.expr)):
            yield "step-left-out", step.name, Sym(name)

    def _iter_unit_prefix_slips(self, needed: frozenset[str]) -> Iterator[SlipCandidate]:
        """Yield the slips of reading a given number with a wrong prefix of its unit.

        Numbers without a dimension have no prefix to mistake.
        """
        used = {n for name in needed for n in self.chain.operands[name]}
        for name in sorted(used & self.chain.given.keys()):
            if not get_unit(self.chain.given[name]).dimension:
                continue
            for power in PREFIXES:
                scale = Num(Fraction(10) ** power)
                wrong = compile_expr(Call("mul", (Sym(name), scale)), float64_system())
                plan = self.chain.compile_affected_steps(
                    (), float64_system(), changed=[name], within=needed
                )
                yield SlipCandidate("unit-prefix-given", name, ((name, wrong), *plan))

    def find(
        self, target: str, solved: Mapping[str, Any], value: float, slack: float
    ) -> tuple[str, str]:
        """Return the note and the place of the one slip that gives a value.

        Parameters
        ----------
        target : str
            The quantity asked.
        solved : mapping
            The right values, in base units.
        value, slack : float
            The wrong value in base units, and how far rounding may have moved it.

        Returns
        -------
        tuple of str
            Note, and the step or the names concerned (never a formula: it may be asked for); the
            detail is empty if several slips of the kind explain the value, both if none or more
            than one kind does.
        """
        hits: dict[str, str] = {}
        for slip, result in self._try_all_slips(target, solved):
            if abs(result - value) <= slack:
                hits[slip.note] = slip.detail if hits.get(slip.note) in {None, slip.detail} else ""
        if len(hits) != 1:
            return "", ""
        ((note, detail),) = hits.items()
        return note, detail

    def _try_all_slips(self, target: str, solved: Mapping[str, Any]) -> Results:
        """Return every slip that changes a quantity, and what it gives in base units.

        The results for the last numbers are stored, since a class shares a paper.
        """
        env = {name: map_numbers(float, number) for name, number in solved.items()}
        last = self._last.get(target)
        if last is not None and last[0] == env:
            return last[1]
        pairs = [(slip, _evaluate_target(slip.plan, env, target)) for slip in self.slips(target)]
        found = [(s, value) for s, value in pairs if value is not None and value != env[target]]
        self._last[target] = env, found
        return found


def _evaluate_target(plan: CompiledSteps, env: dict[str, Any], target: str) -> float | None:
    """Return what a slip gives for the target; None where it has no finite real value."""
    env = dict(env)
    try:
        for name, compiled in plan:
            env[name] = compiled(env)
        return float(env[target])
    except (ArithmeticError, ValueError, TypeError):
        return None


_EXPLAINERS: dict[int, SlipSearch] = {}


def slip_search_for(chain: Chain) -> SlipSearch:
    """Return the compiled slips of a chain, stored for the last ``MOST_CHAINS`` chains."""
    found = _EXPLAINERS.get(id(chain))
    if found is None or found.chain is not chain:
        if len(_EXPLAINERS) >= MOST_CHAINS:
            _EXPLAINERS.pop(next(iter(_EXPLAINERS)))
        found = _EXPLAINERS[id(chain)] = SlipSearch(chain)
    return found


Mutation = tuple[str, str, Expr]
"""Note, the name or operator concerned, and the changed formula."""

TWO = Num(Fraction(2))
HALF_TURN = Num(Fraction(180))
PI = Call("pi", ())


def mutate_formula(expr: Expr, alike: Mapping[str, list[str]]) -> Iterator[Mutation]:
    """Yield every formula that differs from the right one by one slip.

    Parameters
    ----------
    expr : Expr
        The right formula.
    alike : mapping of str to list of str
        Quantity name to other given quantities of the same dimension.
    """
    if isinstance(expr, Sym):
        for other in alike.get(expr.name, ()):
            yield "wrong-parameter", f"{other} / {expr.name}", Sym(other)
    if not isinstance(expr, Call):
        return
    local = _LOCAL.get(expr.op)
    if local is not None:
        yield from local(expr)
    for position, arg in enumerate(expr.args):
        for note, detail, changed in mutate_formula(arg, alike):
            yield note, detail, _replace_argument(expr, position, changed)


def _replace_argument(expr: Call, position: int, arg: Expr) -> Call:
    """Return a call with another argument at a position."""
    return Call(expr.op, (*expr.args[:position], arg, *expr.args[position + 1 :]))


def _drop_argument(expr: Call, position: int) -> Expr:
    """Return a call without one argument; what is left, if that is a single one."""
    rest = (*expr.args[:position], *expr.args[position + 1 :])
    return rest[0] if len(rest) == 1 else Call(expr.op, rest)


def _mutate_sum(expr: Call) -> Iterator[Mutation]:
    """Yield the sum with one term left out, or with its sign turned."""
    for position, term in enumerate(expr.args):
        yield "term-left-out", "+", _drop_argument(expr, position)
        yield "operator", "+ / -", _replace_argument(expr, position, Call("neg", (term,)))


def _mutate_difference(expr: Call) -> Iterator[Mutation]:
    """Yield the sum in its stead, the terms exchanged, and each term alone."""
    first, second = expr.args
    yield "operator", "- / +", Call("add", (first, second))
    yield "operands", "-", Call("sub", (second, first))
    yield "term-left-out", "-", first
    yield "term-left-out", "-", second


def _mutate_product(expr: Call) -> Iterator[Mutation]:
    """Yield the product with one factor left out, or divided by."""
    for position, factor in enumerate(expr.args):
        rest = _drop_argument(expr, position)
        yield "factor-left-out", "*", rest
        yield "operator", "* / ÷", Call("div", (rest, factor))


def _mutate_quotient(expr: Call) -> Iterator[Mutation]:
    """Yield the quotient upside down, the product in its stead, and the numerator alone."""
    first, second = expr.args
    yield "ratio-inverted", "/", Call("div", (second, first))
    yield "operator", "÷ / *", Call("mul", (first, second))
    yield "factor-left-out", "/", first


def _mutate_power(expr: Call) -> Iterator[Mutation]:
    """Yield the base alone, the power with the reciprocal exponent, and base times exponent."""
    base, exponent = expr.args
    note = "square-forgotten" if exponent == TWO else "exponent-forgotten"
    yield note, "^", base
    yield "exponent-inverted", "^", Call("pow", (base, Call("div", (Num(Fraction(1)), exponent))))
    yield "exponent-as-factor", "^", Call("mul", (base, exponent))


def _mutate_root(expr: Call) -> Iterator[Mutation]:
    """Yield what stands under the root."""
    yield "root-forgotten", "sqrt", expr.args[0]


def _mutate_trigonometry(expr: Call) -> Iterator[Mutation]:
    """Yield the function of an angle in the wrong unit, and other functions of the angle."""
    (arg,) = expr.args
    for scale in (Call("div", (PI, HALF_TURN)), Call("div", (HALF_TURN, PI))):
        yield "degrees-radians", expr.op, Call(expr.op, (Call("mul", (arg, scale)),))
    for other in _ROTATED[expr.op]:
        yield "function", f"{other} / {expr.op}", Call(other, (arg,))


def _mutate_inverse_trigonometry(expr: Call) -> Iterator[Mutation]:
    """Yield the angle in degrees taken for radians, and the other way round."""
    for scale in (Call("div", (PI, HALF_TURN)), Call("div", (HALF_TURN, PI))):
        yield "degrees-radians", expr.op, Call("mul", (expr, scale))


def _mutate_logarithm(expr: Call) -> Iterator[Mutation]:
    """Yield the logarithms to the other usual bases."""
    for other in ("ln", "log2", "log10"):
        if other != expr.op:
            yield "log-base", f"{other} / {expr.op}", Call(other, expr.args)


def _mutate_negation(expr: Call) -> Iterator[Mutation]:
    """Yield the formula without its minus sign."""
    yield "sign-inside", "-", expr.args[0]


def _mutate_exponential(expr: Call) -> Iterator[Mutation]:
    """Yield the exponential function of the opposite exponent."""
    yield "sign-inside", "exp", Call("exp", (Call("neg", expr.args),))


def _mutate_absolute_value(expr: Call) -> Iterator[Mutation]:
    """Yield what stands between the bars."""
    yield "absolute-forgotten", "abs", expr.args[0]


def _make_function_swapper(*others: str) -> Callable[[Call], Iterator[Mutation]]:
    """Return a rule that yields a call with each of some other functions in its place."""

    def swap(expr: Call) -> Iterator[Mutation]:
        """Yield the call with another function."""
        for other in others:
            yield "function", f"{other} / {expr.op}", Call(other, expr.args)

    return swap


_ROTATED = {"sin": ("cos", "tan"), "cos": ("sin",), "tan": ("sin",)}

_LOCAL: dict[str, Callable[[Call], Iterator[Mutation]]] = {
    "add": _mutate_sum,
    "sub": _mutate_difference,
    "mul": _mutate_product,
    "div": _mutate_quotient,
    "pow": _mutate_power,
    "sqrt": _mutate_root,
    "sin": _mutate_trigonometry,
    "cos": _mutate_trigonometry,
    "tan": _mutate_trigonometry,
    "asin": _mutate_inverse_trigonometry,
    "acos": _mutate_inverse_trigonometry,
    "atan": _mutate_inverse_trigonometry,
    "atan2": _mutate_inverse_trigonometry,
    "ln": _mutate_logarithm,
    "log2": _mutate_logarithm,
    "log10": _mutate_logarithm,
    "neg": _mutate_negation,
    "exp": _mutate_exponential,
    "abs": _mutate_absolute_value,
    "min": _make_function_swapper("max"),
    "max": _make_function_swapper("min"),
    "floor": _make_function_swapper("ceil", "round"),
    "ceil": _make_function_swapper("floor", "round"),
    "round": _make_function_swapper("floor", "ceil"),
}
