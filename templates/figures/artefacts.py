"""A scene without and with one artefact, both from the camera simulator."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import WIDTH, Canvas, Parameter, Pen, Values, words_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.camera import Camera
    from quizgen.camera.scene import Colour, Scene, Thing

DARK = "keep"

KINDS = (
    "blooming",
    "streak",
    "rolling shutter",
    "vignetting",
    "lateral colour",
    "barrel",
    "pincushion",
    "motion blur",
    "defocus",
    "false colour",
    "clipping",
    "hot pixels",
)
"""Artefacts in the order of their numbers."""

PARAMETERS = {
    "kind": Parameter(
        "",
        "which artefact: " + ", ".join(f"{i} {name}" for i, name in enumerate(KINDS)),
        low=0.0,
        high=len(KINDS) - 1.0,
        whole=True,
    ),
    "variant": Parameter("", "variant of the scene", 0.0, 0.0, 3.0, whole=True),
    "way": Parameter(
        "",
        "way of what moves, read from the top row: 0 by variant, 1 right, 2 left, 3 up, 4 down",
        0.0,
        0.0,
        4.0,
        whole=True,
    ),
}

_WAYS = ("seen", "right", "left", "up", "down")

_WIDE, _HIGH = 144, 96
_GAP, _TOP = 8.0, 18.0
_PITCH = 250e-6
_ORANGE, _BLUE = (0.8, 0.35, 0.05), (0.05, 0.18, 0.55)

CAPTIONS: Mapping[str, str] = {
    "blooming": "Q > Q_{max}",
    "streak": "Q(y) + Q_s(x)",
    "rolling shutter": "t = t_0 + y t_r",
    "vignetting": "{cos} θ < 1",
    "lateral colour": "m(λ)",
    "barrel": "k_1 < 0",
    "pincushion": "k_1 > 0",
    "motion blur": "v t",
    "defocus": "z ≠ s",
    "false colour": "ν > ν_N",
    "clipping": "I > I_{max}",
    "hot pixels": "I_d t",
}
"""What the artefact comes from, in symbols."""


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the symbols of the cause."""
    from quizgen.figures.photographs import place

    kind = KINDS[int(values["kind"])]
    wide = (WIDTH - 3 * _GAP) / 2
    high = wide * _HIGH / _WIDE
    pen = Pen(WIDTH, 2 + high + (_TOP if not quiz else 2))
    pair = _pair(kind, int(values["variant"]), int(values["way"]))
    for left, photo in zip((_GAP, 2 * _GAP + wide), pair, strict=True):
        place(canvas, pen, photo, (left, 2, wide, high))
    if not quiz:
        pen.label((2 * _GAP + 1.5 * wide, pen.height - 8), CAPTIONS[kind])
    pen.onto(canvas, background="#ffffff")


@lru_cache(maxsize=64)
def _pair(kind: str, variant: int, way: int) -> tuple[NDArray[np.uint8], ...]:
    """The scene without and with the artefact, for the question and for its solution."""
    from quizgen.camera import Camera, photographs
    from quizgen.camera.filters import everywhere_alike

    scene, camera = photographed(kind, variant, way)
    with everywhere_alike():
        return tuple(photo.pixels() for photo in photographs(scene, Camera(gamma="srgb"), camera))


def photographed(kind: str, variant: int, way: int = 0) -> tuple[Scene, Camera]:
    """Scene and camera that show one artefact.

    Parameters
    ----------
    kind : str
        One of ``KINDS``.
    variant : int
        0 to 3: where the main thing stands, and which way it moves.
    way : int
        As ``PARAMETERS`` says, where something moves.
    """
    from quizgen.camera import Camera, Scene

    side = 1.0 if variant % 2 else -1.0
    things, behind = _things(kind, side, variant)
    if way:
        things = _turned(things, way)
    camera = Camera(gamma="srgb").but(**_CAMERAS[kind])
    return Scene(_WIDE, _HIGH, things, behind, seed=variant), camera


_LENS: dict[str, Any] = {"focal_length": 18e-3, "pixel_pitch": _PITCH}
_CAMERAS: Mapping[str, dict[str, Any]] = {
    "blooming": {"full_well": 8000.0, "blooming": True, "shot_noise": False},
    "streak": {"full_well": 15000.0, "smear": 0.05, "shot_noise": False},
    "rolling shutter": {"row_time": 1 / 4000},
    "vignetting": {**_LENS, "natural_vignetting": True},
    "lateral colour": {"lateral_colour": 2.5},
    "barrel": {**_LENS, "focal_length": 27e-3, "k1": -0.18},
    "pincushion": {**_LENS, "focal_length": 27e-3, "k1": 0.25},
    "motion blur": {"shutter": 1 / 50},
    "defocus": {"focal_length": 50e-3, "pixel_pitch": _PITCH, "f_number": 1.4,
                "focus_distance": 1.0},
    "false colour": {"mosaic": "RGGB"},
    "clipping": {"exposure": 2.0, "full_well": 20000.0, "shot_noise": False},
    "hot pixels": {"full_well": 15000.0, "hot_pixels": 0.004, "shot_noise": False},
}  # fmt: skip


