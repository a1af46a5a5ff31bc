"""A scene before a camera: what is there, drawn when first needed, and what leaving out can change.

One number follows from effect to effect: by how much any value of two pictures can be apart. What
is left out adds its bound; what runs carries the number on, as a gain does. The numbers hold for
every value, since luck and rounding have ends.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING

from msgspec.structs import replace

from quizgen.camera import effects
from quizgen.camera.effects.effect import Effect
from quizgen.camera.raster.draw import Stack, draw
from quizgen.camera.scene import Scene, SceneError
from quizgen.camera.view import Signal, View

if TYPE_CHECKING:
    from quizgen.camera.camera import Camera

GREY_LEVELS = 255.0
WIDEST = 4
"""A margin is at most this part of the frame's side, as a barrel needs that just does not fold."""
LARGEST = 1e30
"""Signals beyond this are no picture."""
_ROUNDING = 2e-6
"""What single precision adds in one step, relative to the largest value."""


class Prepared:
    """A scene in pixels, drawn when first needed.

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
        """Effects that the camera has, in physical order."""
        there = effects.present(self.given)
        return tuple(one for one in there if self.names is None or one.name in self.names)

    @cached_property
    def absent(self) -> tuple[str, ...]:
        """Names of the effects that the camera has not."""
        return tuple(one.name for one in effects.EFFECTS if one not in self.present)

    @cached_property
    def view(self) -> View:
        """Everything in px."""
        view = self.given
        for effect in self.present:
            effect.check(view)
            if effect.prepare is not None:
                started = perf_counter()
                view = replace(view, scene=effect.prepare(view.scene, view))
                self.prepared_ms[effect.name] = (perf_counter() - started) * 1e3
        return view

    @cached_property
    def views(self) -> tuple[View, ...]:
        """What each present effect works on, with its margin outside the frame."""
        return views(self.present, self.view)

    @cached_property
    def stack(self) -> Stack:
        """The drawn layers, with the margin that the first effect needs."""
        view, started = (*self.views, self.view)[0], perf_counter()
        drawn = draw(view)
        self.drawn_ms = (perf_counter() - started) * 1e3
        return drawn

    @cached_property
    def signals(self) -> tuple[Signal, ...]:
        """Between which values the picture lies before each present effect, if all run.

        Raises
        ------
        SceneError
            If an effect makes signals of more than `LARGEST`.
        """
        found, signal = [], _round(Signal(*self.view.scene.range))
        for effect, view in zip(self.present, self.views, strict=True):
            found.append(signal)
            signal = _round(effect.range_after(signal, view))
            if not signal.size < LARGEST:
                raise SceneError(f"{effect.name} makes signals of more than {LARGEST:g}")
        return tuple(found)

    def bound_omission(self, names: Collection[str]) -> float:
        """Grey levels by which no value changes when these effects are left out and others run.

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
            elif 0.0 < error < LARGEST:
                error = effect.carry_error(error, signal, view) + _ROUNDING * signal.size
        return GREY_LEVELS * error


def _round(signal: Signal) -> Signal:
    slack = _ROUNDING * signal.size
    return signal.widened(slack, slack)


def views(present: tuple[Effect, ...], frame: View) -> tuple[View, ...]:
    """What each effect works on: the frame, and what it and the later effects need around it.

    Parameters
    ----------
    present : tuple of Effect
        In physical order.
    frame : View
        All lengths in px.
    """
    found = [frame] * len(present)
    if frame.scene.image is not None:
        return tuple(found)
    view = frame
    for index in range(len(present) - 1, -1, -1):
        view = found[index] = _with_margin(view, present[index].outside(view))
    return tuple(found)


def _with_margin(view: View, reach: tuple[float, float]) -> View:
    sides = view.scene.width, view.scene.height
    wanted = (had + far for had, far in zip(view.margin, reach, strict=True))
    across, down = (
        math.ceil(min(far, side // WIDEST)) for far, side in zip(wanted, sides, strict=True)
    )
    return view if (across, down) == view.margin else replace(view, margin=(across, down))
