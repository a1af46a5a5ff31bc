"""One given quantity multiplied by a factor, everything else as it was: what follows, exactly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from flint import fmpq

from quizgen.bank.sampler import list_candidates, shuffle
from quizgen.bank.variant import Variant
from quizgen.core.errors import MathError
from quizgen.kinds import NUMERIC
from quizgen.kinds.contract import asked_quantities
from quizgen.locale import translate
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import pretty
from quizgen.maths.numbers import parse_written_number, to_fraction, to_rational
from quizgen.maths.precision import working_precision
from quizgen.maths.scaling import scaling_exponent
from quizgen.maths.tree import Call, names_in, walk_tree
from quizgen.maths.values import Value
from quizgen.question.levels.steps import applicable_branch, has_name, level_seed, stated_quantities
from quizgen.question.part_context import authored_answer
from quizgen.question.worked_steps import quantity_inlines
from quizgen.typeset.prose import Inline, PlainText, translate_inlines

SCALES = tuple(map(Fraction, ("2", "3", "4", "1/2", "1/3", "1/4")))
"""Factors that have a word of their own."""
SLIGHT = (Fraction(11, 10), Fraction(9, 10))
"""Factors for quantities that stand beside others in a sum, and have less room."""
_ROUNDING = frozenset({"mod", "floor", "ceil", "round", "eq", "ne"})
"""Operators of conditions that only keep numbers handy."""
_ROOTS = {(2, Fraction(4)): Fraction(2), (2, Fraction(1, 4)): Fraction(1, 2)}
"""Factors whose square root is a plain number."""


@dataclass(frozen=True)
class Perturbation:
    """One given quantity multiplied by a factor, and what that does to one result.

    Parameters
    ----------
    drawn : Variant
        As it was asked.
    index : int
        The part that asks for the result.
    target : str
        The result.
    given : str
        What is multiplied.
    scale : Fraction
        By what.
    changed : Variant
        The same after the change.
    """

    drawn: Variant
    index: int
    target: str
    given: str
    scale: Fraction
    changed: Variant

    @property
    def before(self) -> Value:
        """Return the result in the task, in its shown unit."""
        return self.drawn.values[self.target]

    @property
    def after(self) -> Value:
        """Return the result after the change, in its shown unit."""
        return self.changed.values[self.target]

    @cached_property
    def power(self) -> Fraction | None:
        """Return the power of the given quantity that the result is proportional to, or None."""
        steps = {
            step.name: applicable_branch(self.drawn, step.expr)
            for step in required_steps(self.drawn, self.target)
        }
        return scaling_exponent(self.target, self.given, steps)

    @cached_property
    def factor(self) -> Fraction | None:
        """Return the factor of the result; None unless it follows from a proved power."""
        if self.power is None or self.scale not in SCALES:
            return None
        base = {(1, self.scale): self.scale, **_ROOTS}.get((self.power.denominator, self.scale))
        return None if base is None else base**self.power.numerator

    def describe(self, lang: str) -> tuple[Inline, ...]:
        """Return the change in words."""
        if self.scale in SLIGHT:
            number = (PlainText(pretty.format_number(f"{float(self.scale):g}")),)
            how = translate_inlines(lang, "transfer.times", number=number)
        else:
            name = f"times_{self.scale}" if self.scale > 1 else f"by_{1 / self.scale}"
            how = (PlainText(translate(lang, f"transfer.{name}")),)
        return translate_inlines(
            lang,
            "transfer.change",
            given=quantity_inlines(self.drawn, self.given, lang),
            change=how,
        )


def required_steps(drawn: Variant, target: str) -> list[ChainStep]:
    """Return all steps that a result rests on in the branches that apply, in order."""
    found = dependencies(drawn, target)
    return [step for step in drawn.template.chain.steps if step.name in found]


def dependencies(drawn: Variant, target: str) -> frozenset[str]:
    """Return all quantities that a result rests on in the branches that apply, with itself."""
    found, todo = set[str](), [target]
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            step = drawn.template.chain.by_name.get(name)
            todo += names_in(applicable_branch(drawn, step.expr)) if step else ()
    return frozenset(found)


class Perturbations:
    """Every change of a variant that makes sense, each solved once.

    Parameters
    ----------
    drawn : Variant
    """

    def __init__(self, drawn: Variant) -> None:
        """Take a variant; changes of it are solved when they are asked for."""
        self.drawn = drawn
        self._solved: dict[tuple[str, Fraction], Variant | None] = {}

    def of(self, index: int, target: str) -> Iterator[Perturbation]:
        """Yield the changes of what a result rests on, in a drawn order."""
        if self.drawn.values[target] == 0:
            return
        steps = required_steps(self.drawn, target)
        pairs = [
            (given, scale)
            for given in list_changeable(self.drawn, target)
            for scale in (*SCALES, *SLIGHT)
        ]
        for given, scale in shuffle(f"{level_seed(self.drawn)}/{target}/changes", pairs):
            changed = self._solve_perturbed(given, scale)
            if changed is None or not has_same_formulas(self.drawn, changed, steps):
                continue
            if not _is_printed_integer(self.drawn, index, target) or _is_whole(
                changed.values[target]
            ):
                yield Perturbation(self.drawn, index, target, given, scale, changed)

    def _solve_perturbed(self, given: str, scale: Fraction) -> Variant | None:
        """Return the variant after a change, solved once; None if it is not admissible."""
        if (given, scale) not in self._solved:
            self._solved[given, scale] = _scale_given(self.drawn, given, scale)
        return self._solved[given, scale]


def _is_printed_integer(drawn: Variant, index: int, target: str) -> bool:
    """Return whether a result is an integer that a program prints, or that is counted."""
    exact = authored_answer(drawn, index).get("exact") and not drawn.template.units[target]
    return bool(exact) and _is_whole(drawn.values[target])


def _is_whole(value: Value) -> bool:
    """Return whether a value is an exact integer."""
    return isinstance(value, fmpq) and value.q == 1


def askable_results(drawn: Variant) -> Iterator[tuple[int, str]]:
    """Yield the results of a question that have a name in every language."""
    for index, part in enumerate(drawn.template.rules.part):
        if part.answer["kind"] in NUMERIC:
            for name in asked_quantities(part.answer):
                if name in drawn.template.chain.by_name and has_name(drawn, name):
                    yield index, name


def list_changeable(drawn: Variant, target: str) -> list[str]:
    """Return the given quantities of a result that may change while all others stay."""
    used = dependencies(drawn, target)
    return [
        given
        for given in drawn.template.chain.given
        if given in used
        and _is_changeable(drawn, given)
        and not used & _find_dependent_quantities(drawn, given)
    ]


def _find_dependent_quantities(drawn: Variant, given: str) -> frozenset[str]:
    """Return drawn quantities that follow from one, and could not stay as they are."""
    found = {given}
    for name, rule in drawn.template.rules.draw.items():
        source = rule.formula or rule.by
        if source and names_in(drawn.template.parse_formula(source)) & found:
            found.add(name)
    return frozenset(found - {given})


def _is_changeable(drawn: Variant, given: str) -> bool:
    """Return whether the task states a quantity that may change: named, not fixed, not zero."""
    named = has_name(drawn, given) and given in stated_quantities(drawn)
    fixed = given in drawn.template.quantities.fixed
    return named and not fixed and drawn.shown.get(given, 0) != 0


def _scale_given(drawn: Variant, given: str, scale: Fraction) -> Variant | None:
    """Return the variant after a change; None if the quantity cannot have that value."""
    if not _is_drawable_value(drawn, given, to_fraction(drawn.shown[given] * to_rational(scale))):
        return None
    changed = scale_freely(drawn, given, scale)
    return changed if changed is not None and _is_kept(changed) else None


def scale_freely(drawn: Variant, given: str, scale: Fraction) -> Variant | None:
    """Return the variant after a change to a value that need not be among those drawn.

    None if what the task states does not hold any more, whatever else keeps its numbers handy.
    """
    shown = {**drawn.shown, given: drawn.shown[given] * to_rational(scale)}
    try:
        with working_precision():
            values = drawn.sampler.solve(shown, drawn.lists)
        changed = replace(drawn, shown=shown, values=values, traps=((),) * len(drawn.traps))
        return changed if _is_admissible(changed) else None
    except (MathError, ZeroDivisionError, OverflowError):
        return None


def _is_drawable_value(drawn: Variant, given: str, value: Fraction) -> bool:
    """Return whether a value lies within those that are drawn, and is an integer if all are."""
    rule = drawn.template.rules.draw.get(given)
    if rule is None:  # what an author's Python gives has no range that is known
        return False
    listed = list_candidates(rule.pick, rule.range, rule.skip)
    if listed and not min(listed) <= to_rational(value) <= max(listed):
        return False
    return len(listed) != 1 and (value.denominator == 1 or not is_counted(drawn, given))


def is_counted(drawn: Variant, given: str) -> bool:
    """Return whether a drawn quantity has whole values alone, and no unit."""
    rule = drawn.template.rules.draw[given]
    listed = list_candidates(rule.pick, rule.range, rule.skip)
    whole = to_fraction(drawn.shown[given]).denominator == 1
    return whole and not rule.unit and all(one.q == 1 for one in listed)


def _is_admissible(changed: Variant) -> bool:
    """Return whether the template's conditions hold, but for those that keep numbers handy."""
    template = changed.template
    for text in template.rules.where:
        expr = template.parse_formula(text)
        handy = any(isinstance(node, Call) and node.op in _ROUNDING for node in walk_tree(expr))
        if not handy and not changed.evaluate(text):
            return False
    return True


