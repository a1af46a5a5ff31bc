"""From a template and a seed to admissible numbers.

Every value is a function of (template origin, version, paper seed, slot, variable, try) through
SHA-256, so adding a template, a variable, a language or a format changes no other value. A draw is
kept only if it meets every condition of the template *and* no known mistake would be accepted or
could be taken for another one.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from typing import Any, TypeVar

from flint import fmpq

from quizgen.bank.rules import KeepRule, Scalar
from quizgen.bank.template import Template
from quizgen.bank.traps import PartPlan
from quizgen.errors import DrawError, MathError
from quizgen.maths.chain import ChainStep
from quizgen.maths.numbers import exact_text, places, rational, rounded_text, to_float, written
from quizgen.maths.precision import working_precision
from quizgen.maths.systems import Compiled, compile_expr, compile_inner, exact
from quizgen.maths.tree import names
from quizgen.maths.units import factor
from quizgen.maths.values import Value, Values

T = TypeVar("T")
SHOWN_FIGURES = 6
"""Significant figures of a shown value that has no short exact form."""
MAX_TRIES = 5000
"""Tries before a template is called impossible."""


@dataclass(frozen=True)
class Draw:
    """One admissible instance of a template.

    Parameters
    ----------
    template : Template
    seed, slot : str
        What it was drawn for.
    tries : int
        Candidates looked at, the kept one included.
    shown : mapping of str to flint.fmpq
        Drawn quantities in the units they are shown in.
    words : mapping of str to str
        Drawn phrases, by their name in the language files.
    values : mapping of str to flint.fmpq or flint.arb
        Every quantity of the chain in base units.
    traps : tuple of tuple of str
        Per part, the mistakes that give a wrong and recognisable answer here.
    shown_values : mapping of str to flint.fmpq or flint.arb
        Every quantity, drawn or solved, in the unit it is shown in. Computed when the draw is made:
        a property cached later would wait for the lock of the precision under a lock of its own.
    """

    template: Template
    seed: str
    slot: str
    tries: int
    shown: Mapping[str, fmpq]
    words: Mapping[str, str]
    values: Values
    traps: tuple[tuple[str, ...], ...] = field(default=())
    shown_values: Values = field(init=False, repr=False, compare=False)
    _texts: dict[str, str] = field(init=False, repr=False, compare=False, default_factory=dict)

    def __repr__(self) -> str:
        return f"<Draw of {self.template.id}, seed {self.seed}, slot {self.slot}>"

    def __post_init__(self) -> None:
        with working_precision():
            object.__setattr__(self, "shown_values", self.plan.shown_env(self.shown, self.values))

    @property
    def plan(self) -> Plan:
        """What does not depend on the numbers."""
        return plan_of(self.template)

    def text(self, name: str) -> str:
        """A quantity's number as it is shown: exact if that is short, else rounded."""
        if name not in self._texts:
            value = self.shown_values[name]
            self._texts[name] = exact_text(value) or rounded_text(value, figures=SHOWN_FIGURES)
        return self._texts[name]

    def is_rounded(self, name: str) -> bool:
        """Whether a quantity's text is not its exact value."""
        return exact_text(self.shown_values[name]) is None

    def computed(self, formula: str) -> Value:
        """Value of a formula of ``template.toml`` over the quantities in shown units."""
        with working_precision():
            value: Value = compile_expr(self.template.formula(formula), exact())(self.shown_values)
        return value

    def steps(self, index: int) -> tuple[ChainStep, ...]:
        """The steps that lead to a part's answer, those that the template leaves out aside."""
        shown = self.template.rules.part[index].show
        steps = self.plan.parts[index].steps
        return tuple(step for step in steps if shown is None or step.name in shown)

    def answer(self, index: int) -> tuple[Value, ...]:
        """The components of a part's answer, each in the unit it is asked in."""
        return self._components(index, self.values)

    def mistaken(self, index: int) -> dict[str, tuple[Value, ...]]:
        """Each usable mistake of a part and the answer it gives, as ``answer``."""
        chain = self.template.chain
        return {
            trap: self._components(index, chain.trapped(trap, self.values))
            for trap in self.traps[index]
        }

    def _components(self, index: int, values: Values) -> tuple[Value, ...]:
        part = self.plan.parts[index]
        with working_precision():
            return tuple(values[n] / factor(part.unit_of(self.template, n)) for n in part.of)


def pick(key: str, count: int) -> int:
    """Index below ``count`` that belongs to a key, the same on every machine."""
    return int.from_bytes(hashlib.sha256(key.encode()).digest()[:8], "big") % count


