"""A scene without and with one artefact, both from the camera simulator."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from quizgen.figures.kit import Parameter, Values, load_alt_words

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.camera import Camera
    from quizgen.camera.setup.scene import Colour, Scene, SceneObject

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
_COLOURED = ("lateral colour", "false colour")

_FINE = 1.5
"""Pixels to a unit of what is drawn: 144 units across, 96 down."""
_PIXELS = (216, 144)
_WIDE, _HIGH, _GAP = 148.0, 98.5, 18.0
SIZE = (2 * _WIDE + _GAP, _HIGH + 14)
_PITCH = 36e-3 / 216

CAPTIONS: Mapping[str, str] = {
    "blooming": r"$Q > Q_{\mathrm{max}}$",
    "streak": "$Q(y) + Q_s(x)$",
    "rolling shutter": r"$t = t_0 + y\,t_r$",
    "vignetting": r"$\mathrm{cos}\,θ < 1$",
    "lateral colour": "$m(λ)$",
    "barrel": "$k_1 < 0$",
    "pincushion": "$k_1 > 0$",
    "motion blur": r"$v\,t$",
    "defocus": "$z$ ≠ $s$",
    "false colour": "$ν > ν_N$",
    "clipping": r"$I > I_{\mathrm{max}}$",
    "hot pixels": r"$I_d\,t$",
}
"""What the artefact comes from, in symbols."""


def COLOUR(values: Values) -> bool:  # noqa: N802 - what a figure's module calls it
    """Whether the artefact is one of colours."""
    return KINDS[int(values["kind"])] in _COLOURED


def draw(fig: Any, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, leave out the symbols of the cause."""
    from quizgen.figures.photographs import place_photo

    kind = KINDS[int(values["kind"])]
    scene, photo = _take_pair(kind, int(values["variant"]), int(values["way"]))
    right = _WIDE + _GAP
    place_photo(fig, scene, (0, 0, _WIDE, _HIGH))
    told = "" if quiz else CAPTIONS[kind]
    place_photo(fig, photo, (right, 0, _WIDE, _HIGH), told=told)
    fig.sketch().arrow((_WIDE + 3, _HIGH / 2), (right - 3, _HIGH / 2), "grey", 0.8, part="arrows")


@lru_cache(maxsize=64)
def _take_pair(kind: str, variant: int, way: int) -> tuple[NDArray[np.uint8], ...]:
    """The scene without and with the artefact: what it needs runs, and it is measured to show."""
    from quizgen.camera.pixels.filters import numpy_only
    from quizgen.camera.question_photo import photograph_question

    with numpy_only():
        asks, grey = _ASKED.get(kind, kind), kind not in _COLOURED
        taken = photograph_question(*make_scene(kind, variant, way), asks, grey=grey)
        return taken.without.pixels(), taken.photo.pixels()


def make_scene(kind: str, variant: int, way: int = 0) -> tuple[Scene, Camera]:
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
    things, behind = _make_things(kind, side, variant, way)
    camera = Camera(gamma="srgb").replace(**_CAMERAS[kind])
    return Scene(*_PIXELS, things, behind, seed=variant), camera


_ASKED = {"streak": "smear", "barrel": "distortion", "pincushion": "distortion",
          "false colour": "demosaicing"}  # fmt: skip
"""What the camera calls an artefact, where that has another name."""
_LENS: dict[str, Any] = {"focal_length": 18e-3, "pixel_pitch": _PITCH}
_CAMERAS: Mapping[str, dict[str, Any]] = {
    "blooming": {"full_well": 8000.0, "blooming": True, "shot_noise": False},
    "streak": {"full_well": 15000.0, "smear": 0.05, "shot_noise": False},
    "rolling shutter": {"row_time": 1 / 6000},
    "vignetting": {**_LENS, "natural_vignetting": True},
    "lateral colour": {"lateral_colour": 2.5 * _FINE},
    "barrel": {**_LENS, "focal_length": 27e-3, "k1": -0.18},
    "pincushion": {**_LENS, "focal_length": 27e-3, "k1": 0.25},
    "motion blur": {"shutter": 1 / 50},
    "defocus": {"focal_length": 50e-3, "pixel_pitch": _PITCH, "f_number": 1.4,
                "focus_distance": 1.0},
    "false colour": {"mosaic": "RGGB"},
    "clipping": {"exposure": 1.0, "full_well": 20000.0, "shot_noise": False},
    "hot pixels": {"full_well": 15000.0, "hot_pixels": 0.004, "shot_noise": False},
}  # fmt: skip


