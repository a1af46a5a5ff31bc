"""Decide which effects run: those that a question asks about, or those that a budget cannot spare.

What is asked runs, with what it would be wrong without (a flat field without vignetting) and what
makes a picture of it at all (brightness, tone curve); nothing else. For a picture without a
question effects are left out, least change first, as long as all that is left out together changes
no value by more than the budget.

How much leaving out can change is one number that follows from effect to effect: what is left out
adds its bound, what runs carries the number on, as a gain does. It holds for every value, since
luck and rounding have ends.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter

from msgspec.structs import replace

from quizgen.camera import effects
from quizgen.camera.camera import Camera
from quizgen.camera.effect import Effect
from quizgen.camera.padding import padded_views
from quizgen.camera.pixels.codes import GREY_LEVELS
from quizgen.camera.raster.rasterizer import LayerStack, rasterize
from quizgen.camera.setup.scene import Scene, SceneError
from quizgen.camera.setup.settings import suggest_setting
from quizgen.camera.setup.view import Signal, View
from quizgen.core.untrusted import error_context

BUDGETS = {"same": 0.5, "visible": 2.0, "sketch": 8.0}
"""Named budgets in 8-bit grey levels."""
LARGEST_SIGNAL = 1e30
"""Signals beyond this are no picture."""
_ROUNDING = 2e-6
"""What single precision adds in one step, relative to the largest value."""


class PreparedScene:
    """A scene in pixels with the effects of a camera, drawn when first needed.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    names : collection of str, optional
        Effects that are wanted of those that the camera has; by default all.
    """

    def __init__(self, scene: Scene, camera: Camera, names: Collection[str] | None = None) -> None:
        self.given = View(scene, camera)
        self.camera, self.names = camera, names
        self.prepared_ms: dict[str, float] = {}
        self.drawn_ms = 0.0

    @cached_property
    def present(self) -> tuple[Effect, ...]:
        """The effects that the camera has, in physical order."""
        there = effects.present_effects(self.given)
        return tuple(one for one in there if self.names is None or one.name in self.names)

    @cached_property
    def absent(self) -> tuple[str, ...]:
        """The names of the effects that the camera does not have."""
        return tuple(one.name for one in effects.EFFECTS if one not in self.present)

    @cached_property
    def view(self) -> View:
        """The camera and the scene with all lengths in px, after the effects that prepare it."""
        view = self.given
        for effect in self.present:
            effect.check_camera(view)
            if effect.prepare is not None:
                started = perf_counter()
                view = replace(view, scene=effect.prepare(view.scene, view))
                self.prepared_ms[effect.name] = (perf_counter() - started) * 1e3
        return view

    @cached_property
    def views(self) -> tuple[View, ...]:
        """The view that each present effect works on, with its margin outside the frame."""
        return padded_views(self.present, self.view)

    @cached_property
    def stack(self) -> LayerStack:
        """The drawn layers, with the margin that the first effect needs."""
        view, started = (*self.views, self.view)[0], perf_counter()
        drawn = rasterize(view)
        self.drawn_ms = (perf_counter() - started) * 1e3
        return drawn

    @cached_property
    def signals(self) -> tuple[Signal, ...]:
        """The range of the picture's values before each present effect, if all run.

        Raises
        ------
        SceneError
            If an effect makes signals of more than `LARGEST_SIGNAL`.
        """
        found, signal = [], _widen_for_rounding(Signal(*self.view.scene.radiance_range))
        for effect, view in zip(self.present, self.views, strict=True):
            found.append(signal)
            signal = _widen_for_rounding(effect.range_after(signal, view))
            if not signal.size < LARGEST_SIGNAL:
                raise SceneError(f"{effect.name} makes signals of more than {LARGEST_SIGNAL:g}")
        return tuple(found)

    def find_unit(self, effect: Effect) -> tuple[str, ...]:
        """Return the names of the effects that run only together with this one, its own too."""
        return tuple(
            one.name for one in self.present if one is effect or one.pair == effect.pair != ""
        )

    def bound_omission(self, names: Collection[str]) -> float:
        """Return by how many grey levels leaving these effects out changes any value at most.

        Parameters
        ----------
        names : collection of str
            Of present effects. Of a pair that runs together, both.
        """
        error = 0.0
        for effect, signal, view in zip(self.present, self.signals, self.views, strict=True):
            if effect.name in names:
                lost = effect.omission_bound(signal, view)
                error += lost + (_ROUNDING * signal.size if lost else 0.0)
            elif 0.0 < error < LARGEST_SIGNAL:
                error = effect.carry_error(error, signal, view) + _ROUNDING * signal.size
        return GREY_LEVELS * error


def _widen_for_rounding(signal: Signal) -> Signal:
    """Return a range with room for the rounding errors of the values in it."""
    slack = _ROUNDING * signal.size
    return signal.with_margins(slack, slack)


@dataclass(frozen=True)
class EffectChoice:
    """Why one effect runs or is left out, and what leaving it out would change.

    Parameters
    ----------
    effect : str
    why : str
        Why it runs, or why it does not.
    says : str
        What it does in its own terms (``darken the corners by 12 %``).
    bound_dn : float
        Grey levels by which leaving it out alone changes any value at most.
    """

    effect: str
    why: str
    says: str
    bound_dn: float


@dataclass(frozen=True)
class Plan:
    """Which effects run and which are left out, each with the reason.

    Parameters
    ----------
    steps : tuple of EffectChoice
        What runs, in physical order.
    left_out : tuple of EffectChoice
    absent : tuple of str
        Effects this camera does not have.
    bound_dn : float
        Grey levels by which the picture differs at most from that of all present effects, before
        rounding to 8 bits.
    budget : float or None
        What was allowed; None where a question decides.
    asked : tuple of str
        Effects that are asked about.
    """

    steps: tuple[EffectChoice, ...]
    left_out: tuple[EffectChoice, ...]
    absent: tuple[str, ...]
    bound_dn: float
    budget: float | None = None
    asked: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the effects that run, in physical order."""
        return tuple(step.effect for step in self.steps)


