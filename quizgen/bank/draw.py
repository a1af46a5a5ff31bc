"""From a template and a seed to admissible numbers.

Every value is a function of (template origin, version, paper seed, slot, variable, try) through
SHA-256, so adding a template, a variable, a language or a format changes no other value. A draw is
kept only if it meets every condition of the template *and* no known mistake would be accepted or
could be taken for another one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

import msgspec
from flint import fmpq

from quizgen.bank.plan import Plan, admissible, plan_of
from quizgen.bank.rules import Scalar
from quizgen.bank.template import Template
from quizgen.errors import DrawError
from quizgen.maths.alike import Form
from quizgen.maths.chain import ChainStep
from quizgen.maths.numbers import at_a_glance, exact_text, rational, rounded_text, to_float
from quizgen.maths.precision import working_precision
from quizgen.maths.values import Value, Values
from quizgen.outside import located

SHOWN_FIGURES = 6
"""Significant figures of a shown value that has no short exact form."""
MAX_TRIES = 5000
"""Tries before a template is called impossible."""


def digits(value: Value) -> str:
    """A number by its first four digits: what somebody who copies it would take for the same."""
    return f"{abs(to_float(value)):.4g}"


class Elsewhere(msgspec.Struct, frozen=True):
    """What the other questions of a paper ask: forms of formulas, and numbers by their digits."""

    formulas: frozenset[Form] = frozenset()
    numbers: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class Draw:
    """One admissible instance of a template; equal to itself alone, so that it can be a key.

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
    elsewhere : Elsewhere
        What this question must not tell, because others of its paper ask it.
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
    elsewhere: Elsewhere = field(default_factory=Elsewhere)
    shown_values: Values = field(init=False, repr=False, compare=False)
    _texts: dict[str, str] = field(init=False, repr=False, compare=False, default_factory=dict)
    _computed: dict[str, Value] = field(init=False, repr=False, compare=False, default_factory=dict)

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
        """A quantity's number as it is shown: exact if drawn or read at a glance, else rounded."""
        if name not in self._texts:
            value = self.shown_values[name]
            exactly = None if self.is_rounded(name) else exact_text(value)
            self._texts[name] = exactly or rounded_text(value, figures=SHOWN_FIGURES)
        return self._texts[name]

    def is_rounded(self, name: str) -> bool:
        """Whether a quantity's text is not its exact value."""
        value = self.shown_values[name]
        return not at_a_glance(value) and (name not in self.shown or exact_text(value) is None)

    def computed(self, formula: str) -> Value:
        """Value of a formula of ``template.toml`` over the quantities in shown units."""
        if formula not in self._computed:
            with working_precision():
                self._computed[formula] = self.plan.compiled(formula)(self.shown_values)
        return self._computed[formula]

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
            factors = [self.template.factor(part.unit_of(self.template, n)) for n in part.of]
            return tuple(values[n] / size for n, size in zip(part.of, factors, strict=True))


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
    with located(template.file):
        return _first(plan_of(template), str(seed), str(slot))


def _first(plan: Plan, seed: str, slot: str) -> Draw:
    """The first admissible try; the lock of the precision is held for one try at a time."""
    template = plan.template
    stem = f"{template.origin}/{template.rules.version}/{seed}/{slot}"
    reasons: Counter[str] = Counter()
    for attempt in range(MAX_TRIES):
        with working_precision():
            shown, words = plan.candidate(stem, attempt)
            result = admissible(plan, shown)
        if not isinstance(result, str):
            values, traps = result
            return Draw(template, seed, slot, attempt + 1, shown, words, values, traps)
        reasons[result] += 1
    worst, count = reasons.most_common(1)[0]
    raise DrawError(f"no admissible draw in {MAX_TRIES} tries; {worst!r} rejected {count} of them")


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
    with located(template.file):
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
        raise DrawError(f"reference instance: {result}")
    values, traps = result
    return Draw(template, "reference", "0", 1, shown, words, values, traps)
