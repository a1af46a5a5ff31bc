"""What the question around a number can tell: errors carried forward, then single slips."""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction

import msgspec
from flint import arb, fmpq

from quizgen.core.errors import FormulaError, MathError
from quizgen.grading.diagnosis.slip_search import slip_search_for
from quizgen.grading.judge import judge_answer
from quizgen.grading.options import GradingOptions, QuestionContext
from quizgen.grading.reading.numbers import ReadNumber
from quizgen.grading.rounding import round_ball_half_away
from quizgen.grading.spec import AnySpec, NumericSpec, matches_target
from quizgen.grading.verdict import CORRECT, HALF, Verdict, partial, wrong
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.numbers import to_fraction
from quizgen.maths.tree import Expr, Num, names_in, operators_in
from quizgen.maths.units import unit_factor
from quizgen.maths.values import Value, Values

CARRIED = "carried-forward"
EARLY = "rounded-too-early"


class NumberDiagnosis(msgspec.Struct, frozen=True):
    """The question around one quantity: what explains a wrong value of it.

    Parameters
    ----------
    spec : NumericSpec
        Whose tolerance decides what agrees.
    number : ReadNumber
        How the answer was written.
    factor : flint.fmpq
        Base units in the unit that values are judged in.
    context : QuestionContext
    target : str
        The chain's name of the quantity.
    """

    spec: NumericSpec
    number: ReadNumber
    factor: fmpq
    context: QuestionContext
    target: str

    def carried_forward(self, value: Value) -> Verdict | None:
        """Return full marks for a value that follows rightly from an own earlier one, else None."""
        for result in recompute_from_earlier(self.context, self.target):
            if matches_target(self.spec, self.number, value, result / self.factor):
                return partial(Fraction(1), self.number.read_as, CARRIED)
        return None

    def operators(self) -> frozenset[str]:
        """Return functions and constants that stand in the steps towards the quantity."""
        chain = self.context.chain
        steps = chain.required_steps(self.target) & chain.by_name.keys()
        return frozenset().union(*(operators_in(chain.by_name[name].expr) for name in steps))

    def find_slip(self, value: Value) -> Verdict | None:
        """Return the verdict of the single slip that explains a value; None if no single one does.

        Rounding too early costs half the credit, any other slip all of it.
        """
        if _is_rounded_early(
            self.context, self.target, value * self.factor, self.number, self.factor
        ):
            return partial(HALF, self.number.read_as, EARLY)
        return _find_slip_verdict(self.number, value, self.factor, self.context, self.target)


def diagnosis_for(
    spec: NumericSpec, number: ReadNumber, scale: fmpq, options: GradingOptions, target: str = ""
) -> NumberDiagnosis | None:
    """Return the diagnosis of one quantity's wrong values, or None without a question around.

    Parameters
    ----------
    spec : NumericSpec
        Its ``of`` names the quantity.
    number : ReadNumber
        How the answer was written.
    scale : flint.fmpq
        Key units per judged unit (1/100 when percent are judged).
    options : GradingOptions
        With the question around.
    target : str
        The quantity, if the spec names several.
    """
    context = options.context
    if context is None:
        return None
    quantities = spec.quantities()
    target = target or (quantities[0] if len(quantities) == 1 else "")
    if target not in context.chain.by_name or target not in context.solved_values:
        return None
    units = dict(zip(quantities, spec.value_units(), strict=True))
    unit = units[target] or context.chain.by_name[target].unit
    return NumberDiagnosis(spec, number, scale * unit_factor(unit), context, target)


def recompute_from_earlier(context: QuestionContext, target: str) -> list[Value]:
    """Return a quantity in base units, recomputed from the student's own earlier values.

    Each right way of the chain gives one. None is left if there is nothing to carry: no earlier
    value is wrong, one is zero, the result is the key's own, or zero.
    """
    solved, found = context.solved_values, list[Value]()
    own = {
        name: value for name, value in context.earlier.items()
        if name in solved and not are_nearly_equal(value, solved[name])
    }  # fmt: skip
    for way in context.chain.right_ways if own else ():
        result = _recompute(way, own, solved, target)
        if result is not None and result != 0 and not are_nearly_equal(result, solved[target]):
            found.append(result)
    return found or _recompute_from_forms(context, own, target)


def _recompute_from_forms(context: QuestionContext, own: Values, target: str) -> list[Value]:
    """Return a quantity in base units as it follows from own forms; empty if it follows none."""
    wrong, _ = _follow_own_forms(context, own)
    chain, solved = context.chain, context.solved_values
    if target in own or not wrong.keys() - own.keys() & chain.required_steps(target):
        return []
    try:
        needed = chain.required_steps(target)
        steps = [ChainStep(name, expr) for name, expr in wrong.items() if name in needed]
        result = chain.solve_with_steps(steps, solved)[target]
        same = result == 0 or are_nearly_equal(result, solved[target])
    except (MathError, KeyError, TypeError):
        return []
    return [] if same else [result]


def _follow_own_forms(
    context: QuestionContext, own: Values
) -> tuple[dict[str, Expr], dict[str, Expr]]:
    """Return the steps and the forms that are others with own values and own forms in place."""
    chain, changed = context.chain, dict(context.forms)
    key = {step.name: step.expr for step in chain.forms}

    def follow(step: ChainStep) -> Expr | None:
        """Return what a step becomes; None if it uses nothing that changed, or cannot be had."""
        if step.recipe is None or not {use.of for use in step.recipe.uses} & changed.keys():
            return None
        with suppress(MathError):
            return step.recipe.follow(key | changed)
        return None

    for form in chain.forms:
        found = None if form.name in changed else follow(form)
        if found is not None:
            changed[form.name] = found
    wrong: dict[str, Expr] = {n: to_constant(v) for n, v in own.items() if n in chain.by_name}
    for step in chain.steps:
        found = None if step.name in wrong else follow(step)
        if found is not None:
            wrong[step.name] = found
    return wrong, changed


