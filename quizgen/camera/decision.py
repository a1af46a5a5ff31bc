"""What was decided about the effects of a view, and why, in words and grey levels."""

from __future__ import annotations

from functools import cached_property

import msgspec

from quizgen.camera.chain import EXACT, GREY_LEVELS, SKIP, Chain
from quizgen.camera.effect import Effect
from quizgen.camera.filters import opencv
from quizgen.camera.view import View


class Chosen(msgspec.Struct, frozen=True):
    """An effect that runs, and how."""

    effect: str
    rung: str


class Step(Chosen, frozen=True):
    """The same with why, and its predicted time in ms."""

    reason: str
    bound_dn: float
    predicted_ms: float


class Skipped(msgspec.Struct, frozen=True):
    """An effect left out: why, by how many grey levels that can matter, and the ms it saves."""

    effect: str
    reason: str
    bound_dn: float
    saved_ms: float


class Level(msgspec.Struct, frozen=True):
    """What is left out besides, or runs on a cheaper rung, where a tile is bright.

    Parameters
    ----------
    above : float
        Value below which no pixel of the tile lies, 1 = white.
    ways : dict of str to str
        By effect, a rung or ``skip``.
    bound_dn : float
        Bound on the difference in these tiles to running everything.
    """

    above: float
    ways: dict[str, str]
    bound_dn: float


class Levels(msgspec.Struct, frozen=True):
    """The same from dark to bright.

    Parameters
    ----------
    since : str
        The effect before which the picture is looked at.
    around : int
        How far around a pixel the effects from there on look, px.
    each : tuple of Level
    """

    since: str
    around: int
    each: tuple[Level, ...]


NO_LEVELS = Levels("", 0, ())


class Plan(msgspec.Struct, frozen=True):
    """What to run.

    Parameters
    ----------
    steps : tuple of Step
        In physical order.
    skipped : tuple of Skipped
    absent : tuple of str
        Effects this camera does not have.
    predicted_error_dn : float
        Bound on the difference to running everything, in 8-bit grey levels before rounding; where
        noise is skipped, all but 1 in 10 000 values keep it.
    predicted_ms : float
        As if what runs in any tile ran in all of them.
    budget : float
    levels : Levels
        What bright tiles do without.
    """

    steps: tuple[Step, ...]
    skipped: tuple[Skipped, ...]
    absent: tuple[str, ...]
    predicted_error_dn: float
    predicted_ms: float
    budget: float
    levels: Levels = NO_LEVELS


class Unit(msgspec.Struct, frozen=True):
    """Effects that are kept or skipped together, with what each choice costs."""

    members: tuple[int, ...]
    choices: tuple[str, ...]
    fixed: bool


class Decision(msgspec.Struct, frozen=True, dict=True):
    """What is run; why, and how long that should take, is worked out when somebody asks.

    Parameters
    ----------
    chain : Chain
    choice : dict of int to str
        By the effect's place in the chain: how it runs, or that it is skipped.
    units : tuple of Unit
    absent : tuple of str
    budget : float
    levels : Levels
    """

    chain: Chain
    choice: dict[int, str]
    units: tuple[Unit, ...]
    absent: tuple[str, ...]
    budget: float
    levels: Levels = NO_LEVELS

    @property
    def steps(self) -> tuple[Chosen, ...]:
        """What runs, in physical order."""
        made = zip(
            self.chain.present, (made for _, made in sorted(self.choice.items())), strict=True
        )
        return tuple(Chosen(effect.name, how) for effect, how in made if how != SKIP)

    @cached_property
    def plan(self) -> Plan:
        """The same with its reasons."""
        return _report(self)


class _Costs(dict[str, float]):
    """Ways to run an effect with their ms, each worked out when first asked for."""

    def __init__(self, effect: Effect, view: View, *, opencv_used: bool) -> None:
        self._of = effect, view, opencv_used

    def __missing__(self, made: str) -> float:
        effect, view, opencv_used = self._of
        self[made] = effect.cost(view, made, opencv_used) if made != SKIP else 0.0
        return self[made]


def cost_table(
    present: tuple[Effect, ...], seen: tuple[View, ...], *, opencv_used: bool
) -> list[dict[str, float]]:
    """By effect and way, ms."""
    pairs = zip(present, seen, strict=True)
    return [_Costs(effect, view, opencv_used=opencv_used) for effect, view in pairs]


def _report(made: Decision) -> Plan:
    chain, choice, absent = made.chain, made.choice, made.absent
    if not choice:
        return Plan((), (), absent, 0.0, 0.0, made.budget)
    times = cost_table(chain.present, chain.views, opencv_used=opencv() is not None)
    steps, skipped = [], []
    bounds = _alone(chain, choice, made.units)
    for unit, alone in zip(made.units, bounds, strict=True):
        for index in unit.members:
            name, how, time = chain.present[index].name, choice[index], times[index]
            if how == SKIP:
                skipped.append(Skipped(name, _why_skipped(alone), alone, time[EXACT]))
            else:
                reason = _why_kept(chain, unit, index, how, alone)
                steps.append((index, Step(name, how, reason, alone, time[how])))
    ran = tuple(step for _, step in sorted(steps, key=lambda pair: pair[0]))
    spent = sum(step.predicted_ms for step in ran)
    error = max(chain.dn(choice), *(level.bound_dn for level in made.levels.each), 0.0)
    return Plan(ran, tuple(skipped), absent, error, spent, made.budget, made.levels)


def _alone(chain: Chain, choice: dict[int, str], units: tuple[Unit, ...]) -> list[float]:
    """What each unit changes in this plan: with it against without it, other choices as made."""
    ran = tuple(index for index, made in sorted(choice.items()) if made != SKIP)
    without: dict[tuple[int, ...], Chain] = {tuple(sorted(choice)): chain}
    bounds = []
    for unit in units:
        kept = tuple(sorted({*ran, *unit.members}))
        if kept not in without:
            present = tuple(chain.present[index] for index in kept)
            seen = tuple(chain.views[index] for index in kept)
            without[kept] = Chain(present, chain.view, chain.facts, seen)
        members = {kept.index(index): SKIP for index in unit.members}
        bounds.append(min(without[kept].dn(members), GREY_LEVELS))
    return bounds


def _why_skipped(bound: float) -> str:
    return f"changes at most {bound:.3g} DN" if bound else "changes nothing"


def _why_kept(chain: Chain, unit: Unit, index: int, made: str, alone: float) -> str:
    if unit.fixed:
        return chain.present[index].reason or "asked about"
    size = "anything" if alone >= GREY_LEVELS else f"up to {alone:.3g} DN"
    if made == EXACT:
        return f"may change {size}"
    return f"may change {size}; this rung is off by {chain.dn({index: made}):.2g} DN at most"
