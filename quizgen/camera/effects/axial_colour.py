"""Axial colour: glass bends blue more than red, so each colour has a focus of its own."""

from __future__ import annotations

from msgspec.structs import replace

from quizgen.camera import focus
from quizgen.camera.body import F_NUMBER, FOCAL_LENGTH, PIXEL_PITCH
from quizgen.camera.costs import at_least_a_call
from quizgen.camera.draw import Layer
from quizgen.camera.effect import Effect, LayerByLayer, Rung
from quizgen.camera.facts import Error, Facts
from quizgen.camera.kernels import change_between
from quizgen.camera.layers import each, within
from quizgen.camera.settings import Rule, Setting, Settings
from quizgen.camera.values import quantity
from quizgen.camera.view import View


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


def work(layer: Layer, view: View, rung: str = "") -> Layer:
    """Blur red and blue each by its own disc; what is left for `defocus` is green."""
    return replace(focus.in_channels(layer, view, shifts(view), rung), sharp=(GREEN,))


def skipped(facts: Facts, view: View) -> Error:
    """Red and blue are then blurred as green is: how far two discs can be apart."""
    return max((_as_green(facts, view, shift) for shift in shifts(view).values()), key=_total)


def _total(error: Error) -> float:
    return error.total


def _as_green(facts: Facts, view: View, shift: float) -> Error:
    total = 0.0
    for layer, sheet, most in each(facts, view):
        if focus.by_depth(sheet, view):
            total += focus.map_error(layer, view) + focus.map_error(layer, view, shift)
        else:
            discs = focus.disc_of(sheet, view), focus.disc_of(sheet, view, shift)
            total += change_between(*discs, layer.jump, layer.bend, most)
    return within(total, facts)


def _fewer_slices(rung: str) -> Rung:
    def error(facts: Facts, view: View) -> Error:
        return focus.fewer_slices(facts, view, rung, tuple(shifts(view).values()))

    return Rung(rung, error)


def after(facts: Facts, view: View) -> Facts:
    """Red and blue do not get steeper, but at borders of slices; green is left as it is."""
    if not view.has_depth_map:
        return facts
    return focus.after(facts, view, tuple(shifts(view).values()))


def cost(view: View, rung: str, opencv_used: bool) -> float:
    """A third of a convolution of three channels for each of two."""
    whole = (focus.cost(view, rung, opencv_used, shift) for shift in shifts(view).values())
    return sum(whole) / 3.0


EFFECT = Effect(
    name="axial colour",
    stage="optics",
    decides=("axial colour", "artefacts"),
    settings=(AXIAL_COLOUR,),
    present=lambda view: view.camera[AXIAL_COLOUR] != 0.0,
    run=LayerByLayer(work),
    cost=at_least_a_call(cost),
    skipped=skipped,
    outside=lambda view: focus.outside(view, tuple(shifts(view).values())),
    after=after,
    rungs=(_fewer_slices("half"), _fewer_slices("quarter")),
)
