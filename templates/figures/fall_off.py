"""A photographed white wall, and how its light falls from the centre of the picture to the side.

Photograph and curve come from one camera, so what is read is what is seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from quizgen.figures.kit import (
    BOLD,
    DOTTED,
    GREY,
    LINE,
    RED,
    THIN,
    Canvas,
    Parameter,
    Pen,
    Values,
    derived,
    given,
    require,
    spoken,
    statement,
    words_of,
)

if TYPE_CHECKING:
    from quizgen.camera.camera import Camera
    from quizgen.camera.scene import Scene

DARK = "keep"

PARAMETERS = {
    "f": Parameter("mm", "focal length", low=1.0, high=1000.0),
    "r": Parameter("mm", "marked distance from the centre", low=0.0, high=500.0),
    "extent": Parameter("mm", "distance from the centre to the side of the picture", 22.0, 1.0),
    "rim": Parameter("1", "shift of the lens rim at the corner in diameters", 0.0, 0.0, 0.99),
}

_WIDE, _HIGH = 96, 72
_LEFT, _RIGHT, _LOW, _TOP = 150.0, 300.0, 34.0, 150.0
_PHOTO = (6.0, 52.0, 112.0, 84.0)
_STEPS = 44


def photographed(values: Values) -> tuple[Scene, Camera]:
    """A white wall and the camera; the middle of the side is ``extent`` from the centre."""
    from quizgen.camera import Camera, Scene

    camera = Camera(
        focal_length=values["f"] / 1000,
        pixel_pitch=values["extent"] / 1000 / (_WIDE / 2),
        natural_vignetting=True,
        mechanical_vignetting=values["rim"],
        gamma="srgb",
    )
    return Scene(_WIDE, _HIGH, (), (0.9, 0.9, 0.9)), camera


def shares(values: Values, distances: Sequence[float]) -> list[float]:
    """Shares of the light of the centre that arrive at distances from it in mm."""
    import numpy as np

    from quizgen.camera.effects.vignetting import fall_off
    from quizgen.camera.view import View

    pixels = np.array(distances) / values["extent"] * _WIDE / 2
    return fall_off(pixels, View(*photographed(values))).tolist()


def share(values: Values, distance: float) -> float:
    """The share at one distance."""
    return shares(values, [distance])[0]


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the share at the mark."""
    require("fall_off", values["r"] <= values["extent"], "r must lie inside the picture")
    pen = Pen(height=176.0)
    _photo(canvas, pen, values)
    _axes(pen, values)
    _curve(pen, values)
    _mark(pen, values, told=not quiz)
    pen.onto(canvas, background="#ffffff")


def _photo(canvas: Canvas, pen: Pen, values: Values) -> None:
    from quizgen.camera import photographs
    from quizgen.camera.filters import everywhere_alike
    from quizgen.figures.photographs import place

    scene, camera = photographed(values)
    with everywhere_alike():
        (photo,) = photographs(scene, camera)
    place(canvas, pen, photo.pixels(), _PHOTO)
    left, low, wide, high = _PHOTO
    middle = low + high / 2
    pen.arrow("path", (left + wide / 2, middle), (left + wide, middle), RED)


def _x(values: Values, distance: float) -> float:
    return _LEFT + (_RIGHT - _LEFT) * distance / values["extent"]


def _y(light: float) -> float:
    return _LOW + (_TOP - 8 - _LOW) * light


def _axes(pen: Pen, values: Values) -> None:

    for tenth in range(1, 11):
        pen.line("grid", [(_LEFT, _y(tenth / 10)), (_RIGHT, _y(tenth / 10))], GREY)
    pen.line("axes", [(_LEFT, _TOP), (_LEFT, _LOW), (_RIGHT, _LOW)], LINE)
    for fifth in range(6):
        pen.label((_LEFT - 6, _y(fifth / 5)), given(fifth / 5), "r", 9)
    for distance in range(0, int(values["extent"]) + 1, 5 if values["extent"] > 10 else 1):
        x = _x(values, distance)
        pen.line("ticks", [(x, _LOW), (x, _LOW - 4)], THIN)
        pen.label((x, _LOW - 11), str(distance), size=9)
    pen.label((_RIGHT, 8), "r / {mm}", "r", 9.5)
    pen.label((_LEFT - 8, _TOP + 9), "E(r) / E(0)", "l", 9.5)


def _curve(pen: Pen, values: Values) -> None:

    places = [values["extent"] * step / _STEPS for step in range(_STEPS + 1)]
    lights = zip(places, shares(values, places), strict=True)
    pen.line("curve", [(_x(values, r), _y(light)) for r, light in lights], BOLD)


def _mark(pen: Pen, values: Values, *, told: bool) -> None:

    x, light = _x(values, values["r"]), share(values, values["r"])
    pen.line("marks", [(x, _LOW), (x, _TOP)], DOTTED)
    if told:
        pen.dot("marks", (x, _y(light)), 2.6)
        pen.label((_RIGHT, _TOP + 18), f"E / E(0) ≈ {derived(light)}", "r", 9.5)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words, the curve at its quarters; in a quiz, not at the mark."""
    words = words_of(__file__, lang)
    steps = [values["extent"] * step / 4 for step in range(5)]
    lights = zip(steps, shares(values, steps), strict=True)
    read = "; ".join(f"{given(r)} mm: {light:.2f}" for r, light in lights)
    told = words["figure"].format(read=read, mark=spoken(statement("r", values["r"], "mm")))
    if quiz:
        return told
    return told + words["answer"].format(light=derived(share(values, values["r"])))
