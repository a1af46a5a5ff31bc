"""From a template and a seed to admissible numbers.

Every value is a function of (template origin, version, paper seed, slot, variable, try) through
SHA-256, so adding a template, a variable, a language or a format changes no other value. A variant
is kept only if it meets every condition of the template *and* no misconception would be accepted or
could be taken for another one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count, takewhile

import msgspec
from flint import fmpq

from quizgen.bank.drawn_lists import RationalList, count_common_decimals
from quizgen.bank.pools import build_identity
from quizgen.bank.rules import Scalar
from quizgen.bank.sampler import (
    REJECTED_DATA,
    DrawnValues,
    Sampler,
    describe_list_fault,
    sampler_for,
    solve_candidate,
)
from quizgen.bank.template import Template
from quizgen.core.errors import BankError, MathError, SamplingError
from quizgen.core.positions import TEXT, Place
from quizgen.maths.canonical import CanonicalForm
from quizgen.maths.chain import ChainStep
from quizgen.maths.notation import format_tree
from quizgen.maths.numbers import (
    format_decimal,
    format_exact,
    format_exact_in_unit,
    format_rounded,
    has_more_figures,
    is_readable_exactly,
    is_short_decimal,
    to_float,
    to_rational,
)
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import Expr, Sym
from quizgen.maths.values import Value, Values

SHOWN_FIGURES = 6
"""Significant figures of a shown value that has no short exact form."""
MOST_LIST_DECIMALS = 12
"""Decimals to which the values of a list are written out."""
MAX_TRIES = 5000
"""Tries before a template is called impossible."""


def leading_digits(value: Value) -> str:
    """Return a number's first four digits: what somebody who copies it takes for the same."""
    return f"{abs(to_float(value)):.4g}"


