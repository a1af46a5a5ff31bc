"""Field of view: a pinhole camera from above between its sensor and a wall, the sensor in front.

The angle is drawn as it is; distances are not, which the strokes on the axis say.
"""

from __future__ import annotations

from math import atan, degrees, hypot, tan
from typing import Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_equation,
    format_given,
    load_alt_words,
    relation_sign,
)

SIZE = (312.0, 160.0)

PARAMETERS = {
    "W": Parameter("mm", "width of the sensor", None, 0.1, 1000.0),
    "H": Parameter("mm", "height of the sensor", None, 0.1, 1000.0),
    "f": Parameter("mm", "focal length, from the pinhole to the sensor", None, 0.1, 10000.0),
    "Z": Parameter("m", "distance of the wall", None, 0.01, 10000.0),
}

_AXIS, _HOLE, _FRONT = 86.0, 158.0, 36.0
_DASHES = (4, 2)
_NARROW = 130.0  # points in which the labels of f and Z do not fit side by side


def angle_of(side: float, f: float) -> float:
    """Angle in degrees that a side of the sensor is seen under from the pinhole."""
    return 2 * degrees(atan(side / (2 * f)))


def _results(values: Values) -> dict[str, float]:
    width, f = values["W"], values["f"]
    diagonal = hypot(width, values["H"])
    return {"alpha": angle_of(width, f), "D": diagonal, "delta": angle_of(diagonal, f),
            "w": values["Z"] * width / f}  # fmt: skip


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, with question marks for both angles and the strip of wall."""
    art, found = fig.sketch(), _results(values)
    slope = tan(atan(values["W"] / (2 * values["f"])))
    behind, before = min(54.0, 32 / slope), min(112.0, 60 / slope)
    sensor, wall = _HOLE - behind, _HOLE + before
    art.line(
        [(sensor - 8, _AXIS), (wall + 8, _AXIS)], "grey", 0.6, dashes=(9, 2, 1.5, 2), part="axis"
    )
    edges = [(wall, _AXIS + before * slope), (_HOLE, _AXIS), (wall, _AXIS - before * slope)]
    art.area(edges, "pale-gold", part="field")
    for side in (1, -1):
        ends = [(wall, _AXIS + side * before * slope), (_HOLE, _AXIS)]
        art.ray(
            [*ends, (sensor, _AXIS - side * behind * slope)],
            "gold",
            1.1,
            heads=((0, 0.5),),
            part="rays",
        )
        art.line(
            [(_HOLE, _AXIS + side * 2), (_HOLE, _AXIS + side * 42)], "ink", 1.6, part="pinhole"
        )
    for x, half, part in ((sensor, behind * slope, "sensor"), (wall, before * slope, "wall")):
        art.line([(x, _AXIS - half), (x, _AXIS + half)], "blue", 3.0, part=part)
    wide = slope > 0.3
    radius, half = (20.0 if wide else 46.0), degrees(atan(slope))
    art.arc((_HOLE, _AXIS), radius, -half, half, "red", 0.9, part="angle")
    spot = (_HOLE + radius + 5, _AXIS + (6 if wide else radius * slope + 7))
    art.label(spot, r"$\alpha$", "l" if wide else "r", fill="red", shift=(0, 0 if wide else 1))
    art.axis_break((_HOLE + (0.86 if wide else 0.75) * before, _AXIS))
    _measure(art, values, quiz, sensor, wall)
    _front(art, values, found, quiz)


def _measure(art: Any, values: Values, quiz: bool, sensor: float, wall: float) -> None:
    row, slope = _AXIS - 74, values["W"] / (2 * values["f"])
    lower = row - (16 if wall - sensor < _NARROW else 0)
    for x, half in (
        (sensor, (_HOLE - sensor) * slope),
        (_HOLE, 42),
        (wall, (wall - _HOLE) * slope),
    ):
        end = row if x == sensor else lower
        art.line([(x, _AXIS - half - 3), (x, end - 3)], "rule", 0.6, part="helpers")
    art.measure((sensor, row), (_HOLE, row), f"$f$ = {format_given(values['f'])} mm", side="b")
    art.measure((_HOLE, lower), (wall, lower), f"$Z$ = {format_given(values['Z'])} m", side="b")
    text = format_equation("$w$", values["Z"] * values["W"] / values["f"], "m", hide=quiz)
    half = (wall - _HOLE) * slope
    strip = [(wall + 9, _AXIS + side * half) for side in (-1, 1)]
    art.arrow(*strip, "grey", 0.6, size=5.5, both=True, part="strip")
    art.label((wall + 14, _AXIS + max(half - 6, 0) * (half > 20) + 10 * (half <= 20)), text, "l")
    art.label((sensor - 6, _AXIS + 7), "$W$", "r")


def _front(art: Any, values: Values, found: dict[str, float], quiz: bool) -> None:
    """Draw the sensor from the front with its diagonal, and the results below."""
    scale = min(58 / values["W"], 44 / values["H"])
    x, y = scale * values["W"] / 2, scale * values["H"] / 2
    top = _AXIS + 30
    corners = [(_FRONT + a * x, top + b * y) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    art.area(corners, "pale-blue", "blue", 0.9, part="front")
    art.line([corners[0], corners[2]], "red", 0.9, dashes=_DASHES, part="diagonal")
    art.label((_FRONT - 0.25 * x, top + 0.25 * y), "$D$", "c", fill="red")
    art.measure(
        (_FRONT - x, top - y - 10),
        (_FRONT + x, top - y - 10),
        f"$W$ = {format_given(values['W'])} mm",
        side="b",
    )
    art.label((_FRONT, top + y + 4), f"$H$ = {format_given(values['H'])} mm", "cb")
    lines = [("$D$", found["D"], " mm")] if not quiz else []
    lines += [(r"$\alpha$", found["alpha"], "°"), (r"$\delta$", found["delta"], "°")]
    for row, (name, value, unit) in enumerate(lines):
        text = "= ?" if quiz else f"{relation_sign(value)} {format_derived(value)}{unit}"
        art.label((_FRONT - 26, top - y - 40 - 14 * row), f"{name} {text}", "l", part="results")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, without angles and the strip of wall."""
    words = load_alt_words(__file__, lang)
    text = words["figure"].format(**{name: format_given(value) for name, value in values.items()})
    if quiz:
        return text + words["quiz"]
    said = {name: f"{relation_sign(v)} {format_derived(v)}" for name, v in _results(values).items()}
    return text + words["answer"].format(**said)
