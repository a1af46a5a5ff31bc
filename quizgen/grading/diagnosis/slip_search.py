"""Which single slip in a chain gives a number: the chain is mutated and recomputed in floats."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cached_property
from typing import Any

import msgspec

from quizgen.grading.diagnosis.mutations import mutate_formula
from quizgen.maths.chain import Chain, ChainStep, CompiledSteps
from quizgen.maths.number_systems import compile_expr, float64_system
from quizgen.maths.tree import Call, Expr, Num, Sym, names_in
from quizgen.maths.units import get_unit
from quizgen.maths.values import map_numbers

PREFIXES = (-6, -3, -2, -1, 1, 2, 3, 6)
MOST_CHAINS = 256


class SlipCandidate(msgspec.Struct, frozen=True):
    """One slip: its note, what it concerns, and the compiled steps that recompute the target."""

    note: str
    detail: str
    plan: CompiledSteps


Results = list[tuple[SlipCandidate, float]]
"""Slips and what they give."""


class SlipSearch(msgspec.Struct, dict=True):
    """All single slips of one chain, compiled once."""

    chain: Chain
    _slips: dict[str, list[SlipCandidate]] = msgspec.field(default_factory=dict)
    _last: dict[str, tuple[dict[str, float], Results]] = msgspec.field(default_factory=dict)
    """Target to the numbers met last and what every slip gives there: a class shares a paper."""

    @cached_property
    def _same_dimension_names(self) -> dict[str, list[str]]:
        """Return the name of each given quantity with the others of the same dimension."""
        kinds = {name: get_unit(text).dimension for name, text in self.chain.given.items()}
        return {
            name: [other for other in kinds if other != name and kinds[other] == kind]
            for name, kind in kinds.items()
        }

    def slips(self, target: str) -> list[SlipCandidate]:
        """Return every slip that can change a quantity, compiled when it is first needed."""
        if target not in self._slips:
            self._slips[target] = list(self._iter_slips(target))
        return self._slips[target]

    def _iter_slips(self, target: str) -> Iterator[SlipCandidate]:
        """Yield the slips in the steps that a quantity needs, then those in given units."""
        needed = self.chain.required_steps(target)
        for step in self.chain.steps:
            if step.name in needed:
                for note, detail, changed in self._iter_step_mutations(step):
                    wrong = ChainStep(step.name, changed)
                    yield SlipCandidate(
                        note,
                        detail,
                        self.chain.compile_affected_steps([wrong], float64_system(), within=needed),
                    )
        yield from self._iter_unit_prefix_slips(needed)

    def _iter_step_mutations(self, step: ChainStep) -> Iterator[tuple[str, str, Expr]]:
        """Yield note, detail and wrong formula for each slip in one step.

        The detail is the step's name; for a wrong parameter or base it is both that were confused.
        """
        for note, detail, changed in mutate_formula(step.expr, self._same_dimension_names):
            yield note, detail if note in {"wrong-parameter", "log-base"} else step.name, changed
        for name in sorted(names_in(step.expr)):
            yield "step-left-out", step.name, Sym(name)

    def _iter_unit_prefix_slips(self, needed: frozenset[str]) -> Iterator[SlipCandidate]:
        """Yield the slips of reading a given number with a wrong prefix of its unit.

        Numbers without a dimension have no prefix to mistake.
        """
        used = {n for name in needed for n in self.chain.operands[name]}
        for name in sorted(used & self.chain.given.keys()):
            if not get_unit(self.chain.given[name]).dimension:
                continue
            for power in PREFIXES:
                scale = Num(Fraction(10) ** power)
                wrong = compile_expr(Call("mul", (Sym(name), scale)), float64_system())
                plan = self.chain.compile_affected_steps(
                    (), float64_system(), changed=[name], within=needed
                )
                yield SlipCandidate("unit-prefix-given", name, ((name, wrong), *plan))

    def find(
        self, target: str, solved: Mapping[str, Any], value: float, slack: float
    ) -> tuple[str, str]:
        """Return the note and the place of the one slip that gives a value.

        Parameters
        ----------
        target : str
            The quantity asked.
        solved : mapping
            The right values, in base units.
        value, slack : float
            The wrong value in base units, and how far rounding may have moved it.

        Returns
        -------
        tuple of str
            Note, and the step or the names concerned (never a formula: it may be asked for); the
            detail is empty if several slips of the kind explain the value, both if none or more
            than one kind does.
        """
        hits: dict[str, str] = {}
        for slip, result in self._try_all_slips(target, solved):
            if abs(result - value) <= slack:
                hits[slip.note] = slip.detail if hits.get(slip.note) in {None, slip.detail} else ""
        if len(hits) != 1:
            return "", ""
        ((note, detail),) = hits.items()
        return note, detail

    def _try_all_slips(self, target: str, solved: Mapping[str, Any]) -> Results:
        """Return every slip that changes a quantity, and what it gives in base units.

        The results for the last numbers are stored, since a class shares a paper.
        """
        env = {name: map_numbers(float, number) for name, number in solved.items()}
        last = self._last.get(target)
        if last is not None and last[0] == env:
            return last[1]
        pairs = [(slip, _evaluate_target(slip.plan, env, target)) for slip in self.slips(target)]
        found = [(s, value) for s, value in pairs if value is not None and value != env[target]]
        self._last[target] = env, found
        return found


def _evaluate_target(plan: CompiledSteps, env: dict[str, Any], target: str) -> float | None:
    """Return what a slip gives for the target; None where it has no finite real value."""
    env = dict(env)
    try:
        for name, compiled in plan:
            env[name] = compiled(env)
        return float(env[target])
    except (ArithmeticError, ValueError, TypeError):
        return None


_EXPLAINERS: dict[int, SlipSearch] = {}


def slip_search_for(chain: Chain) -> SlipSearch:
    """Return the compiled slips of a chain, stored for the last ``MOST_CHAINS`` chains."""
    found = _EXPLAINERS.get(id(chain))
    if found is None or found.chain is not chain:
        if len(_EXPLAINERS) >= MOST_CHAINS:
            _EXPLAINERS.pop(next(iter(_EXPLAINERS)))
        found = _EXPLAINERS[id(chain)] = SlipSearch(chain)
    return found
