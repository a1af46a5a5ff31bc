"""The chain of steps behind a question, without SymPy.

A chain is what a solver's model becomes after loading: given quantities, steps in order, and traps
(wrong steps that stand in for right ones). Drawing, linting, marking, carrying errors forward and
diagnosing all run the same compiled chain. It serialises to plain formulas of the answer grammar.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from functools import cached_property
from itertools import islice, product
from typing import TypeAlias

import msgspec
from flint import fmpq

from quizgen.core.errors import MathError
from quizgen.maths.number_systems import (
    CompiledFormula,
    NumberSystem,
    compile_expr,
    compile_nested,
    exact_system,
    select_branch,
)
from quizgen.maths.numbers import is_short_decimal, to_fraction, to_rational
from quizgen.maths.operators import CHECKED, LIST_OPERATORS, OPERATORS
from quizgen.maths.precision import PRECISION, working_precision
from quizgen.maths.recipes import Recipe
from quizgen.maths.tidy import tidy_formula
from quizgen.maths.tree import Call, Expr, Num, names_in, operators_in, substitute, walk_tree
from quizgen.maths.values import Value, Values

CompiledSteps: TypeAlias = tuple[tuple[str, CompiledFormula], ...]
"""Quantities to compute, in order, each from the ones given and before it."""


MOST_WAYS = 64
"""Choices among other right formulas that are tried with a student's own values."""


class ChainStep(msgspec.Struct, frozen=True):
    """One step: the quantity it defines, its formula, and the unit it is shown in.

    ``forms`` are the formulas, matrices and sets that were put into it, by their names; ``recipe``
    says how, if it can be done again with other ones.
    """

    name: str
    expr: Expr
    unit: str = ""
    forms: tuple[str, ...] = ()
    recipe: Recipe | None = None