def _is_kept(changed: Variant) -> bool:
    """Return whether results are within the bounds that the template keeps."""
    return all(
        (
            keep.min is None
            or changed.shown_values[name] >= to_rational(parse_written_number(keep.min))
        )
        and (
            keep.max is None
            or changed.shown_values[name] <= to_rational(parse_written_number(keep.max))
        )
        for name, keep in changed.template.rules.keep.items()
    )


def has_same_formulas(drawn: Variant, changed: Variant, steps: list[ChainStep]) -> bool:
    """Return whether the same formulas apply after a change, and no quantity changes its sign."""
    with working_precision():
        return all(
            applicable_branch(drawn, step.expr) == applicable_branch(changed, step.expr)
            and _compute_sign(drawn.values[step.name]) == _compute_sign(changed.values[step.name])
            for step in steps
        )


def _compute_sign(value: Value) -> int:
    """Return -1, 0 or 1."""
    return bool(value > 0) - bool(value < 0)


def change_size(change: Perturbation) -> Value:
    """Return how far the result moves."""
    with working_precision():
        return abs(change.after - change.before)


def is_clearly_more(one: Value, other: Value) -> bool:
    """Return whether a distance is so much larger that nobody has to compute it precisely."""
    with working_precision():
        return bool(one > other * fmpq(5, 4))
