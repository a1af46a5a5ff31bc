"""No wrong method scores: which mistakes give a usable wrong answer in a draw.

A mistake's answer is computed in floats, with a margin, because it only ever rejects a draw; what
is kept is solved exactly. ``PartPlan`` holds what does not depend on the seed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import msgspec
from flint import fmpq

from quizgen.bank.template import Template
from quizgen.core.errors import BankError
from quizgen.kinds.contract import asked_quantities
from quizgen.maths.chain import ChainStep, CompiledSteps
from quizgen.maths.constants import parse_exact
from quizgen.maths.number_systems import compile_expr, float64_system
from quizgen.maths.numbers import to_float
from quizgen.maths.tolerance import MARGIN, RULES, Tolerance, parse_tolerance
from quizgen.maths.tree import names_in
from quizgen.maths.values import map_numbers

TIE_MARGIN = 0.02
"""A value closer than this (in units of the asked decimal) to a rounding tie is redrawn."""
APART = 2.0
"""Two values count as different when more than this many tolerances lie between them."""


class PartChecker:
    """What must hold for one part so that no wrong method scores."""

    def __init__(self, template: Template, index: int) -> None:
        rules = template.rules
        self.answer = rules.part[index].answer
        self.of = asked_quantities(self.answer)
        said, place = f"part {index + 1}", ("part", index, "answer")
        unknown = set(self.of) - {*template.chain.given, *template.chain.by_name}
        if unknown:
            what = f"{said}: answer: of: unknown to the solver: {sorted(unknown)}"
            raise BankError(what, rule="QG116", file=template.file, place=(*place, "of"))
        self.known = {n for part in rules.part[:index] for n in asked_quantities(part.answer)}
        needed = frozenset().union(
            *(template.chain.required_steps(n, self.known - {n}) for n in self.of), frozenset()
        )
        self.steps = tuple(step for step in template.chain.steps if step.name in needed)
        whole = 0.01 if self.answer.get("percent") else 1.0
        factors = [template.unit_factor(self.unit_of(template, n)) for n in self.of]
        self.asked = [(n, whole * to_float(f)) for n, f in zip(self.of, factors, strict=True)]
        self.traps = {
            trap: template.chain.compile_affected_steps(wrong, float64_system())
            for trap, wrong in template.chain.traps.items()
            if trap not in rules.drop and self._is_answer_affected(template, wrong, needed)
        }
        self.may_vanish = frozenset(rules.may_vanish)
        try:
            self.tolerances = _list_tolerances(self.answer, self.of)
        except (msgspec.ValidationError, ValueError) as error:
            what = f"{said}: {error}"
            raise BankError(what, rule="QG113", file=template.file, place=place) from None
        bounds = self.answer.get("accept", ()) if self.of else ()
        self.accept = [_Bound(template, str(text)) for text in bounds]
        self.one_step = any(
            t.decimals is not None and parse_exact(t.within) != 1 for t in self.tolerances
        )
        self.apart = 1.0 if self.one_step else APART

    def _round_as_reported(self, values: tuple[float, ...]) -> tuple[float, ...]:
        """Round a wrong answer as it would be written down, if that is what is judged."""
        if not self.one_step:
            return values
        return tuple(
            v if t.decimals is None else _round_half_away(v, t.decimals)
            for v, t in zip(values, self.tolerances, strict=True)
        )

    def _is_answer_affected(
        self, template: Template, wrong: tuple[ChainStep, ...], needed: frozenset[str]
    ) -> bool:
        changed = {
            name for name, _ in template.chain.compile_affected_steps(wrong, float64_system())
        }
        return bool({s.name for s in wrong} & needed) and bool(changed & set(self.of))

    def unit_of(self, template: Template, name: str) -> str:
        """Unit an answer is given in."""
        asked = self.answer.get("unit")
        return str(asked) if asked is not None else template.units[name]

    def check(
        self, env: Mapping[str, float], shown: Mapping[str, fmpq], *, lenient: bool
    ) -> tuple[str, ...] | str:
        """Names of the usable traps, or the reason to redraw.

        Parameters
        ----------
        env : mapping of str to float
            Every quantity of the chain in base units.
        shown : mapping of str to flint.fmpq
            Drawn quantities in the units they are shown in.
        lenient : bool
            Leave out traps that cannot be told apart instead of asking for a redraw.
        """
        if not self.of:
            return ()
        key = self._evaluate_answer(env)
        pairs = zip(self.tolerances, key, strict=True)
        widths = tuple([self.apart * rule.outer_width(k) for rule, k in pairs])
        if not lenient and self._near_tie(key):
            return "rounding tie"
        exact_values, seen = {"the key": key}, {"the key": key}
        for trap, plan in self.traps.items():
            value = self._evaluate_misconception(plan, env)
            if value is None:
                continue
            written = self._round_as_reported(value)
            twin = _find_indistinguishable(written, seen, widths)
            if _is_within_widths(value, key, widths) or self._is_accepted_anyway(value, env, shown):
                twin = "the key"
            if twin is None:
                exact_values[trap], seen[trap] = value, written
            elif not (lenient or self._may_vanish(trap, twin, value, exact_values[twin])):
                return f"trap {trap!r} cannot be told from {twin!r}"
        return tuple(name for name in seen if name != "the key")

    def _is_accepted_anyway(
        self, values: tuple[float, ...], env: Mapping[str, float], shown: Mapping[str, fmpq]
    ) -> bool:
        """Whether values lie in the interval that is accepted as well, seen from outside."""
        if not self.accept:
            return False
        low, high = (bound.at(env, shown) for bound in self.accept)
        slack = (MARGIN - 1) * max(abs(low), abs(high))
        return all(low - slack <= v <= high + slack for v in values)

    def _may_vanish(
        self, trap: str, twin: str, value: tuple[float, ...], other: tuple[float, ...]
    ) -> bool:
        """Left out if it is the key itself, or so near another mistake that one name is enough."""
        return trap in self.may_vanish and (twin != "the key" or _is_same_answer(value, other))

    def _near_tie(self, key: tuple[float, ...]) -> bool:
        return any(
            abs((abs(k) * 10.0**t.decimals) % 1.0 - 0.5) < TIE_MARGIN
            for k, t in zip(key, self.tolerances, strict=True)
            if t.decimals is not None
        )

    def _evaluate_misconception(
        self, plan: CompiledSteps, env: Mapping[str, float]
    ) -> tuple[float, ...] | None:
        changed = dict(env)
        try:
            for name, compiled in plan:
                changed[name] = compiled(changed)
        except (ZeroDivisionError, ValueError, OverflowError):
            return None
        return self._evaluate_answer(changed)

    def _evaluate_answer(self, env: Mapping[str, float]) -> tuple[float, ...]:
        return tuple([env[name] / factor for name, factor in self.asked])


def _list_tolerances(answer: Mapping[str, Any], of: tuple[str, ...]) -> tuple[Tolerance, ...]:
    """The tolerance of each component: a cell's own rule, else that of the whole answer."""
    labels, cells = answer.get("of"), answer.get("cells", {})
    own = [cells.get(label, {}) for label in (labels if isinstance(labels, Mapping) else of)]
    return tuple(
        parse_tolerance(cell if {*RULES} & cell.keys() else {**answer, **cell}) for cell in own
    )


