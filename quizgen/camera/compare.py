"""What a plan leaves out, made visible: pictures beside each other, and each effect on its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera import effects
from quizgen.camera.chain import EXACT, GREY_LEVELS
from quizgen.camera.codes import rounded
from quizgen.camera.decision import NO_LEVELS, Plan, Skipped, Step
from quizgen.camera.plan import Prepared
from quizgen.camera.simulate import Photo, difference_dn, run

Codes = NDArray[np.uint8]

GAIN = 16.0
"""How much a difference is amplified to be seen."""
_GAP = 8


def difference(planned: Photo, whole: Photo) -> Codes:
    """Difference of two pictures times `GAIN`, as 8-bit codes; black where they agree."""
    apart = np.abs(planned.values - whole.values)
    return rounded(apart * (GAIN * GREY_LEVELS))


def side_by_side(*pictures: Codes) -> Codes:
    """Pictures of one height in a row, white between them."""
    height = pictures[0].shape[0]
    gap = np.full((height, _GAP, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture, gap)]
    return np.concatenate(parts[:-1], axis=1)


def really(prepared: Prepared, photo: Photo, told: Callable[[str], None]) -> dict[str, float]:
    """What each effect really changes in this plan, in grey levels: with it against without it.

    Parameters
    ----------
    prepared : Prepared
    photo : Photo
        Taken by the plan. What its bright tiles do without is put in: which those are could change
        with any effect.
    told : callable
        Gets the name of each effect before it is tried.
    """
    found: dict[str, float] = {}
    if photo.plan.levels.each:
        photo = run(prepared, replace(photo.plan, levels=NO_LEVELS))
    for members in _units(photo.plan):
        told(members[0])
        other = run(prepared, _toggled(photo.plan, members))
        found.update(dict.fromkeys(members, difference_dn(*sorted((other, photo), key=_ran))))
    return found


def _ran(photo: Photo) -> int:
    return len(photo.plan.steps)


def _units(what: Plan) -> Iterator[tuple[str, ...]]:
    """Effects that are kept or left out together; not what only prepares a scene."""
    there = {step.effect for step in what.steps} | {item.effect for item in what.skipped}
    units: dict[str, list[str]] = {}
    for effect in effects.EFFECTS:
        if effect.name in there and effect.prepare is None:
            units.setdefault(effect.pair or effect.name, []).append(effect.name)
    yield from map(tuple, units.values())


def _toggled(what: Plan, members: tuple[str, ...]) -> Plan:
    """The plan without these effects if it has them, else with them."""
    made = {step.effect: step for step in what.steps}
    left = {item.effect: item for item in what.skipped}
    for name in members:
        if made.pop(name, None):
            left[name] = Skipped(name, "", 0.0, 0.0)
        else:
            made[name] = Step(name, EXACT, "", 0.0, 0.0)
            del left[name]
    steps = tuple(made[effect.name] for effect in effects.EFFECTS if effect.name in made)
    return Plan(steps, tuple(left.values()), what.absent, 0.0, 0.0, what.budget)