def shuffled(key: str, items: Sequence[T]) -> list[T]:
    """Deterministic permutation that belongs to a key."""
    ranked = sorted(range(len(items)), key=lambda i: hashlib.sha256(f"{key}/{i}".encode()).digest())
    return [items[i] for i in ranked]


@dataclass(frozen=True)
class _Variable:
    """One drawn quantity: its candidates, or the formula that derives it (or its phrase)."""

    name: str
    choices: tuple[fmpq, ...]
    words: tuple[str, ...]
    formula: Compiled | None

    def derive(self, shown: dict[str, fmpq], words: dict[str, str]) -> None:
        """Set the quantity, or the phrase at the place that the formula counts from 0."""
        value = self.formula(shown) if self.formula else fmpq(0)
        if self.words:
            words[self.name] = self.words[int(value.floor()) % len(self.words)]
        else:
            shown[self.name] = value


@dataclass(frozen=True)
class _Condition:
    """A condition over shown values, and the quantities it needs."""

    text: str
    test: Callable[[Values], bool]
    needs: frozenset[str]


def _of(name: str, test: Callable[[Value], bool]) -> Callable[[Values], bool]:
    return lambda env: test(env[name])


class Plan:
    """Everything about drawing a template that does not depend on the seed."""

    def __init__(self, template: Template) -> None:
        self.template = template
        self.variables = [self._variable(name) for name in template.rules.draw]
        conditions = list(self._conditions())
        drawn = {v.name for v in self.variables}
        self.early = [c for c in conditions if c.needs <= drawn]
        self.late = [c for c in conditions if not c.needs <= drawn]
        self.parts = [PartPlan(template, index) for index in range(len(template.rules.part))]

    def _variable(self, name: str) -> _Variable:
        rule = self.template.rules.draw[name]
        source = rule.formula or rule.by
        formula = compile_inner(self.template.formula(source), exact()) if source else None
        listed = () if source else candidates(rule.pick, rule.range, rule.skip)
        return _Variable(name, listed, rule.words, formula)

    def _conditions(self) -> Iterator[_Condition]:
        for text in self.template.rules.where:
            expr = self.template.formula(text)
            yield _Condition(text, compile_inner(expr, exact()), names(expr))
        for name, rule in self.template.rules.keep.items():
            test = keep_test(rule)
            yield _Condition(f"keep.{name}", _of(name, test), frozenset({name}))

    def candidate(self, stem: str, attempt: int) -> tuple[dict[str, fmpq], dict[str, str]]:
        """Values of one try, before any condition; the precision is stated around it."""
        shown: dict[str, fmpq] = {}
        words: dict[str, str] = {}
        for variable in self.variables:
            if variable.formula is not None:
                variable.derive(shown, words)
            elif variable.words:
                index = pick(f"{stem}/{variable.name}/{attempt}", len(variable.words))
                words[variable.name] = variable.words[index]
            else:
                index = pick(f"{stem}/{variable.name}/{attempt}", len(variable.choices))
                shown[variable.name] = variable.choices[index]
        return shown, words

    @cached_property
    def base_factors(self) -> dict[str, fmpq]:
        """Given quantity to the factor from its shown unit to base units."""
        return {n: factor(self.template.units.get(n, "")) for n in self.template.chain.given}

    def solve(self, shown: Mapping[str, fmpq]) -> dict[str, Value]:
        """Run the chain on shown values."""
        return self.template.chain.solve({n: shown[n] * f for n, f in self.base_factors.items()})

    def shown_env(self, shown: Mapping[str, fmpq], values: Values) -> dict[str, Value]:
        """Drawn and solved quantities in shown units."""
        steps = self.template.chain.steps
        return {**{step.name: values[step.name] / factor(step.unit) for step in steps}, **shown}


@cache
def candidates(
    listed: tuple[Scalar, ...], span: tuple[Scalar, ...], skip: tuple[Scalar, ...]
) -> tuple[fmpq, ...]:
    """The values a rule allows, in order."""
    if listed:
        return tuple(rational(str(v)) for v in listed)
    if not span:
        return ()
    first, last, step = map(written, span)
    left_out = {written(v) for v in skip}
    count = int((last - first) / step) + 1
    return tuple(
        rational(first + i * step) for i in range(count) if first + i * step not in left_out
    )


def keep_test(rule: KeepRule) -> Callable[[Value], bool]:
    """Compile a keep rule into a test of one value."""
    tests = [
        partial(KEEP_TESTS[name], _limit(name, getattr(rule, name)))
        for name in KEEP_TESTS
        if getattr(rule, name) not in (None, ())
    ]
    return lambda value: all(test(value) for test in tests)


