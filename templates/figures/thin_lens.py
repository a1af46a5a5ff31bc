"""Thin lens: object, image, and the parallel, central and focal rays.

All distances along the axis share one scale, so the rays obey the lens equation as drawn. An object
between 1.2 f and 6 f, or between 0.3 f and 0.8 f for a virtual image, is to scale. Nearer to F or
farther away the drawing has another ratio, and the axis a break mark.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log
from typing import Any

import numpy as np

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_equation,
    format_given,
    format_statement,
    load_alt_words,
    strip_mathtext,
)
from quizgen.figures.sketch import measure_label

from ._optics import clamp, draw_axis, draw_lens, draw_lines
from ._plots import format_learned

PARAMETERS = {
    "f": Parameter("mm", "focal length", low=1e-6),
    "z": Parameter(
        "mm", "distance of the object from the lens; below f the image is virtual", low=1e-6
    ),
}
SIZE = WIDTH, _ = (312.0, 170.0)

_RAYS = (("parallel", "red", None), ("central", "teal", (7, 1.5)), ("focal", "blue", (4, 1.5)))
_AXIS, _LEFT, _ROOM = 105.0, 18.0, 278.0
_VIRTUAL = (0.3, 0.8)
_NEAREST, _FAR, _FARTHEST = 1.2, 6.0, 41.0


@dataclass(frozen=True, slots=True)
class _Layout:
    """Drawn geometry: focal length 1, lens at x = 0; ``image`` is None when rays leave parallel."""

    object: float
    image: float | None
    lens_x: float
    scale: float
    height: float
    break_at: float | None

    def at(self, x: float, height: float) -> tuple[float, float]:
        return self.lens_x + x * self.scale, _AXIS + height * self.height

    @property
    def magnification(self) -> float:
        return (self.image or 0.0) / self.object

    @property
    def half_lens(self) -> float:
        return min(max(self.height * max(1.0, abs(self.magnification)) + 8, 50.0), 62.0)


def _lay_out(values: Values) -> _Layout:
    ratio = values["z"] / values["f"]
    if ratio == 1:
        return _Layout(1.0, None, 118.0, 96.0, 40.0, None)
    z, place = _choose_object(ratio)
    image = z / (z - 1)
    left, right = max(z, -image, 1.0), max(image, 1.35)
    scale = _ROOM / (left + right)
    height = min(55 / max(1.0, -image / z), 45 / max(image / z, 0.1), 44.0)
    return _Layout(z, image, _LEFT + left * scale, scale, height, place)


def _choose_object(ratio: float) -> tuple[float, float | None]:
    """Object distance to draw, and where the axis is broken if that is not to scale."""
    if ratio < 1:
        low, high = _VIRTUAL
        z = min(max(ratio, low), high)
        return z, None if z == ratio else -z / 2 if z > ratio else -(z + z / (1 - z)) / 2
    if ratio < _NEAREST:
        return _NEAREST, (1 + _NEAREST / (_NEAREST - 1)) / 2
    if ratio <= _FAR:
        return ratio, None
    # The farther, the farther, though not in proportion: draws look different.
    share = min(log(ratio / _FAR) / log(_FARTHEST / _FAR), 1.0)
    z = 3.6 + 2.4 * share
    return z, -(z + 1) / 2


def _image_distance(values: Values) -> float | None:
    f, z = values["f"], values["z"]
    return None if z == f else f * z / (z - f)


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the image distance."""
    art, place = fig.sketch(), _lay_out(values)
    draw_lens(art, place.lens_x, _AXIS, place.half_lens)
    draw_axis(art, 2, WIDTH - 2, _AXIS)
    if place.break_at is not None:
        art.axis_break(place.at(place.break_at, 0))
    if place.image is not None and place.image > 0:
        _draw_meeting_rays(art, place, place.image)
    else:
        _draw_leaving_rays(art, place)
    _draw_ends(art, place)
    _draw_distances(art, place, _label_distances(values, quiz=quiz))


def _draw_meeting_rays(art: Any, place: _Layout, image: float) -> None:
    tip, end = place.at(-place.object, 1), np.array(place.at(image, -place.magnification))
    for (part, ink, dashes), hit in zip(_RAYS, (1.0, 0.0, -place.magnification), strict=True):
        bend = place.at(0, hit)
        on = end + (end - bend) * 14 / max(end[0] - bend[0], 30)
        heads = ((0, 0.55), (1, 0.42))
        art.ray([tip, bend, end, on], ink, heads=heads, dashes=dashes, part=f"ray-{part}")


