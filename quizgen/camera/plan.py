"""Decide which effects a scene calls for.

Rules, in this order: what a question asks about is kept and computed exactly; what the camera does
not have is absent; what cannot change the picture within the budget is skipped and reported; the
rest runs on the cheapest rung that the budget still allows. The budget is spent where it saves
most time per grey level. Bounds follow the error through every later effect, so the total holds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from time import perf_counter

from msgspec.structs import replace

from quizgen.camera import effects
from quizgen.camera.camera import Camera
from quizgen.camera.chain import EXACT, SKIP, Chain
from quizgen.camera.costs import FACTS_PER_MEGAPIXEL
from quizgen.camera.decision import Decision, Plan, Step, Unit, cost_table
from quizgen.camera.draw import Stack, draw
from quizgen.camera.effect import Effect
from quizgen.camera.filters import opencv
from quizgen.camera.levels import by_brightness
from quizgen.camera.look import coarse, filled, glimpsed, measured
from quizgen.camera.margins import views
from quizgen.camera.scene import Scene, SceneError
from quizgen.camera.spending import Choice, Costs, spend
from quizgen.camera.view import View
from quizgen.outside import located

BUDGETS = {"same": 0.5, "visible": 2.0, "sketch": 8.0}
"""Named budgets in 8-bit grey levels."""

GLIMPSES = (128, False), (64, True), (16, True)
"""How far apart lines are that are looked at, and whether columns are, too: a few rows, read at
once, show of most pictures what they are."""

LEAST_LENS_MS = 50.0
"""What lens and movement must take for a photograph to be looked at: that takes up to 0.4 ms, and
of hundreds of small ones, steep somewhere as they are, one can do without any of it."""


class Prepared:
    """A scene in pixels, drawn when first needed.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    """

    def __init__(self, scene: Scene, camera: Camera) -> None:
        self.given = View(scene, camera)
        self.prepared_ms: dict[str, float] = {}
        self.drawn_ms = 0.0

    @cached_property
    def present(self) -> tuple[Effect, ...]:
        """Effects that the camera has, in physical order."""
        return effects.present(self.given)

    @cached_property
    def view(self) -> View:
        """Everything in px."""
        view = self.given
        for effect in self.present:
            effect.check(view)
            if effect.prepare is not None:
                started = perf_counter()
                view = replace(view, scene=effect.prepare(view.scene, view))
                self.prepared_ms[effect.name] = (perf_counter() - started) * 1e3
        return view

    @cached_property
    def views(self) -> tuple[View, ...]:
        """What each present effect works on, with its margin outside the frame."""
        return views(self.present, self.view)

    @cached_property
    def stack(self) -> Stack:
        """The drawn layers, with the margin that the first effect needs."""
        view, started = (*self.views, self.view)[0], perf_counter()
        drawn = draw(view)
        self.drawn_ms = (perf_counter() - started) * 1e3
        return drawn


def _units(present: tuple[Effect, ...], asked: frozenset[str]) -> tuple[Unit, ...]:
    units: dict[str, list[int]] = {}
    for index, effect in enumerate(present):
        units.setdefault(effect.pair or effect.name, []).append(index)
    return tuple([_unit(tuple(members), present, asked) for members in units.values()])


def _unit(members: tuple[int, ...], present: tuple[Effect, ...], asked: frozenset[str]) -> Unit:
    together = [present[index] for index in members]
    rungs = together[0].rungs if len(together) == 1 else ()
    needed = [one for one in together if one.reason or not asked.isdisjoint(one.decides)]
    return Unit(members, (EXACT, *[rung.name for rung in rungs], SKIP), bool(needed))


def _total(costs: Costs, choice: Choice) -> float:
    return sum(costs[index][made] for index, made in choice.items())


def _looking(chain: Chain, units: tuple[Unit, ...], choice: Choice) -> Iterator[Unit]:
    """What was kept and looks at neighbours: of single pixels, steps tell nothing."""
    beside = set(chain.beside)
    for unit in units:
        kept = not unit.fixed and choice[unit.members[0]] != SKIP
        if kept and not beside.isdisjoint(unit.members):
            yield unit


def _worth_a_look(view: View, hopes: tuple[Unit, ...], costs: Costs) -> bool:
    """Whether what was kept takes so long that a photograph's steps are looked at."""
    if view.scene.image is None:
        return True
    return sum(costs[index][EXACT] for unit in hopes for index in unit.members) >= LEAST_LENS_MS


def _may_gain(chain: Chain, hopes: tuple[Unit, ...], choice: Choice, budget: float) -> bool:
    """Whether a look at steps may afford what was kept: not where the least is a code too much.

    Of the lens the last effect takes least, unless more that is left out follows on the first.
    """
    lasts = [unit.members[-1] for unit in hopes]
    lens = [last for last in lasts if chain.present[last].stage == "optics"]
    asked = [last for last in lasts if last not in lens[1:-1]]
    return any(chain.least(last, made, budget) <= budget for made in ({}, choice) for last in asked)


