"""Thin lens: object, image, and the parallel, central and focal rays.

All distances along the axis share one scale, so the rays obey the lens equation as drawn. Objects
nearer than 1.25 f or farther than 5 f (virtual image: outside 0.4 f to 0.75 f) are drawn at the
nearer end of that range, with a break mark on the axis.
"""

from __future__ import annotations

from dataclasses import dataclass

from quizgen.figures.kit import (
    BOLD,
    DASHED,
    DOTTED,
    LINE,
    SHADE,
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Style,
    Values,
    equation,
    given,
    spoken,
    statement,
    text_width,
    words_of,
)

DARK = "invert"

PARAMETERS = {
    "f": Parameter("mm", "focal length", low=1e-6),
    "z": Parameter(
        "mm", "distance of the object from the lens; below f the image is virtual", low=1e-6
    ),
}

_REAL, _VIRTUAL = (1.25, 5.0), (0.4, 0.75)
_AXIS = 105.0
_TOP, _BOTTOM = 55.0, 45.0
_ROW = (22.0, 41.0)


@dataclass(frozen=True, slots=True)
class _Layout:
    """Drawn geometry: focal length 1, lens at x = 0; ``image`` is None when rays leave parallel."""

    object: float
    image: float | None
    lens_x: float
    scale: float
    height: float
    to_scale: bool

    def at(self, x: float, height: float) -> tuple[float, float]:
        return (self.lens_x + x * self.scale, _AXIS + height * self.height)

    @property
    def magnification(self) -> float:
        return 0.0 if self.image is None else self.image / self.object


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the image distance."""
    pen, place = Pen(), _layout(values)
    _lens(pen, place)
    if place.image is None:
        _parallel_rays(pen, place)
    elif place.image > 0:
        _real_rays(pen, place, place.image)
    else:
        _virtual_rays(pen, place, place.image)
    _arrows(pen, place)
    _measures(pen, place, values, quiz=quiz)
    pen.onto(canvas)


def _image_distance(values: Values) -> float | None:
    f, z = values["f"], values["z"]
    return None if z == f else f * z / (z - f)


def _layout(values: Values) -> _Layout:

    ratio = values["z"] / values["f"]
    if ratio == 1:
        return _Layout(1.0, None, 118.0, 96.0, 40.0, to_scale=True)
    low, high = _REAL if ratio > 1 else _VIRTUAL
    z = min(max(ratio, low), high)
    image = z / (z - 1)
    left, right = max(z, -image, 1.0), max(image, 1.35)
    scale = (WIDTH - 34) / (left + right)
    height = min(_TOP / max(1.0, -image / z), _BOTTOM / max(image / z, 0.1), 44.0)
    return _Layout(z, image, 18 + left * scale, scale, height, z == ratio)


def _lens(pen: Pen, place: _Layout) -> None:

    half = min(max(place.height * max(1.0, abs(place.magnification)) + 8, 50.0), 62.0)
    rim = [(6 * (1 - (i / 10) ** 2), half * i / 10) for i in range(-10, 11)]
    shape = [(place.lens_x + x, _AXIS + y) for x, y in rim]
    shape += [(place.lens_x - x, _AXIS - y) for x, y in rim]
    pen.area("lens", shape, SHADE)
    pen.area("lens-edge", shape, LINE)
    pen.line("axis", [(4, _AXIS), (WIDTH - 4, _AXIS)], LINE)
    if not place.to_scale:
        behind = 1.0 if place.object > 1 else 0.0
        pen.break_mark(place.at(-(place.object + behind) / 2, 0))


def _real_rays(pen: Pen, place: _Layout, image: float) -> None:
    tip, end = place.at(-place.object, 1), place.at(image, -place.magnification)
    hits = (1.0, 0.0, -place.magnification)
    for part, hit in zip(("parallel", "central", "focal"), hits, strict=True):
        pen.ray(f"ray-{part}", [tip, place.at(0, hit), end])
    pen.head("ray-on", _between(place.at(0, 1), end, 0.5), _way(place.at(0, 1), end))


def _virtual_rays(pen: Pen, place: _Layout, image: float) -> None:

    tip, top = place.at(-place.object, 1), -place.magnification
    back = place.at(image, top)
    for part, hit, slope in (
        ("parallel", 1.0, -1.0),
        ("central", 0.0, -1.0 / place.object),
        ("focal", top, 0.0),
    ):
        through = 1.0 if part == "parallel" else 1 / abs(slope) if slope else 1.0
        reach = min(1.3, 1.3 * through if slope else 1.3)
        leaving = place.at(reach, hit + slope * reach)
        pen.ray(f"ray-{part}", [tip, place.at(0, hit), leaving])
        pen.line(f"back-{part}", [back, place.at(0, hit) if part != "central" else tip], DASHED)


def _parallel_rays(pen: Pen, place: _Layout) -> None:
    tip = place.at(-1, 1)
    pen.ray("ray-parallel", [tip, place.at(0, 1), place.at(1.85, -0.85)])
    pen.ray("ray-central", [tip, place.at(0, 0), place.at(1.15, -1.15)])


def _between(start: tuple[float, float], end: tuple[float, float], t: float) -> tuple[float, float]:
    return (start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1]))


def _way(start: tuple[float, float], end: tuple[float, float]) -> tuple[float, float]:
    return (end[0] - start[0], end[1] - start[1])


def _arrows(pen: Pen, place: _Layout) -> None:

    pen.arrow("object", place.at(-place.object, 0), place.at(-place.object, 1), BOLD)
    if place.image is not None:
        style = BOLD if place.image > 0 else Style(1.8, dashes=(3.0, 2.0))
        foot = place.at(place.image, 0)
        pen.arrow("image", foot, place.at(place.image, -place.magnification), style)
    for x, name in ((-1.0, "{F}"), (1.0, "{F}'")):
        pen.dot("foci", place.at(x, 0))
        at = place.at(x, 0)
        pen.label(
            (at[0] - 4, at[1] - 10) if x < 0 else (at[0], at[1] + 11), name, "r" if x < 0 else "c"
        )


def _measures(pen: Pen, place: _Layout, values: Values, *, quiz: bool) -> None:
    words = _labels(values, quiz=quiz)
    virtual = place.image is not None and place.image < 0
    _measure(pen, place, -place.object, _ROW[virtual], words["z"])
    if place.image is None or virtual:
        _measure(pen, place, 1.0, _ROW[0], words["f"])
    else:
        _measure(pen, place, 1.0 if place.image > place.object else -1.0, _ROW[1], words["f"])
    if place.image is not None:
        _measure(pen, place, place.image, _ROW[0], words["image"])


def _measure(pen: Pen, place: _Layout, x: float, row: float, text: str) -> None:

    for end in (0.0, x):
        at = place.at(end, 0)
        pen.line("helpers", [(at[0], _AXIS - 4), (at[0], row - 3)], DOTTED)
    beside = "" if row == _ROW[0] else _free_side(place, x, text)
    pen.dimension((place.at(x, 0)[0], row), (place.lens_x, row), text, beside)


def _free_side(place: _Layout, x: float, text: str) -> str:
    """Choose the side of a short measure on which no helper line crosses its label."""
    if x > 0:
        return "r"
    farthest = max(place.object, -(place.image or 0.0))
    return "l" if (farthest + x) * place.scale > text_width(text) + 8 else "r"


def _labels(values: Values, *, quiz: bool) -> dict[str, str]:
    image = _image_distance(values)
    shown = "" if image is None else equation("z'", image, "mm", hide=quiz)
    return {
        "f": statement("f", values["f"], "mm"),
        "z": statement("z", values["z"], "mm"),
        "image": shown,
    }


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave the image distance out."""
    image, words = _image_distance(values), words_of(__file__, lang)
    text = words["figure"].format(f=given(values["f"]), z=given(values["z"]))
    if quiz:
        return text + words["quiz"]
    if image is None:
        return text + words["parallel"]
    answer = spoken(_labels(values, quiz=False)["image"])
    return text + words["real" if image > 0 else "virtual"].format(answer=answer)
