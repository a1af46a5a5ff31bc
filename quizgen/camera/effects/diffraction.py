"""Diffraction: the Airy disc of a round aperture, wider the smaller the aperture."""

from __future__ import annotations

from quizgen.camera.body import NEEDS_LENS, aperture
from quizgen.camera.costs import at_least_a_call, convolution
from quizgen.camera.draw import Layer, sheets
from quizgen.camera.effect import Effect, LayerByLayer
from quizgen.camera.facts import Error, Facts
from quizgen.camera.kernels import Kernel, airy, airy_radius, change
from quizgen.camera.layers import blurred, each, farthest, within
from quizgen.camera.settings import Rule, Setting, Settings, between
from quizgen.camera.values import quantity
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


def work(layer: Layer, view: View, rung: str = "") -> Layer:
    """Blur every layer alike: all light comes through the same aperture."""
    return blurred(layer, _kernel(view))


def skipped(facts: Facts, view: View) -> Error:
    """What the Airy disc can change in each layer."""
    kernel = _kernel(view)
    parts = (change(kernel, part.jump, part.bend, most) for part, _, most in each(facts, view))
    return within(sum(parts), facts)


def outside(view: View) -> tuple[float, float]:
    """As far as the last ring."""
    radius = airy_radius(scale(view)) + 1.0
    return farthest(view, lambda _: (radius, radius))


def after(facts: Facts, view: View) -> Facts:
    """Averages do not steepen."""
    return facts.stepped(1.0, 1.0)


def cost(view: View, rung: str, opencv_used: bool) -> float:
    """A convolution per layer."""
    return convolution(_kernel(view), view, opencv_used) * len(sheets(view))


EFFECT = Effect(
    name="diffraction",
    stage="optics",
    decides=("diffraction", "sharpness"),
    settings=(WAVELENGTH,),
    present=lambda view: view.camera[WAVELENGTH] is not None,
    run=LayerByLayer(work),
    cost=at_least_a_call(cost),
    skipped=skipped,
    outside=outside,
    after=after,
)
