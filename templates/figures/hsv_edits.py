"""One scene four times: unchanged, value scaled, saturation scaled, hue turned."""

from __future__ import annotations

from functools import cache
from itertools import permutations
from typing import TYPE_CHECKING

from quizgen.figures.kit import (
    WIDTH,
    Canvas,
    Parameter,
    Pen,
    Values,
    given,
    numbered,
    spoken,
    words_of,
)

if TYPE_CHECKING:
    from ._scene import Colour

DARK = "keep"

PARAMETERS = {
    "a": Parameter("1", "factor on the value V", low=0.0, high=1.0),
    "b": Parameter("1", "factor on the saturation S", low=0.0, high=1.0),
    "delta": Parameter("deg", "turn of the hue H", low=-360.0, high=360.0),
    "order": Parameter(
        "",
        "which permutation of (original, V, S, H) stands at 1 to 4, as edit_order says",
        0.0,
        0.0,
        23.0,
        whole=True,
    ),
    "scene": Parameter("", "variant of the scene", 0.0, 0.0, 7.0, whole=True),
}

EDITS = ("original", "V", "S", "H")
_GAP, _CAPTION = 8.0, 15.0


def edit_order(order: float) -> tuple[str, ...]:
    """Which edit has number 1, 2, 3 and 4.

    Parameters
    ----------
    order : float
        A whole number from 0 to 23: index into the permutations of ``EDITS`` in lexicographic
        order of positions; 0 leaves them as they are, 23 turns them round.

    Returns
    -------
    tuple of str
        Four names from ``EDITS``.
    """
    return list(permutations(EDITS))[int(order)]


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show numbers without the edits."""
    from quizgen.figures.photographs import framed

    from . import _scene

    wide = (WIDTH - 3 * _GAP) / 2
    high = round(wide * _scene.HEIGHT / _scene.WIDTH)
    pen = Pen(WIDTH, 2 * (high + _CAPTION) + _GAP)
    palettes = _palettes(values)
    for place, edit in enumerate(edit_order(values["order"])):
        left = _GAP + (place % 2) * (wide + _GAP)
        low = (1 - place // 2) * (high + _CAPTION) + _CAPTION
        box = (left, low, wide, high)
        framed(canvas, pen, _png(int(values["scene"]), palettes[edit]), box)
        text = numbered(place + 1, _symbols(values, edit), quiz=quiz)
        pen.label((left + wide / 2, low - 7.5), text)
    pen.onto(canvas, background="#ffffff")


def _symbols(values: Values, edit: str) -> str:
    sign = "+" if values["delta"] >= 0 else "−"
    return {
        "original": "H, S, V",
        "V": f"V × {given(values['a'])}",
        "S": f"S × {given(values['b'])}",
        "H": f"H {sign} {given(abs(values['delta']))}°",
    }[edit]


def _palettes(values: Values) -> dict[str, tuple[Colour, ...]]:
    """The scene's colours under each edit, by the camera's own editing step."""
    import numpy as np

    from quizgen.camera import pictures
    from quizgen.camera.filters import everywhere_alike

    from ._scene import PALETTE

    colours = np.asarray(PALETTE, np.float32)[None] / np.float32(255.0)
    with everywhere_alike():
        made = pictures.hsv_edits(colours, values["a"], values["b"], values["delta"])
    edited = {
        name: tuple((int(r), int(g), int(b)) for r, g, b in pictures.codes(image)[0])
        for name, image in zip(("original", "V", "S", "H"), made, strict=True)
    }
    return {**edited, "original": PALETTE}


@cache
def _pixels(scene: int) -> bytes:
    from quizgen.png import index_data

    from ._scene import indices

    return index_data(indices(scene))


def _png(scene: int, palette: tuple[Colour, ...]) -> bytes:
    from quizgen.png import indexed

    from . import _scene

    return indexed((_scene.HEIGHT, _scene.WIDTH), _pixels(scene), palette)


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words; in a quiz, leave out which edit made which picture."""
    words = words_of(__file__, lang)
    if quiz:
        return words["figure"] + words["quiz"]
    captions = []
    for number, edit in enumerate(edit_order(values["order"]), 1):
        what = words["original"] if edit == "original" else spoken(_symbols(values, edit))
        captions.append(f"{number}: {what}")
    return words["figure"] + " " + "; ".join(captions) + words["stop"]
