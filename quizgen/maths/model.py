"""What a solver file provides: quantities, steps and traps, written once in SymPy.

A solver speaks mathematics only. ``Model.chain()`` turns it into the SymPy-free ``Chain`` that
everything downstream runs.

Examples
--------
>>> from sympy import evaluate, symbols
>>> f, X, Z, x = symbols("f X Z x")
>>> with evaluate(False):
...     MODEL = Model(given={f: "mm", X: "m", Z: "m"}, steps=(Step(x, f * X / Z, "mm"),))
>>> MODEL.chain().steps[0].name
'x'
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from quizgen.core.errors import BankError
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.tree import names_in

if TYPE_CHECKING:
    import sympy


@dataclass(frozen=True, slots=True)
class Step:
    """One step of a derivation.

    Parameters
    ----------
    symbol : sympy.Symbol
        The quantity that the step defines.
    expr : sympy.Expr
        Its formula, built under ``evaluate(False)`` so that terms print in the order written.
    unit : str
        The unit in which the quantity is shown; empty for pure numbers.
    """

    symbol: sympy.Symbol
    expr: sympy.Expr
    unit: str = ""


@dataclass(frozen=True)
class Model:
    """A chain of steps with the mistakes that are known to happen in it.

    Parameters
    ----------
    given : mapping of sympy.Symbol to str
        Given quantities and the unit each is usually shown in.
    steps : tuple of Step
        In order of solution.
    traps : mapping of str to Step or tuple of Step
        Mistake name to the wrong step (or steps) put in place of the right one.
    formulas : mapping of str to str
        Name of a step to the formula of the bank that it applies (``cards/formulas.toml``).
    """

    given: Mapping[sympy.Symbol, str]
    steps: tuple[Step, ...]
    traps: Mapping[str, Step | tuple[Step, ...]] = field(default_factory=dict)
    formulas: Mapping[str, str] = field(default_factory=dict)

    def chain(self) -> Chain:
        """Return the model as a chain of formula trees, without SymPy.

        Raises
        ------
        BankError
            If a step uses a quantity that is neither given nor defined before it, or a formula is
            given for what is no step.
        """
        given = {symbol.name: unit for symbol, unit in self.given.items()}
        steps = tuple(_convert_step(step) for step in self.steps)
        traps = {
            name: tuple(_convert_step(s) for s in (wrong if isinstance(wrong, tuple) else (wrong,)))
            for name, wrong in self.traps.items()
        }
        _check_order(given, steps, traps)
        strangers = set(self.formulas) - {step.name for step in steps}
        if strangers:
            place = ("formulas", min(strangers))
            raise BankError(
                f"formulas: {sorted(strangers)} are not steps", rule="QG116", place=place
            )
        return Chain(given, steps, traps, self.formulas)


def _convert_step(step: Step) -> ChainStep:
    """Return a step without SymPy.

    Raises
    ------
    BankError
        That names the step, if its expression is no formula.
    """
    from quizgen.maths.from_sympy import from_sympy

    try:
        return ChainStep(step.symbol.name, from_sympy(step.expr), step.unit)
    except BankError as error:
        name = step.symbol.name
        raise BankError(f"step {name!r}: {error}", rule="QG131", place=("Step", name)) from error


def _check_order(
    given: Mapping[str, str],
    steps: tuple[ChainStep, ...],
    traps: Mapping[str, tuple[ChainStep, ...]],
) -> None:
    """Check that each step uses what is given or defined before it, wrong steps too.

    Raises
    ------
    BankError
        That names the step or the misconception.
    """
    known = set(given)
    before: dict[str, set[str]] = {}
    for step in steps:
        missing = names_in(step.expr) - known
        if missing:
            what = f"step {step.name!r} uses {sorted(missing)}, not defined before it"
            raise BankError(what, rule="QG130", place=("Step", step.name))
        before[step.name] = set(known)
        known.add(step.name)
    for trap, wrong in traps.items():
        for step in wrong:
            if step.name not in before:
                what = f"trap {trap!r} replaces {step.name!r}, which is not a step"
                raise BankError(what, rule="QG116", place=("traps", trap))
            missing = names_in(step.expr) - before[step.name]
            if missing:
                what = f"trap {trap!r} uses {sorted(missing)}, not defined before it"
                raise BankError(what, rule="QG130", place=("traps", trap))
