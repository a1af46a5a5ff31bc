"""Decide which effects run: those that a question asks about, or those that a budget cannot spare.

What is asked runs, with what it would be wrong without (a flat field without vignetting) and what
makes a picture of it at all (brightness, tone curve); nothing else. For a picture without a
question effects are left out, least change first, as long as all that is left out together changes
no value by more than the budget.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from quizgen.camera import effects
from quizgen.camera.effects.effect import Effect
from quizgen.camera.prepared import GREY_LEVELS, Prepared
from quizgen.camera.scene import SceneError
from quizgen.camera.setup.settings import nearest
from quizgen.camera.view import View
from quizgen.core.untrusted import error_context

BUDGETS = {"same": 0.5, "visible": 2.0, "sketch": 8.0}
"""Named budgets in 8-bit grey levels."""


@dataclass(frozen=True)
class Choice:
    """What is made of an effect.

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
    """What runs and what does not.

    Parameters
    ----------
    steps : tuple of Choice
        What runs, in physical order.
    left_out : tuple of Choice
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

    steps: tuple[Choice, ...]
    left_out: tuple[Choice, ...]
    absent: tuple[str, ...]
    bound_dn: float
    budget: float | None = None
    asked: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The effects that run, in physical order."""
        return tuple(step.effect for step in self.steps)


@dataclass(frozen=True)
class Selection:
    """Effects that are chosen by name.

    Parameters
    ----------
    only : tuple of str
        As if a question asked about them and nothing else.
    plus, minus : tuple of str
        What runs besides, and what does not run whatever is asked.
    """

    only: tuple[str, ...] = ()
    plus: tuple[str, ...] = ()
    minus: tuple[str, ...] = ()


NO_SELECTION = Selection()


