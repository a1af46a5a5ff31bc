"""Pixels beyond the frame: how far each effect looks, and layers cut back to what is needed."""

from __future__ import annotations

import math

from msgspec.structs import replace

from quizgen.camera.effect import Effect
from quizgen.camera.raster.rasterizer import Layer
from quizgen.camera.setup.view import View

WIDEST = 4
"""A margin is at most this part of the frame's side, as a barrel needs that just does not fold."""


def padded_views(present: tuple[Effect, ...], frame: View) -> tuple[View, ...]:
    """Return the view that each effect works on: the frame plus what later effects read around it.

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
        view = found[index] = _with_margin(view, present[index].margin(view))
    return tuple(found)


def _with_margin(view: View, reach: tuple[float, float]) -> View:
    """Return a view with whole px more on each side: across and down of ``reach``, rounded up."""
    sides = view.scene.width, view.scene.height
    wanted = (had + far for had, far in zip(view.margin, reach, strict=True))
    across, down = (
        math.ceil(min(far, side // WIDEST)) for far, side in zip(wanted, sides, strict=True)
    )
    return view if (across, down) == view.margin else replace(view, margin=(across, down))


def crop_layer(layer: Layer, view: View) -> Layer:
    """Return the middle of a layer with a wider margin, as large as a view; nothing is copied."""
    height, width = layer.colour.shape[:2]
    down, across = (height - view.height) // 2, (width - view.width) // 2
    if not down and not across:
        return layer
    part = slice(down, down + view.height), slice(across, across + view.width)
    cover, (x, y) = layer.cover, layer.motion.pivot
    motion = replace(layer.motion, pivot=(x - across, y - down))
    seen = None if cover is None else cover[part]
    return replace(layer, colour=layer.colour[part], cover=seen, motion=motion)
