"""Pinhole geometry in the y-z plane: centre O, image plane, scene point, ray and image point.

The drawing keeps the two similar triangles exact and is to scale along z while the shorter of
``f`` and ``p_z`` is 0.3 to 0.7 of the longer; otherwise the shorter one is drawn at the nearer end
of that range and the axis carries a break mark. Height and depth have scales of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

from quizgen.figures.kit import (
    BOLD,
    DASHED,
    DEEP,
    DOTTED,
    HEIGHT,
    LINE,
    RAY,
    SHADE,
    THIN,
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Values,
    derived,
    equation,
    relation,
    require,
    spoken,
    statement,
    text_width,
    words_of,
)

DARK = "invert"

PARAMETERS = {
    "f": Parameter("1 or mm", "focal length: distance of the image plane from O", low=1e-6),
    "p_z": Parameter("1 or m", "depth of the scene point", low=1e-6),
    "p_y": Parameter("1 or m", "height of the scene point, not 0"),
    "metric": Parameter(
        "", "0: plain numbers; 1: f and p'_y in mm, p in m; 2: all in mm", 0.0, 0.0, 2.0, whole=True
    ),
    "physical": Parameter("", "1: also draw the physical plane at -f", 0.0, 0.0, 1.0, whole=True),
    "y_down": Parameter("", "1: the y axis points down", 0.0, 0.0, 1.0, whole=True),
}

_UNITS = {0: ("", ""), 1: ("mm", "m"), 2: ("mm", "mm")}
_LEAST, _MOST = 0.3, 0.7


@dataclass(frozen=True, slots=True)
class _Layout:
    """Where things are, in points: O, the far leg, and how the near leg divides it."""

    o_x: float
    o_y: float
    length: float
    height: float
    near: float
    point_is_far: bool
    side: int
    to_scale: bool

    def at(self, depth: float, height: float) -> tuple[float, float]:
        return (self.o_x + depth * self.length, self.o_y + self.side * height * self.height)

    def beside(self, depth: float, offset: float) -> tuple[float, float]:
        """Find a place some points away from the axis, on the side of the scene point."""
        return (self.o_x + depth * self.length, self.o_y + self.side * offset)

    @property
    def point(self) -> float:
        return 1.0 if self.point_is_far else self.near

    @property
    def plane(self) -> float:
        return self.near if self.point_is_far else 1.0


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, hide the height of the image point.

    Raises
    ------
    BankError
        If the scene point lies on the axis or in the image plane.
    """
    _check(values)
    pen, words = Pen(), _labels(values, quiz=quiz)
    place = _layout(values, words)
    _triangles(pen, place)
    _axes(pen, place, values)
    if values["physical"]:
        _physical(pen, place)
    _planes(pen, place)
    _names(pen, place, words, values)
    pen.onto(canvas)


def _check(values: Values) -> None:
    require("pinhole", values["p_y"] != 0, "p_y must not be 0")
    require("pinhole", values["p_z"] != values["f"] * _scale(values), "p_z must not be f")


def _scale(values: Values) -> float:
    """Size of the unit of f in units of p."""
    return 1e-3 if values["metric"] == 1 else 1.0


def _image_height(values: Values) -> float:
    return values["f"] * values["p_y"] / values["p_z"]


def _labels(values: Values, *, quiz: bool) -> dict[str, str]:
    image_unit, unit = _UNITS[int(values["metric"])]
    return {
        "f": statement("f", values["f"], image_unit),
        "p_z": statement("p_z", values["p_z"], unit),
        "p_y": statement("p_y", values["p_y"], unit),
        "image": equation("p'_y", _image_height(values), image_unit, hide=quiz),
    }


def _layout(values: Values, words: dict[str, str]) -> _Layout:

    f, p_z = values["f"] * _scale(values), values["p_z"]
    point_is_far, ratio = p_z > f, min(f, p_z) / max(f, p_z)
    far_leg, near_leg = ("p_y", "image") if point_is_far else ("image", "p_y")
    room = WIDTH - 34 - text_width(words[far_leg]) - 12 * values["physical"]
    gap = (text_width(words[near_leg]) + 9) / room
    near = min(max(ratio, _LEAST), _most(gap, values["physical"], point_is_far))
    left = below = values["physical"] * (near if point_is_far else 1.0)
    length = room / (1 + left)
    height = min(HEIGHT - 74, (HEIGHT - 40) / (1 + below))
    side = 1 if (values["p_y"] > 0) != (values["y_down"] == 1) else -1
    depth_below = max(46.0 if values["p_y"] > 0 else 60.0, below * height + 20)
    o_y = depth_below if side > 0 else HEIGHT - depth_below
    o_x = 18 + left * length + (12 if left else 0)
    return _Layout(o_x, o_y, length, height, near, point_is_far, side, near == ratio)