def _limit(name: str, written: Scalar | tuple[Scalar, ...]) -> object:
    """A limit as written, made exact."""
    if name == "skip":
        return {rational(str(v)) for v in written}  # type: ignore[union-attr]
    return written if name in {"decimals", "denominator"} else rational(str(written))


KEEP_TESTS: dict[str, Callable[[Any, Any], bool]] = {
    "min": lambda least, v: bool(v >= least),
    "max": lambda most, v: bool(v <= most),
    "multiple": lambda step, v: isinstance(v, fmpq) and (v / step).q == 1,
    "decimals": lambda count, v: _terminates(v, count),
    "denominator": lambda most, v: isinstance(v, fmpq) and v.q <= most,
    "skip": lambda left_out, v: not (isinstance(v, fmpq) and v in left_out),
}
"""Field of a keep rule to the test of (limit, value)."""


def _terminates(value: Value, decimals: int) -> bool:
    count = places(value) if isinstance(value, fmpq) else None
    return count is not None and count <= decimals


_PLANS: dict[str, Plan] = {}


def plan_of(template: Template) -> Plan:
    """The drawing plan of a template, built once per content."""
    key = f"{template.id}/{template.digest}"
    if key not in _PLANS:
        _PLANS[key] = Plan(template)
    return _PLANS[key]


@working_precision()
def admissible(
    plan: Plan, shown: Mapping[str, fmpq], *, lenient: bool = False
) -> tuple[dict[str, Value], tuple[tuple[str, ...], ...]] | str:
    """Solve a candidate; its values and traps per part, or the reason to reject it."""
    try:
        for condition in () if lenient else plan.early:
            if not condition.test(shown):
                return condition.text
        values = plan.solve(shown)
        if plan.late and not lenient:
            env = plan.shown_env(shown, values)
            for condition in plan.late:
                if not condition.test(env):
                    return condition.text
    except (MathError, ZeroDivisionError) as error:
        return f"no value: {error}"
    approximate = {name: to_float(value) for name, value in values.items()}
    traps = []
    for part in plan.parts:
        usable = part.check(approximate, shown, lenient=lenient)
        if isinstance(usable, str):
            return usable
        traps.append(usable)
    return values, tuple(traps)


def draw(template: Template, seed: str | int, slot: str | int = "0") -> Draw:
    """Draw an admissible instance.

    Parameters
    ----------
    template : Template
    seed, slot : str or int
        The paper's seed and the question's place in it.

    Raises
    ------
    DrawError
        If no try within ``MAX_TRIES`` is admissible; names the condition met most often.
    """
    return _first(plan_of(template), str(seed), str(slot))


@working_precision()
def _first(plan: Plan, seed: str, slot: str) -> Draw:
    """The first admissible try; the plan is made before, under no lock of the precision."""
    template = plan.template
    stem = f"{template.origin}/{template.rules.version}/{seed}/{slot}"
    reasons: Counter[str] = Counter()
    for attempt in range(MAX_TRIES):
        shown, words = plan.candidate(stem, attempt)
        result = admissible(plan, shown)
        if not isinstance(result, str):
            values, traps = result
            return Draw(template, seed, slot, attempt + 1, shown, words, values, traps)
        reasons[result] += 1
    worst, count = reasons.most_common(1)[0]
    raise DrawError(
        f"template {template.id!r}: no admissible draw in {MAX_TRIES} tries; "
        f"{worst!r} rejected {count} of them"
    )


def reference(template: Template) -> Draw:
    """Instance with the numbers printed in the notes; mistakes that coincide there are left out.

    Raises
    ------
    DrawError
        If the template names no reference, or it has no solution.
    """
    given = template.rules.reference
    if given is None:
        raise DrawError(f"template {template.id!r} has no reference instance")
    return _referred(plan_of(template), given)


@working_precision()
def _referred(plan: Plan, given: Mapping[str, Scalar]) -> Draw:
    template = plan.template
    shown, words = plan.candidate(f"{template.origin}/reference", 0)
    for variable in plan.variables:
        if variable.name in given and variable.words:
            words[variable.name] = str(given[variable.name])
        elif variable.name in given:
            shown[variable.name] = rational(str(given[variable.name]))
        elif variable.formula is not None:
            variable.derive(shown, words)
    result = admissible(plan, shown, lenient=True)
    if isinstance(result, str):
        raise DrawError(f"template {template.id!r}: reference instance: {result}")
    values, traps = result
    return Draw(template, "reference", "0", 1, shown, words, values, traps)
