"""No wrong method scores: which mistakes give a usable wrong answer in a variant.

The answer of a misconception is computed in floats, with a margin, because it only ever rejects a
variant; what is accepted is solved exactly. ``PartChecker`` holds what does not depend on the seed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import msgspec
from flint import fmpq

from quizgen.bank.form_comparison import APART, forms_agree
from quizgen.bank.template import Template
from quizgen.core.errors import BankError, MathError
from quizgen.kinds.contract import asked_form, asked_quantities
from quizgen.maths.chain import ChainStep, CompiledSteps
from quizgen.maths.constants import parse_exact
from quizgen.maths.number_systems import compile_expr, float64_system
from quizgen.maths.numbers import to_float
from quizgen.maths.tolerance import MARGIN, RULES, Tolerance, parse_tolerance
from quizgen.maths.tree import Expr, names_in
from quizgen.maths.values import Values, map_numbers

TIE_MARGIN = 0.02
"""A value closer than this (in units of the asked decimal) to a rounding tie is redrawn."""


class PartChecker:
    """Check for one part that no wrong method leads to an accepted answer."""

    def __init__(self, template: Template, index: int) -> None:
        """Compile the misconceptions that change the part's answer, and its tolerances.

        ``one_step`` is true where an answer is judged by its rounded digits: then a wrong value is
        rounded, too, and one step of the last digit tells two of them apart.

        Raises
        ------
        BankError
            If the answer asks for what the solver does not know, or has no valid tolerance.
        """
        rules, self.index = template.rules, index
        self.answer = rules.part[index].answer
        self.of = asked_quantities(self.answer)
        said, place = f"part {index + 1}", ("part", index, "answer")
        unknown = set(self.of) - {*template.chain.given, *template.chain.by_name}
        if unknown:
            what = f"{said}: answer: of: unknown to the solver: {sorted(unknown)}"
            raise BankError(what, rule="QG116", file=template.file, place=(*place, "of"))
        self.chain, self.form = template.chain, asked_form(self.answer)
        if self.form and self.form not in template.chain.form_by_name:
            what = f"{said}: answer: of: {self.form!r} is no formula, matrix or set of the solver"
            raise BankError(what, rule="QG116", file=template.file, place=(*place, "of"))
        self.known = {n for part in rules.part[:index] for n in asked_quantities(part.answer)}
        needed = frozenset().union(
            *(template.chain.required_steps(n, self.known - {n}) for n in self.of), frozenset()
        )
        self.steps = tuple(step for step in template.chain.steps if step.name in needed)
        self._check_scheme(template, said)
        whole = 0.01 if self.answer.get("percent") else 1.0
        factors = [template.unit_factor(self.unit_of(template, n)) for n in self.of]
        self.asked = [(n, whole * to_float(f)) for n, f in zip(self.of, factors, strict=True)]
        self.traps = {
            trap: template.chain.compile_affected_steps(wrong, float64_system())
            for trap, wrong in template.chain.traps.items()
            if trap not in rules.drop and self._is_answer_affected(template, wrong, needed)
        }
        self.form_steps = tuple[ChainStep, ...]()
        if self.form:
            self._plan_form(template)
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

    def _check_scheme(self, template: Template, said: str) -> None:
        """Raise an error if the mark scheme names a step that the solution does not show."""
        part = template.rules.part[self.index]
        names = [step.name for step in self.steps if part.show is None or step.name in part.show]
        unknown = sorted(set(part.scheme) - {*names, self.form})
        if unknown:
            what = f"{said}: scheme: no steps of its solution: {unknown} (these are: {names})"
            place = ("part", self.index, "scheme")
            raise BankError(what, rule="QG116", file=template.file, place=place)

    def _plan_form(self, template: Template) -> None:
        """Find what the form rests on, and the mistakes that change it."""
        chain, step = template.chain, template.chain.form_by_name[self.form]
        used = names_in(step.expr) - {*chain.free}
        needed = frozenset().union(*(chain.required_steps(name) for name in used), frozenset())
        self.steps = tuple(one for one in chain.steps if one.name in needed)
        shown = template.rules.part[self.index].show
        self.form_steps = (step,) if shown is None or step.name in shown else ()
        traps = [
            name for name in (*chain.form_traps, *chain.traps) if name not in template.rules.drop
        ]
        changed = {
            trap: {name for name, _ in chain.compile_affected_steps(wrong, float64_system())}
            for trap, wrong in chain.traps.items()
        }
        self.traps = {
            trap: ()
            for trap in dict.fromkeys(traps)
            if any(wrong.name == self.form for wrong in chain.form_traps.get(trap, ()))
            or changed.get(trap, set()) & used
        }

    def wrong_forms(self, values: Values) -> dict[str, Expr]:
        """Return what each mistake makes of the form, with the numbers of a draw in place."""
        chain, found = self.chain, {}
        for trap in self.traps:
            own = [wrong for wrong in chain.form_traps.get(trap, ()) if wrong.name == self.form]
            expr = own[0].expr if own else chain.form_by_name[self.form].expr
            steps = {wrong.name: wrong.expr for wrong in chain.traps.get(trap, ())}
            try:
                wrong = chain.solve_with_misconception(trap, values) if steps else values
                found[trap] = chain.bind_form(expr, wrong, steps)
            except (MathError, ZeroDivisionError):
                continue
        return found

    def check_form(self, values: Values, *, lenient: bool) -> tuple[str, ...] | str:
        """Return the names of the mistakes that give another form, or the reason to redraw."""
        key = self.chain.bind_form(self.chain.form_by_name[self.form].expr, values)
        seen = {"the key": key}
        relation = str(self.answer.get("up_to", ""))
        rounding = parse_tolerance(self.answer)
        rule = rounding if rounding.stated_rule else None
        for trap, form in self.wrong_forms(values).items():
            twin = next((n for n, o in seen.items() if forms_agree(form, o, relation, rule)), None)
            if twin is None:
                seen[trap] = form
            elif not (lenient or trap in self.may_vanish):
                return f"trap {trap!r} cannot be told from {twin!r}"
        return tuple(name for name in seen if name != "the key")

    def _round_as_reported(self, values: tuple[float, ...]) -> tuple[float, ...]:
        """Return a wrong answer as it would be written down, if that is what is judged."""
        if not self.one_step:
            return values
        return tuple(
            v if t.decimals is None else _round_half_away(v, t.decimals)
            for v, t in zip(values, self.tolerances, strict=True)
        )

    def _is_answer_affected(
        self, template: Template, wrong: tuple[ChainStep, ...], needed: frozenset[str]
    ) -> bool:
        """Return whether wrong steps are among those of this part and change its answer."""
        changed = {
            name for name, _ in template.chain.compile_affected_steps(wrong, float64_system())
        }
        return bool({s.name for s in wrong} & needed) and bool(changed & set(self.of))

    def unit_of(self, template: Template, name: str) -> str:
        """Return the unit that an answer is given in: the asked one, else that of the quantity."""
        asked = self.answer.get("unit")
        return str(asked) if asked is not None else template.units[name]

    def check(
        self, env: Mapping[str, float], shown: Mapping[str, fmpq], *, lenient: bool
    ) -> tuple[str, ...] | str:
        """Return the names of the usable misconceptions, or the reason to redraw.

        Parameters
        ----------
        env : mapping of str to float
            Every quantity of the chain in base units.
        shown : mapping of str to flint.fmpq
            Drawn quantities in the units they are shown in.
        lenient : bool
            Leave out misconceptions that cannot be told apart instead of asking for a redraw.
        """
        if not self.of:
            return ()
        key = self._evaluate_answer(env)
        pairs = zip(self.tolerances, key, strict=True)
        widths = tuple([self.apart * rule.outer_width(k) for rule, k in pairs])
        if not lenient and self._is_near_tie(key):
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
            elif not (lenient or self._is_droppable(trap, twin, value, exact_values[twin])):
                return f"trap {trap!r} cannot be told from {twin!r}"
        return tuple(name for name in seen if name != "the key")

    def _is_accepted_anyway(
        self, values: tuple[float, ...], env: Mapping[str, float], shown: Mapping[str, fmpq]
    ) -> bool:
        """Return whether values lie in the interval that is accepted beside the tolerance.

        The interval is widened by the margin of grading: a value just outside counts as inside.
        """
        if not self.accept:
            return False
        low, high = (bound.at(env, shown) for bound in self.accept)
        slack = (MARGIN - 1) * max(abs(low), abs(high))
        return all(low - slack <= v <= high + slack for v in values)

    def _is_droppable(
        self, trap: str, twin: str, value: tuple[float, ...], other: tuple[float, ...]
    ) -> bool:
        """Return whether a misconception that cannot be told apart may be left out.

        The author must allow it, and either it is another mistake that it cannot be told from, or
        its answer is the key itself.
        """
        return trap in self.may_vanish and (twin != "the key" or _is_same_answer(value, other))

    def _is_near_tie(self, key: tuple[float, ...]) -> bool:
        """Return whether a component lies so near half a unit that rules of rounding disagree."""
        return any(
            abs((abs(k) * 10.0**t.decimals) % 1.0 - 0.5) < TIE_MARGIN
            for k, t in zip(key, self.tolerances, strict=True)
            if t.decimals is not None
        )

    def _evaluate_misconception(
        self, plan: CompiledSteps, env: Mapping[str, float]
    ) -> tuple[float, ...] | None:
        """Return the answer that wrong steps lead to; None where they have no value."""
        changed = dict(env)
        try:
            for name, compiled in plan:
                changed[name] = compiled(changed)
        except (ZeroDivisionError, ValueError, OverflowError):
            return None
        return self._evaluate_answer(changed)

    def _evaluate_answer(self, env: Mapping[str, float]) -> tuple[float, ...]:
        """Return the components of the answer in the units they are asked in, from base units."""
        return tuple([env[name] / factor for name, factor in self.asked])


def _list_tolerances(answer: Mapping[str, Any], of: tuple[str, ...]) -> tuple[Tolerance, ...]:
    """Return the tolerance of each component: a cell's own rule, else that of the answer."""
    labels, cells = answer.get("of"), answer.get("cells", {})
    own = [cells.get(label, {}) for label in (labels if isinstance(labels, Mapping) else of)]
    return tuple(
        parse_tolerance(cell if {*RULES} & cell.keys() else {**answer, **cell}) for cell in own
    )


