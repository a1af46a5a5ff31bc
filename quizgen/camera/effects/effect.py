"""What an effect is: one module with its settings, its work, its bound, and how it is seen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import msgspec

from quizgen.camera.blocks import Work, in_turn
from quizgen.camera.raster.draw import Layer, Stack, composite
from quizgen.camera.scene import Image, Scene
from quizgen.camera.setup.settings import AnySetting
from quizgen.camera.view import Signal, View

Stage = Literal["scene", "optics", "sensor", "processing", "edit"]


Run = Callable[[Stack, View], Stack]
Bound = Callable[[Signal, View], float]
Carry = Callable[[float, Signal, View], float]


def _bound_nothing(signal: Signal, view: View) -> float:
    """Nothing is known: leaving it out may change everything."""
    return float("inf")


def keep_error(error: float, signal: Signal, view: View) -> float:
    """Differences pass through unchanged (averages, shifts, additions)."""
    return error


def keep_range(signal: Signal, view: View) -> Signal:
    """No value leaves the range (averages, shifts)."""
    return signal


def look_nowhere(view: View) -> tuple[float, float]:
    """Every pixel comes from inside the picture."""
    return 0.0, 0.0


def keep_stack(stack: Stack, view: View) -> Stack:
    """Nothing is left to do once the scene is drawn."""
    return stack


def _accept(view: View) -> None:
    """Nothing can be wrong with it."""


def on_picture(work: Callable[[Image, View], Image]) -> Run:
    """Work on one picture: the layers are laid over each other first."""

    def run(stack: Stack, view: View) -> Stack:
        return (Layer(work(composite(stack), view)),)

    return run


class LayerByLayer(msgspec.Struct, frozen=True):
    """A run that takes averages of each layer's values, and looks at no other layer.

    Such effects in a row are finished for one layer before the next is looked at, and an even
    layer, whose averages are all the same, is left as it is.

    Parameters
    ----------
    work : callable
        ``work(layer, view)`` gives the layer afterwards.
    """

    work: Callable[[Layer, View], Layer]

    def __call__(self, stack: Stack, view: View) -> Stack:
        """Run it alone."""
        return tuple(self.work(layer, view) for layer in stack)


class PointByPoint(msgspec.Struct, frozen=True):
    """A run in which every value depends on its own pixel alone.

    Such effects in a row share one pass over the picture.

    Parameters
    ----------
    work : callable
        ``work(view)`` gives what changes a piece in place, see `quizgen.camera.blocks`.
    """

    work: Callable[[View], Work]

    def __call__(self, stack: Stack, view: View) -> Stack:
        """Run it alone."""
        return (Layer(in_turn(composite(stack), [self.work(view)])[0]),)


class Size(msgspec.Struct, frozen=True):
    """What an effect does to a picture, in its own terms, and from where on a person sees it.

    Parameters
    ----------
    of : callable
        The size for a view in px.
    says : str
        A phrase with ``{:.3g}`` for it, its verb first: ``move points by up to {:.3g} px``.
    least : float
        The smallest size that is seen.
    """

    of: Callable[[View], float]
    says: str
    least: float = 0.0


class Effect(msgspec.Struct, frozen=True, kw_only=True):
    """All that the camera knows of an effect.

    Parameters
    ----------
    name : str
        The field's term; the module is called so too, and the stream of its random numbers.
    stage : str
        Up to ``optics`` layers are kept apart.
    answers : tuple of str
        Kinds of question whose answer is this effect.
    settings : tuple of Setting
        Keys of ``[camera]`` that belong to it alone.
    is_present : callable
        Whether the camera's settings differ from the identity.
    run : callable
        ``run(stack, view) -> stack``; see `on_picture` and `PointByPoint`.
    omission_bound : callable
        ``omission_bound(signal, view)``: no value of a picture changes by more if it is left out
        (1 = white; ``signal`` is what comes in). By default anything, so that it never is.
    carry_error : callable
        ``carry_error(error, signal, view)``: how far two pictures are apart after it that were so
        far apart before.
    range_after : callable
        ``range_after(signal, view)``: the `Signal` of what comes out.
    size : Size, optional
        What it does, in its own terms; without one only differences in grey levels are told.
    speckles : bool
        Whether it is seen by the spread of single pixels, as noise is.
    needs_effects : tuple of str
        Effects without which its picture is wrong, such as vignetting before a flat field.
    pair : str
        Effects with the same pair run together or not at all.
    outside : callable
        How far outside a view the light of its pixels can come from, across and down, px.
    check : callable
        Raises `SceneError` if it cannot be computed for a camera before a picture of this size.
    prepare : callable, optional
        ``prepare(scene, view) -> scene``, before anything is drawn.
    always : str
        Why it runs whatever is asked; empty where it is left out unless it is asked about.
    needs : str
        What its settings do nothing without.
    """

    name: str
    stage: Stage
    answers: tuple[str, ...]
    settings: tuple[AnySetting, ...] = ()
    is_present: Callable[[View], bool]
    run: Run
    omission_bound: Bound = _bound_nothing
    carry_error: Carry = keep_error
    range_after: Callable[[Signal, View], Signal] = keep_range
    size: Size | None = None
    speckles: bool = False
    needs_effects: tuple[str, ...] = ()
    pair: str = ""
    outside: Callable[[View], tuple[float, float]] = look_nowhere
    check: Callable[[View], None] = _accept
    prepare: Callable[[Scene, View], Scene] | None = None
    always: str = ""
    needs: str = ""