@dataclass(frozen=True)
class EffectSelection:
    """Effects that a user chose by name, on top of what a question or a budget decides.

    Parameters
    ----------
    only : tuple of str
        As if a question asked about them and nothing else.
    plus, minus : tuple of str
        What runs as well, and what does not run whatever is asked.
    """

    only: tuple[str, ...] = ()
    plus: tuple[str, ...] = ()
    minus: tuple[str, ...] = ()


NO_SELECTION = EffectSelection()


def parse_budget(text: str | float) -> float:
    """Return the grey levels that a text means: a number or a name in `BUDGETS`.

    Raises
    ------
    SceneError
        If it is neither, or negative.
    """
    try:
        budget = BUDGETS[text] if text in BUDGETS else float(text)
    except (TypeError, ValueError):
        budget = math.nan
    if not 0.0 <= budget < math.inf:
        raise SceneError(f"budget {text!r}: a number of grey levels >= 0 or {', '.join(BUDGETS)}")
    return budget


def parse_effect(text: str) -> str:
    """Return the name of an effect, which may be typed with hyphens.

    Raises
    ------
    SceneError
        If there is none of the name.
    """
    name = text.replace("-", " ").replace("_", " ")
    known = [effect.name for effect in effects.EFFECTS]
    if name not in known:
        raise SceneError(
            f"no effect {text!r}{suggest_setting(name, known)}; there are {', '.join(known)}"
        )
    return name


def plan_budget(
    prepared: PreparedScene, budget: str | float = 0.5, chosen: EffectSelection = NO_SELECTION
) -> Plan:
    """Return the plan that leaves out what no value shows by more than the budget.

    The effects with the least change are left out first; their bounds add up.

    Parameters
    ----------
    prepared : PreparedScene
    budget : float or str
        Largest tolerated change in 8-bit grey levels, or a name in `BUDGETS`.
    chosen : EffectSelection
        What runs, or does not, whatever it changes.
    """
    limit = parse_budget(budget)
    with error_context(prepared.given.scene.file):
        units = {prepared.find_unit(one) for one in prepared.present if not one.always}
        bounds = {names: prepared.bound_omission(names) for names in units}
        out: tuple[str, ...] = ()
        for names in sorted(bounds, key=lambda names: (bounds[names], names)):
            if not set(chosen.plus).isdisjoint(names):
                continue
            if bounds[names] <= limit and prepared.bound_omission(out + names) <= limit:
                out += names
        why = dict.fromkeys(out, "too little to be seen")
        why |= dict.fromkeys(chosen.minus, "not wanted")
        runs = {
            one.name: one.always or "may be seen" for one in prepared.present if one.name not in why
        }
        return _build_plan(prepared, runs, why, budget=limit)


