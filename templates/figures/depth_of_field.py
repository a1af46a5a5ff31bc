"""Three models at known distances, photographed at two f-numbers with the same brightness."""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import combinations
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import (
    Parameter,
    Values,
    format_derived,
    format_given,
    load_alt_words,
    require,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.setup.scene import Scene

Setting = tuple[float, float]
"""Distance in focus in m, and f-number."""

PARAMETERS = {
    "f": Parameter("mm", "focal length", 50.0, 10.0, 200.0),
    "N_1": Parameter("", "one f-number", 16.0, 1.0, 64.0),
    "N_2": Parameter("", "the other f-number", 1.8, 1.0, 64.0),
    "s": Parameter("m", "distance in focus", 2.0, 0.3, 100.0),
    "z_1": Parameter("m", "distance of the left model, the house", 1.2, 0.3, 1000.0),
    "z_2": Parameter("m", "distance of the middle one, the balloon", 2.0, 0.3, 1000.0),
    "z_3": Parameter("m", "distance of the right one, the sun", 6.0, 0.3, 1000.0),
    "order": Parameter(
        "", "0 puts N_1 at photo 1 and N_2 at 2, 1 the other way", 0.0, 0.0, 1.0, whole=True
    ),
}

SENSOR_MM = 36.0
"""Width of the sensor: full frame."""

_BEHIND_M = 1000.0
"""Distance of meadow and hills."""
_MODELS = ((-48.0, 7.0), (0.0, -1.0), (48.0, -4.0))
"""Middles of house, balloon and sun, in 144ths of the width, from the middle of the photo."""

_PIXELS = 216
_WIDE, _HIGH, _GAP, _FOOT = 152.0, 101.0, 8.0, 13.0
SIZE = (2 * _WIDE + _GAP, _FOOT + _HIGH + 14)


def order_f_numbers(values: Values) -> tuple[float, float]:
    """F-numbers of photos 1 and 2."""
    pair = (values["N_1"], values["N_2"])
    return (pair[1], pair[0]) if values["order"] else pair


def take_photos(values: Values, wide: int, *settings: Setting) -> tuple[NDArray[np.uint8], ...]:
    """The three models with each setting of the lens, in 8-bit codes, so many pixels wide."""
    depths = tuple(values[f"z_{place}"] for place in (1, 2, 3))
    return _take_photos(values["f"], wide, depths, settings)


@lru_cache(maxsize=64)
def _take_photos(
    focal: float, wide: int, depths: tuple[float, ...], settings: tuple[Setting, ...]
) -> tuple[NDArray[np.uint8], ...]:
    """The photographs, each two measured to differ, for the question and for its solution."""
    from quizgen.camera import Camera
    from quizgen.camera.picture_sets import make_focused
    from quizgen.figures.photographs import check_seen

    scene, models = _make_scene(wide)
    cameras = [
        Camera(focal / 1e3, SENSOR_MM / 1e3 / wide, number, distance, gamma="srgb")
        for distance, number in settings
    ]
    photos = make_focused(scene, [(*depths, _BEHIND_M)[model] for model in models], *cameras)
    for one, other in combinations(photos, 2):
        check_seen(one, other, "depth of field")
    return photos


@cache
def _make_scene(wide: int) -> tuple[Scene, list[int]]:
    """The models, and which one each part belongs to; equally large: blur alone tells distances."""
    from quizgen.camera import Scene

    from . import _models

    size, high = wide / 144, round(wide * 2 / 3)
    drawn = [
        draw_one(size * x, size * y, size)
        for draw_one, (x, y) in zip(_models.MODELS, _MODELS, strict=True)
    ]
    drawn.append(_models.meadow(wide, high, 21 * size))
    models = [place for place, parts in enumerate(drawn) for _ in parts]
    return Scene(wide, high, sum(drawn, ()), _models.SKY), models


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show their numbers without the f-numbers."""
    from quizgen.figures.photographs import place_photo

    _check(values)
    numbers = order_f_numbers(values)
    photos = take_photos(values, _PIXELS, *((values["s"], number) for number in numbers))
    for place, (photo, number) in enumerate(zip(photos, numbers, strict=True)):
        box = (place * (_WIDE + _GAP), _FOOT, _WIDE, _HIGH)
        told = "" if quiz else f"$f$/{format_given(number)}"
        place_photo(fig, photo, box, number=place + 1, told=told)
        write_distances(fig, values, box, 9.5)


def _check(values: Values) -> None:
    require("depth_of_field", 1000 * values["s"] > 2 * values["f"], "s must exceed 2 f")
    nearest = min(values[f"z_{place}"] for place in (1, 2, 3))
    require("depth_of_field", 1000 * nearest > 2 * values["f"], "objects must be beyond 2 f")
    require("depth_of_field", values["N_1"] != values["N_2"], "the f-numbers must differ")


def write_distances(
    fig: Any, values: Values, box: tuple[float, float, float, float], size: float
) -> None:
    """Write below a photograph of the models how far away each stands."""
    left, low, wide, _ = box
    art = fig.sketch()
    for place, (across, _) in enumerate(_MODELS, 1):
        middle = left + wide * (0.5 + across / 144)
        art.label((middle, low - 4), f"{format_given(values[f'z_{place}'])} m", "ct", size)


def measure_discs(values: Values, number: float) -> tuple[float, ...]:
    """Blur discs of the three models on the sensor, mm: f^2 |z-s| / (N z (s-f))."""
    focal, s = values["f"], values["s"]
    depths = [values[f"z_{place}"] for place in (1, 2, 3)]
    return tuple(focal**2 * abs(z - s) / (number * z * (1000 * s - focal)) for z in depths)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words.

    In a quiz, say how sharp the models are instead of the f-numbers.
    """
    words = load_alt_words(__file__, lang)
    depths = [format_given(values[f"z_{place}"]) for place in (1, 2, 3)]
    told = [words["figure"].format(*depths)]
    numbers = order_f_numbers(values)
    for mark, number in enumerate(numbers, 1):
        if quiz:
            told.append(words["wide" if number == min(numbers) else "small"].format(mark))
        else:
            blur = [format_derived(size) for size in measure_discs(values, number)]
            told.append(words["number"].format(mark, format_given(number), *blur))
    return " ".join(told)