class SiblingContent(msgspec.Struct, frozen=True):
    """What the other questions of a paper ask: forms of formulas, and numbers by their digits."""

    formulas: frozenset[CanonicalForm] = frozenset()
    numbers: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class Variant:
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
    lists : mapping of str to tuple of flint.fmpq
        Drawn lists in the units they are shown in.
    elsewhere : SiblingContent
        What this question must not tell, because others of its paper ask it.
    shown_values : mapping of str to flint.fmpq or flint.arb
        Every quantity, drawn or solved, in the unit it is shown in. Computed at once:
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
    lists: Mapping[str, RationalList] = field(default_factory=dict)
    elsewhere: SiblingContent = field(default_factory=SiblingContent)
    shown_values: Values = field(init=False, repr=False, compare=False)
    _texts: dict[str, str] = field(init=False, repr=False, compare=False, default_factory=dict)
    _identity: list[str] = field(init=False, repr=False, compare=False, default_factory=list)
    _computed: dict[str, Value] = field(init=False, repr=False, compare=False, default_factory=dict)
    _forms: dict[str, Expr] = field(init=False, repr=False, compare=False, default_factory=dict)

    def __repr__(self) -> str:
        """Return template, seed and slot, which rebuild it."""
        return f"<Draw of {self.template.id}, seed {self.seed}, slot {self.slot}>"

    def __post_init__(self) -> None:
        """Set ``shown_values``, once: it is read far more often than a variant is drawn."""
        with working_precision():
            object.__setattr__(
                self, "shown_values", self.sampler.in_shown_units(self.shown, self.values)
            )

    @property
    def identity(self) -> str:
        """Return the name of the question: two variants ask the same if and only if it is equal.

        Worked out once, when it is first asked for: it makes the selections of the pools, whose
        faults are those of a question and not of its numbers.
        """
        if not self._identity:
            self._identity.append(build_identity(self))
        return self._identity[0]

    @property
    def sampler(self) -> Sampler:
        """Return the sampler of its template, which does not depend on the numbers."""
        return sampler_for(self.template)

    def format_value(self, name: str) -> str:
        """Return a quantity's number as text: exact if drawn or short, else rounded."""
        if name not in self._texts:
            value = self.shown_values[name]
            unit = self.template.units[name]
            exactly = None if self.is_cut(name) else format_exact_in_unit(value, unit)
            self._texts[name] = exactly or format_rounded(value, figures=SHOWN_FIGURES)
        return self._texts[name]

    def is_cut(self, name: str) -> bool:
        """Return whether a quantity has more figures than formulas show of it."""
        value = self.shown_values[name]
        fits = is_short_decimal(value) and not has_more_figures(value, SHOWN_FIGURES)
        return self.is_rounded(name) and not fits

    def is_rounded(self, name: str) -> bool:
        """Return whether a quantity's text is not its exact value."""
        value = self.shown_values[name]
        if name in self.template.estimated_steps and has_more_figures(value):
            return True
        return not is_readable_exactly(value) and (
            name not in self.shown or format_exact(value) is None
        )

    def evaluate(self, formula: str) -> Value:
        """Return the value of a formula of ``template.toml`` over quantities in shown units."""
        if formula not in self._computed:
            with working_precision():
                self._computed[formula] = self._compute_formula(formula)
        return self._computed[formula]

    def _compute_formula(self, formula: str) -> Value:
        """Return the value of a formula of shown values and drawn lists.

        Raises ``BankError`` if a list stands where a number is needed, or the other way round.
        """
        compiled = self.sampler.compile_formula(formula)
        try:
            return compiled(
                {**self.shown_values, **self.lists} if self.lists else self.shown_values
            )
        except (TypeError, KeyError) as error:
            what = f"formula {formula!r}: {describe_list_fault(error)}"
            file, place = self.template.file, (TEXT, formula)
            raise BankError(what, rule="QG120", file=file, place=place) from error

    def format_list(self, name: str) -> tuple[str, ...]:
        """Return the numbers of a drawn list as they are shown, all with as many decimals."""
        values = self.lists[name]
        places = count_common_decimals(values)
        if places is not None and places <= MOST_LIST_DECIMALS:
            return tuple(format_decimal(value, places) for value in values)
        return tuple(format_exact(v) or format_rounded(v, figures=SHOWN_FIGURES) for v in values)

    def text_list(self, name: str) -> tuple[str, ...]:
        """Return a drawn list of texts; empty if there is none of this name."""
        places = takewhile(self.words.__contains__, (f"{name}[{place}]" for place in count(1)))
        return tuple(self.words[place] for place in places)

    def list_texts(self, name: str) -> tuple[str, ...]:
        """Return a drawn list as it is shown, of numbers or of texts; empty if there is none."""
        return self.format_list(name) if name in self.lists else self.text_list(name)

    def form(self, name: str) -> Expr:
        """Return a form of the solver with the drawn numbers in place, tidied.

        Raises
        ------
        KeyError
            If the solver has no form of this name.
        """
        if name not in self._forms:
            chain = self.template.chain
            with working_precision():
                bound = chain.bind_form(chain.form_by_name[name].expr, self.values)
            self._forms[name] = bound
        return self._forms[name]

    def steps_of_part(self, index: int) -> tuple[ChainStep, ...]:
        """Return the steps to a part's answer, without those that the template leaves out."""
        shown = self.template.rules.part[index].show
        steps = self.sampler.parts[index].steps
        return tuple(step for step in steps if shown is None or step.name in shown)

    def answer_of_part(self, index: int) -> tuple[Value, ...]:
        """Return the components of a part's answer, each in the unit it is asked in."""
        return self._answer_components(index, self.values)

    def misconception_answers(self, index: int) -> dict[str, tuple[Value, ...]]:
        """Return the answer of each usable misconception of a part, as ``answer_of_part``.

        Floats let a wrong way pass that has no certain value, such as an arccosine at its edge: it
        is left out.
        """
        found = {}
        for trap in self.traps[index]:
            with suppress(MathError):
                wrong = self.template.chain.solve_with_misconception(trap, self.values)
                found[trap] = self._answer_components(index, wrong)
        return found

    def exact_texts(self, index: int) -> tuple[str, ...]:
        """Return each irrational component of a part's answer as a formula; empty for none.

        A quantity that is asked in another unit than base units has no such formula.
        """
        part, chain = self.sampler.parts[index], self.template.chain
        found = []
        for name in part.of:
            plain = self.template.unit_factor(part.unit_of(self.template, name)) == 1
            exact = all(isinstance(self.values[given], fmpq) for given in chain.given)
            known = isinstance(self.values[name], fmpq) or not (plain and exact)
            with working_precision():
                found.append("" if known else format_tree(chain.bind_form(Sym(name), self.values)))
        return tuple(found)

    def form_of_part(self, index: int) -> Expr:
        """Return the form that a part asks for, with the drawn numbers in place."""
        return self.form(self.sampler.parts[index].form)

    def misconception_forms(self, index: int) -> dict[str, Expr]:
        """Return each usable mistake of a part and the form that it gives."""
        with working_precision():
            found = self.sampler.parts[index].wrong_forms(self.values)
        return {trap: found[trap] for trap in self.traps[index] if trap in found}

    def _answer_components(self, index: int, values: Values) -> tuple[Value, ...]:
        """Return the components of a part's answer, each in the unit it is asked in."""
        part = self.sampler.parts[index]
        with working_precision():
            factors = [self.template.unit_factor(part.unit_of(self.template, n)) for n in part.of]
            return tuple(values[n] / size for n, size in zip(part.of, factors, strict=True))


