"""No wrong method scores: which mistakes give a usable wrong answer in a draw.

A mistake's answer is computed in floats, with a margin, because it only ever rejects a draw; what
is kept is solved exactly. ``PartPlan`` holds what does not depend on the seed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import Any

from flint import fmpq

from quizgen.bank.template import Template
from quizgen.errors import BankError
from quizgen.maths.chain import ChainStep
from quizgen.maths.numbers import rational, to_float
from quizgen.maths.tree import Compiled, compile_expr, floats
from quizgen.maths.units import unit

TIE_MARGIN = 0.02
"""A value closer than this (in units of the asked decimal) to a rounding tie is redrawn."""
APART = 2.0
"""Two values count as different when more than this many tolerances lie between them."""


@cache
def factor(text: str) -> fmpq:
    """Exact factor from a unit to base units."""
    return rational(unit(text).factor)


def answer_names(answer: Mapping[str, Any]) -> tuple[str, ...]:
    """Chain quantities that an answer consists of."""
    of = answer.get("of", ())
    if isinstance(of, str):
        return (of,)
    return tuple(of.values()) if isinstance(of, Mapping) else tuple(of)


class PartPlan:
    """What must hold for one part so that no wrong method scores."""

    def __init__(self, template: Template, index: int) -> None:
        rules = template.rules
        self.answer = rules.part[index].answer
        self.of = answer_names(self.answer)
        unknown = set(self.of) - set(template.units)
        if unknown:
            raise BankError(
                f"{template.path / 'template.toml'}: part {index + 1}: unknown {sorted(unknown)}"
            )
        self.known = {n for part in rules.part[:index] for n in answer_names(part.answer)}
        needed = frozenset().union(
            *(template.chain.needs(n, self.known - {n}) for n in self.of), frozenset()
        )
        self.steps = tuple(step for step in template.chain.steps if step.name in needed)
        whole = 0.01 if self.answer.get("percent") else 1.0
        self.factors = tuple(whole * to_float(factor(self.unit_of(template, n))) for n in self.of)
        self.traps = {
            trap: _float_plan(template, wrong)
            for trap, wrong in template.chain.traps.items()
            if trap not in rules.drop and self._concerns(template, wrong, needed)
        }
        self.may_vanish = frozenset(rules.may_vanish)
        self.one_step = "decimals" in self.answer and "within" in self.answer
        self.apart = 1.0 + 1e-9 if self.one_step else APART

    def _reported(self, values: tuple[float, ...]) -> tuple[float, ...]:
        """Round a wrong answer as it would be written down, if that is what is judged."""
        if not self.one_step:
            return values
        scale = 10.0 ** int(self.answer["decimals"])
        return tuple(math.copysign(math.floor(abs(v) * scale + 0.5) / scale, v) for v in values)

    def _concerns(
        self, template: Template, wrong: tuple[ChainStep, ...], needed: frozenset[str]
    ) -> bool:
        changed = {name for name, _ in template.chain._plan(wrong)}  # noqa: SLF001 - same package
        return bool({s.name for s in wrong} & needed) and bool(changed & set(self.of))

    def unit_of(self, template: Template, name: str) -> str:
        """Unit an answer is given in."""
        asked = self.answer.get("unit")
        return str(asked) if asked is not None else template.units.get(name, "")

    def tolerance(self, key: float) -> float:
        """Half-width of the accepted interval, seen from outside (never too small)."""
        answer = self.answer
        if "abs" in answer:
            return float(Fraction(str(answer["abs"])))
        if "rel" in answer:
            return float(Fraction(str(answer["rel"]))) * abs(key)
        within = float(Fraction(str(answer.get("within", 1))))
        if "decimals" in answer:
            return within * 10.0 ** -int(answer["decimals"])
        if "sigfigs" in answer:
            return within * abs(key) * 10.0 ** (1 - int(answer["sigfigs"]))
        return min(0.005, 0.01 * abs(key))

    def check(self, env: Mapping[str, float], *, lenient: bool) -> tuple[str, ...] | str:
        """Names of the usable traps, or the reason to redraw."""
        if not self.of:
            return ()
        key = tuple(env[n] / f for n, f in zip(self.of, self.factors, strict=True))
        widths = tuple(self.apart * self.tolerance(k) for k in key)
        if not lenient and self._near_tie(key):
            return "rounding tie"
        exact_values, seen = {"the key": key}, {"the key": key}
        for trap, plan in self.traps.items():
            value = self._trapped(plan, env)
            if value is None:
                continue
            written = self._reported(value)
            twin = next((n for n, v in seen.items() if _close(written, v, widths)), None)
            if twin is None:
                exact_values[trap], seen[trap] = value, written
            elif not (lenient or self._may_vanish(trap, twin, value, exact_values[twin])):
                return f"trap {trap!r} cannot be told from {twin!r}"
        return tuple(name for name in seen if name != "the key")

    def _may_vanish(
        self, trap: str, twin: str, value: tuple[float, ...], other: tuple[float, ...]
    ) -> bool:
        """Left out if it is the key itself, or so near another mistake that one name is enough."""
        return trap in self.may_vanish and (twin != "the key" or _same(value, other))

    def _near_tie(self, key: tuple[float, ...]) -> bool:
        if "decimals" not in self.answer:
            return False
        scale = 10.0 ** int(self.answer["decimals"])
        return any(abs((abs(k) * scale) % 1.0 - 0.5) < TIE_MARGIN for k in key)

    def _trapped(
        self, plan: list[tuple[str, Compiled]], env: Mapping[str, float]
    ) -> tuple[float, ...] | None:
        changed = dict(env)
        try:
            for name, compiled in plan:
                changed[name] = compiled(changed)
        except (ZeroDivisionError, ValueError, OverflowError):
            return None
        return tuple(changed[n] / f for n, f in zip(self.of, self.factors, strict=True))


def _float_plan(template: Template, wrong: tuple[ChainStep, ...]) -> list[tuple[str, Compiled]]:
    swapped = {step.name: step.expr for step in wrong}
    chain = template.chain
    order = [name for name, _ in chain._plan(wrong)]  # noqa: SLF001 - same package
    return [
        (name, compile_expr(swapped.get(name, chain.by_name[name].expr), floats()))
        for name in order
    ]


def _close(a: tuple[float, ...], b: tuple[float, ...], widths: tuple[float, ...]) -> bool:
    return all(abs(x - y) <= w for x, y, w in zip(a, b, widths, strict=True))


def _same(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
    return all(abs(x - y) <= 1e-9 * max(abs(x), abs(y), 1e-300) for x, y in zip(a, b, strict=True))
