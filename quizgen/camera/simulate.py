"""Run effects on a scene and keep the times."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import groupby
from time import perf_counter

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.blocks import BLOCK, in_turn, pieces
from quizgen.camera.camera import Camera
from quizgen.camera.codes import rounded
from quizgen.camera.effects.effect import Effect, LayerByLayer, PointByPoint
from quizgen.camera.filters import warm_up
from quizgen.camera.prepared import GREY_LEVELS, Prepared
from quizgen.camera.raster.draw import Layer, Sheet, Stack, composite, lay_over, sheets
from quizgen.camera.raster.layers import cropped, moved_together
from quizgen.camera.scene import Image, Scene
from quizgen.camera.view import View
from quizgen.core.untrusted import error_context


class Photo(msgspec.Struct, frozen=True):
    """A simulated picture.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (H, W, 3), 1 = white, of the scene's precision; an ideal camera returns its input
        untouched.
    times : dict of str to float
        Measured ms per effect that ran, in physical order.
    drawn_ms : float
        Time for drawing the scene, which is no effect.
    """

    values: Image
    times: dict[str, float]
    drawn_ms: float

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
    names: Collection[str] | None = None,
    told: Callable[[str], None] = silent,
    *,
    last: bool = False,
) -> Photo:
    """Run effects on a scene.

    Parameters
    ----------
    prepared : Prepared
    names : collection of str, optional
        Of present effects; by default all of them.
    told : callable
        Gets the names of effects before they run.
    last : bool
        Whether the drawn layers are not needed afterwards: each is let go once it is photographed.
    """
    with error_context(prepared.given.scene.file):
        return _Run(prepared, told, last=last).photograph(names)


_Step = tuple[Effect, View]


class _Run:
    """One run: the layers, whether the picture may be written over, and the times."""

    def __init__(self, prepared: Prepared, told: Callable[[str], None], *, last: bool) -> None:
        self.frame, self.told = prepared.view, told
        self.present = list(zip(prepared.present, prepared.views, strict=True))
        self.times = dict(prepared.prepared_ms)
        self.stack = list(prepared.stack)
        self.drawn_ms = prepared.drawn_ms
        self.kept = [self.frame.scene.image, *(() if last else (x.colour for x in self.stack))]
        if last:
            del prepared.stack

    def photograph(self, names: Collection[str] | None) -> Photo:
        steps = [one for one in self.present if names is None or one[0].name in names]
        if steps:
            warm_up()
        done = 0
        for kind, group in groupby(steps, lambda step: type(step[0].run)):
            some = list(group)
            done += len(some)
            if kind is LayerByLayer:
                then = steps[done][1] if done < len(steps) else self.frame
                self._run_layers(some, then)
            elif kind is PointByPoint:
                self._run_points(some)
            else:
                for step in some:
                    self._run_one(step)
        self._crop(self.frame)
        times = {effect.name: self.times.get(effect.name, 0.0) for effect, _ in steps}
        return Photo(composite(tuple(self.stack)), times, self.drawn_ms)

    def _count(self, effect: Effect, started: float) -> None:
        spent = (perf_counter() - started) * 1e3
        self.times[effect.name] = self.times.get(effect.name, 0.0) + spent

    def _crop(self, view: View) -> None:
        self.stack = [cropped(layer, view) for layer in self.stack]

    def _run_one(self, step: _Step) -> None:
        effect, view = step
        self.told(effect.name)
        started = perf_counter()
        self._crop(view)
        self.stack = list(effect.run(tuple(self.stack), view))
        self._count(effect, started)

    def _run_layers(self, steps: list[_Step], then: View) -> None:
        """Finish each layer and lay it over those behind, so that few are there at a time.

        Each effect gets no more than it and the later ones need, the last leaves what comes then.
        """
        self.told(_names(steps))
        picture: Image | None = None
        while self.stack:
            drawn = self.stack.pop(0)
            layer, even = replace(drawn, own=self._is_ours(drawn.colour)), drawn.even
            for effect, view in steps:
                started = perf_counter()
                layer = cropped(layer, view)
                if not even:
                    (layer,) = effect.run((layer,), view)
                self._count(effect, started)
            picture = self._lay(layer, picture, then)
        self.stack = [Layer(picture)] if picture is not None else []

    def _lay(self, layer: Layer, behind: Image | None, view: View) -> Image:
        if behind is None and self._is_ours(layer.colour):
            return moved_together(layer.colour, view)
        layer = cropped(layer, view)
        if behind is None:
            return layer.colour
        return lay_over(layer, behind if self._is_ours(behind) else behind.copy())

    def _is_ours(self, picture: Image) -> bool:
        others = (other for other in self.kept if other is not None)
        return not any(np.may_share_memory(picture, other) for other in others)

    def _run_points(self, steps: list[_Step]) -> None:
        """Effects that look at one pixel only, while a tile of the picture is at hand."""
        self.told(_names(steps))
        started, view = perf_counter(), steps[-1][1]
        self._crop(view)
        picture = composite(tuple(self.stack))
        self.stack = []
        own = picture.flags.c_contiguous and self._is_ours(picture)
        works = [one.run.work(view) for one, _ in steps if isinstance(one.run, PointByPoint)]
        result, clock = in_turn(picture, works, into=picture if own else np.empty_like(picture))
        each = (perf_counter() - started) * 1e3 / (float(clock.sum()) or 1.0)
        for (effect, _), took in zip(steps, clock.tolist(), strict=True):
            self.times[effect.name] = each * took
        self.stack = [Layer(result)]


def _names(steps: list[_Step]) -> str:
    return ", ".join(effect.name for effect, _ in steps)


def simulate_everything(scene: Scene, camera: Camera) -> Photo:
    """Photograph a scene with every present effect."""
    return run(Prepared(scene, camera), last=True)


def photographs(scene: Scene, *cameras: Camera) -> tuple[Photo, ...]:
    """One scene by several cameras, every present effect.

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
        photos.append(run(prepared))
    return tuple(photos)


def measure_difference(one: Photo, other: Photo) -> float:
    """Largest difference of two pictures in 8-bit grey levels, before rounding."""
    if one.values is other.values:
        return 0.0
    return float(np.abs(one.values - other.values).max()) * GREY_LEVELS


_SLACK = 1e-4
"""Grey levels that single precision may add to a difference."""


def is_within(bound_dn: float, one: Photo, other: Photo) -> bool:
    """Whether two pictures are no farther apart than a bound on every value says."""
    return measure_difference(one, other) <= bound_dn + _SLACK
