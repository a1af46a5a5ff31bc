"""Ordinary photographs with ordinary cameras: what plans leave out, and what could be left out.

Run by ``python benchmarks/camera.py --photos [N]`` and ``--oracle [N]``.
"""

# ruff: noqa: SLF001 - caches are emptied between runs

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial
from time import process_time
from typing import Any

import msgspec
import numpy as np

from quizgen.arrays.gamma import srgb_decode
from quizgen.camera import Camera, Scene, SceneError, effects
from quizgen.camera.blocks import tiles
from quizgen.camera.chain import GREY_LEVELS, SKIP, Chain
from quizgen.camera.decision import Decision, Plan, Skipped
from quizgen.camera.effects import distortion, vignetting
from quizgen.camera.look import measured
from quizgen.camera.plan import Prepared, decided, everything, plan
from quizgen.camera.simulate import Photo, difference_dn, is_broken, run

TURNS = 5
BUDGETS = 0.5, 2.0, 8.0
"""Grey levels."""
SLOWER = 0.98
"""Everything takes less than so much of the time of a plan that is slower than everything."""
LEAST_DN = 0.01
"""Grey levels below which a ratio says nothing."""
PHOTOS = ("astronaut", "camera", "cat", "coffee", "coins", "moon", "page", "text")
"""Pictures that come with scikit-image."""


