"""The drawing plan of a template: its variables, conditions and parts, whatever the seed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache, cached_property, partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import msgspec
from flint import fmpq

from quizgen.bank.data_file import draw_data
from quizgen.bank.dimensions import find_unit_errors
from quizgen.bank.drawn_lists import (
    ListPlan,
    LookupPlan,
    RationalList,
    TextList,
    is_list_rule,
    list_rule_formulas,
    number_texts,
    plan_list,
    plan_lookup,
)
from quizgen.bank.misconceptions import PartChecker
from quizgen.bank.rules import KeepRule, Scalar
from quizgen.bank.template import Template
from quizgen.core.errors import BankError, MathError
from quizgen.core.untrusted import error_context
from quizgen.maths.number_systems import CompiledFormula, compile_nested, exact_system
from quizgen.maths.numbers import count_decimals, to_float, to_rational
from quizgen.maths.precision import working_precision
from quizgen.maths.tree import names_in
from quizgen.maths.values import NumberList, Value, Values, map_numbers

T = TypeVar("T")


def pick_index(key: str, count: int) -> int:
    """Return the index below ``count`` that belongs to a key, the same on every machine."""
    return int.from_bytes(hashlib.sha256(key.encode()).digest()[:8], "big") % count


def shuffle(key: str, items: Sequence[T]) -> list[T]:
    """Return the items in an order that belongs to a key, the same on every machine."""
    ranked = sorted(range(len(items)), key=lambda i: hashlib.sha256(f"{key}/{i}".encode()).digest())
    return [items[i] for i in ranked]


class DrawnValues(NamedTuple):
    """What one try draws, in shown units: numbers, phrases and texts by name, lists."""

    shown: dict[str, fmpq]
    words: dict[str, str]
    lists: dict[str, RationalList]

    @property
    def environment(self) -> Mapping[str, Any]:
        """Numbers and lists, as formulas take them."""
        return {**self.shown, **self.lists} if self.lists else self.shown

    def add_list(self, name: str, values: RationalList | TextList) -> None:
        """Add a list: of numbers as one value, of texts as a phrase for each of its places."""
        if isinstance(values[0], str):
            self.words.update(number_texts(name, map(str, values)))
        else:
            self.lists[name] = NumberList(values)


REJECTED_DATA = "data.py: draw(rng) gives None"
"""Why a try was rejected whose data an author's Python refused."""


class _Variable(msgspec.Struct, frozen=True):
    """One drawn quantity: its candidates, or the formula that derives it (or its phrase).

    A list has a ``listed`` plan, a value of a table a ``lookup``.
    """

    file: Path
    name: str
    choices: tuple[fmpq, ...]
    words: tuple[str, ...]
    formula: CompiledFormula | None
    listed: ListPlan | None = None
    lookup: LookupPlan | None = None

    def draw(self, stem: str, attempt: int, drawn: DrawnValues) -> None:
        """Set the list or the value that is looked up.

        Raises
        ------
        BankError
            If there is none.
        """
        with error_context(self.file):
            try:
                if self.listed is not None:
                    drawn.add_list(self.name, self.listed.draw(stem, attempt, drawn.environment))
                elif self.lookup is not None:
                    found = self.lookup.look_up(drawn.environment, drawn.words)
                    if isinstance(found, str):
                        drawn.words[self.name] = found
                    else:
                        drawn.shown[self.name] = found
            except BankError as error:
                raise self._fault(str(error)) from error
            except (MathError, TypeError, KeyError, ZeroDivisionError, OverflowError) as error:
                raise self._fault(describe_list_fault(error)) from error

    def derive(
        self,
        shown: dict[str, fmpq],
        words: dict[str, str],
        lists: Mapping[str, RationalList] | None = None,
    ) -> None:
        """Set the quantity, or the phrase at the place that the formula counts from 0.

        A condition counts 1 if it holds, else 0.
        """
        value = self._compute_value({**shown, **lists} if lists else shown)
        if isinstance(value, tuple):
            raise self._fault("a list, where a number is needed")
        if isinstance(value, int):  # a truth, and what Python makes of a sum or negative of some
            value = fmpq(int(value))
        if self.words:
            if not isinstance(value, fmpq):
                raise self._fault("by: the place of a phrase is a rational number")
            words[self.name] = self.words[int(value.floor()) % len(self.words)]
        else:
            shown[self.name] = value

    def _compute_value(self, env: Mapping[str, Any]) -> Value:
        """Return the value of the formula; 0 where there is none.

        Raises ``BankError`` if it has no value here.
        """
        try:
            return self.formula(env) if self.formula else fmpq(0)
        except (MathError, TypeError, KeyError, ZeroDivisionError, OverflowError) as error:
            raise self._fault(describe_list_fault(error)) from error

    def _fault(self, what: str) -> BankError:
        """Return an error at the quantity's table under ``draw``."""
        said = f"draw.{self.name}: {what}"
        return BankError(said, rule="QG120", file=self.file, place=("draw", self.name))


