"""The camera's budget against its time: what a scene costs at each number of grey levels."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import as_file, files

from quizgen.camera.plan import Plan, Prepared, everything, plan
from quizgen.camera.reading import load
from quizgen.camera.simulate import Photo, difference_dn, run
from quizgen.tradeoff.measure import Effort, Timing, spread
from quizgen.tradeoff.work import Curve, Point

SCENES = ("landscape", "portrait", "texture")
BUDGETS = (0.1, 0.5, 2.0, 8.0, 32.0)
"""Grey levels of 255 by which a picture may differ from that of all effects."""


def photographs(effort: Effort) -> Iterator[Curve]:
    """Each scene at every budget: time of its effects, and the difference that is found."""
    for name in SCENES[: effort.scenes]:
        with as_file(files("quizgen.camera") / "scenes" / f"{name}.toml") as file:
            prepared = Prepared(*load(file))
        run(prepared, everything(prepared))  # the first one warms up
        whole, spent = _taken(prepared, everything(prepared), effort)
        points = [Point("=", spent, 0.0, _effects(whole.plan))]
        for budget in BUDGETS:
            photo, spent = _taken(prepared, plan(prepared, budget=budget), effort)
            note, error = _effects(photo.plan), difference_dn(photo, whole)
            points.append(Point(f"{budget:g}", spent, error, note))
        yield Curve(name, tuple(points))


def _taken(prepared: Prepared, what: Plan, effort: Effort) -> tuple[Photo, Timing]:
    photos = [run(prepared, what) for _ in range(effort.photos)]
    return photos[-1], spread([photo.measured_ms * 1e-3 for photo in photos])


def _effects(what: Plan) -> str:
    """What ran, with the rung if it is a cheaper one."""
    ran = (f"{one.effect} ({one.rung})" if one.rung else one.effect for one in what.steps)
    return ", ".join(ran) or "-"