def _make_things(
    kind: str, side: float, variant: int, way: int
) -> tuple[tuple[SceneObject, ...], Colour]:
    from . import _models

    if kind in ("blooming", "streak"):
        return _make_lamp(side, _GLARE[kind]), (0.01, 0.013, 0.03)
    if kind in ("rolling shutter", "motion blur"):
        return _make_box(*_DIRECTIONS.get(way, (side, 0))), _models.light("#dce9f4")
    if kind in ("barrel", "pincushion", "lateral colour"):
        return _make_grid(variant, bold=kind == "lateral colour"), (0.9, 0.9, 0.9)
    if kind == "vignetting":
        return (), (0.55, 0.55 - 0.1 * (variant % 2), 0.55 - 0.1 * (variant // 2))
    if kind == "false colour":
        return _make_weave(side, variant), (0.25, 0.25, 0.25)
    dusk = _models.light("#2b4674")  # single bright dots show best on it
    return _make_models(side), dusk if kind == "hot pixels" else _models.SKY


def _put(shape: str, x: float, y: float, paint: str, **named: Any) -> SceneObject:
    """A thing that stands 4 m away."""
    from ._models import make_thing

    return make_thing(shape, _FINE * x, _FINE * y, _FINE, paint, depth=4.0, **named)


_GLARE = {"streak": (14.0, 12.0, 8.0), "blooming": (5.6, 5.0, 3.9)}
"""Colours of the lamp: what blooms must end inside the picture, or it could be a streak."""


def _make_lamp(side: float, glare: Colour) -> tuple[SceneObject, ...]:
    from dataclasses import replace

    roof = ((-27, 0), (-19, -16), (19, -16), (27, 0))
    stars = ((-60, -40), (-44, -31), (-20, -42), (2, -34), (8, -12), (52, -40), (64, -22), (58, 4))
    panes = [(x, y) for x in (-50, -38, -26) for y in (6, 24)]
    return (
        *(_put("disc", side * x, y, "#aab2c8", radius=0.8) for x, y in stars),
        _put("box", -38 * side, 22, "#333644", width=46, height=46),
        _put("polygon", -38 * side, -1, "#4a2a26", points=roof),
        *(_put("box", side * x, y, "#93692f", width=7, height=9) for x, y in panes),
        *(_put("box", side * x, y, "#333644", width=1, height=9) for x, y in panes),
        *(_put("box", side * x, y, "#333644", width=7, height=1) for x, y in panes),
        _put("box", 0, 44, "#23282b", width=144, height=10),
        _put("box", 30 * side, 17, "#50555c", width=3, height=62),
        replace(_put("disc", 30 * side, -18, "#ffffff", radius=5), colour=glare),
    )


_SPEED = 900.0 * _FINE
_DIRECTIONS = {1: (1, 0), 2: (-1, 0), 3: (0, -1), 4: (0, 1)}
"""Way of the box to the right and down."""


def _make_box(across: float, down: float) -> tuple[SceneObject, ...]:
    """A box with two windows, darker than what is behind, that moves between trees and posts."""
    from dataclasses import replace

    from quizgen.camera import Length

    velocity = (Length(_SPEED * across), Length(_SPEED * down))
    body = (
        _put("box", 0, 8, "#c4501c", width=56, height=56),
        *(_put("box", x, -4, "#f2f7fb", width=14, height=18) for x in (-11, 11)),
    )
    return (
        _put("ellipse", -40, 42, "#b5cfae", width=120, height=34),
        _put("ellipse", 50, 42, "#a5c4a2", width=110, height=44),
        _put("box", 0, 44, "#565b5e", width=144, height=10),
        *(_put("box", x, 22, "#5d4634", width=3, height=36) for x in (-61, 61)),
        *(_put("disc", x, -2, "#3f7d46", radius=10) for x in (-61, 61)),
        *(_put("box", x, 10, "#2c3a40", width=3, height=62) for x in (-44, 44)),
        *(replace(part, velocity=velocity, depth=3.0) for part in body),
    )


def _make_grid(variant: int, *, bold: bool) -> tuple[SceneObject, ...]:
    step, stroke = 14.0 + 2.0 * variant, 3.0 if bold else 2.0
    places = [step * i for i in range(-int(80 / step), int(80 / step) + 1)]
    upright = [_put("box", place, 0, "#191919", width=stroke, height=140) for place in places]
    level = [_put("box", 0, place, "#191919", width=200, height=stroke) for place in places]
    return (*upright, *level)


def _make_weave(side: float, variant: int) -> tuple[SceneObject, ...]:
    return (
        _put("disc", 20 * side, 0, "#262626", other="#ededed", radius=40, texture="rings",
             cell=2.1 / _FINE),
        _put("box", -45 * side, 0, "#303030", other="#e7e7e7", width=40, height=80,
             texture="stripes", cell=2.15 / _FINE, angle=0.15 + 0.05 * variant),
    )  # fmt: skip


def _make_models(side: float) -> tuple[SceneObject, ...]:
    """House, balloon and sun under clouds, which have shades as long as they are not too bright."""
    from dataclasses import replace

    from . import _models

    clouds = ((-20, -37, 1.0), (30, -34, 0.8))
    puffs = ((0, 3, 32, 8), (-6, 0, 16, 10), (3, -3, 18, 12), (9, 1, 12, 8))
    shades = ((1, 4, 20), (-3, 0, 8), (6, -1, 9))
    models = zip(_models.MODELS, ((-48, 8), (0, 4), (48, -3)), strict=True)
    parts = (
        *_models.meadow(*_PIXELS, 21 * _FINE),
        *(_put("ellipse", side * x + size * dx, y + size * dy, "#fafcff", width=size * wide,
               height=size * high) for x, y, size in clouds for dx, dy, wide, high in puffs),
        *(_put("ellipse", side * x + dx, y + dy, "#cfd8e2", width=wide, height=4)
          for x, y, _ in clouds for dx, dy, wide in shades),
        *(part for model, (x, y) in models for part in model(_FINE * side * x, _FINE * y, _FINE)),
    )  # fmt: skip
    return tuple(replace(part, depth=4.0) for part in parts)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, say what is seen, not what it is called."""
    words = load_alt_words(__file__, lang)
    kind = KINDS[int(values["kind"])]
    way = _WAYS[int(values["way"])] if kind == "rolling shutter" else "seen"
    told = f"{words['figure']} {words[f'{kind} {way}']}"
    return told if quiz else f"{told} {words['called']} {words[kind]}{words['stop']}"