def draw_variant(template: Template, seed: str | int, slot: str | int = "0") -> Variant:
    """Return the variant of a template that belongs to a seed and a slot.

    Parameters
    ----------
    template : Template
    seed, slot : str or int
        The paper's seed and the question's place in it.

    Raises
    ------
    SamplingError
        If no try within ``MAX_TRIES`` is admissible; names the condition that rejected most tries.
    """
    plan, seed, slot = sampler_for(template), str(seed), str(slot)
    stem = f"{template.origin}/{template.rules.version}/{seed}/{slot}"
    reasons: Counter[str] = Counter()
    for attempt in range(MAX_TRIES):
        with working_precision():  # its lock is held for one try at a time
            drawn = plan.propose(stem, attempt)
            result = solve_candidate(plan, drawn.shown, drawn.lists) if drawn else REJECTED_DATA
        if drawn and not isinstance(result, str):
            return _build_variant(template, (seed, slot, attempt + 1), drawn, result)
        reasons[str(result)] += 1
    worst, count = reasons.most_common(1)[0]
    what = f"no admissible draw in {MAX_TRIES} tries; {worst!r} rejected {count} of them"
    raise SamplingError(
        what, rule="QG140", file=template.file, place=_locate_condition(worst, template)
    )


def _build_variant(
    template: Template,
    drawn_for: tuple[str, str, int],
    drawn: DrawnValues,
    solved: tuple[dict[str, Value], tuple[tuple[str, ...], ...]],
) -> Variant:
    """Return the variant of a template for (seed, slot, tries), from what was drawn and solved."""
    seed, slot, tries = drawn_for
    return Variant(template, seed, slot, tries, drawn.shown, drawn.words, *solved, drawn.lists)


def _locate_condition(condition: str, template: Template) -> Place:
    """Return the place of a condition in ``template.toml``; ``[draw]`` if it is no author's."""
    if condition in template.rules.where:
        return (TEXT, condition)
    kept = condition.removeprefix("keep.")
    return ("keep", kept) if kept in template.rules.keep else ("draw",)


def reference_variant(template: Template) -> Variant:
    """Return the variant with the numbers printed in the notes.

    Misconceptions that coincide there are left out.

    Raises
    ------
    SamplingError
        If the template names no reference, or it has no solution.
    """
    given = template.rules.reference
    if given is None:
        raise SamplingError(f"template {template.id!r} has no reference instance")
    return _build_reference_variant(sampler_for(template), given)


@working_precision()
def _build_reference_variant(plan: Sampler, given: Mapping[str, Scalar]) -> Variant:
    """Return the variant with the numbers that an author gives; what is derived follows them.

    Raises ``SamplingError`` if the chain has no value for them.
    """
    template = plan.template
    drawn = plan.propose(f"{template.origin}/reference", 0)
    if drawn is None:
        raise SamplingError(REJECTED_DATA, rule="QG140", file=template.file)
    shown, words, lists = drawn
    for variable in plan.variables:
        if variable.name in given and variable.words:
            words[variable.name] = str(given[variable.name])
        elif variable.name in given:
            shown[variable.name] = to_rational(str(given[variable.name]))
        elif variable.formula is not None:
            variable.derive(shown, words, lists)
    result = solve_candidate(plan, shown, lists, lenient=True)
    if isinstance(result, str):
        what = f"reference instance: {result}"
        file, place = template.file, ("reference",)
        raise SamplingError(what, rule="QG140", file=file, place=place)
    return _build_variant(template, ("reference", "0", 1), drawn, result)
