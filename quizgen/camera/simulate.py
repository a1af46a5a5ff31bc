"""Run a plan and keep the times."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import groupby
from time import perf_counter

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera import effects
from quizgen.camera.blocks import BLOCK, Tile, Work, in_turn, pieces, tiles
from quizgen.camera.camera import Camera
from quizgen.camera.chain import GREY_LEVELS, SKIP
from quizgen.camera.codes import rounded
from quizgen.camera.decision import Chosen, Decision, Levels, Plan
from quizgen.camera.draw import Layer, Sheet, Stack, composite, lay_over, sheets
from quizgen.camera.effect import Effect, LayerByLayer, PointByPoint
from quizgen.camera.facts import EXCEEDED
from quizgen.camera.filters import warm_up
from quizgen.camera.levels import by_level
from quizgen.camera.margins import cropped, moved_together
from quizgen.camera.plan import Prepared, decided, everything
from quizgen.camera.scene import Image, Scene
from quizgen.camera.view import View
from quizgen.outside import located


class Photo(msgspec.Struct, frozen=True):
    """A simulated picture.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (H, W, 3), 1 = white, of the scene's precision; an ideal camera returns its input
        untouched.
    what : Plan or Decision
        What was run and what was left out.
    times : dict of str to float
        Measured ms per effect that ran.
    drawn_ms : float
        Time for drawing the scene, which is no effect.
    shares : tuple of float
        Share of the pixels that is darker than the first of the plan's levels, and that of each.
    uneven : dict of str to float
        Share of the layers' pixels in which lens, blur and movement found anything to change.
    """

    values: Image
    what: Plan | Decision
    times: dict[str, float]
    drawn_ms: float
    shares: tuple[float, ...] = (1.0,)
    uneven: Mapping[str, float] = {}

    @property
    def plan(self) -> Plan:
        """What was run and what was left out, with reasons."""
        return self.what if isinstance(self.what, Plan) else self.what.plan

    def share(self, effect: str) -> float:
        """Share of the pixels, or of those of the layers, that an effect has worked on."""
        if effect in self.uneven:
            return self.uneven[effect]
        there = zip(self.shares[1:], self.what.levels.each, strict=True)
        return 1.0 - sum(share for share, level in there if level.ways.get(effect) == SKIP)

    @property
    def measured_ms(self) -> float:
        """Time of all effects."""
        return sum(self.times.values())

    def pixels(self) -> NDArray[np.uint8]:
        """8-bit codes, halves rounded upward."""
        flat = self.values.reshape(-1)
        codes = np.empty(flat.shape, np.uint8)
        for start, stop in pieces(flat.size, BLOCK):
            codes[start:stop] = rounded(flat[start:stop] * GREY_LEVELS)
        return codes.reshape(self.values.shape)


def silent(name: str) -> None:
    """Nobody wants to know what is done now."""


def run(
    prepared: Prepared,
    what: Plan | Decision,
    told: Callable[[str], None] = silent,
    *,
    last: bool = False,
) -> Photo:
    """Run the steps of a plan on a scene.

    Parameters
    ----------
    prepared : Prepared
    what : Plan or Decision
    told : callable
        Gets the names of effects before they run.
    last : bool
        Whether the drawn layers are not needed afterwards: each is let go once it is photographed.
    """
    with located(prepared.given.scene.file):
        if what.steps:
            warm_up()
        return _Run(prepared, told, last=last).photo(what)


class _Run:
    """One run of a plan: the layers, whether the picture may be written over, and the times."""

    def __init__(self, prepared: Prepared, told: Callable[[str], None], *, last: bool) -> None:
        self.frame, self.told = prepared.view, told
        names = (effect.name for effect in prepared.present)
        self.views = dict(zip(names, prepared.views, strict=True))
        self.times = dict(prepared.prepared_ms)
        self.stack = list(prepared.stack)
        self.drawn_ms = prepared.drawn_ms
        self.places: list[list[Tile]] = []
        self.worked: dict[str, tuple[float, int]] = {}
        self.kept = [self.frame.scene.image, *(() if last else (x.colour for x in self.stack))]
        if last:
            del prepared.stack

    def photo(self, what: Plan | Decision) -> Photo:
        done = 0
        for (kind, later), group in groupby(what.steps, _ways(what.levels)):
            steps = tuple(group)
            done += len(steps)
            if later and not self.places:
                self._look(what.levels)
            if kind is LayerByLayer:
                then = (self._view(step) for step in what.steps[done:])
                self._layer_by_layer(steps, next(then, self.frame))
            elif kind is PointByPoint:
                self._in_one_pass(steps, what.levels)
            else:
                for step in steps:
                    self._one(step)
        self._crop(self.frame)
        times = {step.effect: self.times.get(step.effect, 0.0) for step in what.steps}
        uneven = {effect: worked / pixels for effect, (worked, pixels) in self.worked.items()}
        picture = composite(tuple(self.stack))
        return Photo(picture, what, times, self.drawn_ms, self._shares(), uneven)

    def _look(self, levels: Levels) -> None:
        """Sort the tiles of the picture by brightness."""
        self._crop(self.frame)
        picture = composite(tuple(self.stack))
        self.stack, self.places = [Layer(picture)], by_level(picture, levels)

    def _shares(self) -> tuple[float, ...]:
        """Share of the pixels at each level."""
        sizes = [sum(tile.pixels for tile in among) for among in self.places]
        return tuple(size / sum(sizes) for size in sizes) or (1.0,)

    def _count(self, step: Chosen, started: float) -> None:
        spent = (perf_counter() - started) * 1e3
        self.times[step.effect] = self.times.get(step.effect, 0.0) + spent

    def _count_pixels(self, step: Chosen, layer: Layer) -> None:
        pixels = layer.colour.shape[0] * layer.colour.shape[1]
        worked, among = self.worked.get(step.effect, (0.0, 0))
        self.worked[step.effect] = worked + layer.worked * pixels, among + pixels

    def _view(self, step: Chosen) -> View:
        """What an effect works on; one that the camera does not have looks at nothing outside."""
        return self.views.get(step.effect, self.frame)

    def _crop(self, view: View) -> None:
        self.stack = [cropped(layer, view) for layer in self.stack]

    def _one(self, step: Chosen) -> None:
        self.told(step.effect)
        started, view = perf_counter(), self._view(step)
        self._crop(view)
        self.stack = list(_effect(step).run(tuple(self.stack), view, step.rung))
        self._count(step, started)

    def _layer_by_layer(self, steps: tuple[Chosen, ...], then: View) -> None:
        """Finish each layer and lay it over those behind, so that few are there at a time.

        Each effect gets no more than it and the later ones need, the last leaves what comes then.
        """
        self.told(_names(steps))
        picture: Image | None = None
        while self.stack:
            drawn = self.stack.pop(0)
            layer, even = replace(drawn, own=self._ours(drawn.colour)), drawn.even
            for step in steps:
                started, view = perf_counter(), self._view(step)
                layer = replace(cropped(layer, view), worked=0.0)
                if not even:
                    (layer,) = _effect(step).run((layer,), view, step.rung)
                self._count(step, started)
                self._count_pixels(step, layer)
            picture = self._over(layer, picture, then)
        self.stack = [Layer(picture)] if picture is not None else []

    def _over(self, layer: Layer, behind: Image | None, view: View) -> Image:
        if behind is None and self._ours(layer.colour):
            return moved_together(layer.colour, view)
        layer = cropped(layer, view)
        if behind is None:
            return layer.colour
        return lay_over(layer, behind if self._ours(behind) else behind.copy())

    def _ours(self, picture: Image) -> bool:
        others = (other for other in self.kept if other is not None)
        return not any(np.may_share_memory(picture, other) for other in others)

    def _in_one_pass(self, steps: tuple[Chosen, ...], levels: Levels) -> None:
        """Effects that look at one pixel only, while a tile of the picture is at hand."""
        self.told(_names(steps))
        started, view = perf_counter(), self._view(steps[-1])
        self._crop(view)
        picture = composite(tuple(self.stack))
        self.stack = []
        own = picture.flags.c_contiguous and self._ours(picture)
        result, clock = picture if own else np.empty_like(picture), dict.fromkeys(steps, 0.0)
        for level, among in enumerate(self.places or [list(tiles(picture.shape))]):
            works = dict(_works(steps, levels.each[level - 1].ways if level else {}, view))
            _, spent = in_turn(picture, list(works.values()), into=result, among=among)
            for step, took in zip(works, spent.tolist(), strict=True):
                clock[step] += took
        each = (perf_counter() - started) * 1e3 / (sum(clock.values()) or 1.0)
        self.times.update((step.effect, each * took) for step, took in clock.items())
        self.stack = [Layer(result)]


def _works(
    steps: tuple[Chosen, ...], ways: Mapping[str, str], view: View
) -> Iterator[tuple[Chosen, Work]]:
    """What is done at one level."""
    for step in steps:
        run, way = _effect(step).run, ways.get(step.effect, step.rung)
        if isinstance(run, PointByPoint) and way != SKIP:
            yield step, run.work(view, way)


def _ways(levels: Levels) -> Callable[[Chosen], tuple[type, bool]]:
    """How an effect is run, and whether brightness may decide about it."""
    order = {effect.name: place for place, effect in enumerate(effects.EFFECTS)}
    since = order.get(levels.since, len(order))
    return lambda step: (type(_effect(step).run), bool(levels.each) and order[step.effect] >= since)


def _effect(step: Chosen) -> Effect:
    return effects.by_name(step.effect)


def _names(steps: tuple[Chosen, ...]) -> str:
    return ", ".join(step.effect for step in steps)


def simulate(
    scene: Scene,
    camera: Camera,
    question: str | tuple[str, ...] | None = None,
    budget: str | float = 0.5,
) -> Photo:
    """Plan and run.

    Parameters
    ----------
    scene : Scene
    camera : Camera
    question : str or tuple of str, optional
        Kinds of question asked about the picture; by default the scene's own.
    budget : float or str
        Grey levels, see `quizgen.camera.plan.plan`.
    """
    prepared = Prepared(scene, camera)
    return run(prepared, decided(prepared, question, budget), last=True)


def simulate_everything(scene: Scene, camera: Camera) -> Photo:
    """Run every present effect exactly, for comparison."""
    prepared = Prepared(scene, camera)
    return run(prepared, everything(prepared), last=True)


def photographs(scene: Scene, *cameras: Camera) -> tuple[Photo, ...]:
    """One scene by several cameras, every present effect exactly.

    Cameras that see the same layers share them, so that they are drawn once.
    """
    drawn: dict[tuple[tuple[Sheet, ...], tuple[int, int]], Stack] = {}
    photos = []
    for camera in cameras:
        prepared = Prepared(scene, camera)
        view = (*prepared.views, prepared.view)[0]
        seen = sheets(view), view.margin
        prepared.stack = drawn.get(seen) or prepared.stack
        drawn[seen] = prepared.stack
        photos.append(run(prepared, everything(prepared, timed=False)))
    return tuple(photos)


def difference_dn(planned: Photo, whole: Photo) -> float:
    """Difference of two pictures in 8-bit grey levels, before rounding.

    The largest one; where noise was skipped, the largest but for the share `EXCEEDED` of the
    values, which is what the plan's bound is about.
    """
    if planned.values is whole.values:
        return 0.0
    apart = _apart(planned, whole)
    if not _random_differs(planned.plan):
        return float(apart.max())
    allowed = int(EXCEEDED * apart.size)
    return float(np.partition(apart, apart.size - 1 - allowed)[apart.size - 1 - allowed])


def farthest_dn(one: Photo, other: Photo) -> float:
    """Largest difference of two pictures by the same plan, in 8-bit grey levels before rounding."""
    return float(_apart(one, other).max())


def _apart(planned: Photo, whole: Photo) -> Image:
    """Difference of every value in grey levels."""
    return np.abs(planned.values - whole.values).reshape(-1) * GREY_LEVELS


_SLACK = 1e-4
"""Grey levels that single precision may add."""
_CHANCE = 1e-9
"""Chance that a promise that holds is called broken."""


def is_broken(planned: Photo, whole: Photo) -> bool:
    """Whether two pictures differ by more than the plan promised.

    Without noise, if a single value does. With noise, if so many do that it happens to a kept
    promise (a share `EXCEEDED` of the values, each on its own) at most once in 10^9 pictures.
    """
    if planned.values is whole.values:
        return False
    apart = _apart(planned, whole)
    if not np.isfinite(apart).all():
        return True
    beyond = int((apart > planned.plan.predicted_error_dn + _SLACK).sum())
    if not _random_differs(planned.plan):
        return beyond > 0
    return _rarity(beyond, apart.size) < _CHANCE


def _rarity(beyond: int, count: int) -> float:
    """Chernoff's bound on the chance of at least so many events of probability `EXCEEDED`."""
    share = beyond / count
    if share <= EXCEEDED:
        return 1.0
    apart = share * math.log(share / EXCEEDED)
    if share < 1.0:
        apart += (1.0 - share) * math.log((1.0 - share) / (1.0 - EXCEEDED))
    return math.exp(-count * apart)


def _random_differs(what: Plan) -> bool:
    """Whether noise was skipped, or runs on a signal that is not exactly the same."""
    names = {item.effect for item in what.skipped} | {s.effect for s in what.steps if s.rung}
    names.update(name for level in what.levels.each for name in level.ways)
    there = {step.effect for step in what.steps} | names
    return bool(names) and any(effects.by_name(name).random for name in there)