def describe_list_fault(error: Exception) -> str:
    """Return what is wrong in a formula; Python's word for a sum with a list names only types."""
    if isinstance(error, KeyError):
        name = error.args[0]
        return f"{name} is a text, where a number is needed (draw a number, and its words by it)"
    return "a list stands where a number is needed" if isinstance(error, TypeError) else str(error)


class _Condition(msgspec.Struct, frozen=True):
    """A condition over shown values, and the quantities that it reads."""

    text: str
    test: Callable[[Values], bool]
    needs: frozenset[str]


def _make_test_of_name(name: str, test: Callable[[Value], bool]) -> Callable[[Values], bool]:
    """Return a test of all values that tests the one of this name."""
    return lambda env: test(env[name])


def _list_statements(answer: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the conditions of which one must hold, so that an option can be ticked at all."""
    options = answer.get("options", {}) if answer.get("kind") == "multi" else {}
    conditions = tuple(options.values()) if isinstance(options, Mapping) else ()
    fixed = "take" in answer or not all(isinstance(one, str) for one in conditions)
    return () if fixed else conditions


def _holds_if_known(test: CompiledFormula) -> Callable[[Values], bool]:
    """Return a test of all values that passes where a text stands among them."""

    def holds(env: Values) -> bool:
        """Return whether the condition holds, or cannot be told here."""
        try:
            return bool(test(env))
        except KeyError:
            return True

    return holds


class Sampler:
    """What drawing a template needs and the seed does not change: ranges, conditions, factors."""

    def __init__(self, template: Template) -> None:
        """Compile a template's draws, conditions and misconceptions.

        ``early`` conditions need drawn values alone and are tested before the chain is solved,
        ``late`` ones after it.

        Raises
        ------
        BankError
            If a quantity uses a later one, a draw has no value, or a unit does not fit.
        """
        self.template = template
        self._compiled: dict[str, CompiledFormula] = {}
        self._check_order()
        self.variables = [self._build_variable(name) for name in template.rules.draw]
        conditions = list(self._iter_conditions())
        drawn = {v.name for v in self.variables} | template.rules.data.keys()
        self.has_lists = bool(template.rules.data) or any(v.listed for v in self.variables)
        self.early = [c for c in conditions if c.needs <= drawn]
        self.late = [c for c in conditions if not c.needs <= drawn]
        with error_context(template.file):  # a unit of the file may be none, and knows no file
            self.parts = [PartChecker(template, index) for index in range(len(template.rules.part))]
        # A key in a wrong unit looks as well as a right one, so no paper is made of it.
        for error in find_unit_errors(template):
            raise error

    def _check_order(self) -> None:
        """Raise ``BankError`` if a formula under ``draw`` uses what is not drawn before it."""
        rules = self.template.rules
        known: set[str] = set(rules.data)
        for name, rule in rules.draw.items():
            used = {rule.at} if rule.at in rules.draw and rules.draw[rule.at].words else set()
            for source in list_rule_formulas(rule, rules):
                used |= names_in(self.template.parse_formula(source))
            unknown = used - known
            if unknown:
                what = f"draw.{name}: uses {sorted(unknown)}, not drawn before it"
                file, place = self.template.file, ("draw", name)
                raise BankError(what, rule="QG130", file=file, place=place)
            known.add(name)

    def compile_formula(self, formula: str) -> CompiledFormula:
        """Return a formula of ``template.toml``, compiled once; the caller sets the precision."""
        if formula not in self._compiled:
            self._compiled[formula] = compile_nested(
                self.template.parse_formula(formula), exact_system()
            )
        return self._compiled[formula]

    def _build_variable(self, name: str) -> _Variable:
        """Return one quantity, ready to be drawn.

        Raises ``BankError`` if its rule leaves no value.
        """
        rule = self.template.rules.draw[name]
        if is_list_rule(rule) or rule.of:
            return self._plan_table_variable(name)
        source = rule.formula or rule.by
        formula = self.compile_formula(source) if source else None
        listed = () if source else list_candidates(rule.pick, rule.range, rule.skip)
        file = self.template.file
        if not (source or listed or rule.words):
            what, place = f"draw.{name}: no value is left", ("draw", name)
            raise BankError(what, rule="QG120", file=file, place=place)
        return _Variable(file, name, listed, rule.words, formula)

    def _plan_table_variable(self, name: str) -> _Variable:
        """Return how a variable is drawn that is a list or is looked up in a table.

        A ``BankError`` gets the file and the place in it, which the tables do not know.
        """
        template = self.template
        rule, rules = template.rules.draw[name], template.rules
        try:
            if rule.of:
                look = plan_lookup(name, rule, rules, template.path, self.compile_formula)
                return _Variable(template.file, name, (), (), None, lookup=look)
            plan = plan_list(name, rule, template.path, self.compile_formula)
            return _Variable(template.file, name, (), (), None, listed=plan)
        except BankError as error:
            error.file = error.file or template.file
            error.place = error.place or ("draw", name)
            raise

    def _iter_conditions(self) -> Iterator[_Condition]:
        """Yield the conditions under ``where``, then those under ``keep``."""
        for text in self.template.rules.where:
            yield _Condition(
                text, self.compile_formula(text), names_in(self.template.parse_formula(text))
            )
        for name, rule in self.template.rules.keep.items():
            test = compile_keep_test(rule)
            yield _Condition(f"keep.{name}", _make_test_of_name(name, test), frozenset({name}))
        for index, part in enumerate(self.template.rules.part, 1):
            statements = _list_statements(part.answer)
            if statements:
                trees = [self.template.parse_formula(text) for text in statements]
                some = self.compile_formula(" or ".join(f"({text})" for text in statements))
                needs = frozenset().union(*map(names_in, trees))
                yield _Condition(f"part {index}: no option is right", _holds_if_known(some), needs)

    def propose(self, stem: str, attempt: int) -> DrawnValues | None:
        """Return the values of one try, before any condition; the precision is stated around it.

        None if ``data.py`` asks for another try.
        """
        drawn = self._start_draw(stem, attempt)
        if drawn is None:
            return None
        shown, words, lists = drawn
        for variable in self.variables:
            if variable.formula is not None:
                variable.derive(shown, words, lists)
            elif variable.listed or variable.lookup:
                variable.draw(stem, attempt, drawn)
            elif variable.words:
                index = pick_index(f"{stem}/{variable.name}/{attempt}", len(variable.words))
                words[variable.name] = variable.words[index]
            else:
                index = pick_index(f"{stem}/{variable.name}/{attempt}", len(variable.choices))
                shown[variable.name] = variable.choices[index]
        return drawn

    def _start_draw(self, stem: str, attempt: int) -> DrawnValues | None:
        """Return what ``data.py`` gives, which comes before ``[draw]``; nothing without one."""
        template = self.template
        module = template.data_module if template.rules.data else None
        if module is None or template.data_file is None:
            return DrawnValues({}, {}, {})
        key = f"{stem}/data/{attempt}"
        given = draw_data(module, template.data_file, template.rules.data, key)
        return DrawnValues(given.numbers, given.texts, given.lists) if given else None

    @cached_property
    def base_factors(self) -> dict[str, fmpq]:
        """Return the factor from shown unit to base units of each given quantity."""
        template = self.template
        return {n: template.unit_factor(template.units.get(n, "")) for n in template.chain.given}

    @cached_property
    def step_factors(self) -> dict[str, fmpq]:
        """Return the factor from shown unit to base units of each step."""
        return {
            step.name: self.template.unit_factor(step.unit) for step in self.template.chain.steps
        }

    def solve(
        self, shown: Mapping[str, fmpq], lists: Mapping[str, RationalList] | None = None
    ) -> dict[str, Value]:
        """Run the chain on shown values; lists stand in what it gives, in base units as all."""
        if not lists:
            given = {n: shown[n] * f for n, f in self.base_factors.items()}
            return self.template.chain.solve(given)
        known: Mapping[str, Any] = {**shown, **lists}
        given = {n: map_numbers(f.__mul__, known[n]) for n, f in self.base_factors.items()}
        return self.template.chain.solve(given)

    def in_shown_units(self, shown: Mapping[str, fmpq], values: Values) -> dict[str, Value]:
        """Return drawn and solved quantities in the units they are shown in."""
        return {**{name: values[name] / f for name, f in self.step_factors.items()}, **shown}


@cache
def list_candidates(
    listed: tuple[Scalar, ...], span: tuple[Scalar, ...], skip: tuple[Scalar, ...]
) -> tuple[fmpq, ...]:
    """Return the values that a draw rule allows, in order; empty if it lists none."""
    if listed:
        return tuple(to_rational(str(v)) for v in listed)
    if not span:
        return ()
    first, last, step = (to_rational(str(v)) for v in span)
    left_out = {to_rational(str(v)) for v in skip}
    count = int(((last - first) / step).floor()) + 1
    values = (first + place * step for place in range(count))
    return tuple(value for value in values if value not in left_out)


def compile_keep_test(rule: KeepRule) -> Callable[[Value], bool]:
    """Return a test of one value that holds where all limits of a keep rule do."""
    tests = [
        partial(KEEP_TESTS[name], _parse_limit(name, getattr(rule, name)))
        for name in KEEP_TESTS
        if getattr(rule, name) not in (None, ())
    ]
    return lambda value: all(test(value) for test in tests)


def _parse_limit(name: str, written: Scalar | tuple[Scalar, ...]) -> object:
    """Return a limit as its test takes it: exact numbers, a set of them, or a count."""
    if name == "skip":
        return {to_rational(str(v)) for v in written}  # type: ignore[union-attr]
    return written if name in {"decimals", "denominator"} else to_rational(str(written))


KEEP_TESTS: dict[str, Callable[[Any, Any], bool]] = {
    "min": lambda least, v: bool(v >= least),
    "max": lambda most, v: bool(v <= most),
    "multiple": lambda step, v: isinstance(v, fmpq) and (v / step).q == 1,
    "decimals": lambda count, v: _has_short_decimals(v, count),
    "denominator": lambda most, v: isinstance(v, fmpq) and v.q <= most,
    "skip": lambda left_out, v: not (isinstance(v, fmpq) and v in left_out),
}
"""Field of a keep rule to the test of (limit, value)."""


def _has_short_decimals(value: Value, decimals: int) -> bool:
    """Return whether a value is written exactly with at most so many decimals."""
    count = count_decimals(value) if isinstance(value, fmpq) else None
    return count is not None and count <= decimals


_PLANS: dict[str, Sampler] = {}
MOST_PLANS = 1000
"""Samplers in the cache: a process that reads templates as they are edited meets ever new ones."""


def sampler_for(template: Template) -> Sampler:
    """Return the sampler of a template, built once.

    A template of the same content in another bank has a sampler of its own: what the banks say
    about themselves may differ.
    """
    key = f"{template.id}/{template.digest}"
    found = _PLANS.get(key)
    if found is None or found.template is not template:
        found = _PLANS[key] = Sampler(template)
        for oldest in [*_PLANS][:-MOST_PLANS]:
            _PLANS.pop(oldest, None)
    return found


@working_precision()
def solve_candidate(
    plan: Sampler,
    shown: Mapping[str, fmpq],
    lists: Mapping[str, RationalList] | None = None,
    *,
    lenient: bool = False,
) -> tuple[dict[str, Value], tuple[tuple[str, ...], ...]] | str:
    """Return values and misconceptions of each part, or the reason to reject the candidate.

    ``lenient`` skips the conditions and leaves out misconceptions that cannot be told apart:
    numbers that an author prints are taken as they are.
    """
    try:
        early: Mapping[str, Any] = {**shown, **lists} if lists else shown
        for condition in () if lenient else plan.early:
            if not condition.test(early):
                return condition.text
        values = plan.solve(shown, lists)
        if lists:
            _refuse_list_steps(plan, values)
        if plan.late and not lenient:
            env = plan.in_shown_units(shown, values)
            for condition in plan.late:
                if not condition.test({**env, **lists} if lists else env):
                    return condition.text
        traps = _usable_traps(plan, shown, values, lenient=lenient)
    except (MathError, ZeroDivisionError, OverflowError) as error:
        return f"no value: {error}"
    except (TypeError, KeyError) as error:
        if isinstance(error, TypeError) and not lists:
            raise
        what = f"a formula of this question: {describe_list_fault(error)}"
        raise BankError(what, rule="QG120", file=plan.template.file) from error
    return traps if isinstance(traps, str) else (values, traps)


def _refuse_list_steps(plan: Sampler, values: Values) -> None:
    """Raise ``BankError`` if a step of the solution is a list: an answer is one number."""
    for step in plan.template.chain.steps:
        if isinstance(values[step.name], tuple):
            what = f"step {step.name!r} is a list, where a number is needed"
            file = plan.template.solver_file
            raise BankError(what, rule="QG120", file=file, place=("Step", step.name))


def _usable_traps(
    plan: Sampler, shown: Mapping[str, fmpq], values: Values, *, lenient: bool
) -> tuple[tuple[str, ...], ...] | str:
    """Return the usable traps of each part, or the reason to reject the candidate."""
    approximate: dict[str, Any] = (
        {name: map_numbers(to_float, value) for name, value in values.items()}
        if plan.has_lists
        else {name: to_float(value) for name, value in values.items()}
    )
    traps = []
    for part in plan.parts:
        usable = (
            part.check_form(values, lenient=lenient)
            if part.form
            else part.check(approximate, shown, lenient=lenient)
        )
        if isinstance(usable, str):
            return usable
        traps.append(usable)
    return tuple(traps)
