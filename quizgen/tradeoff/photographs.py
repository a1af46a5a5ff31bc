"""The camera's budget against its time: what each scene costs at each number of grey levels."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import as_file, files

from quizgen.camera.plan import Plan, Prepared, everything, plan
from quizgen.camera.reading import load
from quizgen.camera.simulate import difference_dn, run
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
            prepared = Prepared(*load(file))
        whole = run(prepared, everything(prepared))  # the first one warms up
        chosen = list(_plans(prepared))
        spent: dict[str, list[float]] = {label: [] for label, _ in chosen}
        points = []
        for last in range(effort.photos)[::-1]:
            for label, what in chosen:  # in turn, so that what else is running hits all alike
                photo = run(prepared, what)
                spent[label].append(photo.measured_ms * 1e-3)
                if not last:
                    taken = spread(spent[label])
                    points.append(Point(label, taken, difference_dn(photo, whole), _note(what)))
        yield Curve(name, tuple(points))


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
