"""Axial colour: glass bends blue more than red, so each colour has a focus of its own."""

from __future__ import annotations

from msgspec.structs import replace

from quizgen.camera.effects.effect import Effect, LayerByLayer, Size
from quizgen.camera.kernels import moved_share
from quizgen.camera.raster import focus
from quizgen.camera.raster.draw import Layer, Sheet
from quizgen.camera.raster.layers import bound_layers
from quizgen.camera.setup.body import F_NUMBER, FOCAL_LENGTH, PIXEL_PITCH
from quizgen.camera.setup.settings import Rule, Setting, Settings
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import Signal, View


def _has_f_number(_: object, camera: Settings) -> bool:
    return camera[F_NUMBER] is not None


def _leaves_a_focus(between: float, camera: Settings) -> bool:
    return abs(between) <= (camera[FOCAL_LENGTH] or 0.0)


AXIAL_COLOUR = Setting(
    "axial_colour", quantity("m"), 0.0,
    (
        Rule(_has_f_number, "needs f_number: every colour is sharp through a point"),
        Rule(_leaves_a_focus, "must not exceed focal_length"),
    ),
)  # fmt: skip
"""Focal length for red minus that for blue, m; `FOCAL_LENGTH` is that for green, in the middle."""

RED, GREEN, BLUE = 0, 1, 2


def shifts(view: View) -> dict[int, float]:
    """By how much the circles of confusion of red and blue exceed those of green, px.

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


def work(layer: Layer, view: View) -> Layer:
    """Blur red and blue each by its own disc; what is left for `defocus` is green."""
    return replace(focus.in_channels(layer, view, shifts(view)), sharp=(GREEN,))


def omission_bound(signal: Signal, view: View) -> float:
    """Red and blue are then blurred as green is: how far two discs can be apart."""
    return max(_apart(signal, view, shift) for shift in shifts(view).values())


def _apart(signal: Signal, view: View, shift: float) -> float:
    def share(sheet: Sheet) -> float:
        if focus.is_by_depth(sheet, view):
            return focus.share_by_depth(view, 0.0) + focus.share_by_depth(view, shift)
        return moved_share(focus.disc_of(sheet, view), focus.disc_of(sheet, view, shift))

    return bound_layers(signal, view, share)


EFFECT = Effect(
    name="axial colour",
    stage="optics",
    answers=("axial colour", "artefacts"),
    settings=(AXIAL_COLOUR,),
    is_present=lambda view: view.camera[AXIAL_COLOUR] != 0.0,
    run=LayerByLayer(work),
    omission_bound=omission_bound,
    outside=lambda view: focus.outside(view, tuple(shifts(view).values())),
    size=Size(
        lambda view: max(abs(shift) for shift in shifts(view).values()),
        "make the discs of red and blue {:.3g} px wider or narrower",
        1.0,
    ),
    needs_effects=("defocus",),
)
