"""The camera's budget against its time: what each scene costs at each number of grey levels."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import as_file, files

from quizgen.camera.decision import Plan
from quizgen.camera.plan import Prepared, everything, plan
from quizgen.camera.reading import load
from quizgen.camera.scene import PRECISIONS, Precision
from quizgen.camera.simulate import Photo, difference_dn, run
from quizgen.tradeoff.measure import Effort, spread
from quizgen.tradeoff.work import Curve, Point

SCENES = ("landscape", "texture", "portrait", "night", "propeller", "flat", "fisheye", "pinhole")
"""All examples, those first that a budget changes most."""
BUDGETS = (0.1, 0.5, 2.0, 8.0, 32.0)
"""Grey levels of 255 by which a picture may differ from that of all effects."""


def photographs(effort: Effort) -> Iterator[Curve]:
    """Each scene at every budget that changes its plan: time of the effects, difference found."""
    for name in SCENES[: effort.scenes]:
        with as_file(files("quizgen.camera") / "scenes" / f"{name}.toml") as file:
            prepared = {kind: Prepared(*load(file, kind)) for kind in PRECISIONS}
        yield Curve(name, tuple(_points(prepared, effort.photos)))


def _points(prepared: dict[Precision, Prepared], photos: int) -> Iterator[Point]:
    """Every plan in every precision; errors are against all effects in float64."""
    chosen = list(_plans(prepared["float32"]))
    run(prepared["float32"], chosen[0][1])  # warms up
    whole: Photo | None = None
    spent: dict[tuple[str, str], list[float]] = {}
    off: dict[tuple[str, str], float] = {}
    turns: list[Precision] = ["float64"]  # once: doubles take long
    turns += ["float32"] * photos
    for kind in turns:
        for label, what in chosen:
            photo = run(prepared[kind], what)
            whole = whole or photo
            spent.setdefault((kind, label), []).append(photo.measured_ms * 1e-3)
            if (kind, label) not in off:
                off[kind, label] = difference_dn(photo, whole)
    for kind in PRECISIONS:
        for label, what in chosen:
            taken = spread(spent[kind, label])
            yield Point(label, taken, off[kind, label], _note(what), kind)


def _plans(prepared: Prepared) -> Iterator[tuple[str, Plan]]:
    """Everything, then the plans that save something, each with the least budget for it."""
    yield "=", everything(prepared)
    seen = {""}
    for budget in BUDGETS:
        what = plan(prepared, budget=budget)
        if _saved(what) not in seen:
            seen.add(_saved(what))
            yield f"{budget:g}", what


def _note(what: Plan) -> str:
    return _saved(what) or ", ".join(step.effect for step in what.steps)


def _saved(what: Plan) -> str:
    """What was left out (with a minus sign), and what ran on a cheaper rung."""
    out = [f"\N{MINUS SIGN}{one.effect}" for one in what.skipped]
    return ", ".join(out + [f"{one.effect} ({one.rung})" for one in what.steps if one.rung])