def _most(gap: float, physical: float, point_is_far: bool) -> float:
    """Largest place of the near leg that leaves its label room before the far leg."""
    if not physical:
        return min(_MOST, 1 - gap)
    return min(_MOST, (1 - gap) / (1 + gap) if point_is_far else 1 - 2 * gap)


def _triangles(pen: Pen, place: _Layout) -> None:

    for part, depth, tone in (("outer", 1.0, SHADE), ("inner", place.near, DEEP)):
        pen.area(part, [place.at(0, 0), place.at(depth, 0), place.at(depth, depth)], tone)
    pen.line("ray", [place.at(0, 0), place.at(1, 1)], RAY)
    pen.line("leg-point", [place.at(place.point, 0), place.at(place.point, place.point)], BOLD)
    pen.line("leg-image", [place.at(place.plane, 0), place.at(place.plane, place.plane)], BOLD)


def _axes(pen: Pen, place: _Layout, values: Values) -> None:

    start = 6.0 if values["physical"] else place.o_x - 10
    end = (place.o_x + place.length + 26, place.o_y)
    pen.arrow("axis", (start, place.o_y), end, LINE)
    pen.label((end[0] + 7, place.o_y), "z")
    reach = (-1 if values["y_down"] else 1) * (40 if values["p_y"] > 0 else 52)
    pen.arrow("axis-y", (place.o_x, place.o_y), (place.o_x, place.o_y + reach), LINE)
    pen.label((place.o_x - 7, place.o_y + 0.92 * reach), "y")
    if not place.to_scale:
        pen.break_mark(place.at((place.near + 1) / 2, 0))


def _planes(pen: Pen, place: _Layout) -> None:

    top = place.height * place.plane + 9
    pen.line("plane", [place.beside(place.plane, -9), place.beside(place.plane, top)], LINE)
    for depth, foot in ((place.near, -24), (1.0, -42)):
        pen.line("helpers", [place.beside(depth, -3), place.beside(depth, foot)], DOTTED)
    pen.line("helpers", [place.beside(0, -3), place.beside(0, -42)], DOTTED)
    corner = 5 / place.length
    for depth in (place.near, 1.0):
        pen.line(
            "right-angles",
            [
                place.beside(depth - corner, 0),
                place.beside(depth - corner, 5),
                place.beside(depth, 5),
            ],
            THIN,
        )


def _physical(pen: Pen, place: _Layout) -> None:

    depth = place.plane
    pen.area("physical", [place.at(0, 0), place.at(-depth, 0), place.at(-depth, -depth)], DEEP)
    pen.line("physical-ray", [place.at(0, 0), place.at(-depth, -depth)], DASHED)
    foot = -place.height * depth - 9
    pen.line("physical-plane", [place.beside(-depth, 10), place.beside(-depth, foot)], DASHED)
    pen.dot("points", place.at(-depth, -depth))
    pen.label(place.beside(-depth, 17), "−f")
    x, y = place.at(-depth, -depth)
    pen.label((x + 7, y - 3 * place.side), "−p'_y", "l")


def _names(pen: Pen, place: _Layout, words: dict[str, str], values: Values) -> None:
    near, far = ("f", "p_z") if place.point_is_far else ("p_z", "f")
    pen.dimension(place.beside(0, -19), place.beside(place.near, -19), words[near], "r")
    pen.dimension(place.beside(0, -37), place.beside(1, -37), words[far])
    near_leg, far_leg = ("image", "p_y") if place.point_is_far else ("p_y", "image")
    x, y = place.at(place.near, 0.5 * place.near)
    pen.label((x + 4, y), words[near_leg], "l")
    x, y = place.at(1, 0.5)
    pen.label((x + 5, y), words[far_leg], "l")
    _points(pen, place, physical=bool(values["physical"]))


def _points(pen: Pen, place: _Layout, *, physical: bool) -> None:
    near_name, far_name = ("p'", "p") if place.point_is_far else ("p", "p'")
    for depth in (0.0, place.near, 1.0):
        pen.dot("points", place.at(depth, depth))
    x, y = place.at(place.near, place.near)
    pen.label((x - 5, y + 8 * place.side), near_name, "r")
    x, y = place.at(1, 1)
    pen.label((x + 5, y), far_name, "l")
    side = place.side if physical else -place.side
    pen.label((place.o_x - 5, place.o_y + 9 * side), "{O}", "r")


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave the height of the image point out."""
    words = words_of(__file__, lang)
    labels = {name: spoken(label) for name, label in _labels(values, quiz=quiz).items()}
    told = words["figure"].format(**labels)
    if values["physical"]:
        told += words["physical"]
    height, unit = _image_height(values), _UNITS[int(values["metric"])][0]
    return told + words["quiz" if quiz else "answer"].format(
        relation=relation(height), height=derived(height), unit=f" {unit}" if unit else ""
    )