def _round_half_away(value: float, decimals: int) -> float:
    scale = 10.0**decimals
    return math.copysign(math.floor(abs(value) * scale + 0.5) / scale, value)


class _Bound:
    """A bound of an interval, as a formula over quantities in the units they are shown in."""

    def __init__(self, template: Template, text: str) -> None:
        tree = template.parse_formula(text)
        self.compiled = compile_expr(tree, float64_system())
        self.sizes = {n: to_float(template.unit_factor(template.units[n])) for n in names_in(tree)}

    def at(self, env: Mapping[str, float], shown: Mapping[str, fmpq]) -> float:
        """Its value in a draw."""
        known = {
            name: to_float(shown[name])
            if name in shown
            else map_numbers(size.__rtruediv__, env[name])
            for name, size in self.sizes.items()
        }
        return float(self.compiled(known))


def _find_indistinguishable(
    value: tuple[float, ...], seen: Mapping[str, tuple[float, ...]], widths: tuple[float, ...]
) -> str | None:
    """The first of the values seen that this one cannot be told from."""
    for name, other in seen.items():
        if _is_within_widths(value, other, widths):
            return name
    return None


def _is_within_widths(
    a: tuple[float, ...], b: tuple[float, ...], widths: tuple[float, ...]
) -> bool:
    for x, y, width in zip(a, b, widths, strict=True):  # noqa: SIM110 - asked for every draw
        if not abs(x - y) <= width:
            return False
    return True


def _is_same_answer(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    return all(abs(x - y) <= 1e-9 * max(abs(x), abs(y), 1e-300) for x, y in zip(a, b, strict=True))
