"""Run effects on a scene and keep the times."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import groupby
from time import perf_counter

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from quizgen.camera.effect import Effect, LayerByLayer, PointByPoint
from quizgen.camera.padding import crop_layer
from quizgen.camera.pixels.codes import GREY_LEVELS, to_8bit
from quizgen.camera.pixels.filters import warm_up
from quizgen.camera.pixels.tiles import TILE_VALUES, apply_tilewise, split_range
from quizgen.camera.planner import PreparedScene
from quizgen.camera.raster.rasterizer import (
    Layer,
    composite_layers,
    composite_over,
)
from quizgen.camera.setup.scene import Image
from quizgen.camera.setup.view import View
from quizgen.core.untrusted import error_context


class Photo(msgspec.Struct, frozen=True):
    """A simulated picture, with the time that each effect took.

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
        """The time of all effects, ms."""
        return sum(self.times.values())

    def pixels(self) -> NDArray[np.uint8]:
        """Return 8-bit codes, shape (H, W, 3), halves rounded upward."""
        flat = self.values.reshape(-1)
        codes = np.empty(flat.shape, np.uint8)
        for start, stop in split_range(flat.size, TILE_VALUES):
            codes[start:stop] = to_8bit(flat[start:stop] * GREY_LEVELS)
        return codes.reshape(self.values.shape)


def ignore_progress(name: str) -> None:
    """Do nothing: for callers who do not follow the progress."""


def run_plan(
    prepared: PreparedScene,
    names: Collection[str] | None = None,
    on_effect: Callable[[str], None] = ignore_progress,
    *,
    last: bool = False,
) -> Photo:
    """Return the photograph that some or all effects make of a scene.

    Parameters
    ----------
    prepared : PreparedScene
    names : collection of str, optional
        Of present effects; by default all of them.
    on_effect : callable
        Gets the names of effects before they run.
    last : bool
        Whether the drawn layers are not needed afterwards: each is let go once it is photographed.
    """
    with error_context(prepared.given.scene.file):
        return _Run(prepared, on_effect, last=last).photograph(names)


_Step = tuple[Effect, View]


class _Run:
    """One run of effects: the layers, whether they may be overwritten, and the times."""

    def __init__(
        self, prepared: PreparedScene, on_effect: Callable[[str], None], *, last: bool
    ) -> None:
        self.frame, self.on_effect = prepared.view, on_effect
        self.present = list(zip(prepared.present, prepared.views, strict=True))
        self.times = dict(prepared.prepared_ms)
        self.stack = list(prepared.stack)
        self.drawn_ms = prepared.drawn_ms
        self.kept = [self.frame.scene.image, *(() if last else (x.colour for x in self.stack))]
        if last:
            del prepared.stack

    def photograph(self, names: Collection[str] | None) -> Photo:
        """Return the photograph after the effects of these names, None for all present ones."""
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
                self._run_pointwise(some)
            else:
                for step in some:
                    self._run_one(step)
        self._crop(self.frame)
        times = {effect.name: self.times.get(effect.name, 0.0) for effect, _ in steps}
        return Photo(composite_layers(tuple(self.stack)), times, self.drawn_ms)

    def _add_time(self, effect: Effect, started: float) -> None:
        """Add the ms since ``started`` (``perf_counter``) to an effect's time."""
        spent = (perf_counter() - started) * 1e3
        self.times[effect.name] = self.times.get(effect.name, 0.0) + spent

    def _crop(self, view: View) -> None:
        """Crop all layers to a view."""
        self.stack = [crop_layer(layer, view) for layer in self.stack]

    def _run_one(self, step: _Step) -> None:
        """Run one effect on the whole stack."""
        effect, view = step
        self.on_effect(effect.name)
        started = perf_counter()
        self._crop(view)
        self.stack = list(effect.run(tuple(self.stack), view))
        self._add_time(effect, started)

    def _run_layers(self, steps: list[_Step], then: View) -> None:
        """Run effects that work layer by layer, and composite each layer as soon as it is done.

        Each effect gets no more than it and the later ones need, the last leaves what comes then.
        """
        self.on_effect(", ".join(effect.name for effect, _ in steps))
        picture: Image | None = None
        while self.stack:
            drawn = self.stack.pop(0)
            layer, even = replace(drawn, own=self._is_writable(drawn.colour)), drawn.is_uniform
            for effect, view in steps:
                started = perf_counter()
                layer = crop_layer(layer, view)
                if not even:
                    (layer,) = effect.run((layer,), view)
                self._add_time(effect, started)
            picture = self._composite_layer(layer, picture, then)
        self.stack = [Layer(picture)] if picture is not None else []

    def _composite_layer(self, layer: Layer, behind: Image | None, view: View) -> Image:
        """Return the picture with a layer over it, in place where nobody else needs the memory."""
        layer = crop_layer(layer, view)
        if behind is None:
            return layer.colour
        return composite_over(layer, behind if self._is_writable(behind) else behind.copy())

    def _is_writable(self, picture: Image) -> bool:
        """Return whether a picture shares no memory with what others still need."""
        others = (other for other in self.kept if other is not None)
        return not any(np.may_share_memory(picture, other) for other in others)

    def _run_pointwise(self, steps: list[_Step]) -> None:
        """Run effects that look at one pixel only, together on each tile of the picture."""
        self.on_effect(", ".join(effect.name for effect, _ in steps))
        started, view = perf_counter(), steps[-1][1]
        self._crop(view)
        picture = composite_layers(tuple(self.stack))
        self.stack = []
        own = picture.flags.c_contiguous and self._is_writable(picture)
        works = [one.run.operation(view) for one, _ in steps if isinstance(one.run, PointByPoint)]
        result, clock = apply_tilewise(
            picture, works, into=picture if own else np.empty_like(picture)
        )
        each = (perf_counter() - started) * 1e3 / (float(clock.sum()) or 1.0)
        for (effect, _), took in zip(steps, clock.tolist(), strict=True):
            self.times[effect.name] = each * took
        self.stack = [Layer(result)]


def measure_difference(one: Photo, other: Photo) -> float:
    """Return the largest difference of two pictures in 8-bit grey levels, before rounding."""
    if one.values is other.values:
        return 0.0
    return float(np.abs(one.values - other.values).max()) * GREY_LEVELS


_SLACK = 1e-4
"""Grey levels that single precision may add to a difference."""


def is_within(bound_dn: float, one: Photo, other: Photo) -> bool:
    """Return whether two pictures are no farther apart than a bound in grey levels."""
    return measure_difference(one, other) <= bound_dn + _SLACK
