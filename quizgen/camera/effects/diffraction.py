"""Diffraction: the Airy disc of a round aperture, wider the smaller the aperture."""

from __future__ import annotations

from quizgen.camera.effects.effect import (
    Effect,
    LayerByLayer,
    Size,
)
from quizgen.camera.kernels import Kernel, airy, airy_radius, moved_share
from quizgen.camera.raster.draw import Layer
from quizgen.camera.raster.layers import blurred, bound_layers, farthest
from quizgen.camera.setup.body import NEEDS_LENS, aperture
from quizgen.camera.setup.settings import Rule, Setting, Settings, between
from quizgen.camera.setup.values import quantity
from quizgen.camera.view import View


def _has_aperture(_: object, camera: Settings) -> bool:
    return aperture(camera) is not None


WAVELENGTH = Setting[float | None](
    "wavelength",
    quantity("m"),
    None,
    (
        between(1e-9, 1e-3, "m"),
        NEEDS_LENS,
        Rule(_has_aperture, "needs f_number or pinhole: a point has no diffraction"),
    ),
)
"""Wavelength of the light whose diffraction is shown, m; green is 550 nm."""


def scale(view: View) -> float:
    """Wavelength times image distance over aperture, px: 1.22 of it is the first dark ring."""
    wavelength, opening = view.camera[WAVELENGTH], aperture(view.camera)
    if wavelength is None or opening is None:
        return 0.0
    return wavelength * view.image_distance / opening


def _kernel(view: View) -> Kernel:
    return airy(scale(view))


def work(layer: Layer, view: View) -> Layer:
    """Blur every layer alike: all light comes through the same aperture."""
    return blurred(layer, _kernel(view))


def outside(view: View) -> tuple[float, float]:
    """As far as the last ring."""
    radius = airy_radius(scale(view)) + 1.0
    return farthest(view, lambda _: (radius, radius))


EFFECT = Effect(
    name="diffraction",
    stage="optics",
    answers=("diffraction", "sharpness"),
    settings=(WAVELENGTH,),
    is_present=lambda view: view.camera[WAVELENGTH] is not None,
    run=LayerByLayer(work),
    omission_bound=lambda signal, view: bound_layers(
        signal, view, lambda _: moved_share(_kernel(view))
    ),
    outside=outside,
    size=Size(lambda view: 2.44 * scale(view), "blur by an Airy disc {:.3g} px wide", 1.5),
)