def plan_question(
    prepared: PreparedScene, kinds: Iterable[str] = (), chosen: EffectSelection = NO_SELECTION
) -> Plan:
    """Return the plan that runs what a question asks about and what its picture is wrong without.

    Parameters
    ----------
    prepared : PreparedScene
    kinds : iterable of str
        Kinds of question (`quizgen.camera.effects.question_kinds`).
    chosen : EffectSelection

    Raises
    ------
    SceneError
        If no effect answers a kind, or the camera has none that does.
    """
    there = {effect.name: effect for effect in prepared.present}
    with error_context(prepared.given.scene.file):
        for name in (*chosen.only, *chosen.plus):
            if name not in there:
                raise SceneError(
                    f"this camera has no {name}{_suggest_setting_of(effects.get_effect(name))}"
                )
        asked = chosen.only or _find_answering(there.values(), kinds)
        runs = {one.name: one.always for one in there.values() if one.always}
        runs |= dict.fromkeys(chosen.plus, "wanted") | dict.fromkeys(asked, "asked")
        for name in list(runs):
            needed, pair = there[name].needs_effects, there[name].pair
            runs = {
                other: f"{name} needs it"
                for other, one in there.items()
                if other in needed or one.pair == pair != ""
            } | runs
        out = {name: "not asked" for name in there if name not in runs}
        out |= {name: "not wanted" for name in chosen.minus if name in there}
        runs = {name: why for name, why in runs.items() if name not in out}
        return _build_plan(prepared, runs, out, asked=tuple(name for name in runs if name in asked))


def _find_answering(there: Iterable[Effect], kinds: Iterable[str]) -> tuple[str, ...]:
    """Return the names of the present effects that answer a question; every kind must have one."""
    found: list[str] = []
    for kind in kinds:
        known = [effect for effect in effects.EFFECTS if kind in effect.answers]
        if not known:
            kinds = ", ".join(effects.question_kinds())
            raise SceneError(f"unknown question {kind!r}; one of {kinds}")
        names = [effect.name for effect in there if effect in known]
        if not names:
            raise SceneError(
                f"nothing in this camera answers {kind!r}{_suggest_setting_of(known[0])}"
            )
        found.extend(names)
    return tuple(dict.fromkeys(found))


def _suggest_setting_of(effect: Effect) -> str:
    """Return the part of a message that says which setting would bring an effect into a camera."""
    names = " or ".join(setting.name for setting in effect.settings) or effect.needs
    return f": it needs {names}" if names else ""


def describe_size(effect: Effect, view: View) -> str:
    """Return what an effect does in its own terms, verb first; "" where that says nothing.

    Hot pixels alone, for one, are a dark current of 0 electrons.
    """
    size = effect.size
    value = size.of(view) if size else 0.0
    return size.says.format(value) if size and (value or size.least) else ""


def _build_plan(
    prepared: PreparedScene,
    runs: Mapping[str, str],
    out: Mapping[str, str],
    budget: float | None = None,
    asked: tuple[str, ...] = (),
) -> Plan:
    """Return the plan of the effects that run and are left out, each given with its reason."""
    steps: list[EffectChoice] = []
    left_out: list[EffectChoice] = []
    for effect in prepared.present:
        bound = min(prepared.bound_omission(prepared.find_unit(effect)), GREY_LEVELS)
        most = f"at most {bound:.3g} grey levels" if bound else "nothing"
        most = "anything" if bound >= GREY_LEVELS else most
        says = describe_size(effect, prepared.view) or f"change {most}"
        why = runs.get(effect.name) or out.get(effect.name, "")
        choice = EffectChoice(effect.name, why, says, bound)
        (steps if effect.name in runs else left_out).append(choice)
    total = prepared.bound_omission([choice.effect for choice in left_out])
    return Plan(tuple(steps), tuple(left_out), prepared.absent, total, budget, asked)