def _round_half_away(value: float, decimals: int) -> float:
    """Return a value rounded to decimals, halves away from zero."""
    scale = 10.0**decimals
    return math.copysign(math.floor(abs(value) * scale + 0.5) / scale, value)


class _Bound:
    """A bound of an interval, as a formula over quantities in the units they are shown in."""

    def __init__(self, template: Template, text: str) -> None:
        """Compile the formula, and the factor to base units of each name in it."""
        tree = template.parse_formula(text)
        self.compiled = compile_expr(tree, float64_system())
        self.sizes = {n: to_float(template.unit_factor(template.units[n])) for n in names_in(tree)}

    def at(self, env: Mapping[str, float], shown: Mapping[str, fmpq]) -> float:
        """Return the bound's value in a variant."""
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
    """Return the first of the values seen that this one cannot be told from, or None."""
    for name, other in seen.items():
        if _is_within_widths(value, other, widths):
            return name
    return None


def _is_within_widths(
    a: tuple[float, ...], b: tuple[float, ...], widths: tuple[float, ...]
) -> bool:
    """Return whether all components lie within their widths; False for NaN."""
    for x, y, width in zip(a, b, widths, strict=True):  # noqa: SIM110 - asked for every draw
        if not abs(x - y) <= width:
            return False
    return True


def _is_same_answer(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    """Return whether two answers are equal but for rounding of the computation."""
    return all(abs(x - y) <= 1e-9 * max(abs(x), abs(y), 1e-300) for x, y in zip(a, b, strict=True))