class Chain(msgspec.Struct, frozen=True, dict=True):
    """Given quantities, steps and traps, compiled for the exact field on first use.

    Parameters
    ----------
    given : mapping of str to str
        Quantity name to the unit it is usually shown in.
    steps : tuple of ChainStep
        In order: a step may use given quantities and earlier steps.
    traps : mapping of str to tuple of ChainStep
        Trap name to the wrong steps put in place of the right ones of the same name.
    formulas : mapping of str to str
        Step name to the id of the formula that it applies.
    forms : tuple of ChainStep
        Steps that are no single number: formulas over free names, complex numbers, matrices,
        sets, equations. They use given quantities and steps.
    form_traps : mapping of str to tuple of ChainStep
        Trap name to the wrong forms put in place of the right ones.
    free : tuple of str
        Names in forms that no draw gives.
    alternatives : tuple of ChainStep
        Other right formulas of steps: the ways that a student may go from an own earlier value.
    """

    given: Mapping[str, str]
    steps: tuple[ChainStep, ...]
    traps: Mapping[str, tuple[ChainStep, ...]] = msgspec.field(default_factory=dict)
    formulas: Mapping[str, str] = msgspec.field(default_factory=dict)
    forms: tuple[ChainStep, ...] = ()
    form_traps: Mapping[str, tuple[ChainStep, ...]] = msgspec.field(default_factory=dict)
    free: tuple[str, ...] = ()
    alternatives: tuple[ChainStep, ...] = ()

    @cached_property
    def by_name(self) -> dict[str, ChainStep]:
        """Step name to step."""
        return {step.name: step for step in self.steps}

    @cached_property
    def form_by_name(self) -> dict[str, ChainStep]:
        """Name of a form to its step."""
        return {step.name: step for step in self.forms}

    @cached_property
    def right_ways(self) -> tuple[Chain, ...]:
        """The chain as it is written, then with each choice of alternatives; ``MOST_WAYS``."""
        formulas = {step.name: [step] for step in self.steps}
        for other in self.alternatives:
            formulas[other.name].append(other)
        ways = islice(product(*formulas.values()), 1, MOST_WAYS)
        return (self, *(Chain(self.given, steps) for steps in ways))

    def bind_form(
        self, expr: Expr, values: Values, wrong: Mapping[str, Expr] | None = None
    ) -> Expr:
        """Return a form with the numbers of a draw in place, tidied.

        A quantity that is irrational stays the formula that gives it, so that the form is exact.

        Parameters
        ----------
        expr : Expr
        values : mapping of str to flint.fmpq or flint.arb
            Every quantity of the chain in base units.
        wrong : mapping of str to Expr, optional
            Formulas that a mistake puts in place of those of steps.
        """
        steps = {step.name: step.expr for step in self.steps} | dict(wrong or {})
        if isinstance(expr, Call) and expr.op == "piecewise" and not self._has_free_case(expr):
            expr = select_branch(expr, values, exact_system())
        expr = _reckon_lists(expr, values)
        names = names_in(expr) - {*self.free}
        bound = substitute(expr, {n: _write_exactly(n, values, steps) for n in names})
        tidied = tidy_formula(bound)
        return _write_decimals(tidied) if any(map(_is_decimal, walk_tree(bound))) else tidied

    def _has_free_case(self, cases: Call) -> bool:
        """Return whether a condition holds a name that no draw gives: nothing chooses then."""
        return any(names_in(condition) & {*self.free} for condition in cases.args[1::2])

    @cached_property
    def certainties(self) -> dict[str, str]:
        """Step name to how far its value is certified where it is irrational.

        ``ball`` is proved by balls; ``checked`` is computed twice and compared, and so is whatever
        rests on such a step. Rational values are exact all the same.
        """
        found: dict[str, str] = {}
        for step in self.steps:
            below = {found.get(name) for name in self.operands[step.name]}
            checked = bool(operators_in(step.expr) & CHECKED) or "checked" in below
            found[step.name] = "checked" if checked else "ball"
        return found

    @cached_property
    def operands(self) -> dict[str, frozenset[str]]:
        """Step name to the quantities in its formula."""
        return {step.name: names_in(step.expr) for step in self.steps}

    @cached_property
    def _compiled_by_system(self) -> dict[str, dict[str, CompiledFormula]]:
        """Number system to step name to the right formula, filled on demand."""
        return {}

    @cached_property
    def _trap_plans(self) -> dict[str, CompiledSteps]:
        """Misconception to the steps that it changes, compiled for exact numbers."""
        return {
            name: self.compile_affected_steps(wrong, exact_system())
            for name, wrong in self.traps.items()
        }

    def compile_steps(self, system: NumberSystem) -> dict[str, CompiledFormula]:
        """Return step name to its formula in a number system, compiled once, in order."""
        found = self._compiled_by_system.get(system.name)
        if found is None:
            found = {step.name: compile_nested(step.expr, system) for step in self.steps}
            self._compiled_by_system[system.name] = found
        return found

    def compile_affected_steps(
        self,
        wrong: Iterable[ChainStep],
        system: NumberSystem,
        *,
        changed: Iterable[str] = (),
        within: Container[str] | None = None,
    ) -> CompiledSteps:
        """Return only the steps that a change touches, compiled, in order.

        Parameters
        ----------
        wrong : iterable of ChainStep
            Steps that stand in for the right ones of the same name.
        system : NumberSystem
            What the steps compute in.
        changed : iterable of str
            Given quantities that take other values.
        within : container of str, optional
            Leave out steps of other names.
        """
        swapped = {step.name: step.expr for step in wrong}
        right = self.compile_steps(system)
        touched = set(changed)
        plan = []
        for step in self.steps:
            if within is not None and step.name not in within:
                continue
            if step.name in swapped:
                plan.append((step.name, compile_nested(swapped[step.name], system)))
                touched.add(step.name)
            elif touched & self.operands[step.name]:
                plan.append((step.name, right[step.name]))
                touched.add(step.name)
        return tuple(plan)

    def solve(self, given: Values, precision: int = PRECISION) -> dict[str, Value]:
        """Return every quantity of the chain in base units, exactly or as a certified ball.

        Parameters
        ----------
        given : mapping of str to flint.fmpq
            Given quantities in base units.
        precision : int
            Bits for values that are not rational.

        Raises
        ------
        MathError
            If a step has no finite real value.
        """
        return _run_steps(self.compile_steps(exact_system()).items(), dict(given), precision)

    def solve_with_misconception(self, trap: str, solved: Values) -> dict[str, Value]:
        """Return the quantities as somebody with this misconception gets them, in base units.

        Raises
        ------
        MathError
            If the wrong way has no finite real value for these numbers.
        """
        return _run_steps(self._trap_plans[trap], dict(solved), PRECISION)

    def solve_with_steps(self, wrong: Iterable[ChainStep], solved: Values) -> dict[str, Value]:
        """Return the quantities with some steps replaced: mutations, a student's own earlier value.

        Raises
        ------
        MathError
            If a step has no finite real value.
        """
        return _run_steps(
            self.compile_affected_steps(wrong, exact_system()), dict(solved), PRECISION
        )

    def solve_from(self, own: Values, solved: Values) -> dict[str, Value]:
        """Return the quantities with some values replaced, given ones too, and what follows.

        Raises
        ------
        MathError
            If a step has no finite real value.
        """
        plan = self.compile_affected_steps((), exact_system(), changed=own)
        steps = [step for step in plan if step[0] not in own]
        return _run_steps(steps, {**solved, **own}, PRECISION)

    def required_forms(self, steps: Iterable[ChainStep], known: Iterable[str] = ()) -> list[str]:
        """Return the names of the forms that steps were made from, in the order of the solver.

        Forms behind one in ``known`` do not count.
        """
        stop, seen = set(known), set[str]()
        todo = [name for step in steps for name in step.forms]
        while todo:
            current = todo.pop()
            if current not in seen and current not in stop:
                seen.add(current)
                todo += self.form_by_name[current].forms
        return [step.name for step in self.forms if step.name in seen]

    def required_steps(self, name: str, known: Iterable[str] = ()) -> frozenset[str]:
        """Return the names of the steps that ``name`` rests on, itself included.

        Steps behind a quantity in ``known`` do not count.
        """
        stop, seen, todo = set(known), set[str](), [name]
        while todo:
            current = todo.pop()
            if current in seen or current not in self.by_name:
                continue
            seen.add(current)
            todo += [n for n in self.operands[current] if n not in stop]
        return frozenset(seen)


