"""The chain of steps behind a question, without SymPy.

A chain is what a solver's model becomes after loading: given quantities, steps in order, and traps
(wrong steps that stand in for right ones). Drawing, linting, marking, carrying errors forward and
diagnosing all run the same compiled chain. It serialises to plain formulas of the answer grammar.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from quizgen.errors import MathError
from quizgen.maths.precision import PRECISION, working_precision
from quizgen.maths.tree import Compiled, Expr, compile_inner, exact, names
from quizgen.maths.values import Value, Values


@dataclass(frozen=True, slots=True)
class ChainStep:
    """One step: the quantity it defines, its formula, and the unit it is shown in."""

    name: str
    expr: Expr
    unit: str = ""


@dataclass(frozen=True)
class Chain:
    """Given quantities, steps and traps, compiled for the exact field on first use.

    Parameters
    ----------
    given : mapping of str to str
        Quantity name to the unit it is usually shown in.
    steps : tuple of ChainStep
        In order: a step may use given quantities and earlier steps.
    traps : mapping of str to tuple of ChainStep
        Trap name to the wrong steps put in place of the right ones of the same name.
    """

    given: Mapping[str, str]
    steps: tuple[ChainStep, ...]
    traps: Mapping[str, tuple[ChainStep, ...]] = field(default_factory=dict)

    @cached_property
    def by_name(self) -> dict[str, ChainStep]:
        """Step name to step."""
        return {step.name: step for step in self.steps}

    @cached_property
    def _compiled(self) -> list[tuple[str, Compiled]]:
        return [(step.name, compile_inner(step.expr, exact())) for step in self.steps]

    @cached_property
    def _trap_plans(self) -> dict[str, list[tuple[str, Compiled]]]:
        return {name: self._plan(wrong) for name, wrong in self.traps.items()}

    def _plan(self, wrong: Iterable[ChainStep]) -> list[tuple[str, Compiled]]:
        """Only the steps that a replacement changes, in order."""
        swapped = {step.name: step for step in wrong}
        changed: set[str] = set()
        plan = []
        for name, compiled in self._compiled:
            if name in swapped:
                plan.append((name, compile_inner(swapped[name].expr, exact())))
                changed.add(name)
            elif changed & names(self.by_name[name].expr):
                plan.append((name, compiled))
                changed.add(name)
        return plan

    def solve(self, given: Values, precision: int = PRECISION) -> dict[str, Value]:
        """Every quantity of the chain, exactly or as a certified ball.

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
        return _run(self._compiled, dict(given), precision)

    def trapped(self, trap: str, solved: Values, precision: int = PRECISION) -> dict[str, Value]:
        """The quantities as a student in this trap would get them.

        Raises
        ------
        MathError
            If the wrong way has no finite real value for these numbers.
        """
        return _run(self._trap_plans[trap], dict(solved), precision)

    def with_steps(self, wrong: Iterable[ChainStep], solved: Values) -> dict[str, Value]:
        """Recompute with some steps replaced (mutations, a student's own earlier answer)."""
        return _run(self._plan(wrong), dict(solved), PRECISION)

    def needs(self, name: str, known: Iterable[str] = ()) -> frozenset[str]:
        """Step names that ``name`` rests on, not looking through quantities already known."""
        stop, seen, todo = set(known), set[str](), [name]
        while todo:
            current = todo.pop()
            if current in seen or current not in self.by_name:
                continue
            seen.add(current)
            todo += [n for n in names(self.by_name[current].expr) if n not in stop]
        return frozenset(seen)


def _run(
    plan: list[tuple[str, Compiled]], env: dict[str, Value], precision: int
) -> dict[str, Value]:
    with working_precision(precision):
        for name, compiled in plan:
            try:
                env[name] = compiled(env)
            except (ZeroDivisionError, OverflowError) as error:
                raise MathError(f"{name}: {error}") from error
    return env