def read_budget(text: str | float) -> float:
    """Grey levels of a number or of a name in `BUDGETS`.

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


def read_effect(text: str) -> str:
    """The name of an effect, which may be written with hyphens.

    Raises
    ------
    SceneError
        If there is none of the name.
    """
    name = text.replace("-", " ").replace("_", " ")
    known = [effect.name for effect in effects.EFFECTS]
    if name not in known:
        raise SceneError(f"no effect {text!r}{nearest(name, known)}; there are {', '.join(known)}")
    return name


def plan_everything(prepared: Prepared) -> Plan:
    """The plan that runs every present effect."""
    with error_context(prepared.given.scene.file):
        return _report(prepared, {effect.name: "everything" for effect in prepared.present}, {})


def plan_budget(
    prepared: Prepared, budget: str | float = 0.5, chosen: Selection = NO_SELECTION
) -> Plan:
    """Leave out what no value of the picture shows by more than the budget, least change first.

    Parameters
    ----------
    prepared : Prepared
    budget : float or str
        Largest tolerated change in 8-bit grey levels, or a name in `BUDGETS`.
    chosen : Selection
        What runs, or does not, whatever it changes.
    """
    limit = read_budget(budget)
    with error_context(prepared.given.scene.file):
        bounds = {names: prepared.bound_omission(names) for names in _units(prepared)}
        out: tuple[str, ...] = ()
        for names in sorted(bounds, key=lambda names: (bounds[names], names)):
            if chosen.plus and not set(chosen.plus).isdisjoint(names):
                continue
            if bounds[names] <= limit and prepared.bound_omission(out + names) <= limit:
                out += names
        why = dict.fromkeys(out, "too little to be seen") | dict.fromkeys(
            chosen.minus, "not wanted"
        )
        runs = {one.name: one.always or "may be seen" for one in prepared.present}
        return _report(
            prepared, {name: runs[name] for name in runs if name not in why}, why, budget=limit
        )


def plan_question(
    prepared: Prepared, kinds: Iterable[str] = (), chosen: Selection = NO_SELECTION
) -> Plan:
    """Run what a question asks about and what its picture would be wrong without.

    Parameters
    ----------
    prepared : Prepared
    kinds : iterable of str
        Kinds of question (`quizgen.camera.effects.questions`).
    chosen : Selection

    Raises
    ------
    SceneError
        If no effect answers a kind, or the camera has none that does.
    """
    there = {effect.name: effect for effect in prepared.present}
    with error_context(prepared.given.scene.file):
        for name in (*chosen.only, *chosen.plus):
            if name not in there:
                raise SceneError(f"this camera has no {name}{_hint(effects.by_name(name))}")
        asked = chosen.only or _answering(there.values(), kinds)
        runs = {one.name: one.always for one in there.values() if one.always}
        runs |= dict.fromkeys(chosen.plus, "wanted") | dict.fromkeys(asked, "asked")
        for name in list(runs):
            runs = _with_needed(there[name], there, runs)
        out = {name: "not asked" for name in there if name not in runs}
        out |= {name: "not wanted" for name in chosen.minus if name in there}
        runs = {name: why for name, why in runs.items() if name not in out}
        return _report(prepared, runs, out, asked=tuple(name for name in runs if name in asked))


def _answering(there: Iterable[Effect], kinds: Iterable[str]) -> tuple[str, ...]:
    """Present effects that answer a question; every kind has one."""
    found: list[str] = []
    for kind in kinds:
        known = [effect for effect in effects.EFFECTS if kind in effect.answers]
        if not known:
            kinds = ", ".join(effects.questions())
            raise SceneError(f"unknown question {kind!r}; one of {kinds}")
        names = [effect.name for effect in there if effect in known]
        if not names:
            raise SceneError(f"nothing in this camera answers {kind!r}{_hint(known[0])}")
        found.extend(names)
    return tuple(dict.fromkeys(found))


def _hint(effect: Effect) -> str:
    """What would bring an effect into a camera."""
    names = " or ".join(setting.name for setting in effect.settings) or effect.needs
    return f": it needs {names}" if names else ""


def _with_needed(
    effect: Effect, there: Mapping[str, Effect], runs: dict[str, str]
) -> dict[str, str]:
    needed = {
        one.name: f"{effect.name} needs it"
        for one in there.values()
        if one.name in effect.needs_effects or (effect.pair and one.pair == effect.pair)
    }
    return needed | runs


def _units(prepared: Prepared) -> list[tuple[str, ...]]:
    """Effects that may be left out, those of a pair together."""
    units: dict[str, tuple[str, ...]] = {}
    for effect in prepared.present:
        if not effect.always:
            key = effect.pair or effect.name
            units[key] = (*units.get(key, ()), effect.name)
    return list(units.values())


def describe_size(effect: Effect, view: View) -> str:
    """What an effect does in its own terms, its verb first; empty where that says nothing.

    Hot pixels alone, for one, are a dark current of 0 electrons.
    """
    size = effect.size
    value = size.of(view) if size else 0.0
    return size.says.format(value) if size and (value or size.least) else ""


def _describe_bound(bound: float) -> str:
    if bound >= GREY_LEVELS:
        return "change anything"
    return f"change at most {bound:.3g} grey levels" if bound else "change nothing"


def _report(
    prepared: Prepared,
    runs: Mapping[str, str],
    out: Mapping[str, str],
    budget: float | None = None,
    asked: tuple[str, ...] = (),
) -> Plan:
    steps: list[Choice] = []
    left_out: list[Choice] = []
    for effect in prepared.present:
        unit = [
            one.name for one in prepared.present if one is effect or effect.pair == one.pair != ""
        ]
        bound = min(prepared.bound_omission(unit), GREY_LEVELS)
        says = describe_size(effect, prepared.view) or _describe_bound(bound)
        why = runs.get(effect.name) or out.get(effect.name, "")
        choice = Choice(effect.name, why, says, bound)
        (steps if effect.name in runs else left_out).append(choice)
    total = prepared.bound_omission([choice.effect for choice in left_out])
    return Plan(tuple(steps), tuple(left_out), prepared.absent, total, budget, asked)