def judge_carried_form(
    spec: AnySpec, typed: str, options: GradingOptions, context: QuestionContext
) -> Verdict | None:
    """Return full marks for a form that follows rightly from own earlier work, else None."""
    names, chain, solved = spec.quantities(), context.chain, context.solved_values
    if len(names) != 1 or names[0] not in chain.form_by_name:
        return None
    own = {
        name: value for name, value in context.earlier.items()
        if name in solved and not are_nearly_equal(value, solved[name])
    }  # fmt: skip
    wrong, forms = _follow_own_forms(context, own)
    right = chain.form_by_name[names[0]].expr
    form = forms.get(names[0], right)
    if names[0] in context.forms or any(value == 0 for value in own.values()):
        return None
    try:
        needed = {step for name in names_in(form) for step in chain.required_steps(name)}
        steps = [ChainStep(name, expr) for name, expr in wrong.items() if name in needed]
        values = chain.solve_with_steps(steps, solved)
        bound = chain.bind_form(form, values, wrong)
        carried = None if _says_less(bound, right, chain) else spec.replace_key(bound)
        verdict = carried and judge_answer(carried, typed, options)
    except (MathError, FormulaError, ValueError, KeyError, TypeError):
        return None
    if not verdict or verdict.verdict != CORRECT:
        return None
    return partial(Fraction(1), verdict.read_as, CARRIED)


def _says_less(form: Expr, key: Expr, chain: Chain) -> bool:
    """Return whether a form is a mere number where the key is a formula: nothing was to be done."""
    free = {*chain.free}
    return bool(names_in(key) & free) and not names_in(form) & free


def _recompute(way: Chain, own: Values, solved: Values, target: str) -> Value | None:
    """Return a quantity that rests on own values; None if it rests on none, or one is zero."""
    steps = way.required_steps(target)
    used = {name for step in steps for name in way.operands[step]} - {target}
    changed = {name: value for name, value in own.items() if name in used}
    if not changed or any(value == 0 for value in changed.values()):
        return None
    try:
        return way.solve_from(changed, solved)[target]
    except MathError:
        return None


def are_nearly_equal(a: Value, b: Value) -> bool:
    """Return whether two values agree to nine digits: they differ by rounding at most."""
    return bool(abs(a - b) <= fmpq(1, 10**9) * abs(b))


def to_constant(value: Value) -> Num:
    """Return a value as a number in a formula; a ball becomes its midpoint."""
    exact = value.mid().fmpq() if isinstance(value, arb) else value
    return Num(to_fraction(exact))


def _is_rounded_early(
    context: QuestionContext, target: str, value: Value, number: ReadNumber, factor: fmpq
) -> bool:
    """Return whether intermediate results rounded to 0 to 4 decimals give the value.

    ``value`` is in base units, ``factor`` is base units in the unit answered in. Beyond 2 percent
    of the key rounding explains nothing.
    """
    if abs(value - context.solved_values[target]) > fmpq(1, 50) * abs(
        context.solved_values[target]
    ):
        return False
    upstream = context.chain.required_steps(target) - {target}
    if not upstream or number.form != "decimal":
        return False
    slack = factor / (2 * fmpq(10) ** number.places)
    return any(
        _is_result_of_rounding(context, target, value, slack, upstream, places)
        for places in range(5)
    )


def _is_result_of_rounding(
    context: QuestionContext,
    target: str,
    value: Value,
    slack: fmpq,
    upstream: frozenset[str],
    places: int,
) -> bool:
    """Return whether all upstream quantities, rounded to ``places`` decimals, give the value.

    Each is rounded in the unit that the chain shows. ``value`` and ``slack`` are in base units;
    what rounding does not change is not explained by it.
    """
    chain = context.chain
    steps = []
    for name in upstream:
        size = unit_factor(chain.by_name[name].unit)
        rounded = round_ball_half_away(context.solved_values[name] / size, places) * size
        steps.append(ChainStep(name, to_constant(rounded)))
    try:
        result = chain.solve_with_steps(steps, context.solved_values)[target]
    except MathError:
        return False
    return bool(abs(result - value) <= slack) and not are_nearly_equal(
        result, context.solved_values[target]
    )


def _find_slip_verdict(
    number: ReadNumber, value: Value, factor: fmpq, context: QuestionContext, target: str
) -> Verdict | None:
    """Return a wrong verdict that names the one slip in the chain; None if none or several fit."""
    base = float(value * factor)
    # Half a unit of the last decimal written, and a little more: the slip is recomputed in floats,
    # which may miss a rounding tie. Few decimals must not make any slip fit, hence 0.5 percent.
    half = 0.5001 * 10.0**-number.places * float(factor)
    exactly = number.form in {"fraction", "mixed", "expression"}
    slack = abs(base) * 1e-9 if exactly else min(half, 0.005 * abs(base))
    note, detail = slip_search_for(context.chain).find(target, context.solved_values, base, slack)
    return wrong(number.read_as, note, detail=detail) if note else None
