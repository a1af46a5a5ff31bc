"""One grey photograph four times with histograms: unchanged, fewer levels, squeezed, brightened."""

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
    require,
    words_of,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


DARK = "keep"

PARAMETERS = {
    "n": Parameter("", "levels left by the coarse edit", low=2.0, high=32.0, whole=True),
    "low": Parameter("", "grey level that black becomes", low=0.0, high=255.0),
    "high": Parameter("", "grey level that white becomes", low=0.0, high=255.0),
    "s": Parameter("", "grey levels added, then clamped at 255", low=0.0, high=255.0),
    "order": Parameter(
        "", "permutation of (original, n, squeezed, s) at 1 to 4", 0.0, 0.0, 23.0, whole=True
    ),
}

EDITS = ("original", "coarse", "squeezed", "brightened")
BINS = 128
_WIDE, _HIGH = 144, 78
_GAP, _CAPTION, _HISTOGRAM, _TICKS = 8.0, 14.0, 34.0, 12.0


def edit_order(order: float) -> tuple[str, ...]:
    """Which edit has number 1, 2, 3 and 4: an index into the permutations of ``EDITS``."""
    return list(permutations(EDITS))[int(order)]


def levels(edit: str, before: NDArray[np.float64], values: Values) -> NDArray[np.float64]:
    """Grey levels that an edit makes of ones from 0 to 255, not yet rounded to 8 bits."""
    import numpy as np

    gaps = values["n"] - 1
    if edit == "coarse":
        return np.floor(before / 255 * gaps + 0.5) * 255 / gaps
    if edit == "squeezed":
        return values["low"] + (values["high"] - values["low"]) * before / 255
    return np.minimum(255.0, before + (values["s"] if edit == "brightened" else 0.0))


@cache
def scene() -> NDArray[np.uint8]:
    """Soft shades from black to white: a sky, a field, a ball and a wall, shape (78, 144)."""
    from quizgen.camera import Camera, Length, Scene, Thing, pictures, simulate
    from quizgen.camera.filters import everywhere_alike

    def grey(shade: float) -> tuple[float, float, float]:
        return (shade, shade, shade)

    things = (
        Thing("box", y=Length(-13), width=Length(_WIDE), height=Length(52), texture="ramp",
              colour=grey(0.3), other=grey(1.0)),
        Thing("box", y=Length(26), width=Length(_WIDE), height=Length(26), texture="ramp",
              colour=grey(0.5), other=grey(0.0)),
        Thing("disc", x=Length(-34), y=Length(6), width=Length(44), radius=Length(22),
              texture="ramp", colour=grey(1.0), other=grey(0.05)),
        Thing("box", x=Length(38), y=Length(8), width=Length(44), height=Length(32),
              texture="ramp", colour=grey(0.65), other=grey(0.1)),
    )  # fmt: skip
    with everywhere_alike():
        photo = simulate(Scene(_WIDE, _HIGH, things), Camera())
    return pictures.codes(photo.values)[..., 0]


def draw(canvas: Canvas, values: Values, *, quiz: bool) -> None:
    """Draw the figure; in a quiz, show numbers without the edits."""
    require("grey_edits", values["low"] < values["high"], "high must be larger than low")
    wide = (WIDTH - 3 * _GAP) / 2
    high = wide * _HIGH / _WIDE
    cell = _TICKS + _HISTOGRAM + high + _CAPTION + _GAP
    pen = Pen(WIDTH, 2 * cell)
    for place, edit in enumerate(edit_order(values["order"])):
        corner = (_GAP + (place % 2) * (wide + _GAP), (1 - place // 2) * cell)
        _photo(canvas, pen, _edited(edit, values), (*corner, wide, high))
        middle = (corner[0] + wide / 2, corner[1] + cell - 10)
        pen.label(middle, numbered(place + 1, _symbols(values, edit), quiz=quiz), size=9.5)
    pen.onto(canvas, background="#ffffff")


def _edited(edit: str, values: Values) -> NDArray[np.uint8]:
    import numpy as np

    from quizgen.camera import pictures

    table = levels(edit, np.arange(256.0), values) / 255
    return pictures.codes(table.astype(np.float32)).take(scene())


def _photo(canvas: Canvas, pen: Pen, codes: NDArray[np.uint8], where: tuple[float, ...]) -> None:
    from quizgen.figures.photographs import histogram, place

    left, low, wide, high = where
    place(canvas, pen, codes, (left, low + _TICKS + _HISTOGRAM + 3, wide, high))
    histogram(pen, codes, BINS, (left, low + _TICKS, wide, _HISTOGRAM))


def _symbols(values: Values, edit: str) -> str:
    return {
        "original": "I",
        "coarse": f"n = {given(values['n'])}",
        "squeezed": f"{given(values['low'])} … {given(values['high'])}",
        "brightened": f"I + {given(values['s'])} ≤ 255",
    }[edit]


def alt(values: Values, lang: str, *, quiz: bool) -> str:
    """Describe the figure in words: what is seen in a quiz, else which edit it is."""
    words = words_of(__file__, lang)
    fill = {name: given(values[name]) for name in ("n", "low", "high", "s")}
    told = [
        f"{number}: {words[edit + ' seen' if quiz else edit].format(**fill)}"
        for number, edit in enumerate(edit_order(values["order"]), 1)
    ]
    return words["figure"] + " " + "; ".join(told) + words["stop"]
