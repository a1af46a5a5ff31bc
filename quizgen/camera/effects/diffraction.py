"""Diffraction: the Airy disc of a round aperture, wider the smaller the aperture."""

from __future__ import annotations

from quizgen.camera.effect import Effect, EffectSize, LayerByLayer
from quizgen.camera.pixels.kernels import airy_kernel, airy_radius, moved_share
from quizgen.camera.raster.layers import blur_layer, bound_layers, largest_margin
from quizgen.camera.raster.rasterizer import Layer
from quizgen.camera.setup.settings import (
    NEEDS_LENS,
    Setting,
    SettingRule,
    aperture_diameter,
    in_range,
)
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import View

WAVELENGTH = Setting[float | None](
    "wavelength",
    quantity_parser("m"),
    None,
    (
        in_range(1e-9, 1e-3, "m"),
        NEEDS_LENS,
        SettingRule[object](
            lambda _, camera: aperture_diameter(camera) is not None,
            "needs f_number or pinhole: a point has no diffraction",
        ),
    ),
)
"""Wavelength of the light whose diffraction is shown, m; green is 550 nm."""


def airy_scale(view: View) -> float:
    """Return wavelength times image distance over aperture, px.

    1.22 of it is the first dark ring.
    """
    wavelength, opening = view.camera[WAVELENGTH], aperture_diameter(view.camera)
    if wavelength is None or opening is None:
        return 0.0
    return wavelength * view.image_distance / opening


def operation(layer: Layer, view: View) -> Layer:
    """Return a layer blurred by the Airy disc: all layers alike, as light has one aperture."""
    return blur_layer(layer, airy_kernel(airy_scale(view)))


def margin(view: View) -> tuple[float, float]:
    """Return how far across and down light can come from, px: the last ring of the kernel."""
    radius = airy_radius(airy_scale(view)) + 1.0
    return largest_margin(view, lambda _: (radius, radius))


EFFECT = Effect(
    name="diffraction",
    answers=("diffraction", "sharpness"),
    settings=(WAVELENGTH,),
    is_present=lambda view: view.camera[WAVELENGTH] is not None,
    run=LayerByLayer(operation),
    omission_bound=lambda signal, view: bound_layers(
        signal, view, lambda _: moved_share(airy_kernel(airy_scale(view)))
    ),
    margin=margin,
    size=EffectSize(
        lambda view: 2.44 * airy_scale(view), "blur by an Airy disc {:.3g} px wide", 1.5
    ),
)
