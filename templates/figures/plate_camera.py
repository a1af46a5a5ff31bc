"""The road from above: a camera, its field, and number plates at both ends of the range."""

from __future__ import annotations

from typing import Any

from quizgen.figures.kit import Parameter, Values, format_given, load_alt_words

SIZE = (312.0, 118.0)
PARAMETERS = {
    "L": Parameter("m", "width of the lane", 3.5, 1, 10),
    "v": Parameter("m/s", "speed parallel to the image", 10, 1, 50),
    "w": Parameter("px", "least width of a plate", 100, 10, 500),
}

_EYE, _AXIS, _UNIT, _HALF = 24.0, 66.0, 6.4, 26.0


def draw(fig: Any, values: Values, *, quiz: bool) -> None:  # noqa: ARG001 - it shows no result
    """Draw the road, the camera's field and a car at each end of the range."""
    art = fig.sketch()
    near, far = (_EYE + _UNIT * distance for distance in (20, 40))
    slope = _HALF / (near - _EYE)
    edges = [
        (far, _AXIS + slope * (far - _EYE)),
        (_EYE, _AXIS),
        (far, _AXIS - slope * (far - _EYE)),
    ]
    art.area(edges, "pale-gold", part="field")
    for side in (1, -1):
        art.line([(near - 24, _AXIS + side * _HALF), (far + 22, _AXIS + side * _HALF)], "rule", 1.2,
                 part="lane")  # fmt: skip
    art.line([(_EYE, _AXIS), (far + 22, _AXIS)], "grey", 0.6, dashes=(9, 2, 1.5, 2), part="axis")
    for x in (near, far):
        art.area([(x, _AXIS - 11), (x + 20, _AXIS - 11), (x + 20, _AXIS + 11), (x, _AXIS + 11)],
                 "shade", "ink", part="car")  # fmt: skip
        art.line([(x, _AXIS - 5), (x, _AXIS + 5)], "blue", 2.2, part="plate")
    art.area([(_EYE - 14, _AXIS - 6), (_EYE, _AXIS - 6), (_EYE, _AXIS + 6), (_EYE - 14, _AXIS + 6)],
             "ink", part="camera")  # fmt: skip
    art.arrow((near + 34, _AXIS - 18), (near + 34, _AXIS + 18), both=True, part="motion")
    art.label((near + 38, _AXIS + 15), f"{format_given(values['v'])} m/s", "lm")
    art.measure((_EYE, 12), (near, 12), "20 m")
    art.measure((_EYE, 0), (far, 0), "40 m")
    art.measure((near - 18, _AXIS - _HALF), (near - 18, _AXIS + _HALF),
                f"{format_given(values['L'])} m")  # fmt: skip
    art.label((far, _AXIS + 34), f"≥ {format_given(values['w'])} px", "cb")


def alt(values: Values, lang: str, *, quiz: bool) -> str:  # noqa: ARG001 - it shows no result
    """Return the road in words."""
    shown = {name: format_given(values[name]) for name in PARAMETERS}
    return load_alt_words(__file__, lang)["figure"].format(**shown)
