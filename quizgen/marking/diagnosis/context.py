"""What the question around a number can tell: errors carried forward, then single slips."""

from __future__ import annotations

from fractions import Fraction

import msgspec
from flint import arb, fmpq

from quizgen.errors import MathError
from quizgen.marking.diagnosis.explain import explainer
from quizgen.marking.options import Context, Options
from quizgen.marking.reading.scalars import Number
from quizgen.marking.rounding import nearest
from quizgen.marking.specs import Measured, gives
from quizgen.marking.verdict import HALF, Verdict, partial, wrong
from quizgen.maths.chain import ChainStep
from quizgen.maths.numbers import fraction
from quizgen.maths.tree import Num
from quizgen.maths.units import factor
from quizgen.maths.values import Value

CARRIED = "carried-forward"
EARLY = "rounded-too-early"


class Hints(msgspec.Struct, frozen=True):
    """The question around one quantity."""

    spec: Measured
    number: Number
    factor: fmpq
    context: Context
    target: str

    def carried(self, value: Value) -> Verdict | None:
        """Full method marks for a value computed rightly from an own earlier one."""
        result = carry(self.context, self.target)
        if result is None or not gives(self.spec, self.number, value, result / self.factor):
            return None
        return partial(Fraction(1), self.number.read_as, CARRIED)

    def slip(self, value: Value) -> Verdict | None:
        """Name the single slip that explains a value."""
        if _early(self.context, self.target, value * self.factor, self.number, self.factor):
            return partial(HALF, self.number.read_as, EARLY)
        return _slip(self.number, value, self.factor, self.context, self.target)


def hints_for(
    spec: Measured, number: Number, scale: fmpq, options: Options, target: str = ""
) -> Hints | None:
    """Return the diagnosis of one quantity's wrong values, or None without a question around.

    Parameters
    ----------
    spec : Measured
        The spec; ``of`` names the quantity.
    number : Number
        How the answer was written.
    scale : flint.fmpq
        Key units per judged unit (1/100 when percent are judged).
    options : Options
        With the question around.
    target : str
        The quantity, if the spec names several.
    """
    context = options.context
    if context is None:
        return None
    quantities = spec.quantities()
    target = target or (quantities[0] if len(quantities) == 1 else "")
    if target not in context.chain.by_name or target not in context.solved:
        return None
    units = dict(zip(quantities, spec.value_units(), strict=True))
    unit = units[target] or context.chain.by_name[target].unit
    return Hints(spec, number, scale * factor(unit), context, target)


def carry(context: Context, target: str) -> Value | None:
    """Recompute a quantity from the student's own earlier values.

    None if there is nothing to carry: no earlier value is wrong, one is zero, the result is the
    key's own, zero, or simply the student's earlier value again.
    """
    upstream = context.chain.needs(target) - {target}
    own = {name: value for name, value in context.earlier.items() if name in upstream}
    changed = {name: value for name, value in own.items() if not _same(context, name, value)}
    if not changed or any(value == 0 for value in changed.values()):
        return None
    steps = [ChainStep(name, _constant(value)) for name, value in changed.items()]
    try:
        result = context.chain.with_steps(steps, context.solved)[target]
    except MathError:
        return None
    key = context.solved[target]
    trivial = result == 0 or _agree(result, key) or any(_agree(result, v) for v in changed.values())
    return None if trivial else result


def _same(context: Context, name: str, value: Value) -> bool:
    return name not in context.solved or _agree(value, context.solved[name])


def _agree(a: Value, b: Value) -> bool:
    return bool(abs(a - b) <= fmpq(1, 10**9) * abs(b))


def _constant(value: Value) -> Num:
    exact = value.mid().fmpq() if isinstance(value, arb) else value
    return Num(fraction(exact))


def _early(context: Context, target: str, value: Value, number: Number, factor: fmpq) -> bool:
    """Whether rounding the intermediate results to two or three figures gives the value."""
    if abs(value - context.solved[target]) > fmpq(1, 50) * abs(context.solved[target]):
        return False
    upstream = context.chain.needs(target) - {target}
    if not upstream or number.form != "decimal":
        return False
    slack = factor / (2 * fmpq(10) ** number.places)
    return any(_rounds(context, target, value, slack, upstream, places) for places in range(5))


def _rounds(
    context: Context, target: str, value: Value, slack: fmpq, upstream: frozenset[str], places: int
) -> bool:
    chain = context.chain
    steps = []
    for name in upstream:
        size = factor(chain.by_name[name].unit)
        rounded = nearest(context.solved[name] / size, places) * size
        steps.append(ChainStep(name, _constant(rounded)))
    try:
        result = chain.with_steps(steps, context.solved)[target]
    except MathError:
        return False
    return bool(abs(result - value) <= slack) and not _agree(result, context.solved[target])


def _slip(
    number: Number, value: Value, factor: fmpq, context: Context, target: str
) -> Verdict | None:
    base = float(value * factor)
    half = 0.5001 * 10.0**-number.places * float(factor)
    exactly = number.form in {"fraction", "mixed", "expression"}
    slack = abs(base) * 1e-9 if exactly else min(half, 0.005 * abs(base))
    note, detail = explainer(context.chain).explain(target, context.solved, base, slack)
    return wrong(number.read_as, note, detail=detail) if note else None