def _things(kind: str, side: float, variant: int) -> tuple[tuple[Thing, ...], Colour]:
    if kind in ("blooming", "streak"):
        return _lamp(side, _GLARE[kind]), (0.01, 0.013, 0.03)
    if kind in ("rolling shutter", "motion blur"):
        return _car(side, 900.0), (0.35, 0.45, 0.6)
    if kind in ("barrel", "pincushion", "lateral colour"):
        return _grid(variant, bright=kind == "lateral colour"), (0.9, 0.9, 0.9)
    if kind == "vignetting":
        return (), (0.55, 0.55 - 0.1 * (variant % 2), 0.55 - 0.1 * (variant // 2))
    if kind == "false colour":
        return _weave(side, variant), (0.25, 0.25, 0.25)
    return _street(side), (0.3, 0.4, 0.55)


def _box(x: float, y: float, wide: float, high: float, colour: Colour) -> Thing:
    from quizgen.camera import Length, Thing

    return Thing(
        "box", x=Length(x), y=Length(y), width=Length(wide), height=Length(high), colour=colour,
        depth=4.0,
    )  # fmt: skip


_GLARE = {"streak": (14.0, 12.0, 8.0), "blooming": (4.4, 3.9, 3.0)}
"""Colours of the lamp: what blooms must end inside the picture, or it could be a streak."""


def _lamp(side: float, glare: Colour) -> tuple[Thing, ...]:
    from quizgen.camera import Length, Thing

    lamp = Thing("disc", x=Length(30 * side), y=Length(-18), radius=Length(5),
                 colour=glare, depth=4.0)  # fmt: skip
    post = _box(30 * side, 17, 3, 62, (0.08, 0.08, 0.08))
    house = _box(-38 * side, 14, 46, 68, (0.03, 0.03, 0.045))
    window = _box(-46 * side, -2, 10, 12, (0.45, 0.28, 0.08))
    return house, window, _box(0, 44, 144, 10, (0.05, 0.05, 0.05)), post, lamp


def _turned(things: tuple[Thing, ...], way: int) -> tuple[Thing, ...]:
    """The same things, those that move at the same speed in another direction."""
    from dataclasses import replace
    from math import hypot

    from quizgen.camera import Length

    across, down = {1: (1, 0), 2: (-1, 0), 3: (0, -1), 4: (0, 1)}[way]

    def one(thing: Thing) -> Thing:
        speed = hypot(*(part.value for part in thing.velocity))
        if not speed:
            return thing
        return replace(thing, velocity=(Length(across * speed), Length(down * speed)))

    return tuple(one(thing) for thing in things)


def _car(side: float, speed: float) -> tuple[Thing, ...]:
    from dataclasses import replace

    from quizgen.camera import Length

    velocity = (Length(speed * side), Length(0.0))
    body = (
        _box(0, 8, 56, 56, _ORANGE),
        _box(-11, -4, 14, 18, (0.85, 0.9, 0.95)),
        _box(11, -4, 14, 18, (0.85, 0.9, 0.95)),
    )
    moving = tuple(replace(part, velocity=velocity, depth=3.0) for part in body)
    posts = tuple(_box(x, 10, 3, 76, (0.05, 0.1, 0.06)) for x in (-60.0, -44.0, 44.0, 60.0))
    return (_box(0, 44, 144, 10, (0.12, 0.12, 0.12)), *posts, *moving)


def _grid(variant: int, *, bright: bool) -> tuple[Thing, ...]:
    ink = (0.01, 0.01, 0.01)
    step, stroke = 14.0 + 2.0 * variant, 3.0 if bright else 2.0
    count = int(80 / step)
    upright = [_box(step * i, 0, stroke, 140, ink) for i in range(-count, count + 1)]
    level = [_box(0, step * i, 200, stroke, ink) for i in range(-count, count + 1)]
    return (*upright, *level)


def _weave(side: float, variant: int) -> tuple[Thing, ...]:
    from quizgen.camera import Length, Thing

    fine = Thing(
        "disc", x=Length(20 * side), radius=Length(40), texture="rings", cell=Length(2.1),
        colour=(0.02, 0.02, 0.02), other=(0.85, 0.85, 0.85), depth=4.0,
    )  # fmt: skip
    stripes = Thing(
        "box", x=Length(-45 * side), width=Length(40), height=Length(80), texture="stripes",
        cell=Length(2.3), angle=0.15 + 0.05 * variant, colour=(0.03, 0.03, 0.03),
        other=(0.8, 0.8, 0.8), depth=4.0,
    )  # fmt: skip
    return fine, stripes


def _street(side: float) -> tuple[Thing, ...]:
    from quizgen.camera import Length, Thing

    sun = Thing("disc", x=Length(48 * side), y=Length(-28), radius=Length(9),
                colour=(0.98, 0.9, 0.5), depth=4.0)  # fmt: skip
    return (
        sun,
        _box(0, 40, 144, 18, (0.12, 0.2, 0.05)),
        _box(-28 * side, 6, 50, 52, (0.6, 0.52, 0.42)),
        _box(-38 * side, 0, 12, 14, _BLUE),
        _box(-18 * side, 0, 12, 14, _BLUE),
        _box(26 * side, 16, 14, 34, _ORANGE),
    )


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, say what is seen, not what it is called."""
    words = words_of(__file__, lang)
    kind = KINDS[int(values["kind"])]
    way = _WAYS[int(values["way"])] if kind == "rolling shutter" else "seen"
    told = f"{words['figure']} {words[f'{kind} {way}']}"
    return told if quiz else f"{told} {words['called']} {words[kind]}{words['stop']}"
