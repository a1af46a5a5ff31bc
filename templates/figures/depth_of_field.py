"""Three objects at known distances, photographed at two f-numbers with the same brightness."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING

from quizgen.figures.kit import (
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Values,
    derived,
    given,
    numbered,
    require,
    words_of,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.scene import Scene

DARK = "keep"

Setting = tuple[float, float]
"""Distance in focus in m, and f-number."""

PARAMETERS = {
    "f": Parameter("mm", "focal length", 50.0, 10.0, 200.0),
    "N_1": Parameter("", "one f-number", 16.0, 1.0, 64.0),
    "N_2": Parameter("", "the other f-number", 1.8, 1.0, 64.0),
    "s": Parameter("m", "distance in focus", 2.0, 0.3, 100.0),
    "z_1": Parameter("m", "distance of the left object", 1.2, 0.3, 1000.0),
    "z_2": Parameter("m", "distance of the middle object", 2.0, 0.3, 1000.0),
    "z_3": Parameter("m", "distance of the right object", 6.0, 0.3, 1000.0),
    "order": Parameter(
        "", "0 puts N_1 at photo 1 and N_2 at 2, 1 the other way", 0.0, 0.0, 1.0, whole=True
    ),
}

SENSOR_MM = 36.0
"""Width of the sensor: full frame."""

_WIDE, _HIGH = 144, 96
_GAP, _TOP, _BELOW = 8.0, 15.0, 15.0
_APART = 48.0
"""Pixels between the middles of neighbouring objects."""


def f_numbers(values: Values) -> tuple[float, float]:
    """F-numbers of photos 1 and 2."""
    pair = (values["N_1"], values["N_2"])
    return (pair[1], pair[0]) if values["order"] else pair


def photos_of(values: Values, wide: int, *settings: Setting) -> tuple[NDArray[np.uint8], ...]:
    """The three objects with each setting of the lens, in 8-bit codes, so many pixels wide."""
    depths = tuple(values[f"z_{place}"] for place in (1, 2, 3))
    return _photos(values["f"], wide, depths, settings)


@lru_cache(maxsize=64)
def _photos(
    focal: float, wide: int, depths: tuple[float, ...], settings: tuple[Setting, ...]
) -> tuple[NDArray[np.uint8], ...]:
    """The photographs, for the question and for its solution."""
    from quizgen.camera import Camera
    from quizgen.camera.pictures import focused

    cameras = [
        Camera(focal / 1e3, SENSOR_MM / 1e3 / wide, number, distance, gamma="srgb")
        for distance, number in settings
    ]
    return focused(_scene(wide), depths, *cameras)


@cache
def _scene(wide: int) -> Scene:
    """The objects, drawn equally large, so that blur alone tells them apart."""
    from quizgen.camera import Length, Scene, Thing

    looks = (
        ("disc", "checker", (0.9, 0.75, 0.2), (0.25, 0.06, 0.03)),
        ("box", "stripes", (0.95, 0.95, 0.95), (0.02, 0.03, 0.1)),
        ("disc", "checker", (0.75, 0.9, 0.95), (0.02, 0.12, 0.06)),
    )
    size = wide / _WIDE
    things = tuple(
        Thing(
            shape, x=Length(size * _APART * (place - 1)), y=Length(2 * size),
            width=Length(36 * size), height=Length(52 * size), radius=Length(20 * size),
            cell=Length(9 * size), texture=texture, colour=colour, other=other,
        )
        for place, (shape, texture, colour, other) in enumerate(looks)
    )  # fmt: skip
    return Scene(wide, round(size * _HIGH), things, (0.18, 0.24, 0.3))


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show their numbers without the f-numbers."""
    from quizgen.figures.photographs import place as put

    _check(values)
    wide = (WIDTH - 3 * _GAP) / 2
    high = wide * _HIGH / _WIDE
    pen = Pen(WIDTH, _BELOW + high + _TOP + 2)
    photos = photos_of(values, _WIDE, *((values["s"], number) for number in f_numbers(values)))
    for place, photo in enumerate(photos):
        left = _GAP + place * (wide + _GAP)
        put(canvas, pen, photo, (left, _BELOW, wide, high))
        told = f"f{{/{given(f_numbers(values)[place])}}}"
        pen.label((left + wide / 2, pen.height - 8), numbered(place + 1, told, quiz=quiz))
        distances(pen, values, left, wide, 9)
    pen.onto(canvas, background="#ffffff")


def _check(values: Values) -> None:
    require("depth_of_field", 1000 * values["s"] > 2 * values["f"], "s must exceed 2 f")
    nearest = min(values[f"z_{place}"] for place in (1, 2, 3))
    require("depth_of_field", 1000 * nearest > 2 * values["f"], "objects must be beyond 2 f")
    require("depth_of_field", values["N_1"] != values["N_2"], "the f-numbers must differ")


def distances(pen: Pen, values: Values, left: float, wide: float, size: float) -> None:
    """Write below a photograph of the objects how far away each stands."""
    for place in range(3):
        middle = left + wide / 2 + (place - 1) * _APART * wide / _WIDE
        pen.label((middle, 7), f"{given(values[f'z_{place + 1}'])} {{m}}", size=size)


def discs(values: Values, number: float) -> tuple[float, ...]:
    """Blur discs of the three objects on the sensor, mm."""
    return tuple(disc(values, number, values[f"z_{place}"]) / 1000 for place in (1, 2, 3))


def disc(values: Values, number: float, z: float) -> float:
    """Blur disc in um of a thing at z metres: f^2 |z-s| / (N z (s-f))."""
    focal, s = values["f"], values["s"]
    return 1000 * focal**2 * abs(z - s) / (number * z * (1000 * s - focal))


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words.

    In a quiz, say how sharp the objects are instead of the f-numbers.
    """
    words = words_of(__file__, lang)
    depths = [given(values[f"z_{place}"]) for place in (1, 2, 3)]
    told = [words["figure"].format(*depths)]
    for mark, number in enumerate(f_numbers(values), 1):
        if quiz:
            told.append(words["wide" if number == min(f_numbers(values)) else "small"].format(mark))
        else:
            blur = [derived(size) for size in discs(values, number)]
            told.append(words["number"].format(mark, given(number), *blur))
    return " ".join(told)
