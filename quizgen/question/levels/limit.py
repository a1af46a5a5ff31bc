"""What a result approaches while one given quantity grows without bound, or shrinks to 0."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from flint import fmpq

from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.grading.spec import ScalarSpec, decode_spec
from quizgen.kinds import KINDS
from quizgen.kinds.number import NumberSpec
from quizgen.kinds.quantity import QuantitySpec
from quizgen.maths.limits import find_limit
from quizgen.maths.numbers import format_for_key
from quizgen.maths.precision import working_precision
from quizgen.maths.scaling import scaling_exponent
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.levels.consequence import Consequence, value_inlines
from quizgen.question.levels.contract import LevelPart
from quizgen.question.levels.perturbations import (
    Perturbations,
    askable_results,
    has_same_formulas,
    is_counted,
    list_changeable,
    required_steps,
    scale_freely,
)
from quizgen.question.levels.steps import applicable_branch, level_seed
from quizgen.question.solution import PartSolution, SolvedMisconception
from quizgen.question.worked_steps import quantity_inlines
from quizgen.typeset.prose import (
    Emphasis,
    Inline,
    Paragraph,
    PlainText,
    to_inlines,
    translate_inlines,
)

SHOWN = (10, 100, 1000)
"""How many times as large, or as small, a quantity is in the values that a solution shows."""
FAR = fmpq(1, 50)
"""Share of the way that may be left to go at the last of them."""
APART = fmpq(1, 20)
"""Share of the limit by which the value of the task must differ, so that it is a mistake."""
BOUNDED = frozenset({"", "%", "deg", "rad", "px", "bit", "byte", "stop", "dB"})
"""Units of what cannot grow without bound."""


@dataclass(frozen=True)
class Limit:
    """One quantity on its way without end, and what a result approaches.

    Parameters
    ----------
    drawn : Variant
        As it was asked.
    target, given : str
        The result, and what changes.
    grows : bool
        Whether that grows; else it shrinks to 0.
    value : flint.fmpq
        What the result approaches, in base units.
    way : tuple of Variant
        The same with the quantity ten, a hundred and a thousand times as large, or as small.
    """

    drawn: Variant
    target: str
    given: str
    grows: bool
    value: fmpq
    way: tuple[Variant, ...]

    def __call__(self, lang: str) -> LevelPart:
        """Return the part in a language."""
        said = self._say("grows" if self.grows else "shrinks", lang)
        asked = Emphasis("strong", self._say("limit", lang))
        body = (Paragraph((*said, PlainText(" "), asked)),)
        traps, spec = self._list_slips(), self._build_spec()
        solved = PartSolution(
            label="",
            lines=(),
            shown=to_inlines(KINDS[spec.kind].explain_key(spec, lang)),
            mistakes=tuple(
                SolvedMisconception(
                    trap, self._say(f"limit_{trap}", lang), value_inlines(one, self.target)
                )
                for trap, one in traps.items()
            ),
            why=self._say("limit_why" if self.grows else "limit_why_small", lang),
        )
        return LevelPart(Fraction(1), body, spec, solved)

    def _say(self, key: str, lang: str) -> tuple[Inline, ...]:
        """Return a sentence with the quantities and the values on the way."""
        ways = zip(("first", "second", "third"), self.way, strict=True)
        return translate_inlines(
            lang,
            f"transfer.{key}",
            target=quantity_inlines(self.drawn, self.target, lang),
            given=quantity_inlines(self.drawn, self.given, lang),
            **{name: value_inlines(one, self.target) for name, one in ways},
        )

    def _list_slips(self) -> dict[str, Variant]:
        """Return the variants with the wrong values that learners give."""
        nothing = _set_result(self.drawn, self.target, fmpq(0))
        slips = {"stays": self.drawn}
        return {"nothing": nothing, **slips} if self.value else slips

    def _build_spec(self) -> ScalarSpec:
        """Return what the answer is graded by."""
        traps, unit = self._list_slips(), self.drawn.template.units[self.target]
        right = _set_result(self.drawn, self.target, self.value)
        table: dict[str, object] = {
            "kind": "quantity" if unit else "number",
            "value": self._format_result(right),
            "rel": "0.005",
            "traps": {trap: self._format_result(one) for trap, one in traps.items()},
            "notes": {
                each: {trap: inlines_to_text(self._say(f"limit_{trap}", each)) for trap in traps}
                for each in self.drawn.template.languages
            },
        }
        if unit:
            return decode_spec(QuantitySpec, {**table, "unit": unit})
        return decode_spec(NumberSpec, table)

    def _format_result(self, one: Variant) -> str:
        """Return the result of a variant in its shown unit, as a key keeps it."""
        return format_for_key(one.shown_values[self.target])


def choose_limit(changes: Perturbations, asked: Consequence | None) -> Limit | None:
    """Return what happens at an end that one quantity of the task may go to; None if to none.

    Only results are asked that no power law tells, and that approach a value of their own. What
    grows is preferred; another part asks about the pair of ``asked``.
    """
    drawn = changes.drawn
    taken = asked and (asked.change.target, asked.change.given)
    for grows in (True, False):
        for _, target in shuffle(f"{level_seed(drawn)}/limit", list(askable_results(drawn))):
            givens = [one for one in list_changeable(drawn, target) if (target, one) != taken]
            for given in shuffle(f"{level_seed(drawn)}/{target}/limit", givens):
                found = _find_limit(drawn, target, given, grows=grows)
                if found is not None:
                    return found
    return None


def _find_limit(drawn: Variant, target: str, given: str, *, grows: bool) -> Limit | None:
    """Return the limit of a result; None where there is none, or it says nothing."""
    if not _may_go(drawn, given, grows=grows):
        return None
    steps = required_steps(drawn, target)
    formulas = {step.name: applicable_branch(drawn, step.expr) for step in steps}
    if scaling_exponent(target, given, formulas) is not None:
        return None
    value = find_limit(target, given, formulas, drawn.values, grows=grows)
    with working_precision():
        if value is None or not abs(drawn.values[target] - value) > APART * abs(value):
            return None
    way = [scale_freely(drawn, given, Fraction(n) if grows else Fraction(1, n)) for n in SHOWN]
    there = tuple(one for one in way if one is not None and has_same_formulas(drawn, one, steps))
    if len(there) < len(SHOWN):
        return None
    with working_precision():
        left = abs(there[-1].values[target] - value)
        if not left < FAR * abs(drawn.values[target] - value):
            return None
    return Limit(drawn, target, given, grows, value, there)


def _may_go(drawn: Variant, given: str, *, grows: bool) -> bool:
    """Return whether a quantity can grow without bound, or shrink to 0: no count, no share."""
    if given not in drawn.template.rules.draw or is_counted(drawn, given):
        return False
    return drawn.shown[given] > 0 and not (grows and drawn.template.units[given] in BOUNDED)


def _set_result(drawn: Variant, target: str, value: fmpq) -> Variant:
    """Return the variant with another value of a result, in base units."""
    return replace(drawn, values={**drawn.values, target: value})