def _opened(
    units: tuple[Unit, ...], chains: tuple[Chain, Chain], choice: Choice, budget: float
) -> bool:
    """Whether a second look affords a unit that a first has kept; what looks the same is passed."""
    first, second = chains
    for unit in units:
        for made in unit.choices[1:]:
            alone = dict.fromkeys(unit.members, made)
            if all(first.off(index, made) == second.off(index, made) for index in unit.members):
                continue
            if second.hopeless(unit.members, made, budget):
                continue
            if second.dn(alone) <= budget or second.dn({**choice, **alone}) <= budget:
                return True
    return False


def _best(
    prepared: Prepared, units: tuple[Unit, ...], costs: Costs, budget: float
) -> tuple[Chain, Choice]:
    """Decide from colours alone; look at the pixels only where that can still save time."""
    view, seen, present = prepared.view, prepared.views, prepared.present
    chain = Chain(present, view, coarse(view), seen)
    choice = spend(chain, units, costs, budget)
    hopes = tuple(_looking(chain, units, choice))
    if not _worth_a_look(view, hopes, costs) or not _may_gain(chain, hopes, choice, budget):
        return chain, choice
    stack = filled(prepared.stack)
    for apart, columns in GLIMPSES:
        glimpse = glimpsed(stack, view, apart, columns=columns)
        hopeful = Chain(present, view, glimpse, seen, like=chain)
        if not _opened(hopes, (chain, hopeful), choice, budget):
            return chain, choice
    gain = _total(costs, choice) - _total(costs, spend(hopeful, units, costs, budget))
    if gain <= FACTS_PER_MEGAPIXEL * view.megapixels:
        return chain, choice
    chain = Chain(present, view, measured(prepared.stack, view), seen)
    return chain, spend(chain, units, costs, budget)


def wanted(question: str | tuple[str, ...] | None, scene: Scene) -> frozenset[str]:
    """Kinds of question asked, by the caller or else by the scene.

    Raises
    ------
    SceneError
        If no effect decides a kind.
    """
    kinds = scene.question if question is None else question
    asked = frozenset((kinds,) if isinstance(kinds, str) else kinds)
    for kind in sorted(asked.difference(effects.questions())) if asked else ():
        raise SceneError(f"unknown question {kind!r}; one of {', '.join(effects.questions())}")
    return asked


def read_budget(text: str | float) -> float:
    """Grey levels of a number or of a name in `BUDGETS`."""
    try:
        budget = BUDGETS[text] if text in BUDGETS else float(text)
    except (TypeError, ValueError):
        budget = math.nan
    if not 0.0 <= budget < math.inf:
        raise SceneError(f"budget {text!r}: a number of grey levels >= 0 or {', '.join(BUDGETS)}")
    return budget


def plan(
    scene: Scene | Prepared,
    camera: Camera | None = None,
    question: str | tuple[str, ...] | None = None,
    budget: str | float = 0.5,
) -> Plan:
    """Decide what to run.

    Parameters
    ----------
    scene : Scene or Prepared
    camera : Camera
        Not needed with a `Prepared`.
    question : str or tuple of str, optional
        Kinds of question; what decides them is kept. By default the scene's own.
    budget : float or str
        Largest tolerated change in 8-bit grey levels, or a name in `BUDGETS`.

    Returns
    -------
    Plan
        A pure function of the arguments.
    """
    prepared = scene if isinstance(scene, Prepared) else Prepared(scene, camera or Camera())
    return decided(prepared, question, budget).plan


def decided(
    prepared: Prepared,
    question: str | tuple[str, ...] | None = None,
    budget: str | float = 0.5,
) -> Decision:
    """A plan whose reasons are worked out when somebody asks for them.

    Parameters
    ----------
    prepared : Prepared
    question, budget
        As for `plan`.
    """
    given, limit = prepared.given, read_budget(budget)
    asked = wanted(question, given.scene)
    with located(given.scene.file):
        present, absent = prepared.present, _absent(prepared)
        units = _units(present, asked)
        costs = cost_table(present, prepared.views, opencv_used=False)
        chain, choice = _best(prepared, units, costs, limit)
        levels = by_brightness(chain, choice, units, costs, limit)
        return Decision(chain, choice, units, absent, limit, levels)


def everything(scene: Scene | Prepared, camera: Camera | None = None, timed: bool = True) -> Plan:
    """The plan that runs every present effect exactly; with no times if nobody asks."""
    prepared = scene if isinstance(scene, Prepared) else Prepared(scene, camera or Camera())
    present, absent = prepared.present, _absent(prepared)
    with located(prepared.given.scene.file):
        used, seen = opencv() is not None, prepared.views
    steps = tuple(
        Step(one.name, EXACT, "everything", math.nan, one.cost(view, EXACT, used) if timed else 0.0)
        for one, view in zip(present, seen, strict=True)
    )
    return Plan(steps, (), absent, 0.0, sum(step.predicted_ms for step in steps), 0.0)


def _absent(prepared: Prepared) -> tuple[str, ...]:
    """Names of the effects that the camera has not."""
    there = {effect.name for effect in prepared.present}
    return tuple([effect.name for effect in effects.EFFECTS if effect.name not in there])
