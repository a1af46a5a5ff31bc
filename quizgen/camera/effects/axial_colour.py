"""Axial colour: glass bends blue more than red, so each colour has a focus of its own."""

from __future__ import annotations

from msgspec.structs import replace

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.raster import depth_blur
from quizgen.camera.raster.rasterizer import Layer
from quizgen.camera.setup.settings import (
    F_NUMBER,
    FOCAL_LENGTH,
    PIXEL_PITCH,
    Setting,
    SettingRule,
)
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import View

AXIAL_COLOUR = Setting(
    "axial_colour", quantity_parser("m"), 0.0,
    (
        SettingRule[object](
            lambda _, camera: camera[F_NUMBER] is not None,
            "needs f_number: every colour is sharp through a point",
        ),
        SettingRule[float](
            lambda between, camera: abs(between) <= (camera[FOCAL_LENGTH] or 0.0),
            "must not exceed focal_length",
        ),
    ),
)  # fmt: skip
"""Focal length for red minus that for blue, m; `FOCAL_LENGTH` is that for green, in the middle."""

RED, GREEN, BLUE = 0, 1, 2


def blur_shifts(view: View) -> dict[int, float]:
    """Return by how many px the circles of confusion of red and blue exceed that of green.

    A colour of focal length f' makes a circle A (v (1/f' - 1/z) - 1), with the aperture A and the
    sensor at v: compared with green only 1/f' differs, by the same at every depth z.
    """
    length, number = view.camera[FOCAL_LENGTH], view.camera[F_NUMBER]
    pitch = view.camera[PIXEL_PITCH]
    if length is None or number is None or pitch is None:
        return {RED: 0.0, BLUE: 0.0}
    far = view.camera[AXIAL_COLOUR] / 2.0
    scale = length / number * view.image_distance  # aperture in m times distance in px
    own = {RED: length + far, BLUE: length - far}
    return {channel: scale * (1.0 / focal - 1.0 / length) for channel, focal in own.items()}


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer with red and blue each blurred by its own disc.

    Green is left for `defocus`.
    """
    return replace(depth_blur.blur_channels(layer, view, blur_shifts(view)), sharp=(GREEN,))


EFFECT = Effect(
    name="axial colour",
    answers=("axial colour", "artefacts"),
    settings=(AXIAL_COLOUR,),
    is_present=lambda view: view.camera[AXIAL_COLOUR] != 0.0,
    run=LayerByLayer(operation),
    # red and blue are then blurred as green is
    omission_bound=lambda signal, view: max(
        depth_blur.bound_discs(signal, view, shift) for shift in blur_shifts(view).values()
    ),
    margin=lambda view: depth_blur.blur_margin(view, tuple(blur_shifts(view).values())),
    size=EffectSize(
        lambda view: max(abs(shift) for shift in blur_shifts(view).values()),
        "make the discs of red and blue {:.3g} px wider or narrower",
        1.0,
    ),
    needs_effects=("defocus",),
)
