"""A photographed white wall, and how its light falls from the centre of the picture to the side.

Photograph and curve come from one camera, so what is read is what is seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib.path import Path

from quizgen.camera import Camera, Scene
from quizgen.camera.effects.vignetting import light_falloff
from quizgen.camera.pixels.filters import numpy_only
from quizgen.camera.question_photo import photograph_question
from quizgen.camera.setup.view import View
from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_given,
    format_statement,
    load_alt_words,
    require,
)
from quizgen.figures.photographs import place_photo

from ._plots import format_learned, mark_point, trace_lines

PARAMETERS = {
    "f": Parameter("mm", "focal length", low=1.0, high=1000.0),
    "r": Parameter("mm", "marked distance from the centre", low=0.0, high=500.0),
    "extent": Parameter("mm", "distance from the centre to the side of the picture", 22.0, 1.0),
    "rim": Parameter("1", "shift of the lens rim at the corner in diameters", 0.0, 0.0, 0.99),
}
SIZE = (158.0, 120.0)

_WIDE, _HIGH = 96, 72
_PHOTO = (-158.0, 18.0, 112.0, 84.0)  # left of the curve
_STEPS = 44
# No inks of the page: the photograph stays as light as it is on a dark one.
_ARROW, _AROUND = "#b8361f", "#fdfdfd"


def set_camera(values: Values) -> tuple[Scene, Camera]:
    """A white wall and the camera; the middle of the side is ``extent`` from the centre."""
    camera = Camera(
        focal_length=values["f"] / 1000,
        pixel_pitch=values["extent"] / 1000 / (_WIDE / 2),
        natural_vignetting=True,
        mechanical_vignetting=values["rim"],
        gamma="srgb",
    )
    return Scene(_WIDE, _HIGH, (), (0.9, 0.9, 0.9)), camera


def find_shares(values: Values, distances: Sequence[float]) -> list[float]:
    """Shares of the light of the centre that arrive at distances from it in mm."""
    pixels = np.array(distances) / values["extent"] * _WIDE / 2
    return light_falloff(pixels, View(*set_camera(values))).tolist()


@lru_cache(64)
def _take_photo(f: float, extent: float, rim: float) -> Any:
    """The photograph in 8-bit codes, for the question and for its solution."""
    with numpy_only():
        scene, camera = set_camera({"f": f, "extent": extent, "rim": rim})
        return photograph_question(scene, camera, "vignetting", grey=True).photo.pixels()


def draw(ax: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the share at the mark."""
    require("fall_off", values["r"] <= values["extent"], "r must lie inside the picture")
    fig = ax.figure
    place_photo(fig, _take_photo(values["f"], values["extent"], values["rim"]), _PHOTO)
    _draw_axes(ax, values["extent"])
    art, r = fig.sketch(ax), values["r"]
    left, low, wide, high = _PHOTO
    way = [(left + wide / 2, low + high / 2), (left + wide, low + high / 2)]
    for ink, width, size in ((_AROUND, 3.2, 9.0), (_ARROW, 1.3, 6.5)):
        art.in_points().arrow(*way, ink, width, size=size, part="path")
    art.shape(_trace_grid(values["extent"]), None, "rule", 0.4, part="grid")
    places = [values["extent"] * step / _STEPS for step in range(_STEPS + 1)]
    *lights, light = find_shares(values, [*places, r])
    art.line(np.column_stack([places, lights]), "blue", 1.6, part="curve")
    art.line([(r, 0), (r, 1)], "red", 0.8, dashes=(1.4, 1.6), part="marks")
    side = "l" if r < 0.6 * values["extent"] else "r"
    text = format_statement("$r$", r, "mm")
    art.label((r, 0.07), text, side, 10, "red", shift=(4 if side == "l" else -4, 0), halo=True)
    if not quiz:
        art.line([(0, light), (r, light)], "red", 0.6, dashes=(1.4, 1.6), part="marks")
        art.dot((r, light), 2.3, "red", part="marks")
        text = f"$E(r)/E(0)$ ≈ {format_derived(light)}"
        art.label((values["extent"], 1), text, "r", 10, "red", shift=(0, 17), part="answer")


def _draw_axes(ax: Any, extent: float) -> None:
    ax.set(xlim=(0, extent), ylim=(0, 1.05))
    apart = next(step for step in (1, 2, 5, 10, 20, 50, 100, 200, 500) if extent / step <= 6.5)
    ticks = range(0, int(extent) + 1, apart)
    ax.set_xticks(ticks, map(str, ticks))
    fifths = [fifth / 5 for fifth in range(6)]
    ax.set_yticks(fifths, map(format_given, fifths))
    ax.set_xlabel("$r$ / mm")
    ax.set_ylabel("$E(r)/E(0)$")


@lru_cache(16)
def _trace_grid(extent: float) -> Path:
    """Level lines at every tenth."""
    return trace_lines([[(0, tenth / 10), (extent, tenth / 10)] for tenth in range(1, 11)])


MARKS = {"share": ""}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(ax: Any, values: Values, marks: Values) -> None:
    """Draw a learner's ``share`` of the light at the mark."""
    x0, y0, x1, y1 = ax.bbox.extents
    point = ax.transData.transform((values["r"], marks["share"]))
    mark_point(ax.figure, (x0, y0, x1, y1), tuple(point), format_learned(marks["share"]))


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words, the curve at its quarters; in a quiz, not at the mark."""
    words = load_alt_words(__file__, lang)
    steps = [values["extent"] * step / 4 for step in range(5)]
    *lights, light = find_shares(values, [*steps, values["r"]])
    read = "; ".join(f"{format_given(r)} mm: {e:.2f}" for r, e in zip(steps, lights, strict=True))
    told = words["figure"].format(read=read, mark=format_statement("r", values["r"], "mm"))
    return told if quiz else told + words["answer"].format(light=format_derived(light))
