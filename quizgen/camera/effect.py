"""What an effect is: one module with its settings, its work, its bound, and how it is seen."""

from __future__ import annotations

import math
from collections.abc import Callable

import msgspec

from quizgen.camera.pixels.tiles import TileOperation, apply_tilewise
from quizgen.camera.raster.rasterizer import Layer, LayerStack, composite_layers
from quizgen.camera.setup.scene import Image, Scene
from quizgen.camera.setup.settings import AnySetting
from quizgen.camera.setup.view import Signal, View

EffectRun = Callable[[LayerStack, View], LayerStack]


def on_composite(work: Callable[[Image, View], Image]) -> EffectRun:
    """Return an effect's run that composites the layers and hands one picture to ``work``."""

    def run(stack: LayerStack, view: View) -> LayerStack:
        """Return a stack of one layer: what ``work`` makes of the composited picture."""
        return (Layer(work(composite_layers(stack), view)),)

    return run


class LayerByLayer(msgspec.Struct, frozen=True):
    """A run of an effect that averages values within each layer and looks at no other layer.

    Such effects in a row are finished for one layer before the next is looked at, and an even
    layer, whose averages are all the same, is left as it is.

    Parameters
    ----------
    operation : callable
        ``operation(layer, view)`` gives the layer afterwards.
    """

    operation: Callable[[Layer, View], Layer]

    def __call__(self, stack: LayerStack, view: View) -> LayerStack:
        """Return the layers after this effect alone."""
        return tuple(self.operation(layer, view) for layer in stack)


class PointByPoint(msgspec.Struct, frozen=True):
    """A run of an effect in which every value depends on its own pixel alone.

    Such effects in a row share one pass over the picture.

    Parameters
    ----------
    operation : callable
        ``operation(view)`` gives what changes a piece in place, see `quizgen.camera.pixels.tiles`.
    """

    operation: Callable[[View], TileOperation]

    def __call__(self, stack: LayerStack, view: View) -> LayerStack:
        """Return the composited picture after this effect alone."""
        return (Layer(apply_tilewise(composite_layers(stack), [self.operation(view)])[0]),)


class EffectSize(msgspec.Struct, frozen=True):
    """What an effect does to a picture in its own terms, and from what size a person sees it.

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
    """All that the camera knows of one effect.

    Its settings, how it runs, what leaving it out costs.

    Parameters
    ----------
    name : str
        The field's term; the module is called so too, and the stream of its random numbers.
    answers : tuple of str
        Kinds of question whose answer is this effect.
    settings : tuple of Setting
        Keys of ``[camera]`` that belong to it alone.
    is_present : callable
        Whether the camera's settings differ from the identity.
    run : callable
        ``run(stack, view) -> stack``; see `on_composite` and `PointByPoint`.
    omission_bound : callable
        ``omission_bound(signal, view)``: no value of a picture changes by more if it is left out
        (1 = white; ``signal`` is what comes in). By default anything, so that it never is.
    carry_error : callable
        ``carry_error(error, signal, view)``: how far two pictures are apart after it that were so
        far apart before. By default as far, as after averages, shifts and additions.
    range_after : callable
        ``range_after(signal, view)``: the `Signal` of what comes out, by default of what comes in.
    size : EffectSize, optional
        What it does, in its own terms; without one only differences in grey levels are reported.
    speckles : bool
        Whether it is seen by the spread of single pixels, as noise is.
    needs_effects : tuple of str
        Effects without which its picture is wrong, such as vignetting before a flat field.
    pair : str
        Effects with the same pair run together or not at all.
    margin : callable
        How far outside a view the light of its pixels can come from, across and down, px; by
        default from nowhere else.
    check_camera : callable
        Raises `SceneError` if it cannot be computed for a camera before a picture of this size.
    prepare : callable, optional
        ``prepare(scene, view) -> scene``, before anything is drawn.
    always : str
        Why it runs whatever is asked; empty where it is left out unless it is asked about.
    needs : str
        What its settings do nothing without.
    """

    name: str
    answers: tuple[str, ...]
    settings: tuple[AnySetting, ...] = ()
    is_present: Callable[[View], bool]
    run: EffectRun
    omission_bound: Callable[[Signal, View], float] = lambda *_: math.inf
    carry_error: Callable[[float, Signal, View], float] = lambda error, *_: error
    range_after: Callable[[Signal, View], Signal] = lambda signal, _: signal
    size: EffectSize | None = None
    speckles: bool = False
    needs_effects: tuple[str, ...] = ()
    pair: str = ""
    margin: Callable[[View], tuple[float, float]] = lambda _: (0.0, 0.0)
    check_camera: Callable[[View], object] = lambda _: None
    prepare: Callable[[Scene, View], Scene] | None = None
    always: str = ""
    needs: str = ""