def a_photo(source: np.random.Generator, height: int = 480) -> Scene:
    """A piece of a photograph, 4 : 3, in linear light."""
    from skimage import data, transform

    codes = np.atleast_3d(getattr(data, PHOTOS[source.integers(len(PHOTOS))])())[..., :3] / 255.0
    left = int(source.integers(codes.shape[1] // 4))
    piece = codes[:, left : left + codes.shape[1] * 3 // 4]
    width = height * 4 // 3
    light = srgb_decode(np.clip(transform.resize(piece, (height, width), anti_aliasing=True), 0, 1))
    image = np.broadcast_to(light, (height, width, 3)).astype(np.float32)
    seed = int(source.integers(1 << 30))
    return Scene(width, height, image=image, depth=float(source.uniform(2, 20)), seed=seed)


def a_camera(source: np.random.Generator, width: int) -> Camera:
    """What people own: about ten effects, each of an ordinary size."""

    def maybe(chance: float, low: float, high: float, otherwise: Any = 0.0) -> Any:
        drawn = float(np.exp(source.uniform(np.log(low), np.log(high))))
        return drawn if source.random() < chance else otherwise

    sign = source.choice([-1.0, 1.0], 3)
    return Camera(
        float(source.uniform(0.024, 0.085)), 0.0236 / width,
        f_number=maybe(0.8, 1.4, 22, None), focus_distance=float(source.uniform(2, 20)),
        k1=float(sign[0]) * maybe(0.6, 0.001, 0.3), lateral_colour=maybe(0.4, 0.05, 1.0),
        natural_vignetting=bool(source.random() < 0.5), mechanical_vignetting=maybe(0.3, 0.05, 0.5),
        shutter=maybe(1.0, 0.001, 0.06), row_time=maybe(0.4, 1e-6, 3e-5),
        velocity=(float(sign[1]) * maybe(0.5, 1, 200), 0.0),
        exposure=float(sign[2]) * maybe(0.3, 0.1, 1.0), full_well=maybe(1.0, 5e3, 1e5),
        read_noise=maybe(0.9, 1, 10), dark_current=maybe(0.5, 0.05, 5),
        smear=maybe(0.1, 1e-4, 0.01),
        bit_depth=int(source.integers(8, 15)), mosaic="RGGB" if source.random() < 0.3 else "",
        white_balance=(maybe(0.4, 1, 2, 1.0), 1.0, maybe(0.4, 1, 2, 1.0)), gamma="srgb",
    )  # fmt: skip


def _everything(prepared: Prepared) -> Plan:
    return everything(prepared, timed=False)


def busy(
    scene: Scene, camera: Camera, decide: Callable[[Prepared], Plan | Decision]
) -> tuple[float, Photo]:
    """Processor time of deciding and of the effects, s, and the picture.

    It is drawn before the clock starts, with all lengths in px, as any way needs that.
    """
    prepared = Prepared(scene, camera)
    prepared.stack  # noqa: B018 - drawn when first asked for
    forget_maps()
    started = process_time()
    photo = run(prepared, decide(prepared), last=True)
    return process_time() - started, photo


def planning(scene: Scene, camera: Camera, budget: float) -> float:
    """Processor time of a plan alone, s; what everything needs as well is there before."""
    times = []
    for _ in range(TURNS):
        prepared = Prepared(scene, camera)
        prepared.stack  # noqa: B018 - drawn, and all lengths in px, before the clock starts
        started = process_time()
        decided(prepared, budget=budget)
        times.append(process_time() - started)
    return min(times)


class _Turns:
    """Everything, everything once more, and plans of one scene, one after the other."""

    def __init__(self, scene: Scene, camera: Camera, turns: int = TURNS) -> None:
        ways = {"everything": _everything, "again": _everything}
        for budget in BUDGETS:
            ways[f"{budget:g}"] = partial(decided, budget=budget)
        found = [
            {way: busy(scene, camera, decide) for way, decide in ways.items()} for _ in range(turns)
        ]
        self.spent = {way: min(turn[way][0] for turn in found) for way in ways}
        self.photos = {way: found[0][way][1] for way in ways}
        self.planning = {budget: planning(scene, camera, budget) for budget in BUDGETS}

    def ratio(self, way: str) -> float:
        """How many times longer everything takes than this way."""
        return self.spent["everything"] / self.spent[way]

    def skipped(self, way: str) -> float:
        """Share of the effects left out; one left out in a part of the picture counts by that."""
        photo, whole = self.photos[way], self.photos["everything"]
        ran = sum(photo.share(step.effect) for step in photo.plan.steps)
        return 1.0 - ran / (sum(map(whole.share, whole.times)) or 1.0)

    def broken(self, way: str) -> bool:
        """Whether a promise is."""
        return is_broken(self.photos[way], self.photos["everything"])


def photos(count: int, height: int = 480) -> None:
    """What is skipped, what that saves with planning included, and whether promises are kept."""
    found = []
    for seed in range(count):
        source = np.random.default_rng([seed, 12])
        scene = a_photo(source, height)
        with suppress(SceneError):  # the picture folds over
            found.append(_Turns(scene, a_camera(source, scene.width)))
    broken = sum(turns.broken(f"{budget:g}") for turns in found for budget in BUDGETS)
    print(f"{len(found)} photographs ({count - len(found)} refused), {broken} broken promises")
    whole = sum(turns.spent["everything"] for turns in found)
    for budget in BUDGETS:
        way = f"{budget:g}"
        skipped = np.mean([turns.skipped(way) for turns in found])
        took = sum(turns.planning[budget] for turns in found)
        print(
            f"  {way:>3} DN: {skipped:6.1%} of the effects skipped, {_faster(found, way)},"
            f" planning {took / whole:.1%} ({took / len(found) * 1e3:.2f} ms)"
        )
    print(f"  everything against itself: {_faster(found, 'again')}")


def _faster(found: list[_Turns], way: str) -> str:
    ratios = np.array([turns.ratio(way) for turns in found])
    slower = (ratios < SLOWER).sum()
    return f"everything / this x{np.exp(np.log(ratios).mean()):.2f} (CPU), slower in {slower}"


def shipped(scenes: Iterable[tuple[str, Scene, Camera]]) -> None:
    """The same of each shipped scene."""
    for name, scene, camera in scenes:
        turns = _Turns(scene, camera, 3 * TURNS)
        ways = ", ".join(
            f"{way} DN x{turns.ratio(way):.2f} ({turns.skipped(way):.0%})"
            for way in (f"{budget:g}" for budget in BUDGETS)
        )
        whole = turns.spent["everything"] * 1e3
        print(f"{name:10}{whole:7.1f} ms  {ways}  itself x{turns.ratio('again'):.2f}")


def oracle(count: int, height: int = 480) -> None:
    """Per effect: how often it could be left out, how often a plan does, and at what bound.

    Bounds are those from the steps of all pixels, whether a plan would look at them or not.
    The oracle looks at what really changes: effects in the order of what each alone does, as long
    as all together stay within the budget. By tile, each effect has the whole budget, in those
    tiles where it changes less.
    """
    budgets = (0.5, 2.0)
    rows: dict[str, list[tuple[float, ...]]] = {}
    for seed in range(count):
        source = np.random.default_rng([seed, 12])
        scene = a_photo(source, height)
        try:
            prepared = Prepared(scene, a_camera(source, scene.width))
            trial = _Trial(prepared)
        except SceneError:
            continue  # the picture folds over
        free = [trial.leaves_out(budget) for budget in budgets]
        left = [{one.effect for one in plan(prepared, budget=b).skipped} for b in budgets]
        for unit, alone in trial.alone.items():
            ways = zip(free, left, budgets, strict=True)
            counts = [
                share
                for one, other, budget in ways
                for share in (unit[0] in one, trial.tiles(unit, budget), unit[0] in other)
            ]
            bound = trial.bound(unit)
            ratio = bound / alone if alone > LEAST_DN else np.nan
            bounds = bound, alone, ratio, sum(trial.whole.times[name] for name in unit)
            rows.setdefault(" + ".join(unit), []).append((*counts, *bounds))
    _print_table(rows, budgets)


def _print_table(rows: dict[str, list[tuple[float, ...]]], budgets: tuple[float, ...]) -> None:
    """By effect how often it could be left out, then the shares of effects and of their time."""
    ways = "oracle", "by tile", "plan"
    heads = ("photos", *(f"{who} {b:g} DN" for b in budgets for who in ways))
    last = "bound DN", "real DN", "bound/real", "ms"
    print(f"{'':31}" + "".join(f"{head:>15}" for head in (*heads, *last)))
    for name, found in sorted(rows.items()):
        figures = np.array(found, float)
        bound, real, _, spent = np.median(figures[:, 6:], axis=0)
        ratios = figures[np.isfinite(figures[:, 8]), 8]
        ratio = f"{np.median(ratios):.2g}" if ratios.size else ""
        print(
            f"{name:31}{len(found):15}"
            + "".join(f"{count:15.1f}" for count in figures[:, :6].sum(0))
            + f"{bound:15.3g}{real:15.3g}{ratio:>15}{spent:15.2f}"
        )
    figures = np.concatenate([np.array(found, float) for found in rows.values()])
    for column, head in enumerate(heads[1:]):
        saved = figures[:, column] @ figures[:, 9] / figures[:, 9].sum()
        print(f"{head}: {figures[:, column].mean():.1%} of the effects, {saved:.1%} of their time")


class _Trial:
    """What leaving effects out of one photograph really changes."""

    def __init__(self, prepared: Prepared) -> None:
        self.prepared = prepared
        self.everything = everything(prepared)
        self.whole = run(prepared, self.everything)
        view, facts = prepared.view, measured(prepared.stack, prepared.view)
        self.chain = Chain(prepared.present, view, facts, prepared.views)
        units: dict[str, list[str]] = {}
        for step in self.everything.steps:
            key = effects.by_name(step.effect).pair or step.effect
            units.setdefault(key, []).append(step.effect)
        self.apart: dict[tuple[str, ...], np.ndarray] = {}
        self.alone = {}
        for unit in map(tuple, units.values()):
            photo = self.without(frozenset(unit))
            self.alone[unit] = difference_dn(photo, self.whole)
            self.apart[unit] = np.abs(photo.values - self.whole.values).max(axis=2) * 255

    def bound(self, unit: tuple[str, ...]) -> float:
        """Grey levels that leaving these out changes at most."""
        names = [effect.name for effect in self.prepared.present]
        return min(self.chain.dn({names.index(name): SKIP for name in unit}), GREY_LEVELS)

    def tiles(self, unit: tuple[str, ...], budget: float) -> float:
        """Share of the tiles in which leaving these out changes at most so much."""
        apart = self.apart[unit]
        return float(np.mean([apart[tile.place].max() <= budget for tile in tiles(apart.shape)]))

    def change(self, names: frozenset[str]) -> float:
        """Grey levels that leaving these out changes."""
        return difference_dn(self.without(names), self.whole)

    def without(self, names: frozenset[str]) -> Photo:
        """The picture that leaving these out gives."""
        kept = tuple(step for step in self.everything.steps if step.effect not in names)
        left = tuple(Skipped(name, "", 0.0, 0.0) for name in sorted(names))
        what = msgspec.structs.replace(self.everything, steps=kept, skipped=left)
        return run(self.prepared, what)

    def leaves_out(self, budget: float) -> frozenset[str]:
        left: frozenset[str] = frozenset()
        for unit, change in sorted(self.alone.items(), key=lambda pair: pair[1]):
            more = left.union(unit)
            if change <= budget and self.change(more) <= budget:
                left = more
        return left


def forget_maps() -> None:
    distortion.quadrant.cache_clear()
    distortion._kept.cache_clear()
    distortion._inverse_table.cache_clear()
    distortion.undistorted_radius.cache_clear()
    vignetting._fall_off_map.cache_clear()
