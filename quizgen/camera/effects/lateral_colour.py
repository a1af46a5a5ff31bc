"""Lateral colour: red magnified, blue reduced, green stays."""

from __future__ import annotations

import numpy as np

from quizgen.camera.costs import at_least_a_call, at_size
from quizgen.camera.draw import Layer, Stack, sheets
from quizgen.camera.effect import Effect
from quizgen.camera.facts import Error, Facts
from quizgen.camera.filters import sample_grid
from quizgen.camera.layers import resampled, rounding, shifted
from quizgen.camera.scene import Image, SceneError
from quizgen.camera.settings import Setting
from quizgen.camera.values import quantity
from quizgen.camera.view import View

LATERAL_COLOUR = Setting("lateral_colour", quantity("px"), 0.0)
"""Shift of red outward and blue inward at the picture's corner, px."""


def run(stack: Stack, view: View, rung: str = "") -> Stack:
    """Magnify every layer's colours differently."""
    return tuple(_split(layer, view) for layer in stack)


MOST = 0.5
"""Largest shift as a share of the distance to the corner: blue is then magnified twice."""


def check(view: View) -> None:
    """Colours may not shrink to a point, nor turn inside out."""
    if _share(view) > MOST:
        raise SceneError(
            f"lateral_colour of {_shift(view):g} px is more than half of the "
            f"{view.corner:.4g} px to the corner of the picture"
        )


def _scales(view: View) -> tuple[float, float, float]:
    """Magnification of red, green, blue."""
    share = view.camera[LATERAL_COLOUR] / view.corner
    return 1.0 + share, 1.0, 1.0 - share


def _split(layer: Layer, view: View) -> Layer:
    def work(image: Image) -> Image:
        return np.stack([_scaled(image, view, channel) for channel in range(3)], axis=2)

    return resampled(layer, work)


def _scaled(image: Image, view: View, channel: int) -> Image:
    scale = _scales(view)[channel]
    plane = image[..., min(channel, image.shape[2] - 1)]
    if scale == 1.0:
        return plane
    x, y = view.centre
    across = np.arange(view.width, dtype=np.float64) - x
    down = np.arange(view.height, dtype=np.float64) - y
    return sample_grid(plane, across / scale + x, down / scale + y)


def _shift(view: View) -> float:
    shift = view.camera[LATERAL_COLOUR]
    return abs(shift)


def _share(view: View) -> float:
    return _shift(view) / view.corner


def skipped(facts: Facts, view: View) -> Error:
    """Shift at the corner times the steepest slope."""
    return shifted(facts, _shift(view) / (1.0 - _share(view)), view)


def after(facts: Facts, view: View) -> Facts:
    """Steps grow by the reduced colour's scale."""
    factor = 1.0 / (1.0 - _share(view)) + rounding(view)
    return facts.stepped(factor, factor)


def cost(view: View, rung: str, opencv_used: bool) -> float:
    """Colour and, but for the opaque layer, cover."""
    return at_size((2.46, 306), view.megapixels) * (2 * len(sheets(view)) - 1)


EFFECT = Effect(
    name="lateral colour",
    stage="optics",
    decides=("lateral colour", "artefacts"),
    settings=(LATERAL_COLOUR,),
    present=lambda view: view.camera[LATERAL_COLOUR] != 0.0,
    check=check,
    run=run,
    cost=at_least_a_call(cost),
    skipped=skipped,
    after=after,
)