def _draw_leaving_rays(art: Any, place: _Layout) -> None:
    """Draw rays that do not meet behind the lens, and lengthen them backwards to the image."""
    tip, top = place.at(-place.object, 1), -place.magnification
    bends = ((1.0, -1.0), (0.0, -1 / place.object), (top, 0.0))  # height at the lens, slope behind
    for (part, ink, dashes), (hit, slope) in zip(_RAYS, bends, strict=True):
        if place.image is None and part == "focal":
            return
        reach = (
            1.45
            if place.image is None
            else min(1.3, (hit + 55 / place.height) / -slope)
            if slope
            else 1.3
        )
        path = [tip, place.at(0, hit), place.at(reach, hit + slope * reach)]
        art.ray(path, ink, heads=((0, 0.5), (1, 0.6)), dashes=dashes, part=f"ray-{part}")
        if place.image is not None:
            back = [place.at(place.image, top), tip if part == "central" else place.at(0, hit)]
            art.line(back, ink, 0.8, dashes=(2, 2.5), part=f"back-{part}")


def _draw_ends(art: Any, place: _Layout) -> None:
    """Draw object, image and both focal points."""
    foot, tip = place.at(-place.object, 0), place.at(-place.object, 1)
    art.arrow(foot, tip, width=2.0, size=9, part="object")
    if place.image is not None:
        foot, tip = place.at(place.image, 0), place.at(place.image, -place.magnification)
        dashes = (3, 1.6) if place.image < 0 else None
        art.arrow(foot, tip, width=2.0, size=9, dashes=dashes, part="image")
    for x, name, align, shift in ((-1, "F", "r", (-4, -10)), (1, "F$'$", "l", (2, 10))):
        art.dot(place.at(x, 0), 2.2, "paper", "ink", 1.0, part="foci")
        art.label(place.at(x, 0), name, align, shift=shift)


def _label_distances(values: Values, *, quiz: bool) -> dict[str, str]:
    image = _image_distance(values)
    return {
        "f": format_statement("$f$", values["f"], "mm"),
        "z": format_statement("$z$", values["z"], "mm"),
        "image": "" if image is None else format_equation("$z'$", image, "mm", hide=quiz),
    }


def _draw_distances(art: Any, place: _Layout, words: dict[str, str]) -> None:
    virtual = place.image is not None and place.image < 0
    upper = _AXIS - place.half_lens - 13
    lower = upper - 18
    rows = [(-place.object, upper if virtual else lower, words["z"])]
    if place.image is None or virtual:
        rows.append((1.0, lower, words["f"]))
    else:
        rows.append((1.0 if place.image > place.object else -1.0, upper, words["f"]))
    if place.image is not None:
        rows.append((place.image, lower, words["image"]))
    helpers = [[(place.lens_x, _AXIS - place.half_lens), (place.lens_x, lower - 3)]]
    for x, row, text in rows:
        at, _ = place.at(x, 0)
        below = 4 + max(0.0, place.magnification * place.height) * (x == place.image)
        helpers.append([(at, _AXIS - below), (at, row - 3)])
        # A short distance has its label on the side where no line crosses it.
        room = (max(place.object, -(place.image or 0.0)) + x) * place.scale
        free = "l" if x < 0 and room > measure_label(text)[0] + 8 else "r"
        side = "b" if row == lower else free
        art.measure((at, row), (place.lens_x, row), text, side=side)
    draw_lines(art, helpers)


MARKS = {"z'": "mm"}
"""Quantities that ``mark`` draws, and in which unit; where none is named, in that of the key."""


def mark(fig: Any, values: Values, marks: dict[str, float]) -> None:
    """Draw the image where a learner's ``z'`` (mm) puts it, on the central ray."""
    art, place, image = fig.sketch(zorder=6), _lay_out(values), _image_distance(values)
    value, known = marks["z'"], {0.0: 0.0, values["f"]: 1.0}
    if image is not None and place.image is not None:
        known[image] = place.image
    at = sorted(known)
    drawn = float(np.interp(value, at, [known[z] for z in at]))
    if not at[0] <= value <= at[-1]:
        end = at[0] if value < at[0] < 0 else at[-1]
        drawn = value / end * known[end]
    x, beyond = clamp(place.lens_x + drawn * place.scale, 8, WIDTH - 8)
    top = _AXIS + place.half_lens + 6
    art.line([(x, _AXIS), (x, top)], "gold", 0.9, dashes=(2, 2), part="learned")
    if beyond:
        art.arrow((x - 12 * beyond, top), (x + 6 * beyond, top), "gold", part="learned")
    else:
        reach = (x - place.lens_x) / place.object / place.scale * place.height
        art.arrow((x, _AXIS), (x, _AXIS - reach), "gold", 2.0, size=9, part="learned")
    text, align = f"{format_learned(value)} mm", {1: "r", 0: "c", -1: "l"}[beyond]
    art.label((x, top), text, f"{align}b", fill="gold", shift=(0, 4), part="learned")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave the image distance out."""
    image, words = _image_distance(values), load_alt_words(__file__, lang)
    text: str = words["figure"].format(f=format_given(values["f"]), z=format_given(values["z"]))
    if quiz:
        return text + words["quiz"]
    if image is None:
        return text + words["parallel"]
    answer = strip_mathtext(_label_distances(values, quiz=False)["image"])
    return text + words["real" if image > 0 else "virtual"].format(answer=answer)