def _write_exactly(name: str, values: Values, steps: Mapping[str, Expr]) -> Expr:
    """Return a quantity as a rational, else as the formula that gives it."""
    value = values[name]
    if isinstance(value, fmpq):
        return Num(to_fraction(value)) if name in steps else _write_number(value)
    expr = _reckon_lists(select_branch(steps[name], values, exact_system()), values)
    return substitute(expr, {n: _write_exactly(n, values, steps) for n in names_in(expr)})


def _is_decimal(part: Expr) -> bool:
    """Return whether a formula is a number with decimals, as drawn ones are printed."""
    return isinstance(part, Num) and part.decimal


def _write_decimals(expr: Expr) -> Expr:
    """Return a formula with decimals for fractions, if each of its fractions has short ones."""
    numbers = [part for part in walk_tree(expr) if isinstance(part, Num)]
    if not all(is_short_decimal(to_rational(number.value)) for number in numbers):
        return expr
    return _mark_decimals(expr)


def _mark_decimals(expr: Expr) -> Expr:
    """Return a formula whose numbers are decimals."""
    if isinstance(expr, Call):
        return Call(expr.op, tuple(map(_mark_decimals, expr.args)))
    if isinstance(expr, Num) and expr.value.denominator > 1:
        return Num(expr.value, decimal=True)
    return expr


def _write_number(value: fmpq) -> Num:
    """Return a drawn number; one that is printed with decimals says so."""
    return Num(to_fraction(value), value.q != 1 and is_short_decimal(value))


def _reckon_lists(expr: Expr, values: Values) -> Expr:
    """Return a formula with the number that each function of lists gives in its place.

    Raises
    ------
    MathError
        If one has no rational value.
    """
    if not isinstance(expr, Call):
        return expr
    if expr.op not in LIST_OPERATORS or not names_in(expr) <= values.keys():
        return Call(expr.op, tuple(_reckon_lists(arg, values) for arg in expr.args))
    value = compile_expr(expr, exact_system())(values)
    if not isinstance(value, fmpq):
        raise MathError(f"{OPERATORS[expr.op].signs[0]} has no exact value for a formula")
    return _write_number(value)


def _run_steps(
    plan: Iterable[tuple[str, CompiledFormula]], env: dict[str, Value], precision: int
) -> dict[str, Value]:
    """Return the values with those of some steps, computed in order.

    Raises
    ------
    MathError
        If a step has no finite real value.
    """
    with working_precision(precision):
        for name, compiled in plan:
            try:
                env[name] = compiled(env)
            except (ZeroDivisionError, OverflowError) as error:
                raise MathError(f"{name}: {error}") from error
    return env
