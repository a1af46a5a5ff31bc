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

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec

from quizgen.core.errors import BankError
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.tree import names_in

if TYPE_CHECKING:
    import sympy

    from quizgen.maths.symbolic import FormResolver

T = TypeVar("T")


def work_out(compute: Callable[[], T]) -> T:
    """Return what a computation gives where SymPy evaluates, wherever it stands.

    Solvers are loaded with it around ``diff``, ``integrate`` and the like.
    """
    from sympy import evaluate

    with evaluate(True):
        return compute()


@dataclass(frozen=True, slots=True)
class Step:
    """One step of a derivation.

    Parameters
    ----------
    symbol : sympy.Symbol, sympy.Function, sympy.MatrixSymbol or str
        What the step defines. A function of free names, ``Function("f")(x)``, lets later steps
        write ``diff(f, x)``; a matrix lets them write ``det(A)``.
    expr : sympy.Expr, sympy.Matrix, sympy.Set or sympy.Eq
        Its formula. Under ``evaluate(False)`` its terms print in the order written.
    unit : str
        The unit in which the quantity is shown; empty for pure numbers.
    """

    symbol: Any
    expr: Any
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
    free : tuple of str
        Names that no draw gives: a step whose formula holds one is a formula and no number.
    traps : mapping of str to Step or tuple of Step
        Mistake name to the wrong step (or steps) put in place of the right one.
    formulas : mapping of str to str
        Name of a step to the formula of the bank that it applies (``cards/formulas.toml``).
    alternatives : tuple of Step
        Other right formulas of steps, which a student may use with an own earlier value.
    """

    given: Mapping[sympy.Symbol, str]
    steps: tuple[Step, ...]
    free: tuple[str, ...] = ()
    traps: Mapping[str, Step | tuple[Step, ...]] = field(default_factory=dict)
    formulas: Mapping[str, str] = field(default_factory=dict)
    alternatives: tuple[Step, ...] = ()

    def chain(self) -> Chain:
        """Return the model as a chain of formula trees, without SymPy.

        Raises
        ------
        BankError
            If a step uses a quantity that is neither given nor defined before it, or a formula or
            an alternative is given for what is no step.
        """
        from quizgen.maths.symbolic import FormResolver

        given = {symbol.name: unit for symbol, unit in self.given.items()}
        resolver = FormResolver(self.free)
        _check_free(self.free, [*given, *map(_name_step, self.steps)])
        converted = _ConvertedSteps(self.traps)
        wrong = _group_misconceptions(self.traps)
        for step in self.steps:
            converted.add(step, dict(wrong.pop(_name_step(step), ())), resolver)
        for name, rest in wrong.items():
            what = f"trap {rest[0][0]!r} replaces {name!r}, which is not a step"
            raise BankError(what, rule="QG116", place=("traps", rest[0][0]))
        steps, forms = converted.steps, converted.forms
        traps, form_traps = converted.traps, converted.form_traps
        numeric = {name: tuple(found) for name, found in traps.items() if found}
        of_forms = {name: tuple(found) for name, found in form_traps.items() if found}
        others = tuple(_convert_step(step, resolver)[0] for step in self.alternatives)
        before = _check_order(given, tuple(steps), numeric)
        for other in others:
            what, place = f"the alternative of {other.name!r}", ("alternatives", other.name)
            _check_replacement(what, place, other, before)
        _check_forms({*given, *(step.name for step in steps), *self.free}, forms, of_forms)
        strangers = set(self.formulas) - {step.name for step in (*steps, *forms)}
        if strangers:
            place = ("formulas", min(strangers))
            raise BankError(
                f"formulas: {sorted(strangers)} are not steps", rule="QG116", place=place
            )
        return Chain(
            given, tuple(steps), numeric, self.formulas, tuple(forms), of_forms, self.free, others
        )


class _ConvertedSteps:
    """Steps without SymPy, as they are right and as each mistake leaves them.

    A mistake in a formula goes on into every later step that was made from the formula.
    """

    def __init__(self, traps: Iterable[str]) -> None:
        self.steps = list[ChainStep]()
        self.forms = list[ChainStep]()
        self.traps = {name: list[ChainStep]() for name in traps}
        self.form_traps = {name: list[ChainStep]() for name in self.traps}
        self._slipped: dict[str, FormResolver] = {}

    def add(self, step: Step, replaced: Mapping[str, Step], resolver: FormResolver) -> None:
        """Convert a step, and what mistakes put in its place or make follow for it."""
        name = _name_step(step)
        found, is_form = _convert_step(step, resolver)
        for trap in self.traps:
            if trap in replaced or trap in self._slipped:
                self._add_wrong(trap, step, replaced.get(trap), found, resolver)
        recipe = resolver.find_recipe(step.expr) if found.forms else None
        whole = msgspec.structs.replace(found, recipe=recipe)
        (self.forms if is_form else self.steps).append(whole)
        if is_form:
            resolver.remember(name, step.expr, found.expr)

    def _add_wrong(
        self,
        trap: str,
        step: Step,
        replaced: Step | None,
        right: ChainStep,
        resolver: FormResolver,
    ) -> None:
        """Convert what a mistake makes of a step; nothing if it stays right, or cannot be had."""
        taken = replaced or step
        try:
            wrong, is_form = _convert_step(taken, self._slipped.get(trap, resolver))
        except BankError:
            if replaced:
                raise
            return  # nothing follows from what went wrong: no inverse, no solution
        if replaced or wrong != right:
            (self.form_traps if is_form else self.traps)[trap].append(wrong)
        if is_form:
            self._slipped.setdefault(trap, resolver.copy()).remember(
                right.name, taken.expr, wrong.expr
            )


def _name_step(step: Step) -> str:
    """Return the name of a step, without loading SymPy before it is needed."""
    from quizgen.maths.symbolic import step_name

    return step_name(step.symbol)


def _group_misconceptions(
    traps: Mapping[str, Step | tuple[Step, ...]],
) -> dict[str, list[tuple[str, Step]]]:
    """Name of a step to the wrong steps that replace it, each with its mistake."""
    found: dict[str, list[tuple[str, Step]]] = {}
    for trap, wrong in traps.items():
        for step in wrong if isinstance(wrong, tuple) else (wrong,):
            found.setdefault(_name_step(step), []).append((trap, step))
    return found


def _convert_step(step: Step, resolver: FormResolver) -> tuple[ChainStep, bool]:
    """Return a step without SymPy, and whether it is a form."""
    name = _name_step(step)
    try:
        tree, is_form = resolver.resolve(step.expr)
    except BankError as error:
        raise BankError(f"step {name!r}: {error}", rule="QG131", place=("Step", name)) from error
    return ChainStep(name, tree, step.unit, resolver.find_forms(step.expr)), is_form


def _check_free(free: Iterable[str], taken: Iterable[str]) -> None:
    """Raise ``BankError`` if a name without a value is that of a given quantity or a step, too."""
    both = sorted({*free} & {*taken})
    if both:
        what = f"{both} stand in free, and have a value as given or as a step: take other letters"
        raise BankError(what, rule="QG116", place=("Model", both[0]))


def _check_forms(
    known: set[str], forms: list[ChainStep], traps: Mapping[str, tuple[ChainStep, ...]]
) -> None:
    """Raise ``BankError`` if a form or a trap uses a name that is neither given nor free."""
    for step in (*forms, *(wrong for several in traps.values() for wrong in several)):
        missing = names_in(step.expr) - known
        if missing:
            what = f"step {step.name!r} uses {sorted(missing)}, neither given nor free"
            raise BankError(what, rule="QG130", place=("Step", step.name))


def _check_order(
    given: Mapping[str, str],
    steps: tuple[ChainStep, ...],
    traps: Mapping[str, tuple[ChainStep, ...]],
) -> dict[str, set[str]]:
    """Return what each step may use: what is given or defined before it; wrong steps are checked.

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
            _check_replacement(f"trap {trap!r}", ("traps", trap), step, before)
    return before


def _check_replacement(
    said: str, place: tuple[str, str], step: ChainStep, before: Mapping[str, set[str]]
) -> None:
    """Raise ``BankError`` if what stands in for a step is of none, or uses what comes after it."""
    if step.name not in before:
        what = f"{said} replaces {step.name!r}, which is not a step"
        raise BankError(what, rule="QG116", place=place)
    missing = names_in(step.expr) - before[step.name]
    if missing:
        what = f"{said} uses {sorted(missing)}, not defined before it"
        raise BankError(what, rule="QG130", place=place)
